# Running `glint` from Python: one run, or a sweep over configuration keys.
# SPDX-License-Identifier: Apache-2.0
"""`run(...)` and `sweep(...)` start the command `glint` and read what it leaves."""
from __future__ import annotations

import itertools
import json
import os
import pathlib
import shutil
import subprocess
from typing import Any, Callable, Iterable, Mapping

from .collection import Sweep
from .errors import CommandFailed, GlintError
from .run_directory import Run

_IN_TREE = ("build/release/apps/glint/glint", "build/check/apps/glint/glint")


def find_glint(glint: str | pathlib.Path | None = None) -> str:
    """The command: `glint`, else $GLINT, else on PATH, else what ./demo or ./check built beside this package.

    Raises CommandFailed, which says where it looked.
    """
    root = pathlib.Path(__file__).resolve().parents[2]
    for named in (glint, os.environ.get("GLINT")):
        if named:
            found = shutil.which(str(named))
            if not found:
                raise CommandFailed(f"{named}: there is no such program")
            return str(pathlib.Path(found).resolve())
    found = shutil.which("glint")
    for path in ([found] if found else []) + [str(root / name) for name in _IN_TREE]:
        if os.access(path, os.X_OK):
            return path
    raise CommandFailed(f"no command `glint`: not on PATH and not in {root}/build; build it with ./demo or name it in $GLINT")


def run(scene: str | pathlib.Path, *, out: str | pathlib.Path, shader: str | None = None, config: str | pathlib.Path = "mobile",
        set: Mapping[str, Any] | None = None, size: tuple[int, int] | None = None, spp: int | None = None, mode: str | None = None,
        profile: bool = False, sample: int | None = None, options: Iterable[str] = (), glint: str | pathlib.Path | None = None) -> Run:
    """`glint run`: renders a scene or workload, or launches a pipeline or kernel, and reads the run.

    Args:
        scene: what `glint run` takes: a scene, a workload ("SHIP_SH"), or a file.
        out: the run directory.
        shader: "pt", "sh" or "ao".
        config: a preset or TOML file.
        set: configuration keys that differ, {"rt.warps": 8}.
        size: (width, height) in pixels.
        spp: samples a pixel.
        mode: "timing" or "functional".
        profile: count by instruction and line.
        sample: cycles of an interval of the time series.
        options: further options as on the command line.
        glint: the command (see `find_glint`).

    Raises:
        CommandFailed: with exit code and message of the command.
    """
    words = [find_glint(glint), "run", str(scene), "--config", str(config), "--out", str(out)]
    named = {"--shader": shader, "--spp": spp, "--mode": mode, "--sample": sample, "--size": "{}x{}".format(*size) if size else None}
    for option, value in named.items():
        words += [option, str(value)] if value is not None else []
    for key, value in (set or {}).items():
        words += ["--set", f"{key}={_toml(value)}"]
    _call(words + (["--profile"] if profile else []) + list(options))
    return Run(out)


def sweep(workloads: str | Iterable[str], axes: Mapping[str, Iterable[Any]], *, out: str | pathlib.Path,
          progress: Callable[[str], None] | None = None, **options: Any) -> Sweep:
    """Runs every workload at every point of the axes, one after another, into a folder a point.

    Args:
        workloads: what `glint run` takes, one or several.
        axes: values by configuration key, {"rt.warps": [4, 8]}; the key "config" sweeps presets.
        out: the folder; points that are complete there, with the same command, are not run again.
        progress: called with a line before each point.
        options: those of `run`, for every point.

    Raises:
        CommandFailed: at the first point that fails; the points before it are kept.
    """
    folder = pathlib.Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    values = {key: list(axis) for key, axis in axes.items()}
    names = [workloads] if isinstance(workloads, str) else list(workloads)
    points = [(name, dict(zip(values, point))) for name in names for point in itertools.product(*values.values())]
    (folder / "sweep.json").write_text(json.dumps({"workloads": names, "axes": values}, indent=2) + "\n", encoding="utf-8")
    for index, (name, point) in enumerate(points, 1):
        keys = {**dict(options.get("set") or {}), **{key: value for key, value in point.items() if key != "config"}}
        more = {**options, "set": keys, **({"config": point["config"]} if "config" in point else {})}
        there = folder / "-".join([pathlib.Path(name).stem, *(f"{key}={value}" for key, value in point.items())]).replace("/", "_")
        wanted = json.dumps([name, {key: str(value) for key, value in more.items()}], sort_keys=True)
        if _complete(there, wanted):
            continue
        if progress:
            progress(f"{index}/{len(points)} {there.name}")
        run(name, out=there, **more)
        (there / "point.json").write_text(wanted, encoding="utf-8")
    return Sweep(folder)


def _complete(directory: pathlib.Path, wanted: str) -> bool:
    try:
        Run(directory)
        return (directory / "point.json").read_text(encoding="utf-8") == wanted
    except (GlintError, OSError):
        return False


def _toml(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _call(words: list[str]) -> None:
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode:
        message = done.stderr.strip() or done.stdout.strip()
        raise CommandFailed(f"{' '.join(words)}\nended with exit code {done.returncode}: {message}", done.returncode, done.stderr)

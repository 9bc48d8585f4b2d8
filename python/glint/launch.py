# Runs `glint` from Python: one run, or a sweep over configuration keys.
# SPDX-License-Identifier: Apache-2.0
"""`run(...)` and `sweep(...)` start the command `glint` and read the files that it leaves."""
from __future__ import annotations

import hashlib
import itertools
import json
import os
import pathlib
import shutil
import subprocess
import warnings
from typing import Any, Callable, Iterable, Mapping

from .collection import Sweep
from .errors import CommandFailed, GlintError
from .fingerprint import Fingerprints
from .run_directory import Run

_LONGEST = 180  # characters of a point's folder; file systems take 255 bytes
_IN_TREE = "build/release/apps/glint/glint"


def find_glint(glint: str | pathlib.Path | None = None) -> str:
    """Returns the command: the argument `glint`, else $GLINT, else the one on PATH, else the one that ./demo or ./check built next to this package.

    Raises CommandFailed, which says where it was searched.
    """
    root = pathlib.Path(__file__).resolve().parents[2]
    for named in (glint, os.environ.get("GLINT")):
        if named:
            found = shutil.which(str(named))
            if not found:
                raise CommandFailed(f"{named}: there is no such program")
            return str(pathlib.Path(found).resolve())
    found = shutil.which("glint")
    for path in ([found] if found else []) + [str(root / _IN_TREE)]:
        if os.access(path, os.X_OK):
            return path
    raise CommandFailed(f"the command `glint` is neither on PATH nor in {root}/build: build it with ./demo or name it in $GLINT")


def run(scene: str | pathlib.Path, *, out: str | pathlib.Path, shader: str | None = None, config: str | pathlib.Path = "mobile",
        set: Mapping[str, Any] | None = None, size: tuple[int, int] | str | None = None, spp: int | None = None, mode: str | None = None,
        profile: bool = False, sample: int | None = None, options: Iterable[str] = (), glint: str | pathlib.Path | None = None) -> Run:
    """Renders a scene or workload, or launches a pipeline or kernel, with `glint run`, and reads the run.

    Args:
        scene: The argument of `glint run`: a scene, a workload ("SHIP_SH"), or a file.
        out: The run directory.
        shader: One of "pt", "sh" and "ao".
        config: A preset or TOML file.
        set: The configuration keys that differ, {"rt.warps": 8}.
        size: The picture's (width, height) in pixels, or both as on the command line, "256x128".
        spp: Samples per pixel.
        mode: Either "timing" or "functional".
        profile: Whether to count by instruction and line.
        sample: Cycles per interval of the time series.
        options: Further options, as on the command line.
        glint: The command (see `find_glint`).

    Raises:
        CommandFailed: The command failed; the error has its exit code and message.
        TypeError: `options` is one text instead of a list of words.
    """
    words = [find_glint(glint), "run", str(scene), "--config", str(config), "--out", str(out)]
    named = {"--shader": shader, "--spp": spp, "--mode": mode, "--sample": sample, "--size": _size(size)}
    for option, value in named.items():
        words += [option, str(value)] if value is not None else []
    for key, value in (set or {}).items():
        words += ["--set", f"{key}={_toml(key, value)}"]
    _call(words + (["--profile"] if profile else []) + _words(options))
    return Run(out)


def sweep(workloads: str | pathlib.Path | Iterable[str | pathlib.Path], axes: Mapping[str, Iterable[Any]], *, out: str | pathlib.Path,
          progress: Callable[[str], None] | None = None, **options: Any) -> Sweep:
    """Runs every workload at every point of the axes, one after another. Each point has its own folder.

    Args:
        workloads: One or several arguments of `glint run`.
        axes: The values by configuration key, {"rt.warps": [4, 8]}. The key "config" sweeps presets. NumPy arrays are accepted.
        out: The folder. A point that is complete there with the same command is not run again; a point of the same name with
            another command is. Commands are the same if the program, the values of the configuration, and the contents of the
            workload's file and of the files that it names are the same. Points of earlier sweeps are kept but not returned
            (`Sweep.others`).
        progress: A function that is called with a line before each point.
        options: Arguments of `run`, used for every point.

    Raises:
        CommandFailed: A point failed. The points before it are kept.
        TypeError: An axis is not a list of values.
    """
    folder = pathlib.Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    values = {key: _axis(key, axis) for key, axis in axes.items()}
    names = [str(name) for name in ([workloads] if isinstance(workloads, (str, pathlib.PurePath)) else workloads)]
    if "options" in options:
        options["options"] = _words(options["options"])  # read once, used at every point
    points = _points(names, values, options)
    plan = {"workloads": names, "axes": values, "runs": list(points)}
    (folder / "sweep.json").write_text(json.dumps(plan, indent=2) + "\n", encoding="utf-8")
    prints = Fingerprints(find_glint(options.get("glint")))
    for index, (there, (name, more, wanted)) in enumerate(points.items(), 1):
        settings = {key: _toml(key, value) for key, value in more["set"].items()}
        wanted = json.dumps([*json.loads(wanted), prints.of(name, str(more.get("config", "mobile")), settings)])
        if _complete(folder / there, wanted):
            continue
        if progress:
            progress(f"{index}/{len(points)} {there}")
        run(name, out=folder / there, **more)
        (folder / there / "point.json").write_text(wanted, encoding="utf-8")
    found = Sweep(folder)
    _warn_of_idle_keys(found)
    return found


def _warn_of_idle_keys(found: Sweep) -> None:
    """Warns of keys that changed nothing because they belong to a policy that no run chose."""
    for key in found.axes:
        if key != "config" and found and not any(key in run.config for run in found.values()):
            warnings.warn(f"'{key}' has no meaning with the policies of these runs, so its values changed nothing: `glint describe {key}` tells what it needs", stacklevel=3)


def _points(names: list[str], values: Mapping[str, list[Any]], options: Mapping[str, Any]) -> dict[str, tuple[str, dict[str, Any], str]]:
    """Returns every different point by its folder, which is unique: the workload, the options of `run`, and both as text."""
    stems = [_stem(name, names) for name in names]
    found: dict[str, tuple[str, dict[str, Any], str]] = {}
    for (name, stem), *point in itertools.product(zip(names, stems), *([(key, value) for value in axis] for key, axis in values.items())):
        keys = {**dict(options.get("set") or {}), **{key: value for key, value in point if key != "config"}}
        more = {**options, "set": keys, **{key: value for key, value in point if key == "config"}}
        wanted = json.dumps([name, {key: str(value) for key, value in more.items()}], sort_keys=True)
        if any(wanted == known for _, _, known in found.values()):
            continue  # the point was named twice
        there = "-".join([stem, *(f"{key}={value}" for key, value in point)]).replace("/", "_").replace("\\", "_")
        if len(there) > _LONGEST or there in found:
            there = f"{there[:_LONGEST]}-{hashlib.sha256(wanted.encode()).hexdigest()[:8]}"
        found[there] = (name, more, wanted)
    return found


def _stem(name: str, names: Iterable[str]) -> str:
    """Returns the file's name without its ending, with as many of the folders before it as are needed to tell the workloads apart."""
    paths = {pathlib.PurePath(other).with_suffix("").parts for other in names}
    mine = pathlib.PurePath(name).with_suffix("").parts
    for count in range(1, len(mine)):
        if not any(other != mine and other[-count:] == mine[-count:] for other in paths):
            return "_".join(mine[-count:])
    return "_".join(part.strip("/") for part in mine if part.strip("/"))


def _axis(key: str, values: Any) -> list[Any]:
    """Returns the values of an axis as Python's numbers and texts."""
    if isinstance(values, (str, bytes)) or not isinstance(values, Iterable):
        raise TypeError(f"axes['{key}'] is {values!r}: a list of values is needed, [{values!r}] for one")
    return [_plain(value) for value in values]


def _plain(value: Any) -> Any:
    """Returns NumPy's numbers as Python's, and paths as texts."""
    if isinstance(value, pathlib.PurePath):
        return str(value)
    return value.item() if hasattr(value, "item") else value


def _size(size: tuple[int, int] | str | None) -> str | None:
    """Returns the picture's size as on the command line."""
    return size if size is None or isinstance(size, str) else "{}x{}".format(*size)


def _words(options: Iterable[str]) -> list[str]:
    if isinstance(options, str):
        raise TypeError(f"options is the text {options!r}: a list of words is needed, {options.split()!r}")
    return [str(word) for word in options]


def _complete(directory: pathlib.Path, wanted: str) -> bool:
    try:
        Run(directory).check()
        return (directory / "point.json").read_text(encoding="utf-8") == wanted
    except (GlintError, OSError):
        return False


def _toml(key: str, value: Any) -> str:
    value = _plain(value)
    if value is None:
        raise TypeError(f"'{key}' is None: leave the key out to keep what the configuration says")
    return str(value).lower() if isinstance(value, bool) else str(value)


def _call(words: list[str]) -> None:
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode:
        message = done.stderr.strip() or done.stdout.strip()
        raise CommandFailed(f"{' '.join(words)}\nended with exit code {done.returncode}: {message}", done.returncode, done.stderr)

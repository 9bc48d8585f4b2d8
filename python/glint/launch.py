# Runs `glint run` from Python.
# SPDX-License-Identifier: Apache-2.0
"""`run(...)` starts the command `glint` and reads the files that it leaves."""
from __future__ import annotations

import os
import pathlib
import shutil
import subprocess
from typing import Any, Iterable, Mapping

from .errors import CommandFailed
from .run_directory import Run

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
    words = [find_glint(glint), "run", str(scene), f"--config={config}", *(f"--set={one}" for one in settings_of(set)),
             *options_of(shader=shader, size=size, spp=spp, mode=mode, profile=profile, sample=sample, options=options), f"--out={out}"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode:
        raise failure_of(words, done.returncode, done.stdout, done.stderr)
    return Run(out)


def settings_of(set: Mapping[str, Any] | None) -> list[str]:
    """Returns configuration keys and their values as `--set` takes them."""
    return [f"{key}={toml_of(key, value)}" for key, value in (set or {}).items()]


def options_of(shader: str | None = None, size: tuple[int, int] | str | None = None, spp: int | None = None, mode: str | None = None, profile: bool = False,
               sample: int | None = None, options: Iterable[str] = ()) -> list[str]:
    """Returns the arguments of `run` as words of the command line."""
    named = {"shader": shader, "spp": spp, "mode": mode, "sample": sample, "size": _size(size)}
    return [*(f"--{name}={value}" for name, value in named.items() if value is not None), *(["--profile"] if profile else []), *words_in(options)]


def failure_of(words: list[str], code: int, output: str, errors: str) -> CommandFailed:
    """Returns the error of a command that has ended with an exit code (below 0: with a signal)."""
    how = f"exit code {code}" if code >= 0 else f"signal {-code}{', as the system does when memory ends' if code == -9 else ''}"
    return CommandFailed(f"{' '.join(words)}\nended with {how}: {errors.strip() or output.strip()}", code, errors)


def _size(size: tuple[int, int] | str | None) -> str | None:
    """Returns the picture's size as on the command line."""
    return size if size is None or isinstance(size, str) else "{}x{}".format(*size)


def words_in(options: Iterable[str]) -> list[str]:
    if isinstance(options, str):
        raise TypeError(f"options is the text {options!r}: a list of words is needed, {options.split()!r}")
    return [str(word) for word in options]


def toml_of(key: str, value: Any) -> str:
    """Returns a value as `--set` takes it. Raises TypeError for None."""
    value = plain(value)
    if value is None:
        raise TypeError(f"'{key}' is None: leave the key out to keep what the configuration says")
    return str(value).lower() if isinstance(value, bool) else str(value)


def plain(value: Any) -> Any:
    """Returns NumPy's numbers as Python's, and paths as texts."""
    if isinstance(value, pathlib.PurePath):
        return str(value)
    return value.item() if hasattr(value, "item") else value

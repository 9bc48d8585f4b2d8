# Runs every workload at every point of some axes, each in a folder of its own.
# SPDX-License-Identifier: Apache-2.0
"""`sweep(...)` runs points with `glint run`, several at a time, and reads what they leave. `glint.sweeps` is the larger sister, with a store and clusters."""
from __future__ import annotations

import hashlib
import itertools
import json
import os
import pathlib
import tempfile
import threading
import warnings
from typing import Any, Callable, Iterable, Mapping

from .collection import Sweep
from .errors import CommandFailed, GlintError
from .fingerprint import Fingerprints
from .launch import failure_of, find_glint, options_of, plain, settings_of, words_in
from .run_directory import Run
from .sweeps.planning import refusal
from .sweeps.pool import LocalPool
from .sweeps.process import run_process, tail
from .sweeps.program import ask
from .sweeps.running import Engine

_LONGEST = 180  # characters of a point's folder; file systems take 255 bytes


def sweep(workloads: str | pathlib.Path | Iterable[str | pathlib.Path], axes: Mapping[str, Iterable[Any]], *, out: str | pathlib.Path,
          progress: Callable[[str], None] | None = None, workers: int = 0, memory: float = 0, **options: Any) -> Sweep:
    """Runs every workload at every point of the axes, several at a time. Each point has its own folder. All points are checked before the first one runs.

    Args:
        workloads: One or several arguments of `glint run`.
        axes: The values by configuration key, {"rt.warps": [4, 8]}. The key "config" sweeps presets. NumPy arrays are accepted.
        out: The folder. A point that is complete there with the same command is not run again; a point of the same name with
            another command is. Commands are the same if the program, the values of the configuration, and the contents of the
            workload's file and of the files that it names are the same. Points of earlier sweeps are kept but not returned
            (`Sweep.others`).
        progress: A function that is called with a line before each point, never twice at once.
        workers: Points that run at a time; 0: one for each processor. Results do not depend on it.
        memory: GB that they may take together, by estimates; 0: what is available.
        options: Arguments of `run`, used for every point.

    Raises:
        CommandFailed: A point is wrong, and nothing was run; or a point failed. Then no further one begins, and those that are done are kept.
        TypeError: An axis is not a list of values.
        SweepError: `workers` or `memory` is no such number.
    """
    Engine(workers=workers, memory=memory).check()
    folder = pathlib.Path(out)
    values = {key: _axis(key, axis) for key, axis in axes.items()}
    names = [str(name) for name in ([workloads] if isinstance(workloads, (str, pathlib.PurePath)) else workloads)]
    if "options" in options:
        options["options"] = words_in(options["options"])  # read once, used at every point
    points = _points(names, values, options)
    glint = find_glint(options.get("glint"))
    asked = [_asked(name, more) for name, more, _ in points.values()]
    facts, *answers = ask(glint, asked)
    if wrong := refusal(list(points), answers):
        raise CommandFailed(wrong, 2, wrong)
    folder.mkdir(parents=True, exist_ok=True)
    plan = {"workloads": names, "axes": values, "runs": list(points)}
    (folder / "sweep.json").write_text(json.dumps(plan, indent=2) + "\n", encoding="utf-8")
    prints = Fingerprints(glint)
    left = []
    for index, (there, (name, _, wanted), one, answer) in enumerate(zip(points, points.values(), asked, answers), 1):
        wanted = json.dumps([*json.loads(wanted), prints.of(name, answer["config"])])
        if not _complete(folder / there, wanted):
            left.append({**one, "id": there, "index": index, "wanted": wanted, "memory": answer["memory"], "weight": answer["weight"]})
    _run_left(_Points(folder, glint, len(points), progress), left, workers, int(memory * 1e9) or facts["available_memory"])
    found = Sweep(folder)
    _warn_of_idle_keys(found)
    return found


def _asked(name: str, options: Mapping[str, Any]) -> dict[str, Any]:
    """Returns a point as `glint describe --points` takes it."""
    more = {key: value for key, value in options.items() if key not in ("config", "set", "glint")}
    return {"workload": name, "config": str(options.get("config", "mobile")), "settings": settings_of(options["set"]), "options": options_of(**more)}


def _run_left(work: "_Points", left: list[dict[str, Any]], workers: int, memory: int) -> None:
    pool = LocalPool(workers, memory)
    at_a_time = max(1, min(pool.workers, len(left)))
    work.threads = 0 if at_a_time == 1 else max(1, len(os.sched_getaffinity(0)) // at_a_time)
    try:
        pool.run(work, left, None, lambda: False, lambda outcome: None)
    except CommandFailed as error:
        raise work.first_failure() from error


class _Points:
    """Runs points into their folders. `threads` are those of the host for each point, unless its own options say how many."""

    def __init__(self, folder: pathlib.Path, glint: str, total: int, progress: Callable[[str], None] | None):
        self._folder, self._glint, self._total, self._progress = folder, glint, total, progress
        self.threads = 0
        self._guard = threading.Lock()
        self._failures: dict[int, CommandFailed] = {}

    def run(self, point: dict[str, Any], store: None, stop: Callable[[], bool]) -> dict[str, Any]:
        with self._guard:
            if self._progress:
                self._progress(f"{point['index']}/{self._total} {point['id']}")
        with tempfile.TemporaryDirectory(prefix="glint-point-") as scratch:
            output, errors = pathlib.Path(scratch, "stdout"), pathlib.Path(scratch, "stderr")
            words = self._words(point)
            ended = run_process(words, output, None, None, stop, errors=errors)
            if ended.by == "stop":
                return {"id": point["id"], "status": "stopped"}
            if ended.code:
                self._failures[point["index"]] = failure_of(words, ended.code, tail(output), tail(errors))
                raise self._failures[point["index"]]
        (self._folder / point["id"] / "point.json").write_text(point["wanted"], encoding="utf-8")
        return {"id": point["id"], "status": "done", "peak_bytes": ended.peak_bytes}

    def _words(self, point: dict[str, Any]) -> list[str]:
        threads = [] if any(word.split("=")[0] == "--threads" for word in point["options"]) else [f"--threads={self.threads}"]
        return [self._glint, "run", point["workload"], f"--config={point['config']}", *(f"--set={one}" for one in point["settings"]), *point["options"], *threads,
                f"--out={self._folder / point['id']}"]

    def first_failure(self) -> CommandFailed:
        """Returns the error of the first point, in the order of the axes, of those that failed."""
        return self._failures[min(self._failures)]


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
    found = [plain(value) for value in values]
    if not found:
        raise TypeError(f"axes['{key}'] is empty: a list of values is needed")
    return found


def _complete(directory: pathlib.Path, wanted: str) -> bool:
    try:
        Run(directory).check()
        return (directory / "point.json").read_text(encoding="utf-8") == wanted
    except (GlintError, OSError):
        return False

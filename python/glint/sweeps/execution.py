# Runs one point: lock, attempts, what the end of each means, and the result into the store.
# SPDX-License-Identifier: Apache-2.0
"""`Work` is what a worker needs to run points, and `Work.run(point)` runs one. It is safe to run a point twice or to kill it at any time."""
from __future__ import annotations

import dataclasses
import errno
import json
import os
import pathlib
import shutil
import socket
import subprocess
import tempfile
import time
import zipfile
import zlib
from typing import TYPE_CHECKING, Any, Callable

from ..derived import metrics
from ..errors import GlintError, StoreFull, SweepError
from ..fingerprint import file_hash
from ..run_directory import Run
from .process import Ended, run_process, tail
from .program import VARIABLES, Program, stamp_of, words_of
from .store import SCHEMA, Store

if TYPE_CHECKING:
    from .definition import Definition  # which a task of a cluster does not read

_REASONS = {2: "refused", 3: "unsupported", 4: "fault", 5: "stuck"}  # exit codes of docs/errors.md that no second attempt changes
_PARTIAL = 6  # --max-cycles ended the launch, and what it did is whole
_NO_MEMORY = ("out of memory", "bad_alloc", "Cannot allocate memory", "failed to map segment")  # of Glint, of C++, of the system and of its loader
_NO_SPACE = tuple(os.strerror(number) for number in (errno.ENOSPC, errno.EDQUOT))  # which is no property of a point
_SCRATCH = "glint-sweep-"


@dataclasses.dataclass
class Work:
    """Holds what all points of a task share. It can be written as JSON and read by another machine that sees the same folders."""
    store: str
    program: str
    program_hash: str
    program_stamp: list[int]
    definition: dict[str, Any]
    retry: dict[str, int]
    timeout: float | None
    memory_limit: int | None
    report: bool
    variables: dict[str, str]  # of the environment, those that change results

    @staticmethod
    def of(store: Store, program: Program, definition: Definition) -> "Work":
        shared = {name: getattr(definition, name) for name in ("oracles", "stats", "threads")}
        return Work(str(store.folder), program.path, program.hash, program.stamp, shared, definition.retry, definition.timeout, definition.memory_limit, definition.report,
                    {name: os.environ[name] for name in VARIABLES if name in os.environ})

    def check_program(self) -> None:
        """Raises SweepError when the program is another one than when the points were named by it."""
        try:
            same = stamp_of(self.program) == self.program_stamp or file_hash(self.program) == self.program_hash
        except OSError as error:
            raise SweepError(f"{self.program}: the program cannot be read: {error}") from error
        if not same:
            raise SweepError(f"{self.program}: the program has changed since the points were planned: `glint sweep resume` plans them again")

    def run(self, point: dict[str, Any], store: Store, stop: Callable[[], bool] = lambda: False) -> dict[str, Any]:
        """Runs a point unless the store has it. Returns its `id` and `status`: kept, done, failed, busy (somebody else runs it) or stopped."""
        id = point["id"]
        if store.has(id):
            return {"id": id, "status": "kept"}
        if not store.lock(id):
            return {"id": id, "status": "busy"}
        try:
            if store.has(id):
                return {"id": id, "status": "kept"}
            with tempfile.TemporaryDirectory(prefix=f"{_SCRATCH}{os.getpid()}-", ignore_cleanup_errors=True) as folder:
                return self._attempts(point, store, pathlib.Path(folder), stop)
        finally:
            store.unlock(id)

    def _attempts(self, point: dict[str, Any], store: Store, folder: pathlib.Path, stop: Callable[[], bool]) -> dict[str, Any]:
        attempts: list[dict[str, Any]] = []
        while True:
            ended = self._launch(point, folder, stop)
            if ended.by == "stop" or stop():
                return {"id": point["id"], "status": "stopped"}
            kind, message = _reason(ended, folder / "log.txt", self)
            if kind and any(words in tail(folder / "log.txt") for words in _NO_SPACE):
                raise StoreFull(f"no space is left for the files of a run: {message.replace('error: ', '')}\n  note: TMPDIR names another folder for them; what is done stays, and `glint sweep resume` goes on")
            if not kind:
                try:
                    return self._keep(point, store, folder, ended, attempts)
                except StoreFull:
                    raise
                except GlintError as error:
                    kind, message = "crash", f"the run has ended, and its files cannot be kept: {error}"
            attempts.append({"kind": kind, "exit": ended.code, "message": message, "seconds": round(ended.seconds, 3), "peak_bytes": ended.peak_bytes})
            if sum(one["kind"] == kind for one in attempts) > self.retry.get(kind, 0):
                break
        record = {"schema": SCHEMA, "kind": kind, "message": message, "attempts": attempts, "host": socket.gethostname(), "when": _now(), **_description(point),
                  "command": self._words(point, "OUT"), "log": tail(folder / "log.txt")}
        store.fail(point["id"], record)
        return {"id": point["id"], "status": "failed", "kind": kind, "seconds": ended.seconds, "peak_bytes": ended.peak_bytes}

    def _words(self, point: dict[str, Any], out: str) -> list[str]:
        shared = self.definition
        return [self.program, *words_of(point, shared["oracles"], shared["stats"]), f"--threads={shared['threads']}", f"--out={out}"]

    def _launch(self, point: dict[str, Any], folder: pathlib.Path, stop: Callable[[], bool]) -> Ended:
        shutil.rmtree(folder / "run", ignore_errors=True)
        return run_process(self._words(point, str(folder / "run")), folder / "log.txt", self.timeout, self.memory_limit, stop, self._environment())

    def _environment(self) -> dict[str, str]:
        """Returns this process's variables, but those that change results as they were when the points were named."""
        return {**{name: value for name, value in os.environ.items() if name not in VARIABLES}, **self.variables}

    def _keep(self, point: dict[str, Any], store: Store, folder: pathlib.Path, ended: Ended, attempts: list[dict[str, Any]]) -> dict[str, Any]:
        run = Run(folder / "run", partial=ended.code == _PARTIAL)
        files = {"run.zip": _packed(folder / "run", folder / "run.zip")}
        if self.report:
            files["report.html"] = folder / "report.html"
            self._make_report(folder / "run", files["report.html"])
        record = {"schema": SCHEMA, **_description(point), "program": self.program_hash, "glint": [run.info["version"], run.info["git"]],
                  "partial": ended.code == _PARTIAL, "metrics": _numbers(run),
                  "cost": {"seconds": round(ended.seconds, 4), "peak_bytes": ended.peak_bytes, "host": socket.gethostname(), "when": _now(), "failed_attempts": attempts},
                  "files": {name: {"bytes": path.stat().st_size, "crc32": f"{zlib.crc32(path.read_bytes()):08x}"} for name, path in files.items()}}
        store.commit(point["id"], files, record)
        return {"id": point["id"], "status": "done", "seconds": ended.seconds, "peak_bytes": ended.peak_bytes}

    def _make_report(self, run: pathlib.Path, page: pathlib.Path) -> None:
        done = subprocess.run([self.program, "report", str(run), "-o", str(page)], capture_output=True, text=True, check=False, env=self._environment())
        if done.returncode:
            raise GlintError(f"`glint report` ended with exit code {done.returncode}: {done.stderr.strip()[-200:]}")


def _numbers(run: Run) -> dict[str, float | None]:
    """Returns the metrics of a point and, of a sampled run, its estimates with their intervals: NAME, NAME_low, NAME_high."""
    out = {name: run.metrics[name] for name, about in metrics().items() if "wall_seconds" not in about.formula}
    for name, one in run.estimates.items() if run.is_sampled else ():
        out.update({name: one.value, f"{name}_low": one.low, f"{name}_high": one.high})
    return out


def _reason(ended: Ended, log: pathlib.Path, work: Work) -> tuple[str, str]:
    """Returns the kind of failure and its message, or empty texts when the run ended well."""
    if ended.by == "timeout":
        return "timeout", f"the run took longer than {work.timeout:g} s"
    if ended.code in (0, _PARTIAL):
        return "", ""
    text = tail(log)
    said = next((line for line in text.splitlines() if "error" in line), text.strip()[-200:])
    if ended.code == -9 or any(words in text for words in _NO_MEMORY):
        return "memory", said or "the system killed the process, as it does when memory ends"
    if ended.code < 0:
        return "crash", f"signal {-ended.code}: {said}"
    return _REASONS.get(ended.code, "crash"), said


def _description(point: dict[str, Any]) -> dict[str, Any]:
    return {key: point[key] for key in ("id", "workload", "config", "set", "seed", "options")}


def _packed(folder: pathlib.Path, path: pathlib.Path) -> pathlib.Path:
    """Packs a run directory. The same files give the same bytes."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=6) as packed:
        for one in sorted(folder.rglob("*")):
            if one.is_file() and one.name != "glint.lock":
                packed.writestr(zipfile.ZipInfo(str(one.relative_to(folder))), one.read_bytes(), zipfile.ZIP_DEFLATED)
    return path


def _now() -> str:
    return time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())


def remove_left_scratch() -> None:
    """Removes this host's scratch folders of workers that were killed."""
    for path in pathlib.Path(tempfile.gettempdir()).glob(f"{_SCRATCH}*"):
        pid = path.name.removeprefix(_SCRATCH).split("-")[0]
        if pid.isdigit() and not os.path.exists(f"/proc/{pid}"):
            shutil.rmtree(path, ignore_errors=True)


def to_json(work: Work, points: list[dict[str, Any]]) -> str:
    return json.dumps({"work": dataclasses.asdict(work), "points": points})


def from_json(text: str) -> tuple[Work, list[dict[str, Any]]]:
    tree = json.loads(text)
    return Work(**tree["work"]), tree["points"]

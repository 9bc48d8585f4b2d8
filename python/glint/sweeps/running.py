# Runs a sweep: plans it, leaves out what the store has, and hands the rest to an engine.
# SPDX-License-Identifier: Apache-2.0
"""`run(...)` runs or resumes a sweep, and `status(...)` says how far it is."""
from __future__ import annotations

import collections
import concurrent.futures
import contextlib
import dataclasses
import pathlib
import shutil
import signal
import threading
from typing import Any, Iterator, Mapping, TextIO

from ..errors import SweepError
from ..launch import find_glint
from .cluster import Cluster, distribute
from .definition import ENGINES, Definition
from .execution import Work, remove_left_scratch
from .executors import DaskCluster, ExecutorCluster
from .folder import SweepFolder
from .planning import plan, title_of
from .pool import LocalPool
from .program import Program
from .progress import Progress
from .slurm import SlurmCluster
from .store import Store

DEFAULT_STORE = "out/store"


@dataclasses.dataclass
class Engine:
    """Says who runs the points. Without values, the sweep's own file decides."""
    name: str | None = None  # "local", "slurm" or "dask"
    executor: concurrent.futures.Executor | None = None  # anything of Python's own interface: Ray, Parsl, MPI pools
    workers: int = 0
    memory: float = 0  # GB
    scheduler: str | None = None  # of Dask
    chunk: int = 0
    slurm: tuple[str, ...] = ()
    detach: bool = False

    def check(self) -> None:
        """Raises SweepError for values that mean nothing."""
        if self.name not in (None, *ENGINES):
            raise SweepError(f"the engine is {self.name!r}: it is one of {', '.join(ENGINES)}")
        for name in ("workers", "memory", "chunk"):
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 <= value < float("inf") or (name != "memory" and value != int(value)):
                raise SweepError(f"`{name}` of the engine is {value!r}: a {'number' if name == 'memory' else 'whole number'} from 0 is needed")


@dataclasses.dataclass
class Status:
    """Counts the different points of a sweep. `failures` has the record of each point that failed, `stopped` the signal that ended a run."""
    name: str
    points: int
    different: int
    done: int
    failures: list[dict[str, Any]]
    running: list[dict[str, Any]]
    tasks: int = 0  # of Slurm, that wait or run
    stopped: int = 0

    @property
    def left(self) -> int:
        return self.different - self.done - len(self.failures)


def read(sweep: str | pathlib.Path | Mapping[str, Any] | Definition) -> Definition:
    """Returns the definition of a sweep: of a file, a dictionary of the same form, or a definition."""
    if isinstance(sweep, Definition):
        return sweep
    return Definition.of(sweep) if isinstance(sweep, Mapping) else Definition.read(sweep)


def run(sweep: str | pathlib.Path | Mapping[str, Any] | Definition, store: str | pathlib.Path | None = None, *, engine: Engine | None = None, failed: bool = False,
        glint: str | pathlib.Path | None = None, progress: TextIO | None = None) -> Status:
    """Runs the points of a sweep that the store has not got. Running a sweep again resumes it.

    Args:
        sweep: The path of a sweep.toml, a dictionary of the same form, or a Definition.
        store: The folder of the store; by default the file's, else out/store.
        engine: Who runs the points.
        failed: Whether points that failed earlier are run again.
        glint: The command (see `glint.find_glint`).
        progress: Where lines of progress go, such as sys.stderr; None for silence.

    Raises:
        SweepError: Something is wrong with the sweep or with one of its points. Nothing was run.
        StoreFull: No space is left for points. What is done stays.
    """
    definition, engine = read(sweep), engine or Engine()
    engine.check()
    program = Program(find_glint(glint))
    points = plan(definition, program)
    kept_in = Store(store or definition.store or DEFAULT_STORE)
    try:
        kept_in.check_writable()
        folder = SweepFolder(kept_in, definition.name)
        with kept_in.plans_kept_still():
            folder.save(definition, points)
        stopped = _run_rest(definition, engine, program, kept_in, folder, points, failed, progress)
        return dataclasses.replace(_status(kept_in, folder, points), stopped=stopped)
    finally:
        kept_in.close()


def status(sweep: str | pathlib.Path | Mapping[str, Any] | Definition, store: str | pathlib.Path | None = None) -> Status:
    """Returns how far a sweep is. It may run anywhere meanwhile. `sweep` may also be the name of a sweep in the store."""
    kept_in, folder = opened(sweep, store)
    try:
        return _status(kept_in, folder, folder.points)
    finally:
        kept_in.close()


def opened(sweep: str | pathlib.Path | Mapping[str, Any] | Definition, store: str | pathlib.Path | None) -> tuple[Store, SweepFolder]:
    """Returns the store and the folder of a sweep that has been planned."""
    if isinstance(sweep, (str, pathlib.PurePath)) and not pathlib.Path(sweep).is_file():
        kept_in = Store(store or DEFAULT_STORE, new=False)
        return kept_in, SweepFolder.existing(kept_in, str(sweep))
    definition = read(sweep)
    kept_in = Store(store or definition.store or DEFAULT_STORE, new=False)
    return kept_in, SweepFolder.existing(kept_in, definition.name)


def _run_rest(definition: Definition, engine: Engine, program: Program, store: Store, folder: SweepFolder, points: list[dict[str, Any]], failed: bool,
              out: TextIO | None) -> int:
    different = {point["id"]: point for point in points}
    left = {id: point for id, point in different.items() if not store.has(id)}
    kept = len(different) - len(left)
    recorded = store.failed() & set(left)
    known_failures = {id for id in recorded if store.read_failure(id)}
    for id in recorded - known_failures:
        store.forget_failure(id)  # Its record is damaged.
    if failed:
        for id in known_failures:
            store.forget_failure(id)
    else:
        left = {id: point for id, point in left.items() if id not in known_failures}
    if out:
        earlier = f", {len(known_failures)} failed earlier{' and run again' if failed else ' (--failed runs them again)'}" if known_failures else ""
        print(f"{definition.name}: {len(points)} points, {len(different)} different, {kept} in the store{earlier}, {len(left)} to run", file=out)
    if not left:
        return 0
    remove_left_scratch()
    for ended in folder.ended_runs(with_tasks=False):
        shutil.rmtree(ended, ignore_errors=True)
    place = folder.new_run()
    progress = Progress(len(different), kept, {id: point["weight"] for id, point in left.items()}, lambda facts: folder.note(place, facts), out)
    work = Work.of(store, program, definition)
    submitted = False
    try:
        with signals(place) as stop:
            progress.tell()
            cluster = cluster_of(definition, engine, folder, place)
            if cluster is None:
                memory = int(engine.memory * 1e9) or program.facts["available_memory"]
                workers = engine.workers or max(1, LocalPool().workers // definition.threads)
                LocalPool(workers, memory).run(work, list(left.values()), store, stop, progress.count)
            else:
                with contextlib.closing(cluster):
                    submitted = distribute(cluster, work, list(left.values()), store, place, stop, progress.count, progress.tell, engine.detach)
        progress.tell(last=True)
        return stop.signal
    finally:
        if not submitted:
            shutil.rmtree(place, ignore_errors=True)


def cluster_of(definition: Definition, engine: Engine, folder: SweepFolder, place: pathlib.Path) -> Cluster | None:
    """Returns the cluster that an engine means, or None for this machine."""
    if engine.executor is not None:
        return ExecutorCluster(engine.executor, engine.chunk)
    name = engine.name or definition.engine
    if name == "slurm":
        return SlurmCluster(definition, folder, place.name, engine.slurm, engine.chunk)
    if name == "dask":
        return DaskCluster(engine.scheduler or definition.dask.get("scheduler"), engine.workers, engine.chunk or definition.dask.get("chunk", 0))
    return None


class _Stop:
    """Says whether to stop: a signal came, or `glint sweep cancel` marked the run."""

    def __init__(self, place: pathlib.Path):
        from .worker import Stop
        self.signal = 0
        self._mark = Stop(place / "stop")

    def set(self, number: int, _: Any) -> None:
        self.signal = number
        self._mark.set()

    def __call__(self) -> bool:
        return self._mark()


@contextlib.contextmanager
def signals(place: pathlib.Path) -> Iterator[_Stop]:
    """Gives what hears Ctrl-C and SIGTERM, while it lasts."""
    stop = _Stop(place)
    if threading.current_thread() is not threading.main_thread():
        yield stop
        return
    before = {number: signal.signal(number, stop.set) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)}
    try:
        yield stop
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _status(store: Store, folder: SweepFolder, points: list[dict[str, Any]]) -> Status:
    different = {point["id"]: point for point in points}
    left = [id for id in different if not store.has(id)]
    failures = [record for id in sorted(store.failed() & set(left)) if (record := store.read_failure(id))]
    return Status(folder.name, len(points), len(different), len(different) - len(left), failures, list(folder.progress()), slurm_tasks(folder))


def slurm_tasks(folder: SweepFolder) -> int:
    """Returns how many tasks of a sweep Slurm has, or 0 where nobody submitted any."""
    if not shutil.which("squeue") or not any(folder.place.glob("runs/*/0-*.json")):
        return 0
    try:
        return len(SlurmCluster(folder.definition, folder, "").live())
    except SweepError:
        return 0


def text_of(found: Status) -> str:
    """Returns a status in words."""
    from .progress import duration
    lines = [f"{found.name}: {found.points} points, {found.different} different: {found.done} done, {len(found.failures)} failed, {found.left} left"]
    for note in found.running:
        left = f", {duration(note['left'])} left" if note.get("left") is not None else ""
        lines.append(f"runs on {note['host']}, process {note['pid']}: {note['done']} of {note['total']}{left}")
    if found.tasks:
        lines.append(f"Slurm has {found.tasks} tasks that wait or run")
    kinds = collections.Counter(record["kind"] for record in found.failures)
    if kinds:
        lines.append("failures: " + ", ".join(f"{count} {kind}" for kind, count in kinds.most_common()))
    lines += [f"  {record['kind']:<8} {record['id'][:8]}  {title_of(record)}: {record['message'].splitlines()[0] if record['message'] else ''}" for record in found.failures[:10]]
    if len(found.failures) > 10:
        lines.append(f"  ... and {len(found.failures) - 10} more (--json lists all)")
    return "\n".join(lines)

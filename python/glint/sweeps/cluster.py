# Hands the points of a sweep to a cluster as tasks, watches the store, and hands out again what was lost.
# SPDX-License-Identifier: Apache-2.0
"""`distribute(cluster, ...)` works for every `Cluster`: Slurm, Dask, or an executor of Python."""
from __future__ import annotations

import abc
import json
import pathlib
import socket
import time
from typing import Any, Callable

from .execution import SCHEMA, Work, to_json
from .store import Store, write_whole

_TASKS = 500  # tasks that points are spread over when nobody chose a chunk
_PATIENCE = 30  # seconds that tasks have to end when a run is stopped
_LONGEST_WAIT = 30  # seconds between looks at the store


class Cluster(abc.ABC):
    """Runs tasks, each the path of a file for `worker.run_task`.

    Contract:
      - A task may be run several times, at once too. It may be killed at any time.
      - `live()` names each task that waits or runs, until it is certain that it does not any more.
      - `close()` gives back what the cluster took, and ends nothing that was submitted with `detach`.
    """
    chunk = 0

    @abc.abstractmethod
    def submit(self, tasks: list[pathlib.Path], memory: int, threads: int) -> None:
        """Hands out tasks. Each needs `memory` bytes at most, by estimates, and so many threads."""

    @abc.abstractmethod
    def live(self) -> set[pathlib.Path]:
        """Returns the tasks that wait or run, also those that an earlier process submitted for this sweep."""

    @abc.abstractmethod
    def cancel(self) -> None:
        """Takes back every task."""

    def log(self, task: pathlib.Path) -> str:
        """Returns what a task wrote, as far as it is known."""
        return ""

    def close(self) -> None:
        pass


def distribute(cluster: Cluster, work: Work, points: list[dict[str, Any]], store: Store, place: pathlib.Path, stop: Callable[[], bool],
               tell: Callable[[dict[str, Any]], None], wait: Callable[[], None], detach: bool) -> bool:
    """Runs the points on a cluster, and returns whether tasks of this run are still out there.

    Args:
        place: The folder for the files of tasks.
        stop: Says whether to stop.
        tell: Hears of each point that is done or has failed.
        wait: Is called about once a second.
        detach: Whether to leave when all is submitted.
    """
    left = {point["id"]: point for point in points}
    owner: dict[str, pathlib.Path] = {}
    for attempt in range(work.retry["lost"] + 1):
        elsewhere = _points_of(cluster.live())
        wanted = [point for id, point in left.items() if id not in elsewhere]
        tasks = _tasks(cluster, work, wanted, place, attempt, owner)
        if tasks and not stop():
            cluster.submit(tasks, max(point["memory"] for point in wanted) << attempt, work.definition["threads"])
        if detach:
            return True
        _watch(cluster, left, store, stop, tell, wait)
        if stop():
            return _stopped(cluster, place)
        if not left:
            return False
    for id, point in left.items():
        store.fail(id, _lost(point, cluster, owner.get(id), work))
        tell({"id": id, "status": "failed"})
    return False


def _tasks(cluster: Cluster, work: Work, points: list[dict[str, Any]], place: pathlib.Path, attempt: int, owner: dict[str, pathlib.Path]) -> list[pathlib.Path]:
    chunk = cluster.chunk or max(1, -(-len(points) // _TASKS))
    points = sorted(points, key=lambda point: -point["weight"])
    count = -(-len(points) // chunk)
    tasks = []
    for number in range(count):  # Heavy and light points are spread evenly.
        mine = points[number::count]
        path = place / f"{attempt}-{number}.json"
        write_whole(path, to_json(work, mine))
        owner.update({point["id"]: path for point in mine})
        tasks.append(path)
    return tasks


def _points_of(tasks: set[pathlib.Path]) -> set[str]:
    out: set[str] = set()
    for task in tasks:
        try:
            out |= {point["id"] for point in json.loads(task.read_text(encoding="utf-8"))["points"]}
        except (OSError, ValueError, KeyError):
            continue  # A task without its file runs nothing.
    return out


def _watch(cluster: Cluster, left: dict[str, dict[str, Any]], store: Store, stop: Callable[[], bool], tell: Callable[[dict[str, Any]], None], wait: Callable[[], None]) -> None:
    """Waits until the points are done or no task lives. What ended is taken out of `left`."""
    while left and not stop():
        start = time.monotonic()
        alive = bool(cluster.live())
        _settle(left, store, tell)
        if not alive:
            return
        pause = min(_LONGEST_WAIT, max(1.0, 10 * (time.monotonic() - start)))  # Looking takes a tenth of the time at most.
        until = time.monotonic() + pause
        while left and not stop() and time.monotonic() < until:
            wait()
            time.sleep(0.2)


def _settle(left: dict[str, dict[str, Any]], store: Store, tell: Callable[[dict[str, Any]], None]) -> None:
    failed = store.failed()
    for id in list(left):
        status = "done" if store.has(id) else "failed" if id in failed else ""
        if status:
            del left[id]
            tell({"id": id, "status": status})


def _stopped(cluster: Cluster, place: pathlib.Path) -> bool:
    (place / "stop").touch()
    cluster.cancel()
    until = time.monotonic() + _PATIENCE
    while time.monotonic() < until:
        if not cluster.live():
            return False
        time.sleep(0.3)
    return True


def _lost(point: dict[str, Any], cluster: Cluster, task: pathlib.Path | None, work: Work) -> dict[str, Any]:
    times = work.retry["lost"] + 1
    return {"schema": SCHEMA, "kind": "lost", "message": f"the task ended {times} times without a result of this point", "attempts": [], "host": socket.gethostname(),
            **{key: point[key] for key in ("id", "workload", "config", "set", "seed", "options")}, "log": cluster.log(task) if task else ""}

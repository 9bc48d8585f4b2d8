# Runs points on this machine, a few at a time within a limit of memory, as `glint bench` does.
# SPDX-License-Identifier: Apache-2.0
"""`LocalPool` is the engine that needs nothing but this machine."""
from __future__ import annotations

import os
import threading
import time
from typing import Any, Callable, Protocol

from .store import Store

_BUSY = 0.5  # seconds until a point that somebody else runs is looked at again
_MARGIN = 1.1  # of a measured peak of memory


class Worker(Protocol):
    """Runs a point (`execution.Work`). The pool itself asks nothing of the store, which may be None where points are kept elsewhere."""

    def run(self, point: dict[str, Any], store: Any, stop: Callable[[], bool]) -> dict[str, Any]:
        """Returns the `id` and `status` of the point and, when it is done, its `peak_bytes`. It ends soon after `stop` says so."""


class LocalPool:
    """Starts the points that are estimated to take longest first. A point whose memory does not fit waits; one that never fits runs alone.

    Args:
        workers: Points that run at a time.
        memory: Bytes that they may take together, by estimates until a point of the same workload has been measured. 0 sets no limit.
    """

    def __init__(self, workers: int = 0, memory: int = 0):
        self.workers = workers or len(os.sched_getaffinity(0))
        self.memory = memory
        self._turn = threading.Condition()
        self._queue: list[dict[str, Any]] = []
        self._later: list[tuple[float, dict[str, Any]]] = []
        self._running: dict[str, int] = {}
        self._peaks: dict[Any, int] = {}
        self._error: BaseException | None = None
        self._interrupted = False
        self._alive = 0  # threads that have not ended

    def run(self, work: Worker, points: list[dict[str, Any]], store: Store | None, stop: Callable[[], bool], tell: Callable[[dict[str, Any]], None]) -> None:
        """Runs the points until all have ended or `stop` says so. `tell` hears how each ended. When a point raises an error, no other one begins, and the error
        is raised when those that run have ended."""
        self._queue = sorted(points, key=lambda point: -point["weight"])
        self._stop = lambda: self._interrupted or stop()
        threads = [threading.Thread(target=self._work, args=(work, store, tell), daemon=True) for _ in range(min(self.workers, len(points)))]
        self._alive = len(threads)
        try:
            for thread in threads:
                thread.start()
            self._wait()
        except BaseException:  # such as Ctrl-C, where nobody else hears it
            self._interrupted = True
            with self._turn:
                self._alive -= sum(thread.ident is None for thread in threads)
            self._wait()
            raise
        if self._error:
            raise self._error

    def _wait(self) -> None:
        """Waits for the end of all threads. Python's Thread.join() takes a thread for ended when a signal interrupts it."""
        with self._turn:
            while self._alive:
                self._turn.wait(0.2)  # A signal can only be heard between waits.

    def _work(self, work: Worker, store: Store | None, tell: Callable[[dict[str, Any]], None]) -> None:
        try:
            self._run_points(work, store, tell)
        finally:
            with self._turn:
                self._alive -= 1
                self._turn.notify_all()

    def _run_points(self, work: Worker, store: Store | None, tell: Callable[[dict[str, Any]], None]) -> None:
        while point := self._take():
            outcome = None
            try:
                outcome = work.run(point, store, self._stop)
            except BaseException as error:  # noqa: B036 (the thread that started this one raises it)
                self._error = error
            self._give_back(point, outcome)
            if outcome and outcome["status"] in ("kept", "done", "failed"):
                tell(outcome)

    def _take(self) -> dict[str, Any] | None:
        """Returns the next point, or None when there is nothing left to do."""
        with self._turn:
            while not self._stop() and not self._error:
                now = time.monotonic()
                self._queue += [point for when, point in self._later if when <= now]
                self._later = [(when, point) for when, point in self._later if when > now]
                at = next((i for i, point in enumerate(self._queue) if self._fits(point)), None)
                if at is not None:
                    point = self._queue.pop(at)
                    self._running[point["id"]] = self._need(point)
                    return point
                if not self._queue and not self._later:
                    return None
                self._turn.wait(_BUSY / 2)
            return None

    def _fits(self, point: dict[str, Any]) -> bool:
        return not self._running or not self.memory or sum(self._running.values()) + self._need(point) <= self.memory

    def _need(self, point: dict[str, Any]) -> int:
        return self._peaks.get(_kind(point), point["memory"])

    def _give_back(self, point: dict[str, Any], outcome: dict[str, Any] | None) -> None:
        with self._turn:
            del self._running[point["id"]]
            if outcome and outcome["status"] == "busy":
                self._later.append((time.monotonic() + _BUSY, point))
            if outcome and outcome["status"] == "done":
                self._peaks[_kind(point)] = max(self._peaks.get(_kind(point), 0), int(outcome["peak_bytes"] * _MARGIN))
            self._turn.notify_all()


def _kind(point: dict[str, Any]) -> Any:
    return point["workload"], point["config"], tuple(point["options"])

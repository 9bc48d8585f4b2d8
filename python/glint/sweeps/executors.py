# Runs tasks with executors of Python's own interface (concurrent.futures): Dask, Ray, Parsl, MPI pools.
# SPDX-License-Identifier: Apache-2.0
"""`ExecutorCluster(executor)` takes any executor whose workers see the store's folder; `DaskCluster(address)` makes its own."""
from __future__ import annotations

import concurrent.futures
import os
import pathlib
from typing import Any, Callable

from ..errors import SweepError
from ..optional import require
from .cluster import Cluster
from .worker import run_task

_PACKAGE = str(pathlib.Path(__file__).resolve().parents[2])


class ExecutorCluster(Cluster):
    """Submits tasks to an executor. Workers import this package, so it has to be installed where they run."""

    def __init__(self, executor: concurrent.futures.Executor, chunk: int = 0):
        self.chunk = chunk or 1
        self._executor = executor
        self._futures: dict[pathlib.Path, concurrent.futures.Future[Any]] = {}

    def submit(self, tasks: list[pathlib.Path], memory: int, threads: int) -> None:
        function = self._function()
        for task in tasks:
            try:
                self._futures[task] = self._executor.submit(function, str(task))
            except RuntimeError as error:  # An executor whose processes were killed takes nothing more.
                failed: concurrent.futures.Future[Any] = concurrent.futures.Future()
                failed.set_exception(error)
                self._futures[task] = failed

    def _function(self) -> Callable[[str], Any]:
        return run_task

    def live(self) -> set[pathlib.Path]:
        return {task for task, future in self._futures.items() if not future.done()}

    def cancel(self) -> None:
        for future in self._futures.values():
            future.cancel()

    def log(self, task: pathlib.Path) -> str:
        future = self._futures.get(task)
        if future is None or not future.done() or future.cancelled():
            return ""
        return repr(future.exception()) if future.exception() else ""


class DaskCluster(ExecutorCluster):
    """Connects to a Dask scheduler, or starts workers on this machine when there is no address. Workers need this Python, and the folders of the store and the program."""

    def __init__(self, scheduler: str | None, workers: int = 0, chunk: int = 0):
        distributed = require("distributed", "the engine \"dask\"")
        self._local = None
        try:
            if scheduler is None:
                self._local = distributed.LocalCluster(n_workers=workers or len(os.sched_getaffinity(0)), threads_per_worker=1, processes=True, host="127.0.0.1", dashboard_address=None)
            self._client = distributed.Client(self._local or scheduler, timeout="10s")
        except OSError as error:
            raise SweepError(f"{scheduler}: no Dask scheduler answers: {error}") from error
        super().__init__(self._client.get_executor(pure=False), chunk)

    def _function(self) -> Callable[[str], Any]:
        return _carried(_PACKAGE)

    def cancel(self) -> None:
        self._client.cancel([future for future in self._dask_futures()], force=True)
        super().cancel()

    def _dask_futures(self) -> list[Any]:
        return list(self._client.futures)

    def close(self) -> None:
        self._client.close()
        if self._local:
            self._local.close()


def _carried(package: str) -> Callable[[str], Any]:
    """Returns a function that Dask carries whole to its workers, which do not know this package before."""
    def run(path: str) -> Any:
        import sys
        if package not in sys.path:
            sys.path.insert(0, package)
        from glint.sweeps.worker import run_task as task
        return task(path)

    run.__module__, run.__qualname__ = "__main__", "glint_sweep_task"
    return run

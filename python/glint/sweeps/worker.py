# Runs the points of one task of a cluster: `python3 -S -m glint.sweeps.worker TASK.json`.
# SPDX-License-Identifier: Apache-2.0
"""`run_task(path)` runs the points of a task's file one after another. A task may be killed and run again at any time. It needs the standard
library alone, so that its Python starts without looking for packages (-S)."""
from __future__ import annotations

import collections
import os
import pathlib
import signal
import sys
import time
from typing import Any

from ..errors import GlintError
from .execution import from_json, remove_left_scratch
from .store import Store

_LOOK = 1.0  # seconds between looks at the mark of a run that is to stop
_BUSY = 0.5


class Stop:
    """Says whether a task is to end: its run has been marked, or a signal came."""

    def __init__(self, mark: pathlib.Path):
        self._mark, self._seen, self._asked = mark, 0.0, False

    def set(self, *_: Any) -> None:
        self._asked = True

    def __call__(self) -> bool:
        if not self._asked and time.monotonic() - self._seen > _LOOK:
            self._seen = time.monotonic()
            self._asked = os.path.exists(self._mark)
        return self._asked


def run_task(path: str, stop: Stop | None = None) -> dict[str, int]:
    """Runs the points of a task, and returns how many ended in which way. Raises SweepError when the program has changed."""
    file = pathlib.Path(path)
    work, points = from_json(file.read_text(encoding="utf-8"))
    work.check_program()
    stop = stop or Stop(file.parent / "stop")
    store = Store(work.store)
    counts: collections.Counter[str] = collections.Counter()
    try:
        while points and not stop():
            busy = []
            for point in points:
                status = work.run(point, store, stop)["status"] if not stop() else "stopped"
                busy += [point] if status == "busy" else []
                counts[status] += status != "busy"
            points = busy
            if busy:
                time.sleep(_BUSY)
    finally:
        store.close()
    return dict(counts)


def main() -> int:
    path = sys.argv[1]
    stop = Stop(pathlib.Path(path).parent / "stop")
    signal.signal(signal.SIGTERM, stop.set)
    signal.signal(signal.SIGINT, stop.set)
    remove_left_scratch()
    try:
        counts = run_task(path, stop)
    except (GlintError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    print(", ".join(f"{count} {status}" for status, count in sorted(counts.items())))
    return 143 if stop() else 0


if __name__ == "__main__":
    sys.exit(main())

# Says how far a sweep is: at most one line a second, with the time that is left.
# SPDX-License-Identifier: Apache-2.0
"""`Progress` counts points as they end and tells of them."""
from __future__ import annotations

import sys
import threading
import time
from typing import Any, Callable, TextIO


class Progress:
    """Counts the points of a run.

    Args:
        total: How many different points the sweep has.
        kept: How many of them the store has already.
        weights: The relative times of the points to run, by id.
        note: Is called with the counts, at most once a second.
        out: Where lines go, or None for silence.
    """

    def __init__(self, total: int, kept: int, weights: dict[str, float], note: Callable[[dict[str, Any]], None], out: TextIO | None = sys.stderr):
        self.total, self.kept, self.done, self.failed = total, kept, 0, 0
        self._weights, self._left = weights, sum(weights.values())
        self._all = self._left
        self._note, self._out = note, out
        self._start = time.monotonic()
        self._told = self._noted = 0.0
        self._guard = threading.Lock()
        self._every = 1.0 if out is not None and out.isatty() else 5.0

    def count(self, outcome: dict[str, Any]) -> None:
        """Counts a point that ended. Each point counts once."""
        with self._guard:
            weight = self._weights.pop(outcome["id"], None)
            if weight is None:
                return
            self._left -= weight
            self.failed += outcome["status"] == "failed"
            self.done += outcome["status"] != "failed"
        self.tell()

    def tell(self, last: bool = False) -> None:
        now = time.monotonic()
        with self._guard:
            if last or now - self._noted >= 1:
                self._noted = now
                self._note(self.facts())
            if self._out is None or (not last and now - self._told < self._every):
                return
            self._told = now
            end = "\r" if self._out.isatty() and not last else "\n"
            self._out.write(f"{self.text()}\033[K{end}" if self._out.isatty() else f"{self.text()}\n")
            self._out.flush()

    def facts(self) -> dict[str, Any]:
        return {"total": self.total, "done": self.kept + self.done, "failed": self.failed, "seconds": time.monotonic() - self._start, "left": self._seconds_left()}

    def _seconds_left(self) -> float | None:
        finished = self._all - self._left
        return (time.monotonic() - self._start) * self._left / finished if finished > 0 and self._weights else None

    def text(self) -> str:
        seconds, left = time.monotonic() - self._start, self._seconds_left()
        rate = (self.done + self.failed) / seconds if seconds > 0 else 0
        failed = f", {self.failed} failed" if self.failed else ""
        return f"{self.kept + self.done} of {self.total} points{failed}, {rate:.1f} a second" + (f", {duration(left)} left" if left is not None else "")


def duration(seconds: float) -> str:
    """Returns a time in words: "40 s", "12 min", "3.5 h"."""
    if seconds < 120:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"

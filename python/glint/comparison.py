# Tells what changed from one run to another, metric by metric.
# SPDX-License-Identifier: Apache-2.0
"""`compare(a, b)` returns the metrics that differ, the largest change first, as `glint compare` prints them."""
from __future__ import annotations

import dataclasses
import math
import pathlib

from .derived import metrics
from .run_directory import Run


@dataclasses.dataclass(frozen=True)
class Change:
    """Holds a metric of two runs.

    Attributes:
        relative: The value (after - before) / before, or None when `before` is 0 and `after` is not.
    """
    metric: str
    unit: str
    before: float
    after: float
    relative: float | None

    def __str__(self) -> str:
        change = "new" if self.relative is None else f"{self.relative:+.1%}"
        return f"{self.metric:24} {self.before:14.6g} {self.after:14.6g} {change:>9}  {self.unit}"


def compare(a: Run | str | pathlib.Path, b: Run | str | pathlib.Path, everything: bool = False) -> list[Change]:
    """Returns the metrics that both runs have and that changed, or all metrics with `everything`.

    The largest change comes first. Changes are compared as ratios, so half as much and twice as much are equally large. A
    metric that is 0 in one of the runs comes before all others.

    The speed of the host (`sim_rate`) is left out.
    """
    first, second = (run if isinstance(run, Run) else Run(run) for run in (a, b))
    changes = []
    for name, metric in metrics().items():
        before, after = first.metrics[name], second.metrics[name]
        if name == "sim_rate" or before is None or after is None or (before == after and not everything):
            continue
        relative = 0.0 if before == after else (after - before) / abs(before) if before else None
        changes.append(Change(name, metric.unit, before, after, relative))
    return sorted(changes, key=_distance, reverse=True)


def _distance(change: Change) -> float:
    return math.inf if change.relative is None else abs(change.relative)


def speedup(before: list[Run], after: list[Run]) -> float:
    """Returns the geometric mean of time before / time after, run by run. Raises ValueError when the lists are empty or of unequal length."""
    if not before or len(before) != len(after):
        raise ValueError(f"{len(before)} runs before and {len(after)} after: both lists need the same length of at least one")
    product = 1.0
    for one, other in zip(before, after):
        product *= one.seconds / other.seconds
    return product ** (1 / len(before))

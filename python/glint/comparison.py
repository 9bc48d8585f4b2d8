# What changed from one run to another, metric by metric.
# SPDX-License-Identifier: Apache-2.0
"""`compare(a, b)`: the metrics that differ, the largest change first, as `glint compare` prints them."""
from __future__ import annotations

import dataclasses
import math
import pathlib

from .derived import metrics
from .run_directory import Run


@dataclasses.dataclass(frozen=True)
class Change:
    """A metric of two runs.

    Attributes:
        relative: (after - before) / before; None where `before` is 0 and `after` is not.
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
    """Metrics that both runs have and that changed (all with `everything`), the largest change first, on a scale of ratios:
    half as much and twice as much are alike; what was 0, or is now, comes before all.

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
    """Geometric mean of time before / time after, run by run; ValueError for lists of unequal length or none."""
    if not before or len(before) != len(after):
        raise ValueError(f"{len(before)} runs before, {len(after)} after: as many are needed, and at least one")
    product = 1.0
    for one, other in zip(before, after):
        product *= one.seconds / other.seconds
    return product ** (1 / len(before))

# Says how much each key of a sweep moves a result: main effects, and Sobol indices of sampled sweeps.
# SPDX-License-Identifier: Apache-2.0
"""`effects(...)` and `sobol(...)` use the standard library alone."""
from __future__ import annotations

import dataclasses
import random
import statistics
from typing import Any, Sequence

_BINS = 10  # of a key with many values
_IN_A_BIN = 3  # rows at least, without which the scatter within it says nothing
_FEWEST = 20  # points below which a first-order index is not estimated
_RESAMPLES = (20, 100)  # at least, at most
_DRAWN = 300_000  # rows that all resamples of a key may draw
_SEED = 1


@dataclasses.dataclass
class Effect:
    """Says what a key does to a result.

    Attributes:
        levels: For each value, or range of values, of the key: its name, the mean of the result over all points that have it, and their number.
        span: The largest mean less the smallest one.
        share: The part of the result's variance that lies between the means, from 0 to 1. It is the first-order Sobol index of a sample, estimated from
            the given points and corrected for chance.
        interval: 95 % of `share` when points are drawn again (bootstrap).
        total: The total Sobol index with all interactions, for designs of the method "saltelli"; otherwise None.
    """
    key: str
    levels: list[tuple[str, float, int]]
    span: float
    share: float
    interval: tuple[float, float] | None = None
    total: float | None = None


def effects(rows: Sequence[dict[str, Any]], keys: Sequence[str], result: str) -> list[Effect]:
    """Returns the effect of each key that differs, with the largest share first. Rows without the result are left out."""
    rows = [row for row in rows if isinstance(row.get(result), (int, float))]
    out = []
    for key in keys:
        groups = _groups(rows, key, alone=len(keys) == 1)
        if len(groups) < 2:
            continue
        values = [[row[result] for row in group] for _, group in groups]
        levels = [(name, statistics.fmean(group), len(group)) for (name, _), group in zip(groups, values)]
        means = [mean for _, mean, _ in levels]
        out.append(Effect(key, levels, max(means) - min(means), _share(values), _interval(values) if len(rows) >= _FEWEST else None))
    return sorted(out, key=lambda effect: -effect.share)


def sobol(values: Sequence[float], keys: Sequence[str]) -> dict[str, tuple[float, float]]:
    """Returns first-order and total indices of each key, from the results of a "saltelli" design in its order (A, B, AB_1 .. AB_d for each base point).

    The estimators are those that Saltelli et al. (2010) recommend: theirs for the first order, Jansen's for the total.
    """
    width = len(keys) + 2
    rows = [values[i:i + width] for i in range(0, len(values) - width + 1, width)]
    variance = statistics.pvariance([value for row in rows for value in row[:2]]) if rows else 0
    if variance == 0:
        return {key: (0.0, 0.0) for key in keys}
    out = {}
    for i, key in enumerate(keys):
        first = statistics.fmean(row[1] * (row[2 + i] - row[0]) for row in rows) / variance
        total = statistics.fmean((row[0] - row[2 + i]) ** 2 for row in rows) / 2 / variance
        out[key] = (first, total)
    return out


def pareto(rows: Sequence[dict[str, Any]], objectives: Sequence[tuple[str, bool]]) -> list[int]:
    """Returns the places of the rows that no other row beats: none is at least as good in every objective and better in one.

    Args:
        objectives: Columns, and whether more is better.
    """
    points = [(i, [row[name] * (-1 if more else 1) for name, more in objectives]) for i, row in enumerate(rows)
              if all(isinstance(row.get(name), (int, float)) for name, _ in objectives)]
    front: list[tuple[int, list[float]]] = []
    for i, one in sorted(points, key=lambda point: point[1]):  # Whoever beats a point comes before it.
        if not any(all(a <= b for a, b in zip(other, one)) and other != one for _, other in front):
            front.append((i, one))
    return sorted(i for i, _ in front)


def _groups(rows: Sequence[dict[str, Any]], key: str, alone: bool) -> list[tuple[str, list[dict[str, Any]]]]:
    """Returns rows by value of a key, or by ranges with as many rows each when the values are many numbers. Numbers that hardly come twice are many, too, unless
    no other key differs: between groups of one row lies all variance, whatever made it.
    """
    rows = [row for row in rows if row.get(key) is not None]
    different = {row[key] for row in rows}
    is_number = all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in different)
    ordered = sorted(rows, key=lambda row: row[key] if is_number else str(row[key]))
    come_twice = alone or 2 * len(different) <= len(rows)
    if (len(different) <= 2 * _BINS and come_twice) or not is_number:
        out: dict[Any, list[dict[str, Any]]] = {}
        for row in ordered:
            out.setdefault(row[key], []).append(row)
        return [(str(value), group) for value, group in out.items()]
    count = max(2, min(_BINS, len(ordered) // _IN_A_BIN))
    parts = [ordered[len(ordered) * i // count:len(ordered) * (i + 1) // count] for i in range(count)]
    return [(f"{part[0][key]:g} .. {part[-1][key]:g}", part) for part in parts if part]


def _share(groups: Sequence[Sequence[float]]) -> float:
    """Returns the variance between groups over all variance (omega squared, which corrects for chance where groups have several rows)."""
    values = [value for group in groups for value in group]
    mean, count = statistics.fmean(values), len(values)
    whole = sum((value - mean) ** 2 for value in values)
    between = sum(len(group) * (statistics.fmean(group) - mean) ** 2 for group in groups)
    within = (whole - between) / (count - len(groups)) if count > len(groups) else 0.0
    if whole <= 0:
        return 0.0
    return min(1.0, max(0.0, (between - (len(groups) - 1) * within) / (whole + within)))


def _interval(groups: Sequence[Sequence[float]]) -> tuple[float, float]:
    source = random.Random(_SEED)
    count = min(_RESAMPLES[1], max(_RESAMPLES[0], _DRAWN // sum(map(len, groups))))
    found = sorted(_share([source.choices(group, k=len(group)) for group in groups]) for _ in range(count))
    return found[round(0.025 * (count - 1))], found[round(0.975 * (count - 1))]

# Holds the statistics of one run: a flat table by dotted path, with units, meanings, and sums over instances.
# SPDX-License-Identifier: Apache-2.0
"""Reads the statistics in `stats.json` of a run directory (docs/stats.md lists all)."""
from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import Any, Iterator

from .errors import SchemaError, UnknownName
from .patterns import compiled, near
from .table import Table

Number = int | float


@dataclasses.dataclass(frozen=True)
class Stat:
    """Holds one statistic.

    Attributes:
        path: The dotted path, e.g. "gpu.core[3].instructions".
        value: A number, {part: number} for a breakdown, or a list of counts for a histogram.
        unit: The unit, e.g. "cycle".
        doc: A sentence that says what it counts.
        bins: For a histogram {"low", "high", "step"} in the statistic's unit, else None.
    """
    path: str
    value: Number | dict[str, Number] | list[Number]
    unit: str
    doc: str
    bins: dict[str, Number] | None = None


@dataclasses.dataclass(frozen=True)
class Histogram:
    """Holds counts over all instances: `counts[i]` values lie in [edges[i], edges[i + 1]); the last bin is open upwards."""
    edges: list[Number]
    counts: list[Number]
    unit: str


class Stats(Mapping[str, Any]):
    """Holds statistics by path. `stats["gpu.cycles"]` and `stats["gpu.core[0].issue_slots::issued"]` are values.
    `about`, `select`, `sum`, `parts` and `histogram` take patterns. In a pattern, `*` stands for any characters except '.',
    and `core.`, `rt.`, `l1.`, `l2.` or `dram.` at the beginning stands for all instances."""

    def __init__(self, stats: dict[str, Stat]):
        self._stats = stats
        self._paths: dict[str, list[str]] | None = None  # with parts, by what follows the last dot; made when a pattern is first looked for
        self._found: dict[str, list[tuple[str, Any]]] = {}

    @classmethod
    def from_tree(cls, tree: dict[str, Any]) -> Stats:
        """Makes statistics from the tree in stats.json. Raises SchemaError when it has none or when a value is not a number."""
        stats: dict[str, Stat] = {}
        _gather(tree, "", stats)
        if not stats:
            raise SchemaError("stats.json holds no statistics: it was not written by this version of Glint")
        return cls(stats)

    @classmethod
    def from_totals(cls, table: Table) -> Stats:
        """Makes statistics from stats.csv of a run with `--stats compact`: totals, in whose paths `[*]` stands for all instances of a unit."""
        stats: dict[str, Stat] = {}
        for path, value, unit in zip(table["path"], table["value"], table["unit"]):
            name, separator, part = path.partition("::")
            if not _is_value(value):
                raise SchemaError(f"'{path}' is {value!r:.40}, which is not a number: the file is damaged")
            if separator:
                known = stats.setdefault(name, Stat(name, {}, unit, "")).value
                if not isinstance(known, dict):
                    raise SchemaError(f"'{name}' is a number and has parts: the file is damaged")
                known[part] = value
            else:
                stats[path] = Stat(path, value, unit, "")
        return cls(stats)

    def __getitem__(self, path: str) -> Any:
        if path in self._stats:
            return self._stats[path].value
        name, separator, part = path.partition("::")
        value = self._stats[name].value if separator and name in self._stats else None
        if isinstance(value, dict) and part in value:
            return value[part]
        if isinstance(value, dict):
            raise UnknownName(f"'{name}' has no part '{part}': it has {', '.join(value)}")
        hint = " ('*' is for select, sum, parts and histogram)" if "*" in path else ""
        raise UnknownName(f"there is no statistic '{path}'{near(path, self._stats)}{hint}")

    def __iter__(self) -> Iterator[str]:
        return iter(self._stats)

    def __len__(self) -> int:
        return len(self._stats)

    def about(self, path: str) -> Stat:
        """Returns the statistic with unit and meaning; for a pattern, the first that matches. Raises UnknownName when none matches."""
        if path in self._stats:
            return self._stats[path]
        for stat in self.select(path).values():
            return stat
        raise UnknownName(f"there is no statistic '{path}'{near(path, self._stats)}")

    def select(self, pattern: str) -> dict[str, Stat]:
        """Returns all statistics whose whole path matches, in the order of the file, or {} when none matches."""
        match = compiled(pattern.partition("::")[0]).fullmatch
        return {path: stat for path, stat in self._stats.items() if match(path)}

    def values(self, pattern: str | None = None) -> Any:
        """Without a pattern, returns all values, as any mapping does. With a pattern, returns the numbers that match, with parts (`::`)."""
        return super().values() if pattern is None else [value for _, value in self._numbers(pattern)]

    def has(self, pattern: str) -> bool:
        """Returns whether a number matches."""
        return bool(self._numbers(pattern))

    def sum(self, pattern: str) -> Number:
        """Returns the sum of all numbers that match: over instances and, with `::*`, over parts. Raises UnknownName when none matches."""
        found = self._numbers(pattern)
        if not found:
            raise UnknownName(f"there is no statistic '{pattern}'{near(pattern, self._stats)}")
        return sum(value for _, value in found)

    def parts(self, pattern: str) -> dict[str, Number]:
        """Returns the parts of a breakdown in order, summed over the instances that match. Raises UnknownName when none matches."""
        total: dict[str, Number] = {}
        for stat in self.select(pattern).values():
            if isinstance(stat.value, dict):
                for part, value in stat.value.items():
                    total[part] = total.get(part, 0) + value
        if not total and not any(isinstance(stat.value, dict) for stat in self.select(pattern).values()):
            raise UnknownName(f"there is no breakdown '{pattern}'{near(pattern, self._stats)}")
        return total

    def histogram(self, pattern: str) -> Histogram:
        """Returns a histogram, summed over the instances that match. Raises UnknownName when none matches."""
        found = [stat for stat in self.select(pattern).values() if isinstance(stat.value, list) and stat.bins]
        if not found:
            raise UnknownName(f"there is no histogram '{pattern}'{near(pattern, self._stats)}")
        bins = found[0].bins or {}
        counts: list[Number] = [0] * max(len(stat.value) for stat in found)  # type: ignore[arg-type]
        for stat in found:
            for index, count in enumerate(stat.value):  # type: ignore[arg-type]
                counts[index] += count
        edges = [bins["low"] + index * bins["step"] for index in range(len(counts) + 1)]
        return Histogram(edges, counts, found[0].unit)

    def rows(self) -> Iterator[tuple[str, Number, str, str]]:
        """Yields (path, value, unit, meaning) of every number. Parts are written `path::part`; histograms are left out."""
        for stat in self._stats.values():
            if isinstance(stat.value, dict):
                for part, value in stat.value.items():
                    yield f"{stat.path}::{part}", value, stat.unit, stat.doc
            elif not isinstance(stat.value, list):
                yield stat.path, stat.value, stat.unit, stat.doc

    def _numbers(self, pattern: str) -> list[tuple[str, Any]]:
        if pattern not in self._found:
            if self._paths is None:
                self._paths = {}
                for path, *_ in self.rows():
                    self._paths.setdefault(path.rpartition(".")[2], []).append(path)
            match, end = compiled(pattern).fullmatch, pattern.rpartition(".")[2]
            some = [path for path, *_ in self.rows()] if "*" in end else self._paths.get(end, [])
            self._found[pattern] = [(path, self[path]) for path in some if match(path)]
        return self._found[pattern]


def _gather(tree: dict[str, Any], prefix: str, out: dict[str, Stat]) -> None:
    for name, node in tree.items():
        path = f"{prefix}.{name}" if prefix else name
        if isinstance(node, dict) and "value" in node and "unit" in node:
            if not _is_value(node["value"]):
                raise SchemaError(f"'{path}' is {node['value']!r:.40}, which is not a number: the file is damaged")
            out[path] = Stat(path, node["value"], node["unit"], node.get("doc", ""), node.get("bins"))
        elif isinstance(node, dict):
            _gather(node, path, out)


def _is_value(value: Any) -> bool:
    """Returns whether this is a number, or parts or bins of numbers. JSON's true, false, null and texts are not numbers."""
    many = value.values() if isinstance(value, dict) else value if isinstance(value, list) else (value,)
    return all(type(one) in (int, float) and math.isfinite(one) for one in many)

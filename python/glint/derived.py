# Computes the 87 metrics of a run: formulas over its statistics, evaluated as `glint stats --format metrics` does.
# SPDX-License-Identifier: Apache-2.0
"""`metrics.csv` next to this file is the generated output of `glint list metrics`; a test compares the values."""
from __future__ import annotations

import ast
import csv
import dataclasses
import functools
import operator
import pathlib
import re
from collections.abc import Mapping
from typing import Any, Callable, Iterator

from .errors import UnknownName
from .patterns import near


@dataclasses.dataclass(frozen=True)
class Metric:
    """Holds a metric's name, unit, meaning and formula (docs/metrics.md)."""
    name: str
    unit: str
    doc: str
    formula: str


@functools.lru_cache(maxsize=1)
def metrics() -> dict[str, Metric]:
    """Returns all metrics by name, in the order of `metrics.csv` of `glint bench`."""
    path = pathlib.Path(__file__).with_name("metrics.csv")
    with open(path, newline="", encoding="utf-8") as file:
        return {row["name"]: Metric(row["name"], row["unit"], row["meaning"], row["formula"]) for row in csv.DictReader(file)}


class Metrics(Mapping[str, "float | None"]):
    """Holds the metrics of one run by name. A metric is None when its divisor is 0, or when a functional or a sampled run does not count it."""

    def __init__(self, run: Any):
        self._run = run
        self._known: dict[str, float | None] = {}

    def __getitem__(self, name: str) -> float | None:
        if name not in metrics():
            raise UnknownName(f"there is no metric '{name}'{near(name, metrics())} 'glint list metrics' shows all metrics")
        if name not in self._known:
            self._known[name] = self._value(metrics()[name].formula, name)
        return self._known[name]

    def _value(self, formula: str, name: str) -> float | None:
        # The counts of a sampled run are those of a part of the launch, so only its estimate is a metric.
        if "sample.share" in self._run.info:
            return self._run.stats["gpu.sample.cycles"] if name == "cycles" else None
        return evaluate(formula, self._run) if formula else None

    def __iter__(self) -> Iterator[str]:
        return iter(metrics())

    def __len__(self) -> int:
        return len(metrics())

    def about(self, name: str) -> Metric:
        """Returns unit, meaning and formula. Raises UnknownName when there is no such metric."""
        self[name]
        return metrics()[name]


_OPERATORS: dict[type, Callable[[float, float], float]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv}
_CALL = re.compile(r"(sum|max|mean|run|config)\(([^()]*)\)")


def evaluate(formula: str, run: Any) -> float | None:
    """Evaluates a formula of docs/metrics.md over a run. Returns None when a name is missing or a divisor is zero.

    Raises ValueError when the text is not a formula.
    """
    looked_up: list[float | None] = []

    def look_up(match: re.Match[str]) -> str:
        looked_up.append(_look_up(match[1], match[2], run))
        return f"v[{len(looked_up) - 1}]"

    tree = ast.parse(_CALL.sub(look_up, formula), mode="eval").body
    return _value(tree, looked_up, formula)


def _look_up(function: str, name: str, run: Any) -> float | None:
    if function == "run":
        return _number(run.info.get(name))
    if function == "config":
        return _number(run.config.get(name))
    values = run.stats.values(name) or _functional_values(name, run)
    if not values:
        return None
    if function == "max":
        return float(max(values))
    return sum(values) / (len(values) if function == "mean" else 1)


# Maps counters of the timing machine's cores and RT units to the functional machine's statistics, as report/metrics/formula.cpp does.
_FUNCTIONAL = {"core.lane_instructions": "gpu.lanes::*", "core.instructions": "gpu.instructions::*", "rt.rays": "gpu.rays", "rt.nodes": "gpu.nodes",
               "rt.box_tests": "gpu.box_tests", "rt.triangle_tests": "gpu.triangle_tests"}
_BY_CLASS = "core.instructions_by_class::"


def _functional_values(name: str, run: Any) -> list[float]:
    path = "gpu.instructions::" + name.removeprefix(_BY_CLASS) if name.startswith(_BY_CLASS) else _FUNCTIONAL.get(name)
    return run.stats.values(path) if path else []


def _number(value: Any) -> float | None:
    return float(value) if isinstance(value, (int, float)) and not isinstance(value, bool) else None


def _value(node: ast.expr, looked_up: list[float | None], formula: str) -> float | None:
    if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
        return float(node.value)
    if isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Constant):
        return looked_up[node.slice.value]
    if isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
        left, right = _value(node.left, looked_up, formula), _value(node.right, looked_up, formula)
        if left is None or right is None or (isinstance(node.op, ast.Div) and right == 0):
            return None
        return _OPERATORS[type(node.op)](left, right)
    raise ValueError(f"'{formula}' is not a formula")

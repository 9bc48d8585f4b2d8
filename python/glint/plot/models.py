# Draws analytical models: predicted against simulated cycles, workload by workload (LumiBench, Figure 15).
# SPDX-License-Identifier: Apache-2.0
"""The figures read `models.csv` as `glint model` writes it: workloads with simulated cycles and a column `model:NAME` for each model."""
from __future__ import annotations

import math
import pathlib
from typing import Any

from ..collection import Bench
from ..errors import MissingFile, SchemaError
from ..table import Table
from .kinds import Part, ranked
from .style import COLOURS, RUN_COLOURS, legend, new_figure, run_colour, styled

Models = Table | Bench | str | pathlib.Path

_PREFIX = "model:"
_MARKS = "osD^v"


def correlation(predicted: list[float], simulated: list[float]) -> float:
    """Returns R squared of the linear regression of simulated on predicted cycles, as LumiBench gives it, or 0 when one does not vary."""
    count = len(predicted)
    a, b = sum(predicted) / count, sum(simulated) / count
    both = sum((x - a) * (y - b) for x, y in zip(predicted, simulated))
    spread = sum((x - a) ** 2 for x in predicted) * sum((y - b) ** 2 for y in simulated)
    return both * both / spread if spread else 0.0


def _read(table: Models) -> tuple[Table, list[str]]:
    """Returns the table and its columns of models. It checks that all rows have positive cycles."""
    if not isinstance(table, Table):
        path = pathlib.Path(table.directory if isinstance(table, Bench) else table)
        path = path / "models.csv" if path.is_dir() else path
        if not path.is_file():
            raise MissingFile(f"{path}: there is no such table of models")
        table = Table.read(path, needs=("workload", "cycles"))
    models = [column for column in table.columns if column.startswith(_PREFIX)]
    if not models or not len(table):
        raise SchemaError(f"there is no column '{_PREFIX}NAME' or no row, so this is not a table of models")
    for column in ("cycles", *models):
        if not all(isinstance(value, (int, float)) and math.isfinite(value) for value in table[column]) or (column == "cycles" and min(table[column]) <= 0):
            raise SchemaError(f"a row has no number in '{column}', or cycles that are not positive: the table is damaged")
    return table, models


def model_fit(table: Models) -> Any:
    """Draws predicted against simulated cycles with each model's R squared; on the line both are equal. It takes a table, `models.csv`, its folder, or a `Bench` on which `glint model` was run."""
    table, models = _read(table)
    cycles = table["cycles"]
    with styled():
        figure, axes = new_figure(2.6)
        handles, names = [], []
        for index, column in enumerate(models):
            handles.append(axes.scatter(cycles, table[column], s=11, color=run_colour(index), marker=_MARKS[index % len(_MARKS)], linewidth=0))
            names.append(f"{column.removeprefix(_PREFIX)} (R² {correlation(table[column], cycles):.3f})")
        ends = [min(cycles), max(cycles)]
        axes.plot(ends, ends, color=COLOURS["dark"], linewidth=0.6, linestyle="--")
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xlabel("simulated cycles")
        axes.set_ylabel("predicted cycles")
        axes.grid(color=COLOURS["pale"], linewidth=0.4)
        legend(figure, handles, names)
        return figure


def model_errors(table: Models) -> Any:
    """Draws how far each model's cycles are from the simulated ones, workload by workload. It takes the same argument as `model_fit`."""
    table, models = _read(table)
    if len(models) > len(RUN_COLOURS):
        raise SchemaError(f"{len(models)} models are too many, because there are {len(RUN_COLOURS)} colours")
    parts = [Part(column.removeprefix(_PREFIX), run_colour(index), [predicted / cycles - 1 for predicted, cycles in zip(table[column], table["cycles"])])
             for index, column in enumerate(models)]
    return ranked(table["workload"], parts, "predicted - simulated (%)", percent=True)

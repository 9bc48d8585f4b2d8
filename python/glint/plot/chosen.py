# Selects the runs that a figure shows (one, a list, or a folder of runs) and checks what they must have.
# SPDX-License-Identifier: Apache-2.0
"""These functions serve all figures of runs."""
from __future__ import annotations

import pathlib
from collections.abc import Mapping
from typing import Any, Iterable, Sequence

from ..collection import Bench, Sweep
from ..errors import GlintError, SchemaError
from ..labelling import labels
from ..run_directory import Run
from .kinds import Part, grouped, histogram, spread
from .style import RUN_COLOURS, run_colour

Chosen = Run | Iterable[Run] | Mapping[str, Run] | str | pathlib.Path


def opened(path: str | pathlib.Path) -> Run | Bench | Sweep:
    """Returns what a folder holds: a run, the points of a sweep, or the runs of a bench."""
    folder = pathlib.Path(path)
    if (folder / "sweep.json").is_file():
        return Sweep(folder)
    return Run(folder) if (folder / "run.json").is_file() or not (folder / "metrics.csv").is_file() else Bench(folder)


def chosen(runs: Chosen) -> list[Run]:
    """Returns a list of the runs. Raises GlintError when it is empty or has a functional run, which has no cycles."""
    if isinstance(runs, (str, pathlib.Path)):
        runs = opened(runs)
    found = [runs] if isinstance(runs, Run) else list(runs.values()) if isinstance(runs, Mapping) else list(runs)
    if not found:
        raise GlintError("a figure needs at least one run")
    for run in found:
        if run.info["mode"] != "timing":
            raise GlintError(f"{run.directory}: a functional run has no cycles to draw: run it with --mode timing")
    return found


def with_rays(runs: Chosen) -> list[Run]:
    """Returns the runs that traced rays in RT units. Raises GlintError when there is none."""
    found = [run for run in chosen(runs) if run.metrics["rt_occupancy"] is not None]
    if not found:
        raise GlintError("none of the runs has rays in RT units (kernels, compute shaders and rt.unit = \"software\" have none)")
    return found


def names(runs: Sequence[Run]) -> list[str]:
    """Returns a name for each run, made from what differs, or from the workload of a single run."""
    return labels(list(runs))


def rows_of(runs: Sequence[Run], kinds: Sequence[str]) -> list[tuple[str, Run, str]]:
    """Returns (label, run, kind) of every pair of a run and a kind, kind by kind."""
    several = len(runs) > 1
    return [(f"{name}, {kind}" if several else kind, run, kind) for kind in kinds for name, run in zip(names(runs), runs)]


def at_most_eight(runs: Sequence[Run], figure: str) -> None:
    """Raises GlintError when there are more runs than colours."""
    if len(runs) > len(RUN_COLOURS):
        raise GlintError(f"{figure} has a colour for each run, and there are {len(RUN_COLOURS)} colours: choose as many of the {len(runs)} runs")


def total(run: Run, pattern: str) -> Any:
    """Returns the sum of the matching numbers, and 0 for a breakdown without such a part. Raises SchemaError when the run has no such statistic."""
    name = pattern.partition("::")[0]
    if not run.stats.select(name):
        raise SchemaError(f"{run.directory}: there is no statistic '{name}': another version of Glint wrote the run, so run it again")
    return sum(run.stats.values(pattern))


def shares(runs: Sequence[Run], metrics: Sequence[tuple[str, str, str]]) -> Any:
    """Draws bars of metrics that are fractions, with a group for each run. `metrics` has (name shown, colour, metric)."""
    return grouped(names(runs), [Part(name, colour, [run.metrics[metric] for run in runs]) for name, colour, metric in metrics], "%", percent=True, top=100)


def spreads(runs: Sequence[Run], histograms: Sequence[Any], x_label: str, y_label: str) -> Any:
    """Draws histograms of the runs as lines, or, for more runs than colours, their quantiles with a row for each run."""
    if len(runs) > len(RUN_COLOURS):
        return spread(names(runs), histograms, x_label)
    return histogram([(name, run_colour(i), one) for i, (name, one) in enumerate(zip(names(runs), histograms))], x_label, y_label)

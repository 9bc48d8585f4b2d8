# Which runs a figure is of: one, a list, or a folder of runs; and what they must have.
# SPDX-License-Identifier: Apache-2.0
"""Helpers of all figures of runs."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Iterable, Sequence

from ..errors import GlintError, SchemaError
from ..labelling import labels
from ..run_directory import Run
from .kinds import Part, grouped, histogram, spread
from .style import RUN_COLOURS, run_colour

Chosen = Run | Iterable[Run] | Mapping[str, Run]


def chosen(runs: Chosen) -> list[Run]:
    """A list of the runs; GlintError for none, and for functional ones, which have no cycles."""
    found = [runs] if isinstance(runs, Run) else list(runs.values()) if isinstance(runs, Mapping) else list(runs)
    if not found:
        raise GlintError("a figure needs at least one run")
    for run in found:
        if run.info["mode"] != "timing":
            raise GlintError(f"{run.directory}: a functional run has no cycles to draw: run it with --mode timing")
    return found


def with_rays(runs: Chosen) -> list[Run]:
    """The runs that traced rays in RT units; GlintError without any."""
    found = [run for run in chosen(runs) if run.metrics["rt_occupancy"] is not None]
    if not found:
        raise GlintError("none of the runs has rays in RT units (kernels, compute shaders and rt.unit = \"software\" have none)")
    return found


def names(runs: Sequence[Run]) -> list[str]:
    """A name for each run: of what differs, or the workload of a single one."""
    return labels(list(runs))


def rows_of(runs: Sequence[Run], kinds: Sequence[str]) -> list[tuple[str, Run, str]]:
    """(label, run, kind) of every pair, kind by kind."""
    several = len(runs) > 1
    return [(f"{name}, {kind}" if several else kind, run, kind) for kind in kinds for name, run in zip(names(runs), runs)]


def at_most_eight(runs: Sequence[Run], figure: str) -> None:
    """GlintError for more runs than there are colours."""
    if len(runs) > len(RUN_COLOURS):
        raise GlintError(f"{figure} has a colour a run, and there are {len(RUN_COLOURS)}: choose as many of the {len(runs)} runs")


def total(run: Run, pattern: str) -> Any:
    """The sum of what matches, 0 of a breakdown without such a part; SchemaError where the run has no such statistic."""
    name = pattern.partition("::")[0]
    if not run.stats.select(name):
        raise SchemaError(f"{run.directory}: no statistic '{name}': another version of Glint wrote the run, run it again")
    return sum(run.stats.values(pattern))


def shares(runs: Sequence[Run], metrics: Sequence[tuple[str, str, str]]) -> Any:
    """Bars of metrics that are fractions, a group a run; `metrics`: (name shown, colour, metric)."""
    return grouped(names(runs), [Part(name, colour, [run.metrics[metric] for run in runs]) for name, colour, metric in metrics], "%", percent=True, top=100)


def spreads(runs: Sequence[Run], histograms: Sequence[Any], x_label: str, y_label: str) -> Any:
    """Histograms of the runs as lines; of more runs than there are colours their quantiles, a row a run."""
    if len(runs) > len(RUN_COLOURS):
        return spread(names(runs), histograms, x_label)
    return histogram([(name, run_colour(i), one) for i, (name, one) in enumerate(zip(names(runs), histograms))], x_label, y_label)

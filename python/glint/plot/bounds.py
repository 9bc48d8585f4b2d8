# Draws what limits a run, and what changed from one run to another.
# SPDX-License-Identifier: Apache-2.0
"""Draws each resource against the most that it could do, and metrics by their change."""
from __future__ import annotations

import pathlib
from typing import Any, Callable

from ..comparison import compare
from ..errors import GlintError
from ..run_directory import Run
from .chosen import Chosen, at_most_eight, chosen, names, total
from .kinds import Part, ranked
from .style import COLOURS, COLUMN, new_figure, run_colour, styled
from .text import fitted

_SECTOR = 32  # bytes


def _starts(run: Run, tests: float, unit: str) -> float | None:
    cycles = total(run, "rt.unit_cycles")
    if not cycles or f"rt.{unit}.units" not in run.config:
        return None
    return tests * run.config[f"rt.{unit}.interval"] / run.config[f"rt.{unit}.units"] / cycles


def _bandwidth(run: Run, sectors: float, *peaks: str) -> float | None:
    known = [run.info[f"memory_peaks.{peak}"] for peak in peaks if run.info.get(f"memory_peaks.{peak}")]
    return _SECTOR * sectors / run.seconds / min(known) if known else None


def _requests(run: Run) -> float | None:
    most = total(run, "rt.unit_cycles") * run.config.get("rt.requests_per_cycle", 0)
    return total(run, "rt.requests") / most if most else None


# The limits are those of the report (web/src/sections/bounds.js).
_LIMITS: list[tuple[str, Callable[[Run], float | None]]] = [
    ("issue slots", lambda run: total(run, "core.instructions") / (total(run, "core.issue_slots::*") or 1)),
    ("RT unit: requests", _requests),
    ("RT unit: box tests", lambda run: _starts(run, total(run, "rt.internal_nodes") + total(run, "rt.procedural_leaves"), "box")),
    ("RT unit: triangle tests", lambda run: _starts(run, total(run, "rt.triangle_tests"), "triangle")),
    ("L1 data", lambda run: _bandwidth(run, total(run, "core.sectors") + total(run, "rt.sectors"), "l1_bytes_per_second")),
    ("L2 to L1", lambda run: _bandwidth(run, total(run, "l1.sectors_fetched::*"), "network_bytes_per_second", "l2_bytes_per_second")),
    ("DRAM", lambda run: run.metrics["dram_util"])]


def limits(runs: Chosen) -> Any:
    """Draws how close each resource came to the most that it could do, as in the report: issue slots, RT units, caches, DRAM."""
    found = chosen(runs)
    at_most_eight(found, "limits")
    rows = [(name, values) for name, values in ((name, [value(run) for run in found]) for name, value in _LIMITS) if any(values)]
    parts = [Part(name, run_colour(i), [values[i] for _, values in rows]) for i, name in enumerate(names(found))]
    return ranked([name for name, _ in rows], parts, "share of the most possible (%)", percent=True)


def changes(before: Run | str | pathlib.Path, after: Run | str | pathlib.Path, top: int = 16) -> Any:
    """Draws the metrics that changed most from one run to another, as ratios, the largest first. Metrics that are 0 in one run are left out."""
    found = [change for change in compare(before, after) if change.before > 0 and change.after > 0][:top]
    if not found:
        raise GlintError("no metric changed between these runs")
    ratios = [change.after / change.before for change in found]
    with styled():
        figure, axes = new_figure(0.36 + 0.14 * max(2, len(found)))
        places = range(len(found))
        axes.barh(places, [ratio - 1 for ratio in ratios], 0.72, 1, color=[COLOURS["orange" if ratio > 1 else "blue"] for ratio in ratios], linewidth=0)
        axes.set_xscale("log", base=2)
        most = 1.15 * max(max(ratio, 1 / ratio) for ratio in ratios)
        axes.set_xlim(1 / most, most)
        axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}x")
        axes.axvline(1, color=COLOURS["dark"], linewidth=0.6)
        axes.set_yticks(places, fitted([change.metric for change in found], 0.42 * COLUMN, 6.5).texts)
        axes.tick_params(axis="y", length=0)
        axes.set_ylim(len(found) - 0.4, -0.6)
        axes.set_xlabel("after / before")
        axes.grid(axis="x", color=COLOURS["pale"], linewidth=0.4)
        return figure

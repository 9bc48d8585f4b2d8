# Draws what each warp of an SM did over time, from a trace.
# SPDX-License-Identifier: Apache-2.0
"""Draws the warp timeline of a run with `--trace`."""
from __future__ import annotations

from typing import Any, Sequence

from ..errors import GlintError
from ..run_directory import Run
from ..trace import Slice
from .instructions import REASONS
from .style import COLOURS, legend, new_figure, run_colour, styled

_MOST_BARS = 2000  # as many as the report's timeline has
_ROW = 0.1  # inches
_RAYS = "rays in the RT unit"


def timeline(run: Run, sm: int = 0, window: tuple[int, int] | None = None, by: str = "state") -> Any:
    """Draws a row for each warp slot of an SM, coloured by what its warp did, and below it a row for each place of the RT unit's warp buffer.

    Args:
        run: A run with `--trace`.
        sm: The SM.
        window: The first cycle and the one after the last. By default it is the trace's middle, as long as 2,000 bars allow.
        by: "state" colours by what the warps waited for, "stage" by the shader stage.
    """
    if by not in ("state", "stage"):
        raise GlintError(f"a timeline is coloured by 'state' or 'stage', not by '{by}'")
    trace = run.trace
    found = [one for one in trace.slices(sm) if one.kind in (by, "rays") and one.length]
    if not found:
        raise GlintError(f"{trace.path}: nothing ran on SM {sm} in the cycles of the trace")
    begin, end = window if window is not None else _middle(found)
    shown = [one for one in found if one.begin < end and one.end > begin]
    if begin >= end or not shown:
        raise GlintError(f"{trace.path}: SM {sm} did nothing from cycle {begin} to {end}; the trace has the cycles {trace.begin} to {trace.end}")
    rows = sorted({(one.kind == "rays", one.track) for one in shown})
    groups = _groups(shown, by)
    with styled():
        figure, axes = new_figure(0.45 + _ROW * max(6, len(rows)))
        handles = []
        for name, (colour, members) in groups.items():
            bars = [axes.broken_barh([(max(one.begin, begin), min(one.end, end) - max(one.begin, begin)) for one in members if (one.kind == "rays", one.track) == row],
                                     (place - 0.4, 0.8), facecolors=colour, linewidth=0)
                    for place, row in enumerate(rows) if any((one.kind == "rays", one.track) == row for one in members)]
            handles.append(bars[0])
        axes.set_xlim(begin, end)
        axes.set_ylim(len(rows) - 0.5, -0.5)
        axes.set_yticks(range(len(rows)), [f"RT {track}" if is_rays else f"warp {track}" for is_rays, track in rows], fontsize=4.5)
        axes.tick_params(axis="y", length=0)
        axes.set_xlabel(f"cycle, SM {sm}")
        legend(figure, handles, list(groups))
        return figure


def _middle(slices: Sequence[Slice]) -> tuple[int, int]:
    """Returns the longest window around the middle, halved as often as needed, that has few enough bars."""
    begin, end = min(one.begin for one in slices), max(one.end for one in slices)
    middle, half = (begin + end) // 2, (end - begin + 1) // 2
    while half > 1 and sum(one.begin < middle + half and one.end > middle - half for one in slices) > _MOST_BARS:
        half //= 2
    return max(begin, middle - half), min(end, middle + half)


def _groups(slices: Sequence[Slice], by: str) -> dict[str, tuple[str, list[Slice]]]:
    """Returns colour and slices of each entry of the legend, in its order: states by the groups of the CPI stack, stages by name."""
    group_of = {reason: (name, COLOURS[colour]) for name, colour, reasons in REASONS for reason in reasons}
    group_of["running"] = ("running", COLOURS["green"])
    stages = sorted({one.name for one in slices if one.kind == "stage"})
    group_of |= {name: (name.replace("_", " "), run_colour(i)) for i, name in enumerate(stages)}
    order = ["running", *(name for name, _, _ in REASONS), *(name.replace("_", " ") for name in stages), "other", _RAYS]
    found: dict[str, tuple[str, list[Slice]]] = {}
    for one in slices:
        name, colour = (_RAYS, COLOURS["dark"]) if one.kind == "rays" else group_of.get(one.name, ("other", COLOURS["dark"]))
        found.setdefault(name, (colour, []))[1].append(one)
    return {name: found[name] for name in order if name in found}

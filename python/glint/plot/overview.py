# Draws figures across runs and over time: IPC by configuration, time series, picture and maps of cost.
# SPDX-License-Identifier: Apache-2.0
"""Draws IPC of several configurations, a run over time, and what a run shows by pixel."""
from __future__ import annotations

from typing import Any

from ..errors import GlintError
from ..labelling import named
from ..run_directory import Run
from .chosen import Chosen, at_most_eight, chosen, names
from .kinds import Part, grouped, lines, stacked
from .style import COLUMN, RUN_COLOURS, new_figure, run_colour, styled

_PANELS = [("ipc", "IPC", 1), ("rt_warps", "RT warps", 1), ("l1d_miss_rate", "L1 misses (%)", 100), ("l2_miss_rate", "L2 misses (%)", 100), ("dram_use", "DRAM use (%)", 100)]


def ipc(runs: Chosen) -> Any:
    """Draws warp instructions per cycle with a bar for each run (LumiBench, Figure 14).

    The bars are grouped by workload and coloured by configuration. With more than eight configurations each run has a row.
    """
    found = chosen(runs)
    names_of = named(found)
    tasks, configurations = (list(dict.fromkeys(one)) for one in ([one.task for one in names_of], [one.config for one in names_of]))
    if len(configurations) > len(RUN_COLOURS):  # a row for each run
        return stacked([one.label for one in names_of], [Part("IPC", "blue", [run.ipc for run in found])], "warp instructions / cycle", share=False, key=False)
    table = {(one.task, one.config): run.ipc for one, run in zip(names_of, found)}  # runs of the same task and configuration are numbered
    parts = [Part(name, run_colour(i), [table.get((task, name)) for task in tasks]) for i, name in enumerate(configurations)]
    return grouped(tasks, parts, "warp instructions / cycle")


def series(runs: Chosen) -> Any:
    """Draws IPC, warps in RT units, miss rates and DRAM use over time (LumiBench, Figure 6). The runs need `--sample CYCLES`."""
    found = chosen(runs)
    at_most_eight(found, "series")
    panels = [(label, [(name, run.series["cycle"], [factor * value for value in run.series[column]]) for name, run in zip(names(found), found)])
              for column, label, factor in _PANELS if any(any(run.series[column]) for run in found)]
    if not panels:
        raise GlintError("the time series hold only zeros")
    return lines(panels, "cycle")


def picture(run: Run) -> Any:
    """Draws the picture of a run as image.png shows it, with values clipped to [0, 1]."""
    image = run.image.clip(0, 1)
    with styled():
        figure, axes = new_figure(COLUMN * image.shape[0] / image.shape[1])
        axes.imshow(image, interpolation="nearest")
        axes.set_axis_off()
        return figure


def cost_map(run: Run, name: str) -> Any:
    """Draws a map of cost by pixel (`run.map_names`) with its scale from 0 to the 99th percentile, as in the run's own pictures. The run needs `--heat`."""
    values, info = run.map(name), run.map_info(name)
    with styled():
        figure, axes = new_figure(0.4 + 2.7 * values.shape[0] / values.shape[1])
        # Cividis has even steps for every kind of colour vision.
        shown = axes.imshow(values, cmap="cividis", vmin=0, vmax=info["p99"] or info["max"] or 1, interpolation="nearest")
        axes.set_axis_off()
        figure.colorbar(shown, ax=axes, label=f"{name.replace('_', ' ')} ({info['unit']})", shrink=0.9)
        return figure

# Figures across runs and over time: IPC by configuration, time series, picture and maps of cost.
# SPDX-License-Identifier: Apache-2.0
"""IPC of several configurations, a run over time, and what a run shows by pixel."""
from __future__ import annotations

from typing import Any

from ..errors import GlintError
from ..run_directory import Run
from .chosen import Chosen, chosen, names
from .kinds import Part, grouped, lines
from .style import COLUMN, new_figure, run_colour, styled

_PANELS = [("ipc", "IPC", 1), ("rt_warps", "RT warps", 1), ("l1d_miss_rate", "L1 misses (%)", 100), ("l2_miss_rate", "L2 misses (%)", 100), ("dram_use", "DRAM use (%)", 100)]


def ipc(runs: Chosen) -> Any:
    """Warp instructions a cycle by workload, a colour a configuration (LumiBench, Figure 14)."""
    found = chosen(runs)
    keys = [key for key in found[0].config if len({str(run.config.get(key)) for run in found}) > 1]
    presets = {run.config_name for run in found}

    def configuration(run: Run) -> str:  # of presets their names; of one preset the first keys that differ
        return run.config_name if len(presets) > 1 else " ".join(f"{key}={run.config.get(key)}" for key in keys[:2]) or run.config_name

    workloads, configurations = (list(dict.fromkeys(one)) for one in ([run.workload for run in found], [configuration(run) for run in found]))
    table = {(run.workload, configuration(run)): run.ipc for run in found}
    series = [Part(name, run_colour(i), [table.get((workload, name)) for workload in workloads]) for i, name in enumerate(configurations)]
    return grouped(workloads, series, "warp instructions / cycle")


def series(runs: Chosen) -> Any:
    """IPC, warps in RT units, miss rates and DRAM use over time (LumiBench, Figure 6). Needs `--sample CYCLES`."""
    found = chosen(runs)
    panels = [(label, [(name, run.series["cycle"], [factor * value for value in run.series[column]]) for name, run in zip(names(found), found)])
              for column, label, factor in _PANELS if any(any(run.series[column]) for run in found)]
    if not panels:
        raise GlintError("the time series hold nothing but zeros")
    return lines(panels, "cycle")


def picture(run: Run) -> Any:
    """The picture of a run as image.png shows it: values clipped to [0, 1]."""
    image = run.image.clip(0, 1)
    with styled():
        figure, axes = new_figure(COLUMN * image.shape[0] / image.shape[1])
        axes.imshow(image, interpolation="nearest")
        axes.set_axis_off()
        return figure


def cost_map(run: Run, name: str) -> Any:
    """A map of cost by pixel (`run.map_names`) with its scale: from 0 to the 99th percentile, as in the run's own pictures. Needs `--heat`."""
    values, info = run.map(name), run.map_info(name)
    with styled():
        figure, axes = new_figure(0.4 + 2.7 * values.shape[0] / values.shape[1])
        shown = axes.imshow(values, cmap="cividis", vmin=0, vmax=info["p99"] or info["max"] or 1, interpolation="nearest")  # even steps for every kind of colour vision
        axes.set_axis_off()
        figure.colorbar(shown, ax=axes, label=f"{name.replace('_', ' ')} ({info['unit']})", shrink=0.9)
        return figure

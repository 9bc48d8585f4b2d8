# Draws rays, RT units and acceleration structures.
# SPDX-License-Identifier: Apache-2.0
"""Draws how full RT units were, what rays visited and what was fetched for them."""
from __future__ import annotations

from typing import Any

from ..errors import GlintError
from .chosen import Chosen, chosen, names, shares, spreads, total, with_rays
from .kinds import Part, group_names, grouped, stacked, width_for
from .style import COLOURS, new_figure, styled

_FETCHES = [("rt_node", "internal nodes", "blue"), ("rt_instance", "instances", "orange"), ("rt_triangle", "triangles", "green"),
            ("rt_procedural", "procedurals", "pink"), ("rt_table", "candidate tables", "yellow"), ("rt_stack", "stacks", "grey"), ("rt_prefetch", "prefetches", "sky")]
_CYCLES = [("node_request", "sends a request", "green"), ("test_busy", "waits for a test unit", "blue"), ("test_latency", "tests in flight", "sky"),
           ("waiting_memory", "waits for memory", "orange"), ("l1_refused", "refused by the L1", "red"), ("mshr_full", "no entry free", "pink"),
           ("prefetch", "sends a prefetch", "grey"), ("handover", "hand-over", "yellow"), ("idle", "idle", "pale")]


def geometry(runs: Chosen) -> Any:
    """Draws structures, depth, triangles and cycles of each scene (LumiBench, Figure 7)."""
    found = chosen(runs)
    panels = [("bottom\nlevels", "blue", lambda run: run.info.get("structures.bottom_levels")),
              ("instances", "sky", lambda run: run.info.get("structures.instances")),
              ("depth", "green", lambda run: run.metrics["bvh_depth"]),
              ("triangles", "orange", lambda run: run.info.get("structures.triangles")),
              ("cycles", "red", lambda run: run.cycles)]
    panels = [panel for panel in panels if any(panel[2](run) is not None for run in found)]  # runs of user pipelines do not record their structures
    with styled():
        figure, axes = new_figure(0.45 + 0.62 * len(panels) + group_names(names(found)).below, rows=len(panels), sharex=True, squeeze=False, width=width_for(len(found)))
        for panel, (label, colour, value) in zip(axes[:, 0], panels):
            values = [value(run) for run in found]
            grouped(names(found), [Part(label, colour, values)], label, axes=panel)
            some = [one for one in values if one]
            if some and max(some) > 30 * min(some):  # a value of 0 has no bar
                panel.set_yscale("log")
                panel.set_ylim(min(some) / 3, max(some) * 2)
        figure.align_ylabels(axes[:, 0])
        return figure


def rt_use(runs: Chosen) -> Any:
    """Draws RT-unit occupancy and efficiency, and SIMT efficiency (LumiBench, Figure 9)."""
    metrics = [("RT-unit occupancy", "blue", "rt_occupancy"), ("RT-unit efficiency", "orange", "rt_efficiency"), ("SIMT efficiency", "green", "simt_efficiency")]
    return shares(with_rays(runs), metrics)


def traversal(runs: Chosen) -> Any:
    """Draws the nodes that a ray visits per level of the structure (LumiBench, Figure 10). The line marks one straight path from root to leaf."""
    found = [run for run in with_rays(runs) if run.metrics["traversal_ratio"] is not None]
    if not found:
        raise GlintError("none of the runs has a traversal ratio: runs of user pipelines do not record the depth of their structures")
    with styled():
        figure, axes = new_figure(1.4 + group_names(names(found)).below, width=width_for(len(found)))
        grouped(names(found), [Part("traversal ratio", "blue", [run.metrics["traversal_ratio"] for run in found])], "nodes / ray / depth", axes=axes)
        axes.axhline(1, color=COLOURS["dark"], linewidth=0.6, linestyle="--")
        return figure


def rt_cycles(runs: Chosen) -> Any:
    """Draws how the RT units spent their cycles."""
    found = with_rays(runs)
    return stacked(names(found), [Part(name, colour, [total(run, f"rt.cycles::{key}") for run in found]) for key, name, colour in _CYCLES], "share of the RT units' cycles (%)")


def fetch_mix(runs: Chosen) -> Any:
    """Draws what RT units read, by read requests that the L1 accepted (LumiBench, Figure 13)."""
    found = with_rays(runs)
    return stacked(names(found), [Part(name, colour, [total(run, f"l1.reads::{key}") for run in found]) for key, name, colour in _FETCHES], "share of the RT units' reads (%)")


def ray_nodes(runs: Chosen) -> Any:
    """Draws the nodes visited by a ray as shares of rays by bins, or, for more than eight runs, as quantiles with a row for each run."""
    return _ray_histogram(runs, "rt.ray_nodes", "nodes visited by a ray")


def ray_latency(runs: Chosen) -> Any:
    """Draws cycles from a ray's acceptance by the RT unit to its end as shares of rays by bins, or, for more than eight runs, as quantiles with a row for each run."""
    return _ray_histogram(runs, "rt.ray_latency", "cycles of a ray in the RT unit")


def _ray_histogram(runs: Chosen, path: str, label: str) -> Any:
    found = with_rays(runs)
    return spreads(found, [run.stats.histogram(path) for run in found], label, "share of rays (%)")

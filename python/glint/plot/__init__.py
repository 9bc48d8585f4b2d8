# Draws the figures of the report and of the LumiBench paper for papers: a column wide, as PDF, SVG or PNG.
# SPDX-License-Identifier: Apache-2.0
"""Draws figures of runs. Each function takes a `Run`, a list of runs, a folder of runs (`Bench`, `Sweep`), or the path of one of these, and returns a
matplotlib Figure, 3.3 inches wide. `save(figure, "fig.pdf")` writes it. `FIGURES` has the figures that every timing run of a scene has.

The import needs no matplotlib; the functions raise MissingPackage without it. They raise MissingFile when a run lacks a file that
a figure needs (the message names the option that writes it), and GlintError when the runs have nothing to draw.
"""
from .bounds import changes, limits
from .instructions import cpi_stack, instruction_mix, op_counts, op_latency, ops, stage_cycles, stages
from .memory import dram, dram_clocks, l1_reads, l2_reads, miss_latency, miss_stages
from .models import model_errors, model_fit
from .overview import cost_map, ipc, picture, series
from .rays import fetch_mix, geometry, ray_latency, ray_nodes, rt_cycles, rt_use, traversal
from .suite import components, dendrogram, kiviat, scree
from .style import COLOURS, COLUMN, save
from .timeline import timeline

FIGURES = {figure.__name__: figure for figure in (
    geometry, instruction_mix, stages, cpi_stack, rt_use, traversal, rt_cycles, fetch_mix, ray_nodes, ray_latency,
    l1_reads, l2_reads, miss_stages, miss_latency, dram, dram_clocks, ipc)}

__all__ = ["COLOURS", "COLUMN", "FIGURES", "changes", "components", "cost_map", "cpi_stack", "dendrogram", "dram", "dram_clocks", "fetch_mix", "geometry", "instruction_mix",
           "ipc", "kiviat", "l1_reads", "l2_reads", "limits", "miss_latency", "miss_stages", "model_errors", "model_fit", "op_counts", "op_latency", "ops", "picture", "ray_latency", "ray_nodes",
           "rt_cycles", "rt_use", "save", "scree", "series", "stage_cycles", "stages", "timeline", "traversal"]

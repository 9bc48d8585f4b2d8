# Draws caches, misses and DRAM.
# SPDX-License-Identifier: Apache-2.0
"""Draws where reads were answered, how long misses took in each stage, and how DRAM was used."""
from __future__ import annotations

from typing import Any, Callable

from ..errors import GlintError
from ..run_directory import Run
from .chosen import Chosen, chosen, names, rows_of, shares, spreads, total
from .kinds import Part, histogram, stacked

_ASKED_BY: dict[str, Callable[[str], bool]] = {
    "RT unit": lambda name: name.startswith("rt_"), "shaders": lambda name: name.startswith("shader_"),
    "instructions, constants": lambda name: name in ("instruction", "constant")}
_ANSWERS = [("hits", "hit", "green"), ("pending_hits", "on the way", "sky"), ("misses", "miss, held before", "orange"), ("cold_misses", "cold miss", "red")]
_MISS_STAGES = [("l1_queue", "leaves the L1", "yellow"), ("request", "network there", "blue"), ("l2_queue", "waits for the L2", "pink"), ("l2_service", "L2", "green"),
                ("dram_way", "way to DRAM", "grey"), ("dram_queue", "DRAM queue, rows", "red"), ("dram_service", "DRAM data", "orange"), ("reply", "network back, fill", "sky")]
_CLOCKS = [("data", "data", "green"), ("column_wait", "waits for a column", "sky"), ("row_wait", "waits for a row", "orange"),
           ("turnaround", "turns the bus", "pink"), ("refresh", "refresh", "red"), ("idle", "idle", "pale")]


def l1_reads(runs: Chosen) -> Any:
    """Draws the reads of the L1s by RT units and by shaders: hits, misses, cold misses (LumiBench, Figure 11)."""
    return _reads(runs, "gpu.memory.core[*].l1")


def l2_reads(runs: Chosen) -> Any:
    """Draws the reads that the L1s sent to the L2, by RT units and shaders."""
    return _reads(runs, "gpu.memory.partition[*].l2*")


def _answers(run: Run, cache: str, who: str) -> dict[str, float]:
    counts = {}
    for key, _, _ in _ANSWERS:
        parts = run.stats.parts(f"{cache}.{key}")
        counts[key] = sum(value for name, value in parts.items() if _ASKED_BY[who](name))
    counts["misses"] -= counts["cold_misses"]
    return counts


def _reads(runs: Chosen, cache: str) -> Any:
    rows = [(label, run, _answers(run, cache, who)) for label, run, who in rows_of(chosen(runs), list(_ASKED_BY))]
    rows = [row for row in rows if sum(row[2].values())]
    if not rows:
        raise GlintError("these runs have no reads")
    parts = [Part(name, colour, [counts[key] for _, _, counts in rows]) for key, name, colour in _ANSWERS]
    scale = [100 * sum(counts.values()) / total(run, f"{cache}.reads::*") for _, run, counts in rows]
    return stacked([label for label, _, _ in rows], parts, "share of the run's reads (%)", scale=scale)


def dram(runs: Chosen) -> Any:
    """Draws DRAM utilisation (share of all clocks with data), efficiency (share of the clocks with work) and row hits (LumiBench, Figure 12)."""
    metrics = [("utilisation", "blue", "dram_util"), ("efficiency", "orange", "dram_eff"), ("row locality", "green", "row_locality")]
    return shares(chosen(runs), metrics)


def dram_clocks(runs: Chosen) -> Any:
    """Draws how the DRAM channels spent their clocks."""
    found = chosen(runs)
    return stacked(names(found), [Part(name, colour, [total(run, f"dram.use::{key}") for run in found]) for key, name, colour in _CLOCKS], "share of DRAM clocks (%)")


def miss_stages(runs: Chosen) -> Any:
    """Draws the mean latency of a read that missed its L1, as the sum of its stages."""
    found = [run for run in chosen(runs) if total(run, "l1.timed_misses")]
    if not found:
        raise GlintError("these runs have no misses")
    parts = [Part(name, colour, [total(run, f"l1.miss_stages::{key}") for run in found]) for key, name, colour in _MISS_STAGES]
    return stacked(names(found), parts, "cycles of an L1 miss", scale=[total(run, "l1.miss_cycles") / total(run, "l1.timed_misses") for run in found])


def miss_latency(runs: Chosen) -> Any:
    """Draws the distribution of miss latencies: for one run by who answered, for several runs by run, and for more than eight as quantiles."""
    found = chosen(runs)
    if len(found) > 1:
        return spreads(found, [run.stats.histogram("l1.miss_latency") for run in found], "cycles of an L1 miss", "share of misses (%)")
    series = [(name, colour, found[0].stats.histogram(f"l1.{key}")) for name, colour, key in (("L2 answered", "green", "l2_latency"), ("DRAM answered", "orange", "dram_latency"))]
    return histogram(series, "cycles of an L1 miss", "share of misses (%)")

# Draws instructions and the cycles of schedulers: mix, stages, CPI stack, ops.
# SPDX-License-Identifier: Apache-2.0
"""Draws what was executed, and how the schedulers spent their cycles."""
from __future__ import annotations

from typing import Any

from ..run_directory import Run
from .chosen import Chosen, at_most_eight, chosen, names, rows_of, total
from .kinds import Part, panels, ranked, stacked
from .style import run_colour

_CLASSES = [("alu", "ALU", "blue"), ("sfu", "SFU", "sky"), ("mem", "memory", "orange"), ("tex", "texture", "yellow"),
            ("ctrl", "control", "grey"), ("rt", "ray tracing", "red")]
_STAGES = {"raygen": "ray generation", "intersection": "intersection", "any_hit": "any hit", "closest_hit": "closest hit",
           "miss": "miss", "callable": "callable", "compute": "compute"}
# Groups the reasons of docs/profiling.md, as the report's CPI stack does.
REASONS: list[tuple[str, str, tuple[str, ...]]] = [
    ("issued", "green", ("issued",)),
    ("pipe busy", "blue", ("math_pipe_throttle", "register_banks", "lsu_throttle", "tex_throttle")),
    ("fixed latency", "sky", ("raw_fixed", "raw_sfu", "const", "branch", "operand_read")),
    ("memory", "orange", ("long_scoreboard", "local_memory", "shared_memory", "texture", "call", "membar")),
    ("in the RT unit", "pink", ("rt_wait",)),
    ("RT unit full", "red", ("rt_full",)),
    ("fetch, barrier", "yellow", ("no_instruction", "barrier")),
    ("launch, drain", "grey", ("dispatch", "drain")),
    ("no warp", "pale", ("no_warp",)),
]


def instruction_mix(runs: Chosen) -> Any:
    """Draws warp instructions by class, by count and by latency from issue to completion (LumiBench, Figure 8)."""
    paths = {"by count": "core.instructions_by_class", "by latency": "core.latency_by_class"}
    rows = rows_of(chosen(runs), list(paths))
    parts = [Part(name, colour, [total(run, f"{paths[kind]}::{key}") for _, run, kind in rows]) for key, name, colour in _CLASSES]
    return stacked([label for label, _, _ in rows], parts, "share of instructions or of their latency (%)")


def stages(runs: Chosen) -> Any:
    """Draws each shader stage's share of a run's warp instructions, and of their latency from issue to completion, by class."""
    found = chosen(runs)
    used = [key for key in _STAGES if any(total(run, f"core.{key}.instructions::*") for run in found)]
    rows = [row for row in rows_of(found, used) if total(row[1], f"core.{row[2]}.instructions::*")]
    measures = []
    for name, part in (("by count", "instructions"), ("by latency", "latency")):
        parts = [Part(label, colour, [total(run, f"core.{stage}.{part}::{key}") for _, run, stage in rows]) for key, label, colour in _CLASSES]
        measures.append((name, parts, [sum(total(run, f"core.{stage}.{part}::*") for stage in _STAGES) for _, run, _ in rows]))
    return panels([label.replace(stage, _STAGES[stage]) for label, _, stage in rows], measures, "share (%)")


def cpi_stack(runs: Chosen) -> Any:
    """Draws scheduler cycles per warp instruction, by reason."""
    found = chosen(runs)
    slots = [run.stats.parts("core.issue_slots") for run in found]
    parts = [Part(name, colour, [sum(slot.get(reason, 0) for reason in of) for slot in slots]) for name, colour, of in REASONS]
    scale = [sum(slot.values()) / (total(run, "core.instructions") or 1) for slot, run in zip(slots, found)]
    return stacked(names(found), parts, "scheduler cycles / warp instruction", scale=scale)


def stage_cycles(runs: Chosen) -> Any:
    """Draws scheduler cycles charged to each shader stage, by reason. The run needs `--profile`."""
    rows, cycles = [], []
    for label, run in zip(names(chosen(runs)), chosen(runs)):
        by_stage = _by(run, "stage")
        for stage, row in by_stage.items():
            rows.append(f"{label}, {stage}".replace("_", " ") if len(chosen(runs)) > 1 else stage.replace("_", " "))
            cycles.append((row, total(run, "core.issue_slots::*")))
    parts = [Part(name, colour, [sum(row.get(reason, 0) for reason in of) for row, _ in cycles]) for name, colour, of in REASONS]
    scale = [100 * row["cycles"] / (slots or 1) for row, slots in cycles]
    return stacked(rows, parts, "share of scheduler cycles (%)", scale=scale)


def ops(runs: Chosen, top: int = 12) -> Any:
    """Draws the ops with the most scheduler cycles, as shares. The run needs `--profile`."""
    return _op_bars(runs, top, lambda row, whole: row["cycles"] / whole, "share of scheduler cycles (%)", percent=True)


def op_counts(runs: Chosen, top: int = 12) -> Any:
    """Draws the ops that were issued most, as shares of warp instructions. The run needs `--profile`."""
    return _op_bars(runs, top, lambda row, whole: row["issues"] / whole, "share of warp instructions (%)", percent=True, weigh="issues")


def op_latency(runs: Chosen, top: int = 12) -> Any:
    """Draws the mean cycles from issue to completion of L1 accesses and of traces. The run needs `--profile`."""
    return _op_bars(runs, top, lambda row, whole: row["latency"] / row["ended"] if row["ended"] else None, "cycles", percent=False, weigh="latency")


def _op_bars(runs: Chosen, top: int, value: Any, label: str, percent: bool, weigh: str = "cycles") -> Any:
    found = chosen(runs)
    at_most_eight(found, "this figure")
    tables = [_by(run, "op") for run in found]
    known = {op for table in tables for op, row in table.items() if percent or row["ended"]}
    shown = sorted(known, key=lambda op: (-max(table.get(op, {}).get(weigh, 0) for table in tables), op))[:top]
    wholes = [sum(row[weigh] for row in table.values()) or 1 for table in tables]
    series = [Part(name, run_colour(i), [value(table[op], whole) if op in table else None for op in shown])
              for i, (name, table, whole) in enumerate(zip(names(found), tables, wholes))]
    return ranked(shown, series, label, percent=percent)


def _by(run: Run, column: str) -> dict[str, dict[str, int]]:
    """Returns the rows of the profile's instructions, summed by a column."""
    sums: dict[str, dict[str, int]] = {}
    for row in run.profile.where(by="instruction"):
        into = sums.setdefault(row[column], {})
        for name, value in row.items():
            if isinstance(value, (int, float)) and name not in ("line", "index"):
                into[name] = into.get(name, 0) + value
    return sums

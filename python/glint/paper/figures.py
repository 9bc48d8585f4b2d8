# Makes each table and figure of the paper from the runs.
# SPDX-License-Identifier: Apache-2.0
"""`SECTIONS` has anchor, title and function of each. A function returns HTML, or "" when its runs are missing."""
from __future__ import annotations

import html
import pathlib
import tomllib
from typing import Any, Callable, Sequence

from . import drawing
from .analysis import Findings, series
from .plan import DESKTOP_OF, JUDGED_MACHINES, MACHINES, SUBSET, VARIANTS
from .running import Runs
from .statements import Missing, Table, correlation

_TABLE_3 = ("row-buffer locality, DRAM utilisation, BVH depth, RT memory writes, L1D RT read hits, % TLAS leaf accesses, % node accesses, RT active cycles")
_TABLE_4 = (("cores", "# SMs"), ("core.warps", "max warps / SM"), ("core.issue", "warp scheduler"), ("core.registers", "registers / SM"), ("memory.l1.size", "L1, bytes"), ("memory.l1.ways", "L1 ways (0: fully associative)"),
            ("memory.l1.hit_latency", "L1, cycles"), ("memory.l2.slice_size", "L2 slice, bytes"), ("memory.l2.ways", "L2 ways"), ("memory.dram.channels", "DRAM channels"), ("clock_mhz", "core clock, MHz"),
            ("memory.dram.clock_mhz", "memory clock, MHz"), ("rt.warps", "max warps / RT unit"), ("core.local_by_thread", "memory of a thread's own"))


def grid(head: list[str], rows: list[list[str]]) -> str:
    cells = "".join("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return f'<div class="scroll"><table><tr>{"".join(f"<th>{html.escape(name)}</th>" for name in head)}</tr>{cells}</table></div>'


class Scene:
    """Gives the tables of the runs to the sections."""

    def __init__(self, runs: Runs, found: Findings):
        self.runs, self.found = runs, found

    def tables(self, *machines: str) -> list[tuple[str, Table]]:
        """Returns what has been run of the whole suite, with its name: "mobile, generated"."""
        out = []
        for form in ("generated", "files"):
            for machine in machines:
                path = self.runs.path(f"{form}/{machine}") / "metrics.csv"
                if path.is_file():
                    table = Table.read(path)
                    if table.rows:
                        out.append((f"{machine}, {form}", table))
        return out

    def config(self, folder: pathlib.Path) -> dict[str, Any]:
        path = next(iter(sorted(folder.glob("*/config.toml"))), None)
        return tomllib.loads(path.read_text(encoding="utf-8")) if path else {}


def column(table: Table, names: list[str], metric: str) -> list[float | None]:
    out: list[float | None] = []
    for name in names:
        try:
            out.append(table.get(name, metric))
        except Missing:
            out.append(None)
    return out


def by_triangles(table: Table, shader: str | None = None) -> list[str]:
    names = [name for name in table.rows if shader is None or name.endswith("_" + shader)]
    return sorted(names, key=lambda name: (column(table, [name], "triangles")[0] or 0, name))


def each(scene: Scene, machines: tuple[str, ...], make: Callable[[Table], str]) -> str:
    return "".join(f"<h3>{html.escape(name)}</h3>{make(table)}" for name, table in scene.tables(*machines))


def bars_of(*metrics: str, stacked: bool = False, scale: float = 1.0) -> Callable[[Table], str]:
    def make(table: Table) -> str:
        names = by_triangles(table)
        values = {metric: [None if value is None else value * scale for value in column(table, names, metric)] for metric in metrics}
        return f'<div class="scroll">{drawing.bars(names, values, stacked=stacked)}</div>'
    return make


def table_1(scene: Scene) -> str:
    def make(table: Table) -> str:
        rows = []
        for name in by_triangles(table, "PT"):
            form = f"{table.rows[name].get('form', '')} ({float(table.rows[name].get('fraction') or 1):.0%})"
            values = [column(table, [name], metric)[0] for metric in ("triangles", "procedurals", "instances", "bvh_depth", "bvh_bytes")]
            rows.append([name[:-3], form, *("" if value is None else f"{value:,.0f}" for value in values)])
        return grid(["scene", "form (part of the original's data)", "triangles", "procedurals", "instances", "BVH depth", "BVH bytes"], rows)
    return each(scene, ("mobile",), make)


def table_2(scene: Scene) -> str:
    rows = []
    for name in ("generated/mobile", "files/mobile"):
        found = scene.found.characterization(name)
        if found:
            ours = [found["workloads"][one["row"]]["name"] for one in found["representatives"]]
            rows.append([name, " ".join(ours), " ".join(w for w in ours if w in SUBSET), f"{found['coverage_error']:.1%}", f"{found['reference'].get('coverage_error', 0):.1%}"])
    speed = [[name, *_speedup(scene, name)] for name in VARIANTS]
    speed = [row for row in speed if len(row) > 1]
    text = f"<p>The paper's subset: {' '.join(SUBSET)}.</p>" if rows or speed else ""
    text += grid(["suite", "subset that the characterisation chooses", "also in the paper's", "mean distance to the nearest chosen", "with the paper's subset"], rows) if rows else ""
    if speed:
        text += "<h3>The subset on other configurations (cycles on mobile divided by cycles there)</h3>" + grid(["changed", "all: geometric mean (least to most)", "the paper's subset", "difference of the means"], speed)
    return text


def _speedup(scene: Scene, variant: str) -> list[str]:
    paths = [scene.runs.path(name) / "metrics.csv" for name in ("generated/mobile", f"variants/{variant}")]
    if not all(path.is_file() for path in paths):
        return []
    before, after = (Table.read(path) for path in paths)
    ratio = {name: before.get(name, "cycles") / after.get(name, "cycles") for name in before.rows if name in after.rows}

    def mean(values: list[float]) -> float:
        product = 1.0
        for value in values:
            product *= value ** (1 / len(values))
        return product
    chosen = [value for name, value in ratio.items() if name in SUBSET]
    if not ratio or not chosen:
        return []
    texts = [f"{mean(values):.3f} ({min(values):.2f} to {max(values):.2f}), {len(values)} workloads" for values in (list(ratio.values()), chosen)]
    return [*texts, f"{mean(chosen) / mean(list(ratio.values())) - 1:+.1%}"]


def table_3(scene: Scene) -> str:
    rows = [[name, ", ".join(axis["name"] for axis in found["axes"]), f"{found['fitness']:.3f}"] for name in ("generated/mobile", "generated/vulkan-sim-mobile", "files/mobile", "files/vulkan-sim-mobile", "joint/mobile", "joint/vulkan-sim-mobile")
            if (found := scene.found.characterization(name))]
    return f"<p>The paper's eight: {_TABLE_3}.</p>" + grid(["runs", "the chosen metrics", "correlation of distances"], rows) if rows else ""


def table_4(scene: Scene) -> str:
    configs = {machine: scene.config(scene.runs.path(f"generated/{machine}")) for machine in MACHINES}
    configs = {machine: config for machine, config in configs.items() if config}

    def value(config: Any, key: str) -> str:
        for part in key.split("."):
            config = config.get(part) if isinstance(config, dict) else None
        return "" if config is None else str(config)
    return grid(["", *configs], [[title, *(value(config, key) for config in configs.values())] for key, title in _TABLE_4]) if configs else ""


def _tree(found: dict[str, Any]) -> str:
    workloads = found["workloads"]
    return drawing.tree([one["name"] for one in workloads], found["joins"], found["leaves"], [one["cluster"] for one in workloads], [one["chosen"] for one in workloads])


def figure_3(scene: Scene) -> str:
    out = ""
    for name in ("generated/mobile", "generated/vulkan-sim-mobile", "files/mobile", "files/vulkan-sim-mobile", "joint/mobile", "joint/vulkan-sim-mobile"):
        found = scene.found.characterization(name)
        if found:
            about = "both suites, with the metrics that have a meaning without rays" if name.startswith("joint") else "chosen workloads are bold"
            out += f"<h3>{html.escape(name)}: {about}</h3>{_separation(found) if name.startswith('joint') else ''}{_tree(found)}"
    return out


def _separation(found: dict[str, Any]) -> str:
    """Says whether the compute programs stand apart from the workloads of rays in the tree."""
    members: list[set[int]] = [{index} for index in range(len(found["workloads"]))]
    programs = {index for index, one in enumerate(found["workloads"]) if "_" not in one["name"]}
    best = max((len(both) for both in _joined(members, found["joins"]) if both <= programs), default=1)
    mixed = sorted({one["cluster"] for i, one in enumerate(found["workloads"]) if i in programs} & {one["cluster"] for i, one in enumerate(found["workloads"]) if i not in programs})
    apart = "no cluster has both kinds" if not mixed else f"{len(mixed)} of {found['clusters']} clusters have both kinds"
    return f"<p>{len(programs)} compute programs and {len(members) - len(programs)} workloads of rays: {apart}; the largest subtree of programs alone has {best} of them.</p>"


def _joined(members: list[set[int]], joins: list[list[float]]) -> list[set[int]]:
    out = list(members)
    for first, second, *_ in joins:
        out.append(out[int(first)] | out[int(second)])
    return out


def figure_4(scene: Scene) -> str:
    out = ""
    for name in ("generated/mobile", "generated/vulkan-sim-mobile", "joint/mobile"):
        found = scene.found.characterization(name)
        if found:
            axes = [axis["name"] for axis in found["axes"]]
            out += f"<h3>{html.escape(name)}: {html.escape(', '.join(f'{i} {axis}' for i, axis in enumerate(axes, 1)))}</h3>" + "".join(drawing.radar(one["name"], axes, one["kiviat"]) for one in found["workloads"])
    return out


def figure_6(scene: Scene) -> str:
    out = ""
    for machine in JUDGED_MACHINES:
        found = series(scene.runs, machine)
        for metric in ("rt_warps", "ipc", "l1d_miss_rate") if found else ():
            out += f"<h3>{machine}: {metric}</h3>" + drawing.lines({name: [(row["cycle"], row[metric]) for row in rows] for name, rows in found.items()}, "cycles")
        path = scene.runs.path(f"large/{machine}") / "metrics.csv"
        if path.is_file() and (large := Table.read(path)).rows:
            name = next(iter(large.rows))
            row = large.rows[name]
            out += f"<p>{machine}: {name} at {row['width']} x {row['height']}: " + ", ".join(f"{metric} {large.get(name, metric):.3f}" for metric in ("thread_ipc", "rt_occupancy", "l1d_miss_rate", "rt_miss_rate")) + ".</p>"
    return out


def figure_7(scene: Scene) -> str:
    def make(table: Table) -> str:
        names = by_triangles(table, "PT")
        if not names:
            return ""
        upper = drawing.bars(names, {metric: column(table, names, metric) for metric in ("triangles", "procedurals", "instances")}, logarithmic=True)
        lower = drawing.bars(names, {"BVH depth": column(table, names, "bvh_depth")}) + drawing.bars(names, {"cycles": column(table, names, "cycles")})
        return f'<div class="scroll">{upper}{lower}</div>'
    return each(scene, JUDGED_MACHINES, make)


def figure_8(scene: Scene) -> str:
    kinds = ("alu", "sfu", "mem", "tex", "ctrl", "rt")
    counts, latency = bars_of(*(f"ins_{kind}%" for kind in kinds), stacked=True), bars_of("lat_alu%", "lat_mem%", "lat_rt%", stacked=True)
    return each(scene, JUDGED_MACHINES, lambda table: counts(table) + latency(table))


def figure_11(scene: Scene) -> str:
    def make(table: Table) -> str:
        names = by_triangles(table)
        parts: dict[str, list[float | None]] = {"traceRay: hits": [], "traceRay: misses": [], "shaders: misses": [], "the rest": []}
        for name in names:
            try:
                total, reads = table.get(name, "l1d_accesses"), table.get(name, "cachelines")
                rt = reads * table.get(name, "rt_miss_rate")
                all_rate, shader_rate = table.get(name, "l1d_miss_rate"), table.get(name, "l1d_shader_miss_rate")
                shaders = shader_rate * (rt - all_rate * reads) / (all_rate - shader_rate) if all_rate != shader_rate else 0.0
                values = [reads - rt, rt, shaders, total - reads - shaders]
                for part, value in zip(parts.values(), values):
                    part.append(100 * max(value, 0.0) / total)
            except (Missing, ZeroDivisionError):
                for part in parts.values():
                    part.append(None)
        return f'<div class="scroll">{drawing.bars(names, parts, stacked=True)}</div>'
    return each(scene, JUDGED_MACHINES, make)


def figure_14(scene: Scene) -> str:
    out = ""
    for form in ("generated", "files"):
        tables = {name.split(",")[0]: table for name, table in scene.tables(*MACHINES) if name.endswith(form)}
        for machine in JUDGED_MACHINES:
            pair = {name: tables[name] for name in (machine, DESKTOP_OF[machine]) if name in tables}
            if pair:
                names = by_triangles(next(iter(pair.values())))
                out += f'<h3>thread IPC, {html.escape(form)}</h3><div class="scroll">' + drawing.bars(names, {name: column(table, names, "thread_ipc") for name, table in pair.items()}) + "</div>"
    return out


def _r2(predicted: Sequence[float], simulated: Sequence[float]) -> str:
    try:
        return f"{correlation(predicted, simulated) ** 2:.3f}"
    except Missing:
        return ""


def _instructions(row: dict[str, str]) -> float:
    """Returns the warp instructions of a run by the inputs of Hong and Kim's model."""
    product = 1.0
    for name in ("launches", "cores", "warps_per_core", "repetitions", "instructions_per_warp"):
        product *= float(row[name])
    return product


def figure_15(scene: Scene) -> str:
    rows, pictures = [], ""
    for name in (f"{form}/{machine}" for form in ("compute", "generated", "files") for machine in MACHINES):
        models = scene.found.models(name)
        for model in (key for key in (models[0] if models else {}) if key.startswith("model:")):
            pairs = {row["workload"]: (float(row[model]), float(row["cycles"])) for row in models if row[model]}
            if len(pairs) < 3:
                continue
            predicted, simulated = [x for x, _ in pairs.values()], [y for _, y in pairs.values()]
            off = sum(abs(x / y - 1) for x, y in pairs.values()) / len(pairs)
            subset = [pair for workload, pair in pairs.items() if workload in SUBSET]
            low = _r2(*zip(*subset)) if 2 < len(subset) < len(pairs) else ""
            done = [_instructions(row) for row in models if row[model]]
            speed = _r2([n / x for n, x in zip(done, predicted)], [n / y for n, y in zip(done, simulated)])
            rows.append([name, model[6:], str(len(pairs)), _r2(predicted, simulated), low, speed, f"{off:.1%}"])
            if model == "model:as in LumiBench" and name in ("compute/mobile", "generated/mobile", "compute/vulkan-sim-mobile", "generated/lumibench", "generated/vulkan-sim-mobile"):
                pictures += f'<div style="display:inline-block"><b>{html.escape(name)}</b><br>{drawing.points(pairs, "predicted cycles", "simulated cycles")}</div>'
    text = ("<p>The paper has R2 0.704 on Rodinia and 0.298 on ray tracing for the model of Hong and Kim, and less on its subset. The model \"as in LumiBench\" has the paper's "
            "inputs: the latency of DRAM times the rate of misses, and 128 bytes for a memory instruction, whatever the caches hold. The one above it has the bytes that came from DRAM.</p>")
    return text + grid(["runs", "model", "workloads", "R2 of cycles", "R2 of the subset's cycles", "R2 of IPC", "mean error"], rows) + pictures if rows else ""


SECTIONS: tuple[tuple[str, str, Callable[[Scene], str]], ...] = (
    ("table-1", "Table 1: scenes", table_1),
    ("table-2", "Table 2: the subset", table_2),
    ("table-3", "Table 3: metrics that tell workloads apart", table_3),
    ("table-4", "Table 4: configurations", table_4),
    ("figure-3", "Figure 3: which workloads are alike", figure_3),
    ("figure-4", "Figure 4: Kiviat diagrams", figure_4),
    ("figure-6", "Figure 6: over time", figure_6),
    ("figure-7", "Figure 7: geometry, depth and time", figure_7),
    ("figure-8", "Figure 8: instructions and their latency, %", figure_8),
    ("figure-9", "Figure 9: occupancy and efficiency of RT units, SIMT efficiency, %", lambda scene: each(scene, JUDGED_MACHINES, bars_of("rt_occupancy", "rt_efficiency", "simt_efficiency", scale=100))),
    ("figure-10", "Figure 10: traversal ratio", lambda scene: each(scene, JUDGED_MACHINES, bars_of("traversal_ratio"))),
    ("figure-11", "Figure 11: accesses to the L1, %", figure_11),
    ("figure-12", "Figure 12: DRAM utilisation and efficiency, %", lambda scene: each(scene, MACHINES, bars_of("dram_util", "dram_eff", scale=100))),
    ("figure-13", "Figure 13: what RT units fetch", lambda scene: each(scene, JUDGED_MACHINES, bars_of("acc_internal", "acc_instance_leaf", "acc_quad_leaf", "acc_proc_leaf", stacked=True))),
    ("figure-14", "Figure 14: IPC", figure_14),
    ("figure-15", "Figure 15: analytical models", figure_15),
)

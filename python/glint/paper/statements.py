# Says which statements of the LumiBench paper about the order of its workloads hold for a metrics.csv of `glint bench`.
# SPDX-License-Identifier: Apache-2.0
"""Evaluates the LumiBench paper's statements on Glint's figures: each holds, does not hold, or cannot be judged.

Each statement gives the bounds that stand for the paper's words. No bound was fitted to Glint's figures."""
import argparse
import csv
import math
import pathlib

from .plan import SUBSET


class Missing(Exception):
    """A figure that a statement needs is missing."""


class Table:
    """Holds a metrics.csv: figures by workload and metric."""

    def __init__(self, rows, stands_for_all=False):
        self.stands_for_all = stands_for_all
        self.rows = {row["workload"]: row for row in rows}

    @staticmethod
    def read(path, stands_for_all=False):
        with open(path, newline="") as file:
            return Table(list(csv.DictReader(file)), stands_for_all)

    def get(self, workload, metric):
        if workload not in self.rows:
            raise Missing(f"no row {workload}")
        cell = self.rows[workload].get(metric, "")
        if cell == "":
            raise Missing(f"{workload} has no {metric}")
        return float(cell)

    def names(self, shader=None):
        names = [name for name in self.rows if shader is None or name.endswith("_" + shader)]
        if not names:
            raise Missing(f"no workload{' with ' + shader if shader else ''}")
        return names

    def values(self, metric, shader=None):
        return [self.get(name, metric) for name in self.names(shader)]

    def mean(self, metric, shader=None):
        values = self.values(metric, shader)
        return sum(values) / len(values)


def whole(table, count=46):
    """Checks that the table has all workloads, which statements about all workloads need. A table of a subset stands for all when it says so."""
    if len(table.rows) < count and not table.stands_for_all:
        raise Missing(f"{len(table.rows)} of {count} workloads")


def correlation(a, b):
    n = len(a)
    ma, mb = sum(a) / n, sum(b) / n
    va, vb = sum((x - ma) ** 2 for x in a), sum((y - mb) ** 2 for y in b)
    if va == 0 or vb == 0:
        raise Missing("a figure is the same everywhere")
    return sum((x - ma) * (y - mb) for x, y in zip(a, b)) / math.sqrt(va * vb)


def ranks(values):
    """Returns ranks from 0. Ties share their mean rank."""
    return [sum(v < x for v in values) + (sum(v == x for v in values) - 1) / 2 for x in values]


def percent(fraction):
    return f"{100 * fraction:.1f} %"


def rt_and_shader_misses(t, name):
    """Returns the L1 read misses of the RT unit and of shaders, which follow from their rates and the RT unit's reads."""
    reads = sum(t.get(name, "acc_" + kind) for kind in ("internal", "instance_leaf", "quad_leaf", "proc_leaf"))
    rt = t.get(name, "rt_miss_rate") * reads
    all_rate, shader_rate = t.get(name, "l1d_miss_rate"), t.get(name, "l1d_shader_miss_rate")
    if all_rate == shader_rate:
        raise Missing("both rates are the same")
    return rt, shader_rate * (rt - all_rate * reads) / (all_rate - shader_rate)


# Each entry has: (item of the checklist, statement with its bound, function of tables to (holds, figures)).
STATEMENTS = []


def statement(item, text):
    def add(function):
        STATEMENTS.append((item, text, function))
        return function
    return add


@statement(4, "the RT units of PARK_PT, BUNNY_AO and SHIP_SH reach their limit of 4 warps (certain when the mean is above 3)")
def _(t, **_):
    means = {name: 4 * t.get(name, "rt_occupancy") for name in ("PARK_PT", "BUNNY_AO", "SHIP_SH")}
    text = ", ".join(f"{name} {mean:.2f} warps on average" for name, mean in means.items())
    if min(means.values()) <= 3:
        raise Missing(text + "; the most is in no metric (glint run --sample has it)")
    return True, text


def after_start(rows):
    """Returns the samples of a series from the first one on in which the RT units hold nine tenths of the most warps that they ever hold."""
    most = max(row["rt_warps"] for row in rows)
    return rows[next(i for i, row in enumerate(rows) if row["rt_warps"] >= 0.9 * most):]


def drift(rows, value, weight):
    """Returns how far the running mean is from its last value, as a fraction: the largest in the first quarter and in the second half."""
    rows = [row for row in rows if row["instructions"] > 0]
    total = weights = 0.0
    means = []
    for row in rows:
        total += row[value] * row[weight]
        weights += row[weight]
        means.append(total / weights if weights else 0.0)
    if len(means) < 16 or means[-1] == 0:
        raise Missing("the series has too few samples: glint run --sample with fewer cycles")
    off = [abs(mean / means[-1] - 1) for mean in means]
    return max(off[:len(off) // 4]), max(off[len(off) // 2:])


@statement(4, "IPC and L1D miss rate become stable after fluctuating at first (the running mean stays within 10 % of its last "
              "value in the second half, and is farther from it in the first quarter)")
def _(t, series=None, **_):
    if not series:
        raise Missing("needs --series, the series.csv of a run with --sample")
    def judged(cut):
        found = {(name, what): drift(cut(rows), what, weight) for name, rows in series.items()
                 for what, weight in (("ipc", "cycles"), ("l1d_miss_rate", "l1d_reads"))}
        text = ", ".join(f"{name} {what} {percent(first)} then {percent(later)}" for (name, what), (first, later) in found.items())
        return all(later <= 0.1 < first for first, later in found.values()), text
    holds, text = judged(lambda rows: rows)
    try:  # A series of Glint begins with the launch, when the caches are cold and no warp has reached the RT units.
        other, more = judged(after_start)
        text += f"; without the start-up it {'holds' if other else 'does not hold'}: {more}"
    except Missing as reason:
        text += f"; without the start-up {reason}"
    return holds, text


@statement(4, "SHIP_SH has a higher L1D miss rate at 1920x1080 than at 128x128")
def _(t, large=None, **_):
    if large is None:
        raise Missing("needs --large, a metrics.csv of SHIP_SH at 1920x1080")
    small, big = t.get("SHIP_SH", "l1d_miss_rate"), large.get("SHIP_SH", "l1d_miss_rate")
    return big > small, f"{percent(small)} and {percent(big)}"


@statement(5, "PARTY ranks higher by instances than by triangles")
def _(t, **_):
    names = t.names("PT")
    whole(t)
    t.get("PARTY_PT", "instances")
    by = {m: dict(zip(names, ranks(t.values(m, "PT")))) for m in ("instances", "triangles")}
    mine = {m: by[m]["PARTY_PT"] for m in by}
    return mine["instances"] > mine["triangles"], (f"{t.get('PARTY_PT', 'instances'):.0f} instances (rank {mine['instances'] + 1:g} of {len(names)}), "
                                                   f"{t.get('PARTY_PT', 'triangles'):.0f} triangles (rank {mine['triangles'] + 1:g})")


@statement(5, "FRST has more triangles than SPRNG and about the same depth (within 20 %)")
def _(t, **_):
    more, depth = t.get("FRST_PT", "triangles") > t.get("SPRNG_PT", "triangles"), [t.get(n, "bvh_depth") for n in ("FRST_PT", "SPRNG_PT")]
    return more and abs(depth[0] - depth[1]) <= 0.2 * depth[1], f"depths {depth[0]:.0f} and {depth[1]:.0f}"


@statement(5, "CRNVL is nearly as deep as CAR (at least 80 %) with far fewer triangles (below a quarter)")
def _(t, **_):
    depth, triangles = [[t.get(n, m) for n in ("CRNVL_PT", "CAR_PT")] for m in ("bvh_depth", "triangles")]
    return depth[0] >= 0.8 * depth[1] and triangles[0] < triangles[1] / 4, f"depths {depth[0]:.0f} and {depth[1]:.0f}, triangles {triangles[0]:.0f} and {triangles[1]:.0f}"


@statement(5, "PT cycles correlate with none of triangles, instances and depth (each r between -0.7 and 0.7)")
def _(t, **_):
    whole(t)
    r = {m: correlation(t.values("cycles", "PT"), t.values(m, "PT")) for m in ("triangles", "instances", "bvh_depth")}
    return max(map(abs, r.values())) < 0.7, ", ".join(f"{m} r = {value:.2f}" for m, value in r.items())


@statement(6, "ALU is the most frequent class of instructions in every workload")
def _(t, **_):
    others = ("ins_sfu%", "ins_mem%", "ins_tex%", "ins_ctrl%", "ins_rt%")
    wrong = [n for n in t.names() if t.get(n, "ins_alu%") <= max(t.get(n, m) for m in others)]
    return not wrong, f"{t.mean('ins_alu%'):.1f} % on average" + (", but not in " + " ".join(wrong) if wrong else "")


@statement(6, "RT has the largest share of the latency and Mem the second largest (means over the workloads)")
def _(t, **_):
    rt, mem, alu = (t.mean(m) for m in ("lat_rt%", "lat_mem%", "lat_alu%"))
    return rt > mem > alu, f"RT {rt:.1f} %, Mem {mem:.1f} %, ALU {alu:.1f} %"


@statement(6, "PARK_PT is bound by RT (more than half of its latency)")
def _(t, **_):
    return t.get("PARK_PT", "lat_rt%") > 50, f"RT {t.get('PARK_PT', 'lat_rt%'):.1f} %"


@statement(6, "Mem has a larger share of WKND_PT's latency than RT")
def _(t, **_):
    return t.get("WKND_PT", "lat_mem%") > t.get("WKND_PT", "lat_rt%"), f"Mem {t.get('WKND_PT', 'lat_mem%'):.1f} %, RT {t.get('WKND_PT', 'lat_rt%'):.1f} %"


@statement(7, "RT occupancy is high (above half) in most workloads")
def _(t, **_):
    values = t.values("rt_occupancy")
    high = sum(value > 0.5 for value in values)
    return high > len(values) / 2, f"{high} of {len(values)}, mean {percent(t.mean('rt_occupancy'))}"


def by_shader(t, metric):
    pt, ao, sh = (t.mean(metric, shader) for shader in ("PT", "AO", "SH"))
    return pt < ao < sh, f"PT {percent(pt)}, AO {percent(ao)}, SH {percent(sh)}"


@statement(7, "RT efficiency is lowest for PT, higher for AO and highest for SH (means)")
def _(t, **_):
    return by_shader(t, "rt_efficiency")


@statement(7, "BUNNY_AO's RT efficiency is exceptional (more than a standard deviation above the mean)")
def _(t, **_):
    whole(t)
    values, mean = t.values("rt_efficiency"), t.mean("rt_efficiency")
    deviation = math.sqrt(sum((v - mean) ** 2 for v in values) / len(values))
    mine = t.get("BUNNY_AO", "rt_efficiency")
    return mine > mean + deviation, f"{percent(mine)}, mean {percent(mean)}, deviation {percent(deviation)}"


@statement(7, "PARK_PT's RT efficiency is very low (below the mean of PT)")
def _(t, **_):
    return t.get("PARK_PT", "rt_efficiency") < t.mean("rt_efficiency", "PT"), f"{percent(t.get('PARK_PT', 'rt_efficiency'))}, mean of PT {percent(t.mean('rt_efficiency', 'PT'))}"


@statement(7, "SIMT efficiency has the same order: PT, AO, SH (means)")
def _(t, **_):
    return by_shader(t, "simt_efficiency")


@statement(8, "CHSNT_PT's traversal ratio is high (above the mean)")
def _(t, **_):
    whole(t)
    return t.get("CHSNT_PT", "traversal_ratio") > t.mean("traversal_ratio"), f"{t.get('CHSNT_PT', 'traversal_ratio'):.2f}, mean {t.mean('traversal_ratio'):.2f}"


@statement(8, "BATH_AO's traversal ratio is low (below the mean)")
def _(t, **_):
    whole(t)
    return t.get("BATH_AO", "traversal_ratio") < t.mean("traversal_ratio"), f"{t.get('BATH_AO', 'traversal_ratio'):.2f}, mean {t.mean('traversal_ratio'):.2f}"


@statement(9, "half of traceRay's L1D reads miss on average (40 to 60 %)")
def _(t, **_):
    whole(t)
    return 0.4 <= t.mean("rt_miss_rate") <= 0.6, f"{percent(t.mean('rt_miss_rate'))}"


@statement(9, "traceRay's reads in PARK_PT miss more often than the average")
def _(t, **_):
    return t.get("PARK_PT", "rt_miss_rate") > t.mean("rt_miss_rate"), f"{percent(t.get('PARK_PT', 'rt_miss_rate'))}, paper 66 %"


@statement(9, "the L2 misses about as often as the L1 (means within 15 points)")
def _(t, **_):
    l1, l2 = t.mean("l1d_miss_rate"), t.mean("l2_miss_rate")
    return abs(l1 - l2) <= 0.15, f"L1D {percent(l1)}, L2 {percent(l2)}"


@statement(9, "most misses of BUNNY_AO come from the shaders")
def _(t, **_):
    rt, shader = rt_and_shader_misses(t, "BUNNY_AO")
    return shader > rt, f"shaders {percent(shader / (rt + shader))}"


@statement(9, "most misses of PARK_PT come from the traversal")
def _(t, **_):
    rt, shader = rt_and_shader_misses(t, "PARK_PT")
    return rt > shader, f"traversal {percent(rt / (rt + shader))}"


@statement(9, "cold misses are a small part of the RT units' misses (mean below a third)")
def _(t, **_):
    parts = [t.get(n, "rt_cold_misses") / rt_and_shader_misses(t, n)[0] for n in t.names()]
    return sum(parts) / len(parts) < 1 / 3, f"{percent(sum(parts) / len(parts))}"


@statement(10, "DRAM efficiency lies within 48 to 88 % in the subset")
def _(t, **_):
    values = {n: t.get(n, "dram_eff") for n in SUBSET}
    return min(values.values()) >= 0.48 and max(values.values()) <= 0.88, f"{percent(min(values.values()))} to {percent(max(values.values()))}"


@statement(10, "in the subset PARK_PT has the lowest DRAM efficiency and SPNZA_AO the highest")
def _(t, **_):
    values = {n: t.get(n, "dram_eff") for n in SUBSET}
    low, high = min(values, key=values.get), max(values, key=values.get)
    return (low, high) == ("PARK_PT", "SPNZA_AO"), f"lowest {low} {percent(values[low])}, highest {high} {percent(values[high])}"


@statement(10, "PARTY_PT's DRAM efficiency is low (below the mean; paper 37 %)")
def _(t, **_):
    return t.get("PARTY_PT", "dram_eff") < t.mean("dram_eff"), f"{percent(t.get('PARTY_PT', 'dram_eff'))}, mean {percent(t.mean('dram_eff'))}"


@statement(10, "DRAM utilisation lies a little below efficiency (mean difference within 7 points +- 5)")
def _(t, **_):
    difference = t.mean("dram_eff") - t.mean("dram_util")
    return 0.02 <= difference <= 0.12, f"{100 * difference:.1f} points"


@statement(10, "ROBOT's DRAM utilisation is low (mean of its workloads below the mean of all)")
def _(t, **_):
    mine = sum(t.get(f"ROBOT_{s}", "dram_util") for s in ("PT", "SH", "AO")) / 3
    return mine < t.mean("dram_util"), f"{percent(mine)}, mean {percent(t.mean('dram_util'))}"


@statement(10, "on desktop DRAM efficiency and utilisation are much lower (means, by a quarter at least)")
def _(t, desktop=None, **_):
    if desktop is None:
        raise Missing("needs --desktop, a metrics.csv of the same workloads on desktop")
    pairs = [(t.mean(m), desktop.mean(m)) for m in ("dram_eff", "dram_util")]
    return all(b <= 0.75 * a for a, b in pairs), ", ".join(f"{name} {percent(a)} and {percent(b)}" for name, (a, b) in zip(("efficiency", "utilisation"), pairs))


@statement(10, "DRAM bandwidth hardly changes PARTY_PT's cycles (twice the bandwidth: within 10 %)")
def _(t, bandwidth=None, bandwidth_base=None, **_):
    if bandwidth is None:
        raise Missing("needs --bandwidth, a metrics.csv of PARTY_PT with twice the bandwidth")
    a, b = (bandwidth_base or t).get("PARTY_PT", "cycles"), bandwidth.get("PARTY_PT", "cycles")
    return abs(b - a) <= 0.1 * a, f"{a:.0f} and {b:.0f} cycles"


@statement(11, "SHIP_SH and PARK_PT fetch many more leaves than the others (share of RT reads above 1.25 times the mean)")
def _(t, **_):
    whole(t)

    def share(name):
        leaves = t.get(name, "acc_quad_leaf") + t.get(name, "acc_proc_leaf")
        return leaves / (leaves + t.get(name, "acc_internal") + t.get(name, "acc_instance_leaf"))
    mean = sum(map(share, t.names())) / len(t.names())
    mine = {name: share(name) for name in ("SHIP_SH", "PARK_PT")}
    return min(mine.values()) > 1.25 * mean, ", ".join(f"{n} {percent(v)}" for n, v in mine.items()) + f", mean {percent(mean)}"


@statement(12, "IPC is higher on desktop in every workload")
def _(t, desktop=None, **_):
    if desktop is None:
        raise Missing("needs --desktop")
    wrong = [n for n in t.names() if desktop.get(n, "thread_ipc") <= t.get(n, "thread_ipc")]
    return not wrong, f"mean {t.mean('thread_ipc'):.1f} and {desktop.mean('thread_ipc'):.1f}" + (", but not " + " ".join(wrong) if wrong else "")


@statement(12, "IPC has the same trends on desktop (rank correlation above 0.7)")
def _(t, desktop=None, **_):
    if desktop is None:
        raise Missing("needs --desktop")
    names = t.names()
    r = correlation(ranks([t.get(n, "thread_ipc") for n in names]), ranks([desktop.get(n, "thread_ipc") for n in names]))
    return r > 0.7, f"r = {r:.2f}"


def evaluate(table, **others):
    """Returns (item, statement, verdict, figures) of each statement."""
    out = []
    for item, text, function in STATEMENTS:
        try:
            holds, figures = function(table, **others)
            out.append((item, text, "holds" if holds else "does not hold", figures))
        except Missing as reason:
            out.append((item, text, "cannot be judged", str(reason)))
    return out


def flips(folder):
    """Returns the verdicts of the first machine of an ablation by statement, and for each other machine the statements whose verdict is another one."""
    tables = {path.parent.name: Table.read(path, stands_for_all=True) for path in sorted(pathlib.Path(folder).glob("*/metrics.csv"))}
    if "from" not in tables:
        raise SystemExit(f"error: {folder} has no from/metrics.csv; `glint ablate` writes it")
    verdicts = {name: {text: (verdict, figures) for _, text, verdict, figures in evaluate(table)} for name, table in tables.items()}
    first = verdicts.pop("from")
    return first, {name: {text: of[text] for text in first if of[text][0] != first[text][0]} for name, of in verdicts.items()}


def print_flips(folder):
    first, others = flips(folder)
    for text, (verdict, figures) in first.items():
        print(f"{verdict:16}  {text}: {figures}")
        for name, changed in others.items():
            if text in changed:
                print(f"    {name}: {changed[text][0]}, {changed[text][1]}")


def read_series(path):
    with open(path, newline="") as file:
        rows = [{key: float(value) if value else 0.0 for key, value in row.items()} for row in csv.DictReader(file)]
    for before, row in zip([{"cycle": 0.0}] + rows, rows):
        row["cycles"] = row["cycle"] - before["cycle"]
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("metrics", nargs="?", help="the metrics.csv of `glint bench` on mobile")
    parser.add_argument("--ablation", metavar="FOLDER", help="folder of `glint ablate`: print which statements each machine flips; its workloads stand for all")
    parser.add_argument("--desktop", help="the metrics.csv of the same workloads on desktop")
    parser.add_argument("--large", help="the metrics.csv of SHIP_SH at 1920x1080")
    parser.add_argument("--bandwidth", help="the metrics.csv of PARTY_PT with twice the DRAM bandwidth")
    parser.add_argument("--series", nargs="+", default=[], metavar="RUN", help="run directories of PARK_PT, BUNNY_AO and SHIP_SH with --sample")
    parser.add_argument("--markdown", action="store_true", help="print a table for docs")
    arguments = parser.parse_args()
    if arguments.ablation:
        print_flips(arguments.ablation)
        return
    if not arguments.metrics:
        parser.error("the following arguments are required: metrics")
    table = Table.read(arguments.metrics)
    others = {name: Table.read(path) for name in ("desktop", "large", "bandwidth") if (path := getattr(arguments, name))}
    series = {pathlib.Path(run).name: read_series(pathlib.Path(run) / "series.csv") for run in arguments.series}
    results = evaluate(table, series=series, **others)
    if arguments.markdown:
        print("| item | statement | verdict | our figures |\n|---|---|---|---|")
    for item, text, verdict, figures in results:
        print(f"| {item} | {text} | {verdict} | {figures} |" if arguments.markdown else f"{item:2}  {verdict:16}  {text}: {figures}")
    counts = {v: sum(r[2] == v for r in results) for v in ("holds", "does not hold", "cannot be judged")}
    print(("\n" if arguments.markdown else "") + ", ".join(f"{count} {verdict}" for verdict, count in counts.items()))


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Compares frames that a GPU drew with the same frames under a preset: ranks, logarithms, a table and a figure.

Usage: compare_rt_frames.py [--hardware FILE] [--glint FILE] [--figure FILE.svg] [--simulate GLINT --jobs N] [--config NAME] [--mhz MHZ]
The hardware's file is that of examples/rt_frames with a column `samples` (bench/rt_frames/h200.csv). --simulate runs the frames of 256x256 with one
sample first, and writes --glint. The output is a table in Markdown.
"""
# SPDX-License-Identifier: Apache-2.0
import argparse
import concurrent.futures
import csv
import math
import os
import statistics
import subprocess
import tempfile
from pathlib import Path

from scatter import Point, scatter

FOLDER = Path(__file__).resolve().parent.parent / "bench" / "rt_frames"
SHADERS = ["PT", "SH", "AO"]
SIZE, SAMPLES = 256, 1


def read_hardware(path):
    """Returns microseconds by workload, of the frames that are compared."""
    with open(path) as file:
        return {row["workload"]: float(row["median_ns"]) / 1e3 for row in csv.DictReader(file)
                if int(row["width"]) == SIZE and int(row["samples"]) == SAMPLES}


def read_glint(path, mhz):
    with open(path) as file:
        return {row["workload"]: int(row["cycles"]) / mhz for row in csv.DictReader(file)}


def simulate(glint, config, workloads, jobs, path):
    """Runs the frames and writes their cycles."""
    def cycles(workload):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([glint, "run", workload, "--config", config, "--size", f"{SIZE}x{SIZE}", "--spp", str(SAMPLES), "--stats", "compact",
                            "--out", folder], check=True, stdout=subprocess.DEVNULL)
            with open(Path(folder) / "stats.csv") as file:
                return next(row["value"] for row in csv.DictReader(file) if row["path"] == "gpu.cycles")
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        found = list(pool.map(cycles, workloads))
    rows = "".join(f"{workload},{SIZE},{SIZE},{SAMPLES},{value}\n" for workload, value in zip(workloads, found))
    Path(path).write_text("workload,width,height,samples,cycles\n" + rows)


def ranks(values):
    """Returns the rank of each value; equal values share the mean of their ranks."""
    order = sorted(values)
    return [(order.index(value) + len(order) - 1 - order[::-1].index(value)) / 2 for value in values]


def agreement(pairs):
    """Returns the rank correlation, the correlation of logarithms, and the geometric mean of Glint over hardware."""
    glint, hardware = zip(*pairs)
    logs = [[math.log(value) for value in side] for side in (glint, hardware)]
    return (statistics.correlation(ranks(glint), ranks(hardware)), statistics.correlation(*logs),
            math.exp(statistics.mean(logs[0]) - statistics.mean(logs[1])))


def table(glint, hardware):
    """Returns the rows of each scene, and those of the correlations."""
    scenes = list(dict.fromkeys(name.split("_")[0] for name in glint))
    lines = ["| scene | pt: Glint | H200 | ratio | sh: Glint | H200 | ratio | ao: Glint | H200 | ratio |", "|---|" + "---|" * 9]
    for scene in scenes:
        cells = []
        for shader in SHADERS:
            name = f"{scene}_{shader}"
            there = name in glint and name in hardware
            cells += [f"{glint[name]:,.0f}", f"{hardware[name]:,.0f}", f"{glint[name] / hardware[name]:.2f}"] if there else [""] * 3
        lines.append(f"| {scene} | " + " | ".join(cells) + " |")
    lines += ["", "| frames | number | rank correlation | correlation of logarithms | Glint / H200, geometric mean |", "|---|---|---|---|---|"]
    for title, ending in (("all", ""), *((shader.lower(), "_" + shader) for shader in SHADERS)):
        pairs = [(glint[name], hardware[name]) for name in glint if name in hardware and name.endswith(ending)]
        rank, logs, ratio = agreement(pairs)
        lines.append(f"| {title} | {len(pairs)} | {rank:.3f} | {logs:.3f} | {ratio:.2f} |")
    return "\n".join(lines) + "\n"


def figure(glint, hardware):
    """Returns the frames as points, as SVG. The full line is equality, the dashed one the mean ratio."""
    points = [Point(name, name[-2:].lower(), hardware[name], glint[name]) for name in glint if name in hardware]
    mean = agreement([(point.computed, point.measured) for point in points])[2]
    return scatter(points, "Times of 46 ray-traced frames on an H200 and under the preset h200", "H200, microseconds",
                   "Glint, preset h200, microseconds", ((1, False), (mean, True)), centre=mean)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--hardware", default=FOLDER / "h200.csv")
    parser.add_argument("--glint", default=FOLDER / "glint.csv")
    parser.add_argument("--figure")
    parser.add_argument("--simulate", metavar="GLINT")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--config", default="h200")
    parser.add_argument("--mhz", type=float, default=1980.0, help="clock of the simulated cores")
    options = parser.parse_args()
    hardware = read_hardware(options.hardware)
    if options.simulate:
        simulate(options.simulate, options.config, list(hardware), options.jobs, options.glint)
    glint = read_glint(options.glint, options.mhz)
    if options.figure:
        Path(options.figure).write_text(figure(glint, hardware))
    print(table(glint, hardware), end="")


if __name__ == "__main__":
    main()

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

FOLDER = Path(__file__).resolve().parent.parent / "bench" / "rt_frames"
COLOURS = {"PT": "#1f6fb4", "SH": "#c8651b", "AO": "#3a8f4d"}
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
        for shader in COLOURS:
            name = f"{scene}_{shader}"
            there = name in glint and name in hardware
            cells += [f"{glint[name]:,.0f}", f"{hardware[name]:,.0f}", f"{glint[name] / hardware[name]:.2f}"] if there else [""] * 3
        lines.append(f"| {scene} | " + " | ".join(cells) + " |")
    lines += ["", "| frames | number | rank correlation | correlation of logarithms | Glint / H200, geometric mean |", "|---|---|---|---|---|"]
    for title, ending in (("all", ""), *((shader.lower(), "_" + shader) for shader in COLOURS)):
        pairs = [(glint[name], hardware[name]) for name in glint if name in hardware and name.endswith(ending)]
        rank, logs, ratio = agreement(pairs)
        lines.append(f"| {title} | {len(pairs)} | {rank:.3f} | {logs:.3f} | {ratio:.2f} |")
    return "\n".join(lines) + "\n"


def figure(glint, hardware, outliers=6):
    """Returns the frames as points on logarithmic axes, as SVG. The names are of those furthest from the mean ratio."""
    names = [name for name in glint if name in hardware]
    low = 10 ** math.floor(math.log10(min(min(glint[name], hardware[name]) for name in names)))
    high = 10 ** math.ceil(math.log10(max(max(glint[name], hardware[name]) for name in names)))
    side, left, top = 460, 70, 20
    place = lambda value: side * math.log(value / low) / math.log(high / low)
    x, y = lambda value: left + place(value), lambda value: top + side - place(value)
    mean = agreement([(glint[name], hardware[name]) for name in names])[2]
    far = sorted(names, key=lambda name: -abs(math.log(glint[name] / hardware[name] / mean)))[:outliers]
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {left + side + 20} {top + side + 60}" font-family="sans-serif" font-size="12">',
           '<title>Times of 46 ray-traced frames on an H200 and under the preset h200</title>',
           f'<rect x="{left}" y="{top}" width="{side}" height="{side}" fill="#fff" stroke="#888"/>']
    tick = low
    while tick <= high:
        out += [f'<line x1="{x(tick):.1f}" y1="{top}" x2="{x(tick):.1f}" y2="{top + side}" stroke="#ddd"/>',
                f'<line x1="{left}" y1="{y(tick):.1f}" x2="{left + side}" y2="{y(tick):.1f}" stroke="#ddd"/>',
                f'<text x="{x(tick):.1f}" y="{top + side + 18}" text-anchor="middle">{tick:,.0f}</text>',
                f'<text x="{left - 6}" y="{y(tick) + 4:.1f}" text-anchor="end">{tick:,.0f}</text>']
        tick *= 10
    for factor, dash in ((1, ""), (mean, ' stroke-dasharray="5 4"')):
        out.append(f'<line x1="{x(low):.1f}" y1="{y(low * max(factor, 1)):.1f}" x2="{x(high / factor):.1f}" y2="{y(high):.1f}" stroke="#888"{dash}/>')
    for name in names:
        out.append(f'<circle cx="{x(hardware[name]):.1f}" cy="{y(glint[name]):.1f}" r="4" fill="{COLOURS[name[-2:]]}" fill-opacity="0.75"/>')
        if name in far:
            above = glint[name] / hardware[name] > mean
            out.append(f'<text x="{x(hardware[name]) + (-7 if above else 7):.1f}" y="{y(glint[name]) + 4:.1f}" text-anchor="{"end" if above else "start"}" '
                       f'font-size="10">{name}</text>')
    for i, (shader, colour) in enumerate(COLOURS.items()):
        out += [f'<circle cx="{left + side - 60}" cy="{top + side - 60 + 18 * i}" r="4" fill="{colour}"/>',
                f'<text x="{left + side - 50}" y="{top + side - 56 + 18 * i}">{shader.lower()}</text>']
    out += [f'<text x="{left + side / 2}" y="{top + side + 42}" text-anchor="middle">H200, microseconds</text>',
            f'<text transform="translate(16 {top + side / 2}) rotate(-90)" text-anchor="middle">Glint, preset h200, microseconds</text>', "</svg>"]
    return "\n".join(out) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--hardware", default=FOLDER / "h200.csv")
    parser.add_argument("--glint", default=FOLDER / "glint.csv")
    parser.add_argument("--figure")
    parser.add_argument("--simulate", metavar="GLINT")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
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

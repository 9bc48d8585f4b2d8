#!/usr/bin/env python3
# Measures how well sampled runs estimate whole ones, and how much time they take.
# SPDX-License-Identifier: Apache-2.0
"""Prints the tables of docs/sampling.md: `bench/sampling_table.py GLINT [WORKLOAD ...]`.

With --launches, launches are sampled and not pixels: NAME:SHARE is a compute program or a sequence of frames with
the sample's size, and NAME/small:SHARE the program with its small input.

Every workload is run whole once, and sampled with several seeds. The table says how far the estimates are from
the whole runs, how often their 95 % intervals cover them, and how much processor time a sample takes. Runs of
several processes at a time (--jobs) share caches and clocks of the host, which is why times are those of one
process and only their quotients are shown.
"""
import argparse
import concurrent.futures
import csv
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

# The estimate of a sampled run, and the counters of a whole one whose quotient it estimates.
FRACTIONS = {
    "l1_hit_rate": ("gpu.memory.core[*].l1.hits", "gpu.memory.core[*].l1.reads"),
    "l2_hit_rate": ("gpu.memory.partition[*].l2.hits", "gpu.memory.partition[*].l2.reads"),
    "dram_utilisation": ("gpu.memory.partition[*].dram.busy_clocks", "gpu.memory.partition[*].dram.clocks"),
}
NAMES = ["cycles", "ipc", "l1_hit_rate", "l2_hit_rate", "dram_utilisation"]


def totals(folder):
    """Returns the compact statistics of a run by path; parts of breakdowns are summed."""
    sums = {}
    with open(folder / "stats.csv", newline="") as file:
        for path, value, *_ in list(csv.reader(file))[1:]:
            path = path.split("::")[0]
            sums[path] = sums.get(path, 0) + float(value)
    return sums


def run(glint, workload, folder, arguments):
    """Runs a workload on one thread. Returns its statistics, the time of the launch alone, and the processor time of the process."""
    command = [glint, "run", workload, "--threads", "1", "--stats", "compact", "--out", str(folder), *arguments]
    with tempfile.TemporaryFile("w+") as said, subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=said) as process:
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode:
            said.seek(0)
            sys.exit(f"{' '.join(command)}\n{said.read()}")
    seconds = json.loads((folder / "run.json").read_text())["wall_seconds"]
    return totals(folder), seconds, usage.ru_utime + usage.ru_stime


def truth_of(sums):
    """Returns what a whole run has in place of each estimate."""
    out = {name: sums[above] / sums[below] for name, (above, below) in FRACTIONS.items() if sums.get(below)}
    out["cycles"] = sums["gpu.cycles"]
    out["ipc"] = sums["gpu.core[*].instructions"] / sums["gpu.cycles"]
    return out


def measure(glint, workload, options, seeds, settings):
    """Returns rows (workload, seed, name, truth, value, low, high, seconds of the whole run, of the sample)."""
    rows = []
    frame = [] if workload.endswith(".toml") else ["--size", options.size, "--spp", str(options.spp)]
    sample, common, share, program = "--sample-pixels", [*frame, *settings], options.share, workload
    by = [] if options.launches else ["--sample-by", options.by]
    if options.launches:
        program, _, own = workload.partition(":")
        program, _, small = program.partition("/")
        is_scene = "_" in program
        sample, share = "--sample-launches", own or share
        common = [*(frame if is_scene else []), *(["--small"] if small else []), *settings]
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        # A sample of launches has a first pass, which is no part of any launch, so the whole process counts.
        whole, *long = run(glint, program, scratch / "whole", common)
        long = long[options.launches]
        truth = truth_of(whole)
        for seed in seeds:
            sums, *short = run(glint, program, scratch / f"sample{seed}", [*common, sample, share, *by, "--sample-seed", str(seed)])
            for name in NAMES:
                if (value := sums.get(f"gpu.sample.{name}")) is None or name not in truth:
                    continue
                rows.append([pathlib.Path(workload).stem, seed, name, truth[name], value, sums[f"gpu.sample.{name}_low"],
                             sums[f"gpu.sample.{name}_high"], long, short[options.launches]])
    return rows


def error(row):
    """Returns the error of a count as a share of the truth, and that of a fraction as a difference."""
    return (row[4] - row[3]) / (1 if row[2] in FRACTIONS else row[3])


def print_tables(rows):
    """Prints the table of the estimates, and that of the workloads' cycles."""
    print("| estimate | median error | mean error (bias) | 95 % of errors below | intervals that cover | median half "
          "interval |\n|---|---|---|---|---|---|")
    for name in NAMES:
        mine = [row for row in rows if row[2] == name]
        errors = [error(row) for row in mine]
        sizes = sorted(abs(e) for e in errors)
        covered = sum(row[5] <= row[3] <= row[6] for row in mine)
        half = statistics.median((row[6] - row[5]) / 2 / (1 if name in FRACTIONS else row[4]) for row in mine)
        print(f"| {name} | {100 * statistics.median(sizes):.1f} % | {100 * statistics.mean(errors):+.1f} % | "
              f"{100 * sizes[math.ceil(0.95 * len(sizes)) - 1]:.1f} % | {covered} of {len(mine)} "
              f"({100 * covered / len(mine):.0f} %) | {100 * half:.1f} % |")
    print("\n| workload | cycles | errors of cycles, by seed | covered | time of a sample |\n|---|---|---|---|---|")
    for workload in dict.fromkeys(row[0] for row in rows):
        mine = [row for row in rows if row[0] == workload and row[2] == "cycles"]
        took = f"{100 * statistics.mean(row[8] for row in mine) / mine[0][7]:.1f} %" if len(mine[0]) > 7 else ""
        print(f"| {workload} | {mine[0][3]:,.0f} | {', '.join(f'{100 * error(row):+.1f} %' for row in mine)} | "
              f"{sum(row[5] <= row[3] <= row[6] for row in mine)} of {len(mine)} | {took} |")
    if len(rows[0]) < 8:
        return  # The file has no times, because other work ran beside its runs.
    shares = [row[8] / row[7] for row in rows if row[2] == "cycles"]
    print(f"\nA sample takes {100 * statistics.mean(shares):.1f} % of the whole run's time (mean), and all samples "
          f"{100 * sum(row[8] for row in rows) / sum(row[7] for row in rows):.1f} %.")


def main():
    """Reads the command line, runs, and prints."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("glint")
    parser.add_argument("workloads", nargs="*", help="names as in `glint list workloads`; none: LumiBench's 46")
    parser.add_argument("--size", default="512x512")
    parser.add_argument("--spp", type=int, default=1, help="samples of a pixel")
    parser.add_argument("--share", default="5%")
    parser.add_argument("--by", default="position", help="how blocks are chosen, as --sample-by names it")
    parser.add_argument("--launches", action="store_true", help="sample launches, and not the pixels of one")
    parser.add_argument("--seeds", type=int, default=3, help="number of samples of each workload")
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--set", action="append", default=[], help="KEY=VALUE of the configuration")
    parser.add_argument("--config", default="mobile")
    parser.add_argument("--csv", help="file that gets every row")
    parser.add_argument("--read", help="print the tables of such a file, and run nothing")
    options = parser.parse_args()
    if options.read:
        with open(options.read, newline="") as file:
            rows = [[*row[:3], *map(float, row[3:])] for row in list(csv.reader(file))[1:]]
        return print_tables(rows)
    names = options.workloads or [line.split()[0] for line in subprocess.run(
        [options.glint, "list", "workloads"], capture_output=True, text=True, check=True).stdout.splitlines()
        if "_" in line.split()[0]]
    settings = ["--config", options.config, *(word for one in options.set for word in ("--set", one))]
    seeds = range(options.first_seed, options.first_seed + options.seeds)
    rows = []
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool, open(
            options.csv or os.devnull, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["workload", "seed", "name", "truth", "value", "low", "high", "whole_s", "sample_s"])
        for some in pool.map(lambda name: measure(options.glint, name, options, seeds, settings), names):
            rows += some
            writer.writerows(some)
            file.flush()
    print_tables(rows)


if __name__ == "__main__":
    main()

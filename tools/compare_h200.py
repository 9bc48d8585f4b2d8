#!/usr/bin/python3
"""Runs the kernels of a folder of bench under the preset h200 and prints the results next to a card's counters.

Usage: compare_h200.py GLINT [KERNEL ...] [--folder bench/probes] [--counters FILE] [--set KEY=VALUE ...] [--config NAME] [--runs FOLDER]
The folder is bench/held_out unless another one is given. The output is a table in Markdown. The hardware's cycles are the median of three
launches. The folder of --runs keeps the run directories, for `glint model FOLDER`. The exit status is 2 when a kernel has no counters.
"""
# SPDX-License-Identifier: Apache-2.0
import argparse
import csv
import json
import re
import statistics
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

BENCH = Path(__file__).resolve().parent.parent / "bench"


def launch_file(folder, kernel, launch):
    lines = [f'kernel = "{folder / "kernels.ptx"}"', f'entry = "{kernel}"', f"grid = {launch['grid']}", f"block = {launch['block']}"]
    for i, argument in enumerate(launch["arguments"]):
        lines.append("[[argument]]")
        if "type" in argument:
            lines.append(f'buffer = "b{i}"')
        lines += [f"{key} = {json.dumps(value)}" for key, value in argument.items()]
    return "\n".join(lines) + "\n"


def read_counters(path):
    launches = {}
    for row in csv.DictReader(open(path)):
        launches.setdefault(row["kernel"], []).append({key: int(value) for key, value in row.items() if key != "kernel"})
    return {kernel: {key: statistics.median(row[key] for row in rows) for key in rows[0]} for kernel, rows in launches.items()}


def run(glint, kernel, text, config, settings, runs):
    """Returns what Glint counts: cycles, executed instructions, warps' loads from global memory; and the launch latency of the configuration.

    `runs` keeps the run directory, unless it is None.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"{kernel}.toml"
        path.write_text(text)
        out = Path(runs or folder) / kernel
        command = [glint, "run", path, "--config", config, "--out", out]
        for setting in settings:
            command += ["--set", setting]
        subprocess.run(command, check=True, capture_output=True)
        rows = {row["path"]: row["value"] for row in csv.DictReader(open(out / "stats.csv"))}
        launch = tomllib.loads((out / "config.toml").read_text())["core"]["launch_latency"]

    def total(name):
        return sum(float(value) for path, value in rows.items() if re.fullmatch(rf"gpu\.core\[\d+\]\.{name}", path))

    return float(rows["gpu.cycles"]), total("instructions") + total("sequence_slots"), total("global_loads"), launch


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("glint")
    parser.add_argument("kernel", nargs="*")
    parser.add_argument("--folder", type=Path, default=BENCH / "held_out", help="folder with kernels.ptx, launches.toml and counters.csv")
    parser.add_argument("--counters", type=Path, help="other counters than those of the folder, for example of another card")
    parser.add_argument("--config", default="h200")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--runs", metavar="FOLDER")
    options = parser.parse_args()
    folder = options.folder.resolve()
    launches = tomllib.loads((folder / "launches.toml").read_text())
    counters = read_counters(options.counters or folder / "counters.csv")
    unknown = [kernel for kernel in options.kernel if kernel not in launches or kernel not in counters]
    if unknown:
        print(f"compare_h200.py: there is no kernel {', '.join(unknown)}; the kernels are {', '.join(launches)}", file=sys.stderr)
        return 2
    print("| kernel | cycles | hardware | error | instructions | hardware | error | global loads |\n|---|---|---|---|---|---|---|---|")
    errors, inner, counts = [], [], []
    for kernel in options.kernel or launches:
        text = launch_file(folder, kernel, launches[kernel])
        cycles, instructions, loads, launch = run(options.glint, kernel, text, options.config, options.set, options.runs)
        real = counters[kernel]
        error = cycles / real["sm__cycles_elapsed.max"] - 1
        executed = real["smsp__inst_executed.sum"]
        real_loads = real["l1tex__t_requests_pipe_lsu_mem_global_op_ld.sum"]
        errors.append(abs(error))
        inner.append(abs((cycles - launch) / (real["sm__cycles_elapsed.max"] - launch) - 1))
        counts.append(abs(instructions / executed - 1))
        print(f"| {kernel} | {cycles:,.0f} | {real['sm__cycles_elapsed.max']:,.0f} | {error:+.1%} | {instructions:,.0f} | {executed:,.0f} | "
              f"{instructions / executed - 1:+.1%} | {f'{loads / real_loads - 1:+.1%}' if real_loads else loads:} |", flush=True)
    print(f"\nMean absolute error of cycles: {statistics.mean(errors):.1%} (median {statistics.median(errors):.1%}, largest {max(errors):.1%}); without "
          f"{launch} cycles of launch on both sides: {statistics.mean(inner):.1%}; of instructions: {statistics.mean(counts):.1%}, of which "
          f"{sum(error <= 0.05 for error in counts)} of {len(counts)} within 5 %")
    return 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/python3
"""Runs the kernels of bench/held_out under the preset h200 and prints the results next to an H200's counters.

Usage: compare_h200.py GLINT [KERNEL ...] [--set KEY=VALUE ...] [--config NAME] [--runs FOLDER]
The output is a table in Markdown. The hardware's cycles are the median of three launches. The folder of --runs keeps the run directories, for
`glint model FOLDER`. The exit status is 2 when a kernel has no counters.
"""
# SPDX-License-Identifier: Apache-2.0
import argparse
import csv
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

FOLDER = Path(__file__).resolve().parent.parent / "bench" / "held_out"
MI = 1 << 20


def counting(kind, count):
    """Returns a buffer that holds 0, 1, 2 ..."""
    return {"type": f'"{kind}"', "count": count, "init": '"iota"'}


def zeros(kind, count):
    return {"type": f'"{kind}"', "count": count}


# Each kernel has: grid, block, arguments, as main() of kernels.cu launches it.
LAUNCHES = {
    "h_scan": ([1024], [256], [counting("f32", MI), zeros("f32", MI // 4), {"s32": MI // 4}]),
    "h_spmv": ([256], [256], [counting("f32", 16 * MI), counting("f32", MI), zeros("f32", 65536), {"s32": 65536}, {"s32": 0xFFFFF}]),
    "h_nbody": ([32], [128], [counting("f32", MI), zeros("f32", MI), {"s32": 4096}]),
    "h_bitonic": ([512], [256], [counting("u32", MI), zeros("u32", MI)]),
    "h_gemm": ([8, 8], [256], [counting("f32", MI), counting("f32", 16 * MI), zeros("f32", MI), {"s32": 512}]),
    "h_warp_sum": ([264], [256], [counting("f32", 16 * MI), zeros("f32", 64), {"s32": 4 * MI}]),
    "h_chase": ([512], [128], [counting("u32", MI), zeros("u32", MI), {"u32": 0xFFFFF}]),
    "h_collatz": ([512], [128], [zeros("u32", MI)]),
    "h_options": ([1024], [256], [counting("f32", MI), zeros("f32", MI // 4), {"s32": MI // 4}]),
    "h_newton": ([256], [256], [counting("f32", MI), zeros("f64", 65536), {"s32": 65536}]),
    "h_layer_norm": ([1024], [256], [counting("f32", 16 * MI), zeros("f32", MI)]),
    "h_copy": ([16384], [256], [counting("f32", 16 * MI), zeros("f32", 16 * MI), {"s32": 4 * MI}]),
    "h_count": ([264], [256], [counting("u32", MI), zeros("u32", 65536), {"s32": MI}]),
    "h_heat": ([4, 16], [32, 8], [counting("f32", 16 * MI), zeros("f32", 2 * MI), {"s32": 128}]),
}


def launch_file(kernel):
    grid, block, arguments = LAUNCHES[kernel]
    lines = [f'kernel = "{FOLDER / "kernels.ptx"}"', f'entry = "{kernel}"', f"grid = {grid}", f"block = {block}"]
    for i, argument in enumerate(arguments):
        lines.append("[[argument]]")
        if "type" in argument:
            lines.append(f'buffer = "b{i}"')
        lines += [f"{key} = {value}" for key, value in argument.items()]
    return "\n".join(lines) + "\n"


def read_counters():
    launches = {}
    for row in csv.DictReader(open(FOLDER / "counters.csv")):
        launches.setdefault(row["kernel"], []).append({key: int(value) for key, value in row.items() if key != "kernel"})
    return {kernel: {key: statistics.median(row[key] for row in rows) for key in rows[0]} for kernel, rows in launches.items()}


def run(glint, kernel, config, settings, runs):
    """Returns what Glint counts: cycles, executed instructions, warps' loads from global memory. `runs` keeps the run directory, unless it is None."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"{kernel}.toml"
        path.write_text(launch_file(kernel))
        out = Path(runs or folder) / kernel
        command = [glint, "run", path, "--config", config, "--out", out]
        for setting in settings:
            command += ["--set", setting]
        subprocess.run(command, check=True, capture_output=True)
        rows = {row["path"]: row["value"] for row in csv.DictReader(open(out / "stats.csv"))}

    def total(name):
        return sum(float(value) for path, value in rows.items() if re.fullmatch(rf"gpu\.core\[\d+\]\.{name}", path))

    return float(rows["gpu.cycles"]), total("instructions") + total("sequence_slots"), total("global_loads")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("glint")
    parser.add_argument("kernel", nargs="*", default=list(LAUNCHES))
    parser.add_argument("--config", default="h200")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--runs", metavar="FOLDER")
    options = parser.parse_args()
    counters = read_counters()
    unknown = [kernel for kernel in options.kernel if kernel not in LAUNCHES or kernel not in counters]
    if unknown:
        print(f"compare_h200.py: there is no kernel {', '.join(unknown)}; the kernels are {', '.join(LAUNCHES)}", file=sys.stderr)
        return 2
    print("| kernel | cycles | hardware | error | instructions | hardware | error | global loads |\n|---|---|---|---|---|---|---|---|")
    errors = []
    for kernel in options.kernel:
        cycles, instructions, loads = run(options.glint, kernel, options.config, options.set, options.runs)
        real = counters[kernel]
        error = cycles / real["sm__cycles_elapsed.max"] - 1
        executed = real["smsp__inst_executed.sum"]
        real_loads = real["l1tex__t_requests_pipe_lsu_mem_global_op_ld.sum"]
        errors.append(abs(error))
        print(f"| {kernel} | {cycles:,.0f} | {real['sm__cycles_elapsed.max']:,.0f} | {error:+.1%} | {instructions:,.0f} | {executed:,.0f} | "
              f"{instructions / executed - 1:+.1%} | {f'{loads / real_loads - 1:+.1%}' if real_loads else loads:} |", flush=True)
    print(f"\nMean absolute error of cycles: {statistics.mean(errors):.1%}")
    return 0


if __name__ == "__main__":
    sys.exit(main())

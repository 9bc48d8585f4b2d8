#!/usr/bin/python3
"""Runs the kernels of a folder of bench on a real GPU and writes its counters.

Usage: record_kernels.py FOLDER [--arch sm_90]
It needs a GPU, nvcc, Nsight Compute (ncu) and CuPy. It translates kernels.cu to kernels.ptx, launches each kernel of launches.toml three times
with new buffers, and writes counters.csv. Nsight Compute flushes the caches before each launch (its default), and clocks are not locked.
"""
# SPDX-License-Identifier: Apache-2.0
import argparse
import csv
import io
import subprocess
import sys
import tomllib
from pathlib import Path

METRICS = ["sm__cycles_elapsed.max", "sm__cycles_active.max", "smsp__inst_executed.sum", "smsp__thread_inst_executed.sum",
           "l1tex__t_requests_pipe_lsu_mem_global_op_ld.sum", "lts__t_sectors.sum", "lts__t_sectors_op_write.sum", "dram__bytes_read.sum",
           "dram__bytes_write.sum", "launch__registers_per_thread"]


def launch_all(folder):
    """Launches each kernel three times. ncu runs this."""
    import cupy
    import numpy
    types = {"u32": numpy.uint32, "s32": numpy.int32, "f32": numpy.float32, "f64": numpy.float64, "u64": numpy.uint64, "s64": numpy.int64}
    module = cupy.RawModule(path=str(folder / "kernels.cubin"))
    for name, launch in tomllib.loads((folder / "launches.toml").read_text()).items():
        kernel = module.get_function(name)
        for _ in range(3):
            arguments = []
            for argument in launch["arguments"]:
                if "type" in argument:
                    kind, count = types[argument["type"]], argument["count"]
                    host = numpy.arange(count).astype(kind) if argument.get("init") == "iota" else numpy.zeros(count, kind)
                    arguments.append(cupy.asarray(host))
                else:
                    (kind, value), = argument.items()
                    arguments.append(types[kind](value))
            kernel(tuple(launch["grid"]), tuple(launch["block"]), tuple(arguments))
            cupy.cuda.Device().synchronize()


def profile(kernels, metrics, program, *options):
    """Runs a program under Nsight Compute. Returns a row for each launch of one of the kernels."""
    command = ["ncu", "--clock-control", "none", *options, "--csv", "--page", "raw", "--print-units", "base", "--metrics", ",".join(metrics),
               "-k", f"regex:^({'|'.join(kernels)})$", *program]
    output = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    rows = list(csv.DictReader(io.StringIO("\n".join(line for line in output.splitlines() if line.startswith('"')))))[1:]  # the first row has units
    return [(row["Kernel Name"], [row[metric].replace(",", "") for metric in metrics]) for row in rows]


def record(folder, arch):
    subprocess.run(["nvcc", f"-arch={arch}", "-O3", "-ptx", "-o", folder / "kernels.ptx", folder / "kernels.cu"], check=True)
    subprocess.run(["nvcc", f"-arch={arch}", "-cubin", "-o", folder / "kernels.cubin", folder / "kernels.ptx"], check=True)
    rows = profile(tomllib.loads((folder / "launches.toml").read_text()), METRICS, [sys.executable, __file__, folder, "--launch"])
    turns = {}
    with open(folder / "counters.csv", "w") as out:
        table = csv.writer(out, lineterminator="\n")
        table.writerow(["kernel", "launch"] + METRICS)
        for name, values in rows:
            turns[name] = turns.get(name, 0) + 1
            table.writerow([name, turns[name]] + values)
    (folder / "kernels.cubin").unlink()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--arch", default="sm_90")
    parser.add_argument("--launch", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.launch:
        launch_all(options.folder)
    else:
        record(options.folder, options.arch)


if __name__ == "__main__":
    main()

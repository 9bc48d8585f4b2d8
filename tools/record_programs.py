#!/usr/bin/python3
"""Runs the PTX forms of Rodinia's programs on a real GPU and writes the counters of each launch, or compares Glint with them.

Usage: record_programs.py                                on a machine with a GPU, Nsight Compute (ncu) and CuPy
       record_programs.py --compare GLINT [--config NAME] [--counters FILE]
The inputs are the full ones of `glint run NAME-ptx`, to the bit. Caches are cold before the first launch of a program and kept between launches, as in
Glint. Programs whose kernels are in PTX: backprop, bfs, gaussian, hotspot, nn and pathfinder.
"""
# SPDX-License-Identifier: Apache-2.0
import argparse
import csv
import math
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from record_kernels import profile

ROOT = Path(__file__).resolve().parent.parent
KERNELS = ROOT / "shaders" / "compute"
COUNTERS = ROOT / "bench" / "programs" / "counters_h100.csv"
METRICS = ["sm__cycles_elapsed.max", "smsp__inst_executed.sum"]
PROGRAMS = ["backprop", "bfs", "gaussian", "hotspot", "nn", "pathfinder"]


class Device:
    """Launches kernels of shaders/compute, with the numbers of compute/host.h."""

    def __init__(self):
        import cupy
        import numpy
        self.cupy, self.numpy = cupy, numpy
        self.bits = numpy.random.RandomState(1)  # MT19937, as std::mt19937
        self.functions = {}

    def words(self, count):
        return self.bits.randint(0, 2**32, count, dtype=self.numpy.uint64)

    def below(self, count, end):
        return (self.words(count) * self.numpy.uint64(end) >> self.numpy.uint64(32)).astype(self.numpy.uint32)

    def floats(self, count, low, high):
        f32 = self.numpy.float32
        return f32(low) + f32(f32(high) - f32(low)) * ((self.words(count) >> self.numpy.uint64(8)).astype(f32) * f32(2**-24))

    def buffer(self, values, kind="float32"):
        return self.cupy.asarray(self.numpy.asarray(values, dtype=kind))

    def zeros(self, count, kind="float32"):
        return self.cupy.zeros(count, dtype=kind)

    def cold(self):
        """Reads so much that nothing else is left in the caches."""
        self.cupy.ones(1 << 27, dtype="float32").sum()
        self.cupy.cuda.Device().synchronize()

    def launch(self, name, groups, block, *arguments):
        if name not in self.functions:
            self.functions[name] = self.cupy.RawModule(path=str(KERNELS / f"{name}.ptx")).get_function(name)
        values = [self.numpy.uint32(a) if isinstance(a, int) else self.numpy.float32(a) if isinstance(a, float) else a for a in arguments]
        self.functions[name](groups, block, tuple(values))


def groups_of(count, size):
    return (count + size - 1) // size


def backprop(d):
    count, width = 65536, 17
    inputs, output_weights = d.floats(count + 1, 0, 1), d.floats(width, -1, 1)
    weights = d.floats((count + 1) * width, -0.01, 0.01)
    values, matrix, sums, moved = d.buffer(inputs), d.buffer(weights), d.zeros(count), d.zeros(len(weights))
    d.cold()
    d.launch("backprop_forward", (count // 16, 1), (16, 16), values, matrix, sums, 16)
    errors = d.buffer(output_weights * d.numpy.float32(0.01))  # Choice: the size of errors, which no time depends on
    d.launch("backprop_adjust", (count // 16, 1), (16, 16), values, matrix, moved, errors, 16)


def bfs(d):
    nodes = 65536
    of = [[] for _ in range(nodes)]
    words = iter(d.words(16 * nodes).tolist())
    for node in range(nodes):
        for _ in range(2 + (next(words) * 3 >> 32)):
            to = next(words) * nodes >> 32
            of[node].append(to)
            of[to].append(node)
    first = [0]
    for edges in of:
        first.append(first[-1] + len(edges))
    firsts, edges = d.buffer(first, "uint32"), d.buffer([e for edges in of for e in edges], "uint32")
    frontier, after, visited, more = d.zeros(nodes, "uint32"), d.zeros(nodes, "uint32"), d.zeros(nodes, "uint32"), d.zeros(1, "uint32")
    distance = d.buffer([-1] * nodes, "int32")
    frontier[0] = visited[0] = 1
    distance[0] = 0
    d.cold()
    while True:
        more[0] = 0
        d.launch("bfs_expand", (nodes // 256,), (256,), firsts, edges, frontier, after, visited, distance, nodes)
        d.launch("bfs_advance", (nodes // 256,), (256,), frontier, after, visited, more, nodes)
        if not int(more[0]):
            return


def gaussian(d):
    size = 256
    matrix, right = d.floats(size * size, -1, 1), d.floats(size, -1, 1)
    matrix.reshape(size, size)[range(size), range(size)] += d.numpy.float32(size)
    values, multipliers, side = d.buffer(matrix), d.zeros(size), d.buffer(right)
    d.cold()
    for pivot in range(size - 1):
        rows = size - pivot - 1
        d.launch("gaussian_column", (groups_of(rows, 256),), (256,), values, multipliers, size, pivot)
        d.launch("gaussian_rows", (groups_of(rows + 1, 16), groups_of(rows, 16)), (16, 16), values, multipliers, side, size, pivot)


def hotspot(d):
    cells, steps = 512, 2
    cell = 0.016 / cells
    in_plane, capacity = 2 * 100 * 0.0005, 1.75e6 * 0.5 * 0.0005 * cell * cell
    step = 0.001 / (3e6 / (2 * 1.75e6 * 0.5 * 0.0005))
    before, heat, after = d.buffer(d.floats(cells * cells, 320, 340)), d.buffer(d.floats(cells * cells, 0, 0.01)), d.zeros(cells * cells)
    groups = groups_of(cells, 16 - 2 * steps)
    d.cold()
    d.launch("hotspot", (groups, groups), (16, 16), before, heat, after, cells, cells, steps, in_plane, in_plane, 100 * cell * cell / 0.0005, 80.0,
             step / capacity)


def nn(d):
    records = 42764
    numbers = d.words(2 * records) >> d.numpy.uint64(8)
    unit = numbers.astype("float32") * d.numpy.float32(2**-24)
    places = d.numpy.empty(2 * records, "float32")
    places[0::2], places[1::2] = 7 + 56 * unit[0::2], 358 * unit[1::2]
    buffer, distances = d.buffer(places), d.zeros(records)
    d.cold()
    d.launch("nn", (groups_of(records, 256),), (256,), buffer, distances, 30.0, 90.0, records)


def pathfinder(d):
    columns, rows, rows_a_launch = 100000, 100, 20
    wall = d.below(columns * rows, 10).astype("int32")
    cells, source, target = d.buffer(wall, "int32"), d.buffer(wall[:columns], "int32"), d.zeros(columns, "int32")
    d.cold()
    for row in range(1, rows, rows_a_launch):
        turns = min(rows_a_launch, rows - row)
        d.launch("pathfinder", (groups_of(columns, 256 - 2 * turns),), (256,), cells, source, target, columns, row, turns)
        source, target = target, source


def record():
    rows = []
    names = [path.stem for path in sorted(KERNELS.glob("*.ptx"))]
    for program in PROGRAMS:
        found = profile(names, METRICS, [sys.executable, __file__, "--launch", program], "--cache-control", "none")
        rows += [[program, i, kernel] + values for i, (kernel, values) in enumerate(found)]
    COUNTERS.parent.mkdir(exist_ok=True)
    with open(COUNTERS, "w") as out:
        csv.writer(out, lineterminator="\n").writerows([["program", "launch", "kernel"] + METRICS] + rows)


def simulate(glint, program, config):
    """Returns cycles and instructions of each launch in Glint."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([glint, "run", f"{program}-ptx", "--config", config, "--out", folder], check=True, capture_output=True)
        return [(row["kernel"], int(row["cycles"]), int(row["warp_instructions"])) for row in csv.DictReader(open(Path(folder) / "launches.csv"))]


def squared_correlation(pairs):
    return statistics.correlation(*zip(*[(math.log(a), math.log(b)) for a, b in pairs])) ** 2


def compare(glint, config, counters):
    hardware = {}
    for row in csv.DictReader(open(counters)):
        hardware.setdefault(row["program"], []).append((row["kernel"], int(row[METRICS[0]]), int(row[METRICS[1]])))
    print("| program | launches | cycles | hardware | error | mean error of a launch | instructions | hardware | error |\n|---|---|---|---|---|---|---|---|---|")
    launches, sums = [], []
    for program, card in hardware.items():
        mine = simulate(glint, program, config)
        if [kernel for kernel, *_ in mine] != [kernel for kernel, *_ in card]:
            sys.exit(f"error: {program} has {len(mine)} launches in Glint and {len(card)} in {counters}, or other kernels")
        pairs = [(a[1], b[1]) for a, b in zip(mine, card)]
        launches += pairs
        total = [sum(column) for column in zip(*[(a[1], b[1], a[2], b[2]) for a, b in zip(mine, card)])]
        sums.append(total[:2])
        error = statistics.mean(abs(a / b - 1) for a, b in pairs)
        print(f"| {program} | {len(pairs)} | {total[0]:,} | {total[1]:,} | {total[0] / total[1] - 1:+.1%} | {error:.1%} | {total[2]:,} | {total[3]:,} | "
              f"{total[2] / total[3] - 1:+.1%} |")
    print(f"\nMean absolute error of a program's cycles: {statistics.mean(abs(a / b - 1) for a, b in sums):.1%}, of a launch's "
          f"{statistics.mean(abs(a / b - 1) for a, b in launches):.1%}. R2 of logarithms: programs {squared_correlation(sums):.3f}, launches "
          f"{squared_correlation(launches):.3f}.")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--compare", metavar="GLINT", help="program that runs the simulation")
    parser.add_argument("--config", default="h100")
    parser.add_argument("--counters", type=Path, default=COUNTERS)
    parser.add_argument("--launch", choices=PROGRAMS, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.launch:
        globals()[options.launch](Device())
    elif options.compare:
        compare(options.compare, options.config, options.counters)
    else:
        record()


if __name__ == "__main__":
    main()

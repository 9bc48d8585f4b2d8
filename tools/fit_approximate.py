#!/usr/bin/python3
"""Fits the tables of the special-function unit (isa/approximate_tables.h) to recorded outputs of a GPU.

The unit evaluates C0 + C1 * x + C2 * square(x) in fixed point, where x are the mantissa bits below those that choose
the segment and square() keeps the partial products of weight 2^-15 and more. An output is the sum cut to 24 bits, so
each sample bounds the sum on both sides: a segment's coefficients are the integers that meet all its bounds. Where
the recordings are dense there is exactly one triple; tanh below 2^-4 has few samples, and the triple nearest to tanh
is taken of those that meet them all (marked in the output).

Usage: fit_approximate.py RECORDINGS > isa/approximate_tables.h, where RECORDINGS holds h200/mufu and ptx-golden.
Needs numpy and zstd.
"""
# SPDX-License-Identifier: Apache-2.0
import json
import lzma
import subprocess
import sys
from pathlib import Path

import numpy as np

BITS = 17  # bits of x; functions with fewer bits shift them up
ONE = 2.0**24  # all sums are in units of 2^-24
DENSE = {"rcp": (0x3F800000, 128), "rsqrt": (0x3F800000, 256), "sqrt": (0x3F800000, 256), "ex2": (0x3F800000, 128),
         "lg2": (0x3F800000, 128), "sin": (0x3F000000, 512), "cos": (0x3F000000, 512), "tanh": (0x3F000000, 512)}


def truncated_square():
    """Returns square(x) of all 17-bit x as multiples of 2^-15, from a folded squarer without the columns below."""
    x = np.arange(2**BITS)
    out = np.zeros_like(x)
    for j in range(10, BITS):
        out += ((x >> j) & 1) * (2 ** (2 * j - 19) + ((x & (2**j - 1)) >> (18 - j)))
    return out / 2.0**15


SQUARE = truncated_square()


class Recordings:
    def __init__(self, folder):
        self.mufu = Path(folder) / "h200/mufu"
        self.golden = Path(folder) / "ptx-golden"
        raw = self.unpacked(self.mufu / "mufu_dense.bin.zst")
        self.outputs = dict(zip(DENSE, np.frombuffer(raw, dtype=np.uint32).reshape(len(DENSE), -1)))

    @staticmethod
    def unpacked(path):
        return subprocess.run(["zstd", "-d", "--long=27", "-c", str(path)], check=True, capture_output=True).stdout

    def dense(self, name):
        first, step = DENSE[name]
        y = self.outputs[name]
        return (first + np.arange(len(y), dtype=np.uint32) * np.uint32(step)).astype(np.uint32), y

    def full(self, index, first, function):
        """Returns, for all 2^23 mantissas, the correctly rounded result and the recorded difference in ulp."""
        delta = np.frombuffer(lzma.open(self.mufu / f"mufu_delta_{index}.xz").read(), dtype=np.int8)
        x = (first + np.arange(2**23, dtype=np.uint32)).astype(np.uint32)
        y = function(x.view(np.float32).astype(np.float64)).astype(np.float32).view(np.int32) + delta
        return x, y.astype(np.uint32)

    def lanes(self, op):
        """Returns inputs and outputs of a unary f32 op without their signs."""
        form = next(o for o in json.loads((self.golden / "manifest.json").read_text())["ops"] if o["op"] == op)
        read = lambda name, where: np.frombuffer(self.unpacked(self.golden / name), dtype=np.uint32, count=2048,
                                                 offset=where["offset"])
        x, y = read("inputs.bin.zst", form["inputs"][0]), read("outputs.bin.zst", form["outputs"][0])
        return x & np.uint32(0x7FFFFFFF), y & np.uint32(0x7FFFFFFF)


def bounds(y, scale=ONE, resolution=0.0):
    """Returns the bounds low <= s < high of the sum s that gave output y. An output keeps 24 bits, and none below the resolution."""
    value = y.view(np.float32).astype(np.float64) * scale
    ulp = 2.0 ** ((y >> 23).astype(int) - 150) * scale
    return value, value + np.maximum(ulp, resolution)


def feasible(x, low, high, steps, reach=3):
    """Returns all (C1, C2) near the least-squares fit for which a C0 exists, with C0's bounds, widest first."""
    step1, step2 = steps
    t, s, weight = x / 2.0**BITS, SQUARE[x], 1 / (high - low)
    columns = np.c_[np.ones(len(t)), t, s]
    fit = np.linalg.lstsq(columns * weight[:, None], (low + high) / 2 * weight, rcond=None)[0]
    found = []
    for n2 in range(-reach, reach + 1):
        c2 = (round(fit[2] / step2) + n2) * step2
        for n1 in range(-reach, reach + 1):
            c1 = (round((fit[1] + fit[2] - c2) / step1) + n1) * step1
            rest = c1 * t + c2 * s
            least, most = (low - rest).max(), (high - rest).min()
            if least < most:
                found.append((most - least, least, most, c1, c2))
    return sorted(found, reverse=True)


def fit_table(name, segment, x, low, high, count, steps, grid, bias):
    """Returns the rows (C0, C1, C2) of a table. C0 = n * grid + bias, and the result has C0 without the bias."""
    rows = []
    for k in range(count):
        chosen = segment == k
        found = []
        for _, least, most, c1, c2 in feasible(x[chosen], low[chosen], high[chosen], steps):
            c0 = np.ceil((least - bias) / grid - 1e-9) * grid
            if least <= c0 + bias < most:
                found.append((c0, c1, c2))
        if len(found) != 1:
            sys.exit(f"{name} segment {k}: {len(found)} triples meet all samples")
        rows.append(found[0])
    return rows


def split(x, segment_bits):
    mantissa = (x & np.uint32(0x7FFFFF)).astype(np.int64)
    width = 23 - segment_bits
    return mantissa >> width, (mantissa & (2**width - 1)) << (BITS - width), mantissa


def mantissa_table(name, recorded, segment_bits, steps, grid, bias, scale=ONE, resolution=0.0, skip_zero=True):
    x, y = recorded
    segment, low_bits, mantissa = split(x, segment_bits)
    keep = (mantissa != 0) if skip_zero else mantissa >= 0
    low, high = bounds(y[keep], scale, resolution)
    return fit_table(name, segment[keep], low_bits[keep], low, high, 2**segment_bits, steps, grid, bias)


def octave(recorded, exponent):
    x, y = recorded
    keep = (x >> 23) == 127 + exponent
    return x[keep], y[keep]


def sine_table(recorded):
    x, y = recorded
    factor = float(np.array([0x3E22F983], dtype=np.uint32).view(np.float32)[0])  # 1 / (2 pi)
    product = x.view(np.float32).astype(np.float64) * factor  # exact: 48 bits
    product = (product.view(np.uint64) & np.uint64(0xFFFFFFFFE0000000)).view(np.float64)  # toward zero, to 24 bits
    turns = np.floor(product * 2.0**25).astype(np.int64) & (2**25 - 1)
    keep = turns < 2**23  # the first quarter; the others mirror it
    low, high = bounds(y[keep])
    return fit_table("sin", turns[keep] >> 17, turns[keep] & 0x1FFFF, low, high, 64, (16, 4), 0.5, 0)


# Each octave of tanh has: its exponent, log2 of its segments, steps of C1, C2 and C0.
TANH = [(-8, 0, 2, 1, 0.5), (-7, 0, 4, 2, 1), (-6, 0, 8, 4, 2), (-5, 1, 8, 4, 2), (-4, 1, 16, 8, 4), (-3, 2, 16, 4, 2),
        (-2, 2, 16, 8, 4), (-1, 2, 32, 16, 8), (0, 3, 16, 8, 4), (1, 4, 4, 2, 1), (2, 3, 16, 8, 4)]
LOOSE = -5  # the octaves up to this one have less than four samples per segment


def nearest_to_tanh(x, low, high, first, width, steps):
    """Returns the triple that meets the few samples and has the least worst distance from tanh."""
    step1, step2, grid = steps
    t = np.linspace(0, 1, 65)
    truth = np.tanh(first + t * width) * ONE
    fit = np.polyfit(t, truth, 2)
    found = []
    for c2 in (np.arange(-60, 61) + round(fit[0] / step2)) * step2:
        for c1 in (np.arange(-60, 61) + round((fit[1] + fit[0] - c2) / step1)) * step1:
            rest = c1 * (x / 2.0**BITS) + c2 * SQUARE[x]
            c0 = np.ceil((low - rest).max() / grid - 1e-9) * grid
            if (low - rest).max() <= c0 < (high - rest).min():
                found.append((abs(c0 + c1 * t + c2 * t * t - truth).max(), (c0, c1, c2)))
    return min(found)[1] if found else None


def tanh_table(dense, lanes):
    x, y = np.r_[dense[0], lanes[0]], np.r_[dense[1], lanes[1]]
    rows, loose = [], 0
    for exponent, segment_bits, step1, step2, grid in TANH:
        ox, oy = octave((x, y), exponent)
        segment, _, mantissa = split(ox, segment_bits)
        low_bits = ((mantissa << segment_bits) & 0x7FFFFF) >> 6  # the bits below these 17 are dropped
        low, high = bounds(oy)
        if exponent > LOOSE:
            rows += fit_table(f"tanh {exponent}", segment, low_bits, low, high, 2**segment_bits, (step1, step2), grid,
                              0)
            continue
        for k in range(2**segment_bits):
            q = segment == k
            width = 2.0 ** (exponent - segment_bits)
            row = nearest_to_tanh(low_bits[q], low[q], high[q], 2.0**exponent + k * width, width, (step1, step2, grid))
            if row is None:
                sys.exit(f"tanh {exponent} segment {k}: no triple meets all {q.sum()} samples")
            rows.append(row)
            loose += 1
    return rows, loose


def fitted(recordings):
    r = recordings
    full = [r.full(0, 0x3F800000, lambda v: 1 / v), r.full(1, 0x3F800000, lambda v: 1 / np.sqrt(v)),
            r.full(2, 0x40000000, lambda v: 1 / np.sqrt(v)), r.full(3, 0x3F800000, np.exp2)]
    below = -1 / 65536
    tables = {
        "rcp": mantissa_table("rcp", full[0], 7, (2, 1), 0.25, 2023 / 32768),
        "rsqrt": mantissa_table("rsqrt", full[1], 6, (2, 2), 0.25, below)
        + mantissa_table("rsqrt", full[2], 6, (2, 2), 0.25, below, skip_zero=False),
        "sqrt": mantissa_table("sqrt", octave(r.dense("sqrt"), 0), 6, (2, 1), 0.5, below)
        + mantissa_table("sqrt", octave(r.dense("sqrt"), 1), 6, (2, 1), 0.5, below),
        "ex2": mantissa_table("ex2", full[3], 6, (2, 1), 0.25, 6114 / 32768, scale=2.0**22, skip_zero=False),
        "lg2": mantissa_table("lg2", r.dense("lg2"), 6, (8, 2), 0.25, 1674 / 32768, resolution=2.0**-12),
        "sin": sine_table(r.dense("sin")),
    }
    tables["tanh"], loose = tanh_table(r.dense("tanh"), r.lanes("tanh.approx.f32"))
    return tables, loose


ABOUT = {
    "rcp": "1 / m, m in [1, 2): 7 bits choose the segment, sums in 2^-24",
    "rsqrt": "1 / sqrt(m), m in [1, 2), then [2, 4)",
    "sqrt": "sqrt(m), m in [1, 2), then [2, 4)",
    "ex2": "2^m, m in [0, 1), sums in 2^-23",
    "lg2": "log2(m), m in [1, 2)",
    "sin": "sin(m * pi / 2), m in [0, 1)",
    "tanh": "tanh(m): octaves from 2^-8 to 8 of 1, 1, 1, 2, 2, 4, 4, 4, 8, 16 and 8 segments",
}


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    tables, loose = fitted(Recordings(sys.argv[1]))
    print("// Holds the coefficients of the special-function unit, fitted to recorded outputs by tools/fit_approximate.py.")
    print("// SPDX-License-Identifier: Apache-2.0")
    print("//")
    print("// Each row is the only one that gives all recorded bits of its segment, except the first "
          f"{loose} rows of tanh.\n// There are few samples in their segments. Of all rows that give these samples, they are the nearest to tanh.")
    print("// clang-format off\n#pragma once\n#include <cstdint>\n\nnamespace glint::isa::GLINT_ISA_PATH {\n")
    print("// Holds one segment: C0 (without the function's bias) in quarters of the sum's unit, C1 and C2 in units.")
    print("struct Segment {\n  int32_t c0, c1, c2;\n};\n")
    for name, rows in tables.items():
        units = (4, 1, 1)
        values = np.array(rows) * units
        assert (values == np.round(values)).all() and abs(values).max() < 2**31
        print(f"// Segments of {ABOUT[name]}.")
        print(f"inline constexpr Segment k{name.capitalize()}Segments[{len(rows)}] = {{")
        cells = [f"{{{int(a)}, {int(b)}, {int(c)}}}" for a, b, c in values]
        for i in range(0, len(cells), 3):
            print("    " + ", ".join(cells[i:i + 3]) + ",")
        print("};\n")
    print("}  // namespace glint::isa::GLINT_ISA_PATH")


if __name__ == "__main__":
    main()

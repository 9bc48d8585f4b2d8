#!/usr/bin/env python3
# Cuts 32 lanes of every form out of a folder of GPU recordings, which is small enough for the repository.
# SPDX-License-Identifier: Apache-2.0
"""usage: make_golden_extract.py RECORDINGS OUT

RECORDINGS holds manifest.json, inputs.bin.zst and outputs.bin.zst. OUT gets forms.txt and lanes.bin.zst. forms.txt has a
line for each form: name, input types, output types, PTX text, separated by tabs. lanes.bin.zst has for each form its inputs,
then its outputs, of 32 lanes each. A form whose lanes read each other keeps a whole warp. For other forms 32 lanes are drawn,
which are the same each time.
"""
import json
import pathlib
import random
import subprocess
import sys

LANES = 32
WARP_WIDE = ("shfl", "vote", "match", "redux", "elect", "activemask", "lanemask", "red.", "bar.", "%laneid")


def unpack(path):
    return subprocess.run(["zstd", "-dc", "--long=27", str(path)], check=True, stdout=subprocess.PIPE).stdout


def main():
    source, out = (pathlib.Path(a) for a in sys.argv[1:3])
    manifest = json.loads((source / "manifest.json").read_text())
    sides = {"inputs": unpack(source / "inputs.bin.zst"), "outputs": unpack(source / "outputs.bin.zst")}
    lines, data = [], bytearray()
    for op in manifest["ops"]:
        draw = random.Random(op["op"])
        if any(word in op["ptx"] for word in WARP_WIDE):
            first = draw.randrange(manifest["lanes"] // LANES) * LANES
            lanes = range(first, first + LANES)
        else:
            lanes = sorted(draw.sample(range(manifest["lanes"]), LANES))
        for side, recorded in sides.items():
            for array in op[side]:
                size, offset = array["bytes"], array["offset"]
                for lane in lanes:
                    data += recorded[offset + lane * size : offset + (lane + 1) * size]
        types = [" ".join(a["type"] for a in op[side]) for side in sides]
        lines.append("\t".join([op["op"], *types, op["ptx"]]))
    out.mkdir(parents=True, exist_ok=True)
    head = "// Op, types of inputs, types of outputs, PTX text: of tools/make_golden_extract.py\n"
    (out / "forms.txt").write_text(head + "\n".join(lines) + "\n")
    raw = out / "lanes.bin"
    raw.write_bytes(data)
    subprocess.run(["zstd", "-19", "-q", "-f", "--rm", str(raw), "-o", str(raw) + ".zst"], check=True)


main()

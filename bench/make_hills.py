#!/usr/bin/env python3
# Writes a scene of any size, so that the time from a large file to the first cycle can be measured.
# SPDX-License-Identifier: Apache-2.0
"""bench/make_hills.py TRIANGLES FILE.glb

The file holds one mesh: hills over a square grid, with normals. 20 million triangles take 480 MB."""
import array
import json
import math
import pathlib
import struct
import sys


def heights(side: int) -> list[array.array]:
    """Returns the rows of heights. A height is a product of waves along both axes, so it costs no sine."""
    waves = [math.sin(60 * i / side) for i in range(side + 1)], [math.cos(46 * i / side) for i in range(side + 1)]
    return [array.array("f", [x * z for x in waves[0]]) for z in waves[1]]


def mesh(side: int) -> list[array.array]:
    """Returns positions, normals and indices."""
    xs = [20 * i / side - 10 for i in range(side + 1)]
    positions, normals, indices = array.array("f"), array.array("f", [0, 1, 0]) * (side + 1) ** 2, array.array("I")
    for z, row in zip(xs, heights(side)):
        flat = array.array("f", [z]) * (3 * (side + 1))
        flat[0::3], flat[1::3] = array.array("f", xs), row
        positions.extend(flat)
    for j in range(side):
        first = range(j * (side + 1), j * (side + 1) + side)
        quads = array.array("I", [0]) * (6 * side)
        for k, step in enumerate((0, side + 1, 1, 1, side + 1, side + 2)):
            quads[k::6] = array.array("I", [a + step for a in first])
        indices.extend(quads)
    return [positions, normals, indices]


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    arrays = mesh(max(1, math.isqrt(int(sys.argv[1]) // 2)))
    views, at = [], 0
    for values in arrays:
        views.append({"buffer": 0, "byteOffset": at, "byteLength": 4 * len(values)})
        at += 4 * len(values)
    count = len(arrays[0]) // 3
    accessors = [{"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3", "min": [-10, -1, -10], "max": [10, 1, 10]},
                 {"bufferView": 1, "componentType": 5126, "count": count, "type": "VEC3"},
                 {"bufferView": 2, "componentType": 5125, "count": len(arrays[2]), "type": "SCALAR"}]
    text = json.dumps({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                       "meshes": [{"name": "hills", "primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2}]}],
                       "buffers": [{"byteLength": at}], "bufferViews": views, "accessors": accessors}).encode()
    text += b" " * (-len(text) % 4)
    with pathlib.Path(sys.argv[2]).open("wb") as out:
        out.write(struct.pack("<3I2I", 0x46546C67, 2, 28 + len(text) + at, len(text), 0x4E4F534A) + text + struct.pack("<2I", at, 0x004E4942))
        for values in arrays:
            values.tofile(out)


if __name__ == "__main__":
    main()

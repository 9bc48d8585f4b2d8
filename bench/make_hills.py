#!/usr/bin/env python3
# Writes a scene of any size, so that the time from a large file to the first cycle can be measured.
# SPDX-License-Identifier: Apache-2.0
"""bench/make_hills.py TRIANGLES FILE.glb | FILE.obj

The file holds one mesh: hills over a square grid. A glTF file has normals, and an OBJ file has none. 20 million triangles
take 480 MB as glTF and 820 MB as OBJ."""
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


def write_obj(path: pathlib.Path, side: int) -> None:
    positions, _, indices = mesh(side)
    with path.open("w") as out:
        for i in range(0, len(positions), 3):
            out.write("v %.6f %.6f %.6f\n" % tuple(positions[i:i + 3]))
        for i in range(0, len(indices), 3):
            a, b, c = indices[i:i + 3]
            out.write(f"f {a + 1} {b + 1} {c + 1}\n")


def write_glb(path: pathlib.Path, side: int) -> None:
    arrays = mesh(side)
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
    with path.open("wb") as out:
        out.write(struct.pack("<3I2I", 0x46546C67, 2, 28 + len(text) + at, len(text), 0x4E4F534A) + text + struct.pack("<2I", at, 0x004E4942))
        for values in arrays:
            values.tofile(out)


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    side, path = max(1, math.isqrt(int(sys.argv[1]) // 2)), pathlib.Path(sys.argv[2])
    write_obj(path, side) if path.suffix == ".obj" else write_glb(path, side)


if __name__ == "__main__":
    main()

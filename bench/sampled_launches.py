#!/usr/bin/env python3
# Writes launch files of kernels and pipelines that are large enough to be sampled.
# SPDX-License-Identifier: Apache-2.0
"""`bench/sampled_launches.py FOLDER` writes NAME.toml for each launch of docs/sampling.md, and prints the paths:

    bench/sampling_table.py GLINT $(bench/sampled_launches.py /tmp/launches) --seeds 4
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]


def buffer(binding, kind, count, **more):
    """Returns a [[buffer]] of a pipeline file: random numbers, unless `more` says something else."""
    keys = {"name": f"b{binding}", "binding": binding, "type": kind, "count": count, **({"init": "random"} if not more else more)}
    return "[[buffer]]\n" + "".join(f"{name} = {repr(value) if not isinstance(value, str) else chr(34) + value + chr(34)}\n" for name, value in keys.items())


def compute(shader, groups, constants, *buffers, folder="shaders/compute"):
    """Returns the pipeline file of a compute shader of the suite, or of another folder."""
    push = "".join(f"{name} = {value}\n" for name, value in constants.items())
    return f'[compute]\nshader = "{ROOT}/{folder}/{shader}.comp"\n[launch]\ngroups = {groups}\n[push_constants]\n{push}' + "".join(buffers)


def kernel(name, grid, block, arguments):
    """Returns the launch file of a PTX kernel."""
    return f'kernel = "{ROOT}/shaders/{name}.ptx"\ngrid = {grid}\nblock = {block}\n' + "".join(f"[[argument]]\n{one}\n" for one in arguments)


def larger(example, **sizes):
    """Returns the file of an example with other sizes, and with paths that are whole."""
    folder = ROOT / "examples" / example
    text = (folder / "pipeline.toml").read_text()
    text = re.sub(r'^(shader|file|intersection|closest_hit|any_hit) = "', lambda found: f'{found[1]} = "{folder}/', text, flags=re.M)
    for key, value in sizes.items():
        text, count = re.subn(rf"^{key} = .*$", f"{key} = {value}", text, flags=re.M)
        assert count > 0, (example, key)
    return re.sub(r"^save = .*\n", "", text, flags=re.M)


def launches():
    """Returns the launch files by name."""
    cells, points = 1024 * 1024, 2097152
    saxpy = ['buffer = "x"\ntype = "f32"\ncount = 4194304\ninit = "iota"', 'buffer = "y"\ntype = "f32"\ncount = 4194304', "f32 = 2.0", "u32 = 4194304"]
    return {
        "saxpy": kernel("kernels/saxpy", [32768], [128], saxpy),
        "nn": compute("nn", [8192], {"latitude": 30.0, "longitude": 90.0, "records": 2097152}, buffer(0, "f32", 4194304), buffer(1, "f32", 2097152, init="zero")),
        "hotspot": compute("hotspot", [86, 86], {"width": 1024, "height": 1024, "steps": 2, "x_conductance": 0.1, "y_conductance": 0.1, "z_conductance": 0.001,
                           "ambient": 80.0, "step_over_capacity": 0.1}, buffer(0, "f32", cells), buffer(1, "f32", cells), buffer(2, "f32", cells, init="zero")),
        "srad_gradient": compute("srad_gradient", [64, 64], {"columns": 1024, "rows": 1024, "speckle": 0.5, "step": 0.5}, buffer(0, "f32", cells, init="random", low=1, high=2),
                                 *(buffer(i, "f32", cells, init="zero") for i in range(1, 6))),
        "kmeans": compute("kmeans", [8192], {"points": points, "features": 8, "clusters": 5}, buffer(0, "f32", 8 * points), buffer(1, "f32", 40), buffer(2, "s32", points, init="zero")),
        "pathfinder": compute("pathfinder", [4630], {"columns": 1000000, "first_row": 1, "rows": 20}, buffer(0, "s32", 21000000, init="random", low=0, high=9),
                              buffer(1, "s32", 1000000, init="random", low=0, high=9), buffer(2, "s32", 1000000, init="zero")),
        "product": compute("product", [64, 64], {"columns": 1024, "terms": 256}, buffer(0, "f32", 262144), buffer(1, "f32", 262144), buffer(2, "f32", cells, init="zero"), folder="bench/sampling"),
        "lookup": compute("lookup", [8192], {"entries": 524288}, buffer(0, "f32", 524288), buffer(1, "f32", cells, init="zero"), folder="bench/sampling"),
        "mandelbrot": larger("mandelbrot", groups=[64, 64], size=[512, 512]),
        "occlusion": larger("ambient_occlusion", groups=[64, 128], size=[512, 512]),
        "spheres": larger("spheres", size=[512, 512]),
        "cutout": larger("cutout", size=[512, 512]),
        "materials": larger("materials", size=[512, 512]),
    }


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in launches().items():
        path = folder / f"{name}.toml"
        path.write_text(text)
        print(path)


if __name__ == "__main__":
    main()

# Where the documentation's commands run: a copy of the tree in a temporary folder, with `glint` on the path.
# SPDX-License-Identifier: Apache-2.0
"""Fixtures are named here: what a page takes for granted, by page. What is run smaller than written is said by rule, and what is not run by name."""
import os
import pathlib
import shutil
import stat
import subprocess

# THE RULE OF REDUCTION, for `glint run` of scenes and `glint bench`; everything else runs as it is written.
SIZE, SAMPLES = "16x16", "1"
BENCH = ["WKND_PT", "SHIP_SH"]  # instead of more than two workloads
QUICK_SUITE = [f"{scene}_{shader}" for scene in ("WKND", "SHIP", "REF") for shader in ("PT", "SH", "AO")]
BENCH_OF = {f"docs/{name}.md": QUICK_SUITE for name in ("characterization", "modelling", "report")}  # pages whose commands need a suite to look at
SLOW_SCENES = {"PARK_PT": "PARTY_PT", "ROBOT_SH": "SHIP_SH"}  # scenes of millions of triangles, by one that stands in
KERNEL_ONLY = ["--only", "L1"]  # `glint microbench` without --only

# What is not run: it builds all of Glint, or is run by a test of its own. Its arguments are checked instead.
NOT_RUN = ("cmake", "ninja", "ctest", "sudo", "apt-get")

OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n"
GLTF = """{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"scene":0,"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}]}"""
# Commands before a page's own, in a shell of their own; files that all pages may name are made in `make`.
FIXTURES = {
    "docs/report.md": "glint run SHIP --shader sh --set rt.warps=8 --out out/ship8 && glint bench SHIP --out out/bench-mobile",
    "docs/python.md": "true",
    "docs/howto/cite.md": "glint run SHIP --shader sh --out out/ship",
    "docs/howto/policy.md": "true",  # the page's C++ block is compiled into a command of its own: docs_test.py
    "docs/characterization.md": "glint bench --config desktop --out out/bench-desktop",
    "docs/modelling.md": "glint run SHIP --shader sh --out out/ship",
    "docs/profiling.md": "glint run WKND --shader pt --profile --sample 1000 --out out",
}
WRAPPER = """#!/bin/sh
exec "{python}" -B "{here}/reduced.py" "{glint}" "$@"
"""
REFUSER = """#!/bin/sh
exec "{python}" -B "{here}/not_run.py" {name} "{root}" "{glint}" "$@"
"""


def make(root: pathlib.Path, glint: pathlib.Path, folder: pathlib.Path, python: str, page: str = "") -> dict[str, str]:
    """Fills `folder` as the project's root would look after ./demo; gives the environment of its commands."""
    for path in root.iterdir():
        if path.name not in ("build", "out", ".git", "configs", "shaders", "demo", "check"):
            (folder / path.name).symlink_to(path)
    for name in ("configs", "shaders"):  # pages may write beside these
        shutil.copytree(root / name, folder / name, symlinks=True)
    tools = folder / ".commands"
    tools.mkdir()
    here = pathlib.Path(__file__).parent
    _executable(tools / "glint", WRAPPER.format(python=python, here=here, glint=glint))
    for name in (*NOT_RUN, "demo", "check"):
        place = folder / name if name in ("demo", "check") else tools / name
        _executable(place, REFUSER.format(python=python, here=here, name=name, root=root, glint=glint))
    built = folder / "build/release/apps/glint"
    built.mkdir(parents=True)
    (built / "glint").symlink_to(tools / "glint")
    (folder / "out").mkdir()
    rows = [[f"W{i}", *((i * 37 + j * 101 + i * i * j) % 97 for j in range(10))] for i in range(12)]  # any table will do
    (folder / "mine.csv").write_text("\n".join(",".join(map(str, row)) for row in [["workload", *(f"m{j}" for j in range(10))], *rows]) + "\n")
    for path in (root / "examples/hello_triangle").glob("hello.r*"):
        shutil.copy(path, folder / "shaders")  # docs/pipelines.md: "shaders/*.r*"
    for name, text in {"teapot.obj": OBJ, "car.obj": OBJ, "car.gltf": GLTF}.items():
        (folder / name).write_text(text)
    subprocess.run([python, "-c", GLB, str(folder / "car.gltf"), str(folder / "car.glb")], check=True)
    return {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}", "PYTHONPATH": str(root / "python"), "GLINT": str(tools / "glint"),
            "PYTHONDONTWRITEBYTECODE": "1", "GLINT_DOCS_LOG": str(tools / "log"), "GLINT_DOCS_BENCH": " ".join(BENCH_OF.get(page, BENCH))}


# A binary glTF file from a text one.
GLB = """
import struct, sys
text = open(sys.argv[1], 'rb').read(); text += b' ' * (-len(text) % 4)
open(sys.argv[2], 'wb').write(struct.pack('<4sIIII', b'glTF', 2, 20 + len(text), len(text), 0x4E4F534A) + text)
"""


def _executable(path, text):
    path.write_text(text)
    path.chmod(path.stat().st_mode | stat.S_IXUSR | stat.S_IXGRP | stat.S_IXOTH)

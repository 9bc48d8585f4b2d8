# Makes the folder in which the documentation's commands run: a copy of the tree in a temporary folder, with `glint` on the path.
# SPDX-License-Identifier: Apache-2.0
"""This file lists the fixtures, which are what each page takes for granted. It gives the rule by which commands run smaller than written, and the names of commands that do not run."""
import os
import pathlib
import shutil
import stat
import subprocess

# THE RULE OF REDUCTION holds for `glint run` and `glint export` of scenes and for `glint bench`; `glint ablate` only plans. Everything else runs as it is written.
SIZE, SAMPLES = "16x16", "1"
BENCH = ["WKND_PT", "SHIP_SH"]  # run instead of a suite or of several workloads
QUICK_SUITE = [f"{scene}_{shader}" for scene in ("WKND", "SHIP", "BATH") for shader in ("PT", "SH", "AO")]
BENCH_OF = {f"docs/{name}.md": QUICK_SUITE for name in ("characterization", "modelling", "report")}  # these pages show results of a suite
SLOW_SCENES = {"PARK_PT": "BUNNY_PT", "ROBOT_SH": "SHIP_SH", "SPNZA": "SHIP", "BATH": "SHIP"}  # scenes of many triangles, with the scene that is run instead
KERNEL_ONLY = ["--only", "L1"]  # added to `glint microbench` without --only

NEEDS = {"docs/vulkan.md": ("vulkaninfo", "ffmpeg"), "docs/frames.md": ()}  # Where these are not installed, or the driver is not built, the page's commands do not run.

# These commands are not run: they build all of Glint, or have a test of their own. Their arguments are checked instead.
NOT_RUN = ("cmake", "ninja", "ctest", "sudo", "apt-get")

OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n"
GLTF = """{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"scene":0,"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}]}"""
# Commands that run before a page's own, in a shell of their own. make() writes the files that all pages may name.
FIXTURES = {
    "docs/report.md": "glint run SHIP --shader sh --set rt.warps=8 --out out/ship8 && glint bench SHIP --out out/bench-mobile",
    "docs/python.md": "true",
    "docs/howto/cite.md": "glint run SHIP --shader sh --out out/ship",
    "docs/howto/policy.md": "true",  # docs_test.py compiles the page's C++ block into a command of its own
    "docs/characterization.md": "glint bench --config desktop --out out/bench-desktop",
    "docs/modelling.md": "glint run SHIP --shader sh --out out/ship",
    "docs/profiling.md": "glint run WKND --shader pt --profile --sample 1000 --out out",
}
# With -S, python looks for no installed packages and starts sooner.
WRAPPER = """#!/bin/sh
exec "{python}" -B -S "{here}/reduced.py" "{glint}" "$@"
"""
REFUSER = """#!/bin/sh
exec "{python}" -B -S "{here}/not_run.py" {name} "{root}" "{glint}" "$@"
"""


def make(root: pathlib.Path, glint: pathlib.Path, folder: pathlib.Path, python: str, page: str = "") -> dict[str, str]:
    """Fills `folder` with what the project's root holds after ./demo, and returns the environment of the commands."""
    for path in root.iterdir():
        if path.name not in ("build", "out", ".git", "configs", "shaders", "demo", "check"):
            (folder / path.name).symlink_to(path)
    for name in ("configs", "shaders"):  # pages may write into these folders
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
    drawer = folder / "build/rt_frames/rt_frames"  # docs/frames.md builds it; the tests of the driver have built it
    drawer.parent.mkdir()
    drawer.symlink_to(glint.parent.parent.parent / "examples/rt_frames/rt_frames")
    (folder / "out").mkdir()
    rows = [[f"W{i}", *((i * 37 + j * 101 + i * i * j) % 97 for j in range(10))] for i in range(12)]  # the values do not matter
    (folder / "mine.csv").write_text("\n".join(",".join(map(str, row)) for row in [["workload", *(f"m{j}" for j in range(10))], *rows]) + "\n")
    for path in (root / "examples/hello_triangle").glob("hello.r*"):
        shutil.copy(path, folder / "shaders")  # docs/pipelines.md: "shaders/*.r*"
    for name, text in {"teapot.obj": OBJ, "car.obj": OBJ, "car.gltf": GLTF}.items():
        (folder / name).write_text(text)
    subprocess.run([python, "-c", GLB, str(folder / "car.gltf"), str(folder / "car.glb")], check=True)
    return {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}", "PYTHONPATH": str(root / "python"), "GLINT": str(tools / "glint"),
            "PYTHONDONTWRITEBYTECODE": "1", "GLINT_DOCS_LOG": str(tools / "log"), "GLINT_DOCS_BENCH": " ".join(BENCH_OF.get(page, BENCH))}


# This program makes a binary glTF file from a text one.
GLB = """
import struct, sys
text = open(sys.argv[1], 'rb').read(); text += b' ' * (-len(text) % 4)
open(sys.argv[2], 'wb').write(struct.pack('<4sIIII', b'glTF', 2, 20 + len(text), len(text), 0x4E4F534A) + text)
"""


def _executable(path, text):
    path.write_text(text)
    path.chmod(path.stat().st_mode | stat.S_IXUSR | stat.S_IXGRP | stat.S_IXOTH)

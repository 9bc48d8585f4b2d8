# Provides what tests of sweeps share: the command, a folder, a stand-in for the simulator, and what two stores must agree on.
# SPDX-License-Identifier: Apache-2.0
"""Scripts that use this module are called with GLINT SOURCE_DIR [SUITE...]."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest
import zipfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
import python_case  # noqa: E402
from python_case import GLINT, ROOT, SKIPPED, main, need  # noqa: E402,F401

os.environ["GLINT"] = str(GLINT)
os.environ["GLINT_PYTHON"] = sys.executable
TINY = {"workloads": ["WKND_SH"], "run": {"size": "8x8", "spp": 1}}

# It stands for the simulator: it lets the real one check points, and copies one finished run for each point.
STAND_IN = """#!/bin/sh
[ "$1" = run ] || exec {glint} "$@"
for word in "$@"; do case "$word" in --out=*) out="${{word#--out=}}" ;; esac; done
{before}
cp -r {run} "$out"
"""


class SweepTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        import glint.sweeps
        self.sweeps = glint.sweeps

    def write(self, text, name="sweep.toml"):
        path = self.folder / name
        path.write_text(text)
        return path

    def glint(self, *words, code=0):
        """Runs `glint sweep`, which must end with this exit code."""
        done = subprocess.run([GLINT, "sweep", *map(str, words)], capture_output=True, text=True, cwd=self.folder, timeout=280)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def start(self, *words, **variables):
        """Starts `glint sweep` in the background, with these variables of the environment."""
        child = subprocess.Popen([GLINT, "sweep", *map(str, words)], cwd=self.folder, env={**os.environ, **variables}, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.addCleanup(lambda: (child.kill(), child.wait(), child.stdout.close()))
        return child

    def stand_in(self, before="", name="stand_in"):
        """Returns a program that stands for the simulator. `before` are lines of shell that run first."""
        run = self.folder / "finished"
        if not run.exists():
            subprocess.run([GLINT, "run", "WKND_SH", "--size", "8x8", "--spp", "1", "--stats", "compact", "--out", run], check=True, capture_output=True)
        path = self.folder / name
        path.write_text(STAND_IN.format(glint=GLINT, run=run, before=before))
        path.chmod(0o755)
        return path

    def until(self, holds, seconds=120):
        """Waits until something holds, and fails when it never does."""
        end = time.monotonic() + seconds
        while not holds():
            self.assertLess(time.monotonic(), end, "it never came to hold")
            time.sleep(0.02)


def points_in(store):
    return sorted(path.parent.name for path in pathlib.Path(store).glob("points/*/*/point.json"))


def contents(store):
    """Returns by point what every run of it has to leave: all files but run.json, which has times and paths, and the metrics."""
    out = {}
    for id in points_in(store):
        place = pathlib.Path(store) / "points" / id[:3] / id
        with zipfile.ZipFile(place / "run.zip") as packed:
            files = {name: packed.read(name) for name in packed.namelist() if name != "run.json"}
        record = json.loads((place / "point.json").read_text())
        out[id] = (files, record["metrics"], record["set"], record["workload"])
    return out

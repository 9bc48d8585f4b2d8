# Provides what tests of the Python package share: an interpreter with the needed packages, the package from the tree, a small run.
# SPDX-License-Identifier: Apache-2.0
"""Scripts that use this module are called with GLINT SOURCE_DIR [SUITE...]."""
import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

GLINT, ROOT = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
SKIPPED = 77  # ctest shows it as skipped
SMALL = {"size": (16, 16), "spp": 1, "glint": GLINT}

os.environ["PYTHONPATH"] = str(ROOT / "python")
sys.path.insert(0, str(ROOT / "python"))
sys.dont_write_bytecode = True


def need(*modules):
    """Continues with the system's own Python when this one lacks a module, and prints a message when that one lacks it, too."""
    missing = [name for name in modules if importlib.util.find_spec(name) is None]
    if not missing:
        return
    system = "/usr/bin/python3"
    if os.environ.get("GLINT_TEST_PYTHON") != system and os.access(system, os.X_OK):
        os.environ["GLINT_TEST_PYTHON"] = system
        sys.stdout.flush()
        os.execv(system, [system, *sys.argv])
    print(f"SKIPPED: {pathlib.Path(sys.argv[0]).name}: no {', '.join(missing)} (Debian: apt-docs.txt names the packages)")
    sys.stdout.flush()
    os._exit(SKIPPED)  # within a test, sys.exit() would count as an error of the test


class PythonTest(unittest.TestCase):
    """Holds tests on runs that are made once per class: `ship`, with profile and series, and `wknd`."""

    @classmethod
    def setUpClass(cls):
        import glint
        cls.glint = glint
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.ship = glint.run("SHIP_SH", out=cls.folder / "ship", profile=True, sample=1000, **SMALL)
        cls.wknd = glint.run("WKND_PT", out=cls.folder / "wknd", **SMALL)

    def command(self, *words):
        """Returns what glint writes to stdout."""
        return subprocess.run([GLINT, *map(str, words)], capture_output=True, text=True, check=True).stdout


def main():
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])

# Shares with the tests of the Vulkan driver: the manifest, the environment of a program, and skipping.
# SPDX-License-Identifier: Apache-2.0
"""Scripts that use this module are called with MANIFEST SOURCE_DIR [arguments of their own]."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

MANIFEST, ROOT = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
SKIPPED = 77  # the exit code of a test that could not run


def need(program, package):
    """Ends the test as skipped, and says so, when a program is not installed."""
    if not shutil.which(program):
        print(f"SKIPPED: {program} is not installed (package {package})")
        sys.exit(SKIPPED)


def find_module(name):
    """Returns the folder of a module of npm, or None."""
    folder = os.environ.get("GLINT_NODE_MODULES", "")
    return pathlib.Path(folder, name).resolve() if folder and pathlib.Path(folder, name).is_dir() else None


def need_module(*names):
    """Returns the folders of modules of npm, or ends the test as skipped and says so when none of them is there."""
    found = [find_module(name) for name in names]
    if not any(found):
        print(f"SKIPPED: GLINT_NODE_MODULES names no folder with {' or '.join(names)} (npm install --force {names[0]})")
        sys.exit(SKIPPED)
    return found


class VulkanTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_on_glint(self, *command, **environment):
        """Runs a program whose only Vulkan device is Glint's."""
        known = {key: value for key, value in os.environ.items() if not key.startswith(("VK_", "DISPLAY"))}
        known |= {"VK_DRIVER_FILES": str(MANIFEST), "VK_ICD_FILENAMES": str(MANIFEST), "XDG_RUNTIME_DIR": str(self.folder)}
        return subprocess.run([str(word) for word in command], cwd=self.folder, env=known | environment, capture_output=True,
                              text=True, timeout=300)


def main():
    del sys.argv[1:]
    unittest.main(verbosity=2)

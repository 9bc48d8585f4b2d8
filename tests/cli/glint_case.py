# What all tests of the command share: the binary, a folder of one's own to run it in, and a look at what it says.
# SPDX-License-Identifier: Apache-2.0
"""For scripts that are called with GLINT SOURCE_DIR [SUITE...]."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

GLINT, ROOT = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()


class GlintTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, text):
        """Writes a file of the test's folder, and gives its name."""
        path = self.folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
        return name

    def glint(self, *arguments, text=True, **environment):
        """Runs glint in the test's folder; what it says comes as bytes with text=False."""
        return subprocess.run([GLINT, *map(str, arguments)], capture_output=True, text=text, cwd=self.folder, timeout=300,
                              env={**os.environ, **environment})

    def expect(self, code, parts, *arguments):
        """Runs glint; it must exit with `code` and say every one of `parts` on stderr."""
        done = self.glint(*arguments)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        for part in parts:
            self.assertIn(part, done.stderr)
        return done


def main():
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])

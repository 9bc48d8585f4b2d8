# Tests that the notebook runs from its first cell to its last with the command that it names, and has no stored outputs.
# SPDX-License-Identifier: Apache-2.0
"""usage: notebook_test.py GLINT SOURCE_DIR. The exit status is 77, with a message, when nbconvert or the packages for figures are not installed."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import python_case
from python_case import GLINT, ROOT

python_case.need("nbclient", "nbconvert", "ipykernel", "matplotlib", "numpy", "pandas")
NOTEBOOKS = sorted((ROOT / "examples/notebooks").glob("*.ipynb"))


def project_with(notebook, folder):
    """Makes the root of a project with the package and the notebook, in which only the pictures are smaller."""
    root = pathlib.Path(folder) / "project"
    there = root / notebook.relative_to(ROOT)
    there.parent.mkdir(parents=True)
    there.write_text(notebook.read_text().replace("size = (64, 64)", "size = (16, 16)"))
    shutil.copytree(ROOT / "python", root / "python")
    return root


class Notebooks(unittest.TestCase):
    def test_the_command_that_a_notebook_tells_runs_it_to_its_end_and_shows_its_figures(self):
        self.assertTrue(NOTEBOOKS)
        for path in NOTEBOOKS:
            cells = json.loads(path.read_text())["cells"]
            told = next(line.split() for line in "".join(cells[0]["source"]).splitlines() if line.startswith("    jupyter "))
            with self.subTest(notebook=path.name), tempfile.TemporaryDirectory() as folder:
                root = project_with(path, folder)
                environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
                environment |= {"GLINT": str(GLINT), "IPYTHONDIR": folder, "JUPYTER_RUNTIME_DIR": folder}
                done = subprocess.run([sys.executable, "-m", *told[1:]], cwd=root, env=environment, capture_output=True, text=True, timeout=240)
                self.assertEqual(done.returncode, 0, done.stderr[-3000:])
                page = (root / "out/notebook" / path.with_suffix(".html").name).read_text()
                figures = sum("glint.plot." in "".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")
                self.assertEqual(page.count('src="data:image/png'), figures)
                self.assertEqual(len(list(root.glob("out/notebook/sweep/*/run.json"))), 6)

    def test_notebooks_are_kept_without_outputs(self):
        for path in NOTEBOOKS:
            for cell in json.loads(path.read_text())["cells"]:
                if cell["cell_type"] == "code":
                    self.assertEqual((cell["outputs"], cell["execution_count"]), ([], None), path.name)


if __name__ == "__main__":
    python_case.main()

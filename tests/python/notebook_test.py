# The notebook runs from its first cell to its last, and is kept without outputs.
# SPDX-License-Identifier: Apache-2.0
"""usage: notebook_test.py GLINT SOURCE_DIR; exit status 77, said loudly, where nbclient and the packages of figures are not installed."""
import json
import os
import pathlib
import tempfile
import unittest

import python_case
from python_case import GLINT, ROOT

python_case.need("nbclient", "nbformat", "ipykernel", "matplotlib", "numpy", "pandas")
NOTEBOOKS = sorted((ROOT / "examples/notebooks").glob("*.ipynb"))


class Notebooks(unittest.TestCase):
    def test_every_notebook_runs_to_its_end_and_shows_its_figures(self):
        import nbclient
        import nbformat
        self.assertTrue(NOTEBOOKS)
        for path in NOTEBOOKS:
            with self.subTest(notebook=path.name), tempfile.TemporaryDirectory() as folder:
                os.environ["GLINT"] = str(GLINT)
                os.environ["IPYTHONDIR"] = os.environ["JUPYTER_RUNTIME_DIR"] = folder
                book = nbformat.read(path, as_version=4)
                for cell in book.cells:
                    cell.source = cell.source.replace("size = (64, 64)", "size = (16, 16)")  # the only thing that is reduced
                nbclient.NotebookClient(book, timeout=240, kernel_name="python3", resources={"metadata": {"path": folder}}).execute()
                pictures = sum("image/png" in output.get("data", {}) for cell in book.cells for output in cell.get("outputs", []))
                figures = sum("glint.plot." in cell.source for cell in book.cells if cell.cell_type == "code")
                self.assertEqual(pictures, figures)
                self.assertEqual(len(list(pathlib.Path(folder).glob("out/notebook/sweep/*/run.json"))), 6)

    def test_notebooks_are_kept_without_outputs(self):
        for path in NOTEBOOKS:
            for cell in json.loads(path.read_text())["cells"]:
                if cell["cell_type"] == "code":
                    self.assertEqual((cell["outputs"], cell["execution_count"]), ([], None), path.name)


if __name__ == "__main__":
    python_case.main()

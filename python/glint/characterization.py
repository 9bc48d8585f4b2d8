# Reads what `glint characterize` found about a suite: components, clusters, the chosen workloads and metrics.
# SPDX-License-Identifier: Apache-2.0
"""`Characterization(directory)` reads the tables of docs/characterization.md when they are asked for."""
from __future__ import annotations

import functools
import pathlib

from .documents import read_json
from .errors import MissingFile, SchemaError
from .file_list import ListedFiles
from .table import Table


class Characterization:
    """Holds the folder that `glint characterize` wrote, or a folder of `glint bench` with that folder in `characterization`.

    Raises MissingFile when the folder is neither.
    """

    def __init__(self, directory: str | pathlib.Path):
        self.directory = pathlib.Path(directory)
        if not (self.directory / "scores.csv").is_file() and (self.directory / "characterization/scores.csv").is_file():
            self.directory = self.directory / "characterization"
        if not (self.directory / "scores.csv").is_file():
            raise MissingFile(f"{self.directory}: there is no scores.csv; `glint characterize` writes it (docs/characterization.md)")
        record = self.directory / "characterization.json"
        listed = read_json(record).get("files") if record.is_file() else None
        self._files = ListedFiles(self.directory, "characterization.json", listed, "run `glint characterize` again")

    def table(self, name: str, *needs: str) -> Table:
        """Returns a table by its file's name without .csv. Raises MissingFile and SchemaError."""
        path = self.directory / f"{name}.csv"
        if not path.is_file():
            raise MissingFile(f"{self.directory}: there is no {name}.csv")
        self._files.check(path.name)
        return Table.read(path, needs=needs)

    @functools.cached_property
    def eigenvalues(self) -> Table:
        """Returns the table of eigenvalues, the largest first: component, eigenvalue, share of the variance, cumulative, kept (1 or 0)."""
        return self.table("eigenvalues", "component", "eigenvalue", "cumulative", "kept")

    @functools.cached_property
    def scores(self) -> Table:
        """Returns the coordinates of the workloads in the components that were kept."""
        return self.table("scores", "workload", "PC1")

    @functools.cached_property
    def linkage(self) -> list[list[float]]:
        """Returns SciPy's linkage matrix for `scipy.cluster.hierarchy`. Each row is a merger: both clusters, their distance, and the number of leaves."""
        rows = [list(row.values()) for row in self.table("linkage", "first", "second", "distance", "leaves")]
        if len(rows) != len(self.scores) - 1:
            raise SchemaError(f"{self.directory}: linkage.csv has {len(rows)} rows, but {len(self.scores)} workloads need {len(self.scores) - 1}")
        return rows

    @functools.cached_property
    def clusters(self) -> dict[str, int]:
        """Returns the cluster of each workload, in the order of the dendrogram's leaves."""
        leaves = self.table("leaves", "position", "workload", "cluster")
        return dict(zip(leaves["workload"], leaves["cluster"]))

    @functools.cached_property
    def subset(self) -> list[str]:
        """Returns the workloads that represent all workloads."""
        return self.table("subset", "workload")["workload"]

    @functools.cached_property
    def kiviat(self) -> Table:
        """Returns the chosen metrics of each workload, scaled so that the smallest value of all workloads is 0 and the largest is 1."""
        return self.table("kiviat", "workload")

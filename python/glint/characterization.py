# What `glint characterize` found about a suite: components, clusters, the chosen workloads and metrics.
# SPDX-License-Identifier: Apache-2.0
"""`Characterization(directory)`: the tables of docs/characterization.md, read when they are asked for."""
from __future__ import annotations

import functools
import pathlib

from .errors import MissingFile, SchemaError
from .table import Table


class Characterization:
    """The folder that `glint characterize` wrote, or a folder of `glint bench` with it in `characterization`.

    Raises MissingFile where the folder is neither.
    """

    def __init__(self, directory: str | pathlib.Path):
        self.directory = pathlib.Path(directory)
        if not (self.directory / "scores.csv").is_file() and (self.directory / "characterization/scores.csv").is_file():
            self.directory = self.directory / "characterization"
        if not (self.directory / "scores.csv").is_file():
            raise MissingFile(f"{self.directory}: no scores.csv: `glint characterize` writes it (docs/characterization.md)")

    def table(self, name: str, *needs: str) -> Table:
        """A table by its file's name without .csv; MissingFile, SchemaError."""
        path = self.directory / f"{name}.csv"
        if not path.is_file():
            raise MissingFile(f"{self.directory}: no {name}.csv")
        return Table.read(path, needs=needs)

    @functools.cached_property
    def eigenvalues(self) -> Table:
        """component, eigenvalue, share of the variance, cumulative, kept (1 or 0); the largest first."""
        return self.table("eigenvalues", "component", "eigenvalue", "cumulative", "kept")

    @functools.cached_property
    def scores(self) -> Table:
        """The workloads in the components that were kept."""
        return self.table("scores", "workload", "PC1")

    @functools.cached_property
    def linkage(self) -> list[list[float]]:
        """SciPy's linkage matrix: a row a merger with both clusters, their distance, and the leaves below; `scipy.cluster.hierarchy` takes it."""
        rows = [list(row.values()) for row in self.table("linkage", "first", "second", "distance", "leaves")]
        if len(rows) != len(self.scores) - 1:
            raise SchemaError(f"{self.directory}: linkage.csv has {len(rows)} rows, {len(self.scores) - 1} expected for {len(self.scores)} workloads")
        return rows

    @functools.cached_property
    def clusters(self) -> dict[str, int]:
        """The cluster of each workload, in the order of the dendrogram's leaves."""
        leaves = self.table("leaves", "position", "workload", "cluster")
        return dict(zip(leaves["workload"], leaves["cluster"]))

    @functools.cached_property
    def subset(self) -> list[str]:
        """The workloads that stand for all."""
        return self.table("subset", "workload")["workload"]

    @functools.cached_property
    def kiviat(self) -> Table:
        """The chosen metrics of each workload: 0 the least of all workloads, 1 the most."""
        return self.table("kiviat", "workload")

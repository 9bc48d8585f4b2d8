# Many runs: the folder of a `glint bench`, or of a sweep over configuration keys.
# SPDX-License-Identifier: Apache-2.0
"""`Bench(directory)` and `Sweep(directory)`: runs by name, and one table of them all."""
from __future__ import annotations

import functools
import json
import pathlib
import re
from collections.abc import Mapping
from typing import Any, Iterable, Iterator

from .errors import GlintError, MissingFile
from .derived import metrics
from .optional import require
from .run_directory import Run
from .table import Table


class Runs(Mapping[str, Run]):
    """The complete runs of a folder by name, in the order of the names (numbers in them by value).

    Attributes:
        directory: the folder.
        failed: runs that cannot be read, with the reason: nothing is left out silently.
    """

    def __init__(self, directory: str | pathlib.Path):
        self.directory = pathlib.Path(directory)
        self.failed: dict[str, str] = {}
        self._runs: dict[str, Run] = {}
        if not self.directory.is_dir():
            raise MissingFile(f"{self.directory}: there is no such folder")
        for record in sorted(self.directory.glob("**/run.json"), key=_natural):
            name = str(record.parent.relative_to(self.directory))
            try:
                self._runs[name] = Run(record.parent)
            except GlintError as error:
                self.failed[name] = str(error)
        if not self._runs and not self.failed:
            raise MissingFile(f"{self.directory}: holds no runs (folders with a run.json)")

    def __getitem__(self, name: str) -> Run:
        return self._runs[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._runs)

    def __len__(self) -> int:
        return len(self._runs)

    def __repr__(self) -> str:
        failed = f", {len(self.failed)} failed" if self.failed else ""
        return f"{type(self).__name__}('{self.directory}': {len(self)} runs{failed})"

    def point(self, name: str) -> dict[str, Any]:
        """What names a run in tables."""
        run = self[name]
        return {"run": name, "workload": run.workload, "config": run.config_name}

    def rows(self, columns: Iterable[str] | None = None) -> list[dict[str, Any]]:
        """A dictionary a run: what names it, then metrics (docs/metrics.md; all without `columns`) or statistics, summed."""
        names = list(columns) if columns is not None else list(metrics())
        return [{**self.point(name), **{column: _number(self[name], column) for column in names}} for name in self]

    def frame(self, columns: Iterable[str] | None = None) -> Any:
        """`rows()` as a pandas.DataFrame; MissingPackage without pandas."""
        return require("pandas", f"{type(self).__name__}.frame()").DataFrame(self.rows(columns))


class Bench(Runs):
    """The folder of a `glint bench`: a run a workload, and the table that it wrote."""

    @functools.cached_property
    def table(self) -> Table:
        """metrics.csv as `glint bench` wrote it."""
        path = self.directory / "metrics.csv"
        if not path.is_file():
            raise MissingFile(f"{self.directory}: no metrics.csv: no folder of `glint bench`, or a bench that was stopped")
        return Table.read(path, needs=("workload", "config", "cycles"))


class Sweep(Runs):
    """The folder of a `glint.sweep(...)`; `rows()` and `frame()` have a column for each key that was swept."""

    def __init__(self, directory: str | pathlib.Path):
        super().__init__(directory)
        self.axes: dict[str, list[Any]] = {}
        plan = self.directory / "sweep.json"
        if plan.is_file():
            self.axes = json.loads(plan.read_text(encoding="utf-8"))["axes"]

    def point(self, name: str) -> dict[str, Any]:
        run = self[name]
        return {**super().point(name), **{key: run.config.get(key) for key in self.axes if key != "config"}}


def _natural(path: pathlib.Path) -> list[Any]:
    """Sorts numbers in names by their value: rt.warps=4 before rt.warps=16."""
    return [(int(part), "") if part.isdigit() else (-1, part) for part in re.split(r"(\d+)", str(path))]


def _number(run: Run, name: str) -> Any:
    if name in metrics():
        return run.metrics[name]
    return run.stats.sum(name) if run.stats.has(name) else run.stats[name]

# Reads many runs: the folder of a `glint bench`, or of a sweep over configuration keys.
# SPDX-License-Identifier: Apache-2.0
"""`Bench(directory)` and `Sweep(directory)` hold runs by name, and one table of all runs."""
from __future__ import annotations

import functools
import pathlib
import re
from collections.abc import Mapping
from typing import Any, Iterable, Iterator

from .documents import read_json
from .errors import GlintError, MissingFile, SchemaError, UnknownName
from .derived import metrics
from .file_list import ListedFiles
from .optional import require
from .patterns import near
from .run_directory import Run
from .table import Table


class Runs(Mapping[str, Run]):
    """Holds the complete runs of a folder by name, sorted by name (numbers in names by value).

    Statistics and configuration of every run are read at once. A run in which one of them is incomplete is listed as failed.

    Attributes:
        directory: The folder.
        failed: The runs that cannot be read, with the reason. No run is left out silently.
    """

    def __init__(self, directory: str | pathlib.Path):
        self.directory = pathlib.Path(directory)
        self.failed: dict[str, str] = {}
        self._runs: dict[str, Run] = {}
        if not self.directory.is_dir():
            raise MissingFile(f"{self.directory}: there is no such folder")
        found = sorted(self.directory.glob("**/run.json"), key=_natural)
        for record in found:
            name = str(record.parent.relative_to(self.directory))
            if self._takes(name):
                self._read(name)
        if not found:
            raise MissingFile(f"{self.directory}: the folder holds no runs (folders with a run.json)")

    def _takes(self, name: str) -> bool:
        """Returns whether the run of this name is one of these runs. Here, all runs in the folder are."""
        return True

    def _read(self, name: str) -> None:
        try:
            run = Run(self.directory / name)
            run.check()
            self._runs[name] = run
        except GlintError as error:
            self.failed[name] = str(error)

    def __getitem__(self, name: str) -> Run:
        """Raises UnknownName (a KeyError) with near names, or with the reason why the run failed."""
        if name not in self._runs:
            reason = f"'{name}' cannot be read: {self.failed[name]}" if name in self.failed else f"there is no run '{name}'{near(name, self._runs)}"
            raise UnknownName(f"{self.directory}: {reason}")
        return self._runs[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._runs)

    def __len__(self) -> int:
        return len(self._runs)

    def __repr__(self) -> str:
        failed = f", {len(self.failed)} failed" if self.failed else ""
        return f"{type(self).__name__}('{self.directory}': {len(self)} runs{failed})"

    def point(self, name: str) -> dict[str, Any]:
        """Returns the columns that name a run in tables."""
        run = self[name]
        return {"run": name, "workload": run.workload, "config": run.config_name}

    def rows(self, columns: Iterable[str] | None = None) -> list[dict[str, Any]]:
        """Returns a dictionary for each run: its name, then metrics (docs/metrics.md) or sums of statistics. Without `columns`, all metrics are returned."""
        names = list(columns) if columns is not None else list(metrics())
        return [{**self.point(name), **{column: _number(self[name], column) for column in names}} for name in self]

    def frame(self, columns: Iterable[str] | None = None) -> Any:
        """Returns `rows()` as a pandas.DataFrame. Raises MissingPackage without pandas."""
        return require("pandas", f"{type(self).__name__}.frame()").DataFrame(self.rows(columns))


class Bench(Runs):
    """Holds the folder of a `glint bench`: a run for each workload, and the table that the bench wrote.

    Its runs are the workloads of the table. If the bench was stopped before it wrote a table, they are all runs in the folder.

    Attributes:
        others: The names of complete runs that are in the folder but not in the table.
    """

    def __init__(self, directory: str | pathlib.Path):
        super().__init__(directory)
        known = set(self.table["workload"]) if (self.directory / "metrics.csv").is_file() else set(self._runs)
        self.others: list[str] = [name for name in self._runs if name not in known]
        for name in self.others:
            del self._runs[name]
        for name in sorted(known - set(self._runs) - set(self.failed)):
            self.failed[name] = "metrics.csv lists the run, but its folder is missing"

    @functools.cached_property
    def table(self) -> Table:
        """Returns the table metrics.csv as `glint bench` wrote it."""
        path = self.directory / "metrics.csv"
        if not path.is_file():
            raise MissingFile(f"{self.directory}: there is no metrics.csv: this is no folder of `glint bench`, or the bench was stopped")
        record = self.directory / "bench.json"
        listed = read_json(record).get("files") if record.is_file() else None
        ListedFiles(self.directory, "bench.json", listed, "remove metrics.csv and run the bench again with --resume").check("metrics.csv")
        return Table.read(path, needs=("workload", "config", "cycles"))


class Sweep(Runs):
    """Holds the folder of a `glint.sweep(...)`. `rows()` and `frame()` have a column for each key that was swept.

    Its runs are the points of the last sweep into the folder, in their order.

    Attributes:
        axes: The swept values by key. They are {} for a folder without sweep.json, of which all runs are taken.
        others: The names of runs in the folder that belong to earlier sweeps.
    """

    def __init__(self, directory: str | pathlib.Path):
        self.axes: dict[str, list[Any]] = {}
        self.others: list[str] = []
        self._names: list[str] | None = None
        plan = pathlib.Path(directory) / "sweep.json"
        if plan.is_file():
            tree = read_json(plan)
            axes, names = tree.get("axes"), tree.get("runs")  # older files have no "runs"
            if not isinstance(axes, dict) or not all(isinstance(values, list) for values in axes.values()):
                raise SchemaError(f"{plan}: there are no axes: the file is damaged")
            if names is not None and not (isinstance(names, list) and all(isinstance(name, str) for name in names)):
                raise SchemaError(f"{plan}: 'runs' is not a list of names: the file is damaged")
            self.axes, self._names = axes, names
        super().__init__(directory)
        for name in self._names or []:
            if name not in self._runs and name not in self.failed:
                self.failed[name] = "this point has not been run: the sweep was stopped before"
        self._runs = {name: self._runs[name] for name in self._names or self._runs if name in self._runs}

    def _takes(self, name: str) -> bool:
        if self._names is None or name in self._names:
            return True
        self.others.append(name)
        return False

    def point(self, name: str) -> dict[str, Any]:
        run = self[name]
        return {**super().point(name), **{key: run.config.get(key) for key in self.axes if key != "config"}}


def _natural(path: pathlib.Path) -> list[Any]:
    """Returns a sort key that orders numbers in names by their value: rt.warps=4 comes before rt.warps=16."""
    return [(int(part), "") if part.isdigit() else (-1, part) for part in re.split(r"(\d+)", str(path))]


def _number(run: Run, name: str) -> Any:
    if name in metrics():
        return run.metrics[name]
    return run.stats.sum(name) if run.stats.has(name) else run.stats[name]

# Collects the results of a sweep: one row for each point, as CSV, Parquet and a page.
# SPDX-License-Identifier: Apache-2.0
"""`collect(sweep, store)` gives a `Collection`; `write(...)` leaves its files."""
from __future__ import annotations

import csv
import dataclasses
import io
import pathlib
from typing import Any, Mapping

from ..derived import metrics
from ..errors import SweepError
from ..optional import require
from ..patterns import near
from . import index
from .definition import Definition
from .folder import SweepFolder
from .planning import number_of
from .running import opened
from .sensitivity import Effect, effects, sobol
from .store import Store, write_whole

_NAMES = ("index", "id", "workload", "config", "seed")


@dataclasses.dataclass
class Collection:
    """Holds the results of a sweep.

    Attributes:
        rows: A row for each point that is done, in the order of the sweep: index, id, workload, config, seed, the keys that differ, then the metrics and, of sampled runs, the estimates.
        keys: The names of the keys that differ.
        failures: The records of points that failed.
        costs: For each different point what it took: seconds, bytes, host. These numbers differ from run to run, so no row has them.
        missing: How many points have not run yet.
    """
    definition: Definition
    store: str
    rows: list[dict[str, Any]]
    keys: list[str]
    failures: list[dict[str, Any]]
    costs: list[dict[str, Any]]
    missing: int
    damaged: list[str] = dataclasses.field(default_factory=list)  # ids of points whose record cannot be read

    def frame(self) -> Any:
        """Returns the rows as a pandas.DataFrame."""
        return require("pandas", "Collection.frame()").DataFrame(self.rows)

    @property
    def factors(self) -> list[str]:
        """Returns what differs between points: the keys, and workload, config and seed where there are several."""
        return [*self.keys, *(name for name in ("workload", "config", "seed") if len({row[name] for row in self.rows}) > 1)]

    def effects(self, metric: str) -> list[Effect]:
        """Returns what each factor does to a metric, with total Sobol indices for a sweep by the method "saltelli"."""
        if metric not in metrics():
            raise SweepError(f"there is no metric '{metric}'{near(metric, metrics())}")
        found = effects(self.rows, self.factors, metric)
        indices = self._saltelli(metric)
        for effect in found:
            if effect.key in indices:
                effect.share, effect.total = indices[effect.key]
                effect.interval = None
        return sorted(found, key=lambda effect: -effect.share)

    def _saltelli(self, metric: str) -> dict[str, tuple[float, float]]:
        """Returns indices by key, as means over workloads, configurations and seeds; or {} where the design is another one, or a point is missing."""
        design = self.definition.designs[0] if len(self.definition.designs) == 1 else {}
        if design.get("method") != "saltelli" or self.missing or self.failures or self.definition.constraints:
            return {}
        groups: dict[Any, list[float]] = {}
        for row in self.rows:
            groups.setdefault((row["workload"], row["config"]), []).append(row[metric])
        seeds = len(self.definition.seeds)
        found = [sobol(values[seed::seeds], self.keys) for values in groups.values() for seed in range(seeds) if all(isinstance(value, (int, float)) for value in values)]
        return {key: tuple(sum(one[key][i] for one in found) / len(found) for i in (0, 1)) for key in self.keys} if found else {}  # type: ignore[misc]


def collect(sweep: str | pathlib.Path | Mapping[str, Any] | Definition, store: str | pathlib.Path | None = None) -> Collection:
    """Returns what a sweep has found so far. `sweep` may also be the name of a sweep in the store."""
    kept_in, folder = opened(sweep, store)
    try:
        return _collected(kept_in, folder)
    finally:
        kept_in.close()


def _collected(store: Store, folder: SweepFolder) -> Collection:
    points = folder.points
    known = index.records(store, (point["id"] for point in points))
    keys = list(dict.fromkeys(key for point in points for key in point["set"]))
    keys = [key for key in keys if len({str(point["set"].get(key)) for point in points}) > 1]
    rows = []
    for point in points:
        if point["id"] not in known:
            continue
        settings = {key: number_of(point["resolved"].get(key, point["set"].get(key))) for key in keys}
        record = known[point["id"]]
        numbers = {name: record["metrics"].get(name) for name in metrics() if name in record["metrics"]}
        rows.append({**{name: point.get(name) for name in _NAMES}, **settings, **numbers, **{name: value for name, value in record["metrics"].items() if name not in numbers}})
    failures = [record for id in dict.fromkeys(point["id"] for point in points) if id not in known and (record := store.read_failure(id))]
    costs = [{"id": id, **{name: record["cost"].get(name) for name in ("seconds", "peak_bytes", "host", "when")}, "failed_attempts": len(record["cost"]["failed_attempts"])}
             for id, record in known.items()]
    others = {point["id"] for point in points} - set(known) - {record["id"] for record in failures}
    damaged = sorted(id for id in others if store.has(id))
    return Collection(folder.definition, str(store.folder), rows, keys, failures, costs, len(others) - len(damaged), damaged)


def csv_of(rows: list[dict[str, Any]]) -> str:
    """Returns rows as CSV. Values that are missing are empty cells."""
    out = io.StringIO()
    writer = csv.DictWriter(out, list(dict.fromkeys(name for row in rows for name in row)), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return out.getvalue()


def write(found: Collection, folder: str | pathlib.Path) -> list[pathlib.Path]:
    """Writes points.csv, costs.csv, failures.csv, effects.csv, and points.parquet where pyarrow is installed. Returns the files."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    failures = [{**{name: record.get(name) for name in ("id", "workload", "config", "seed", "kind", "message")}, "settings": " ".join(f"{key}={value}" for key, value in record["set"].items())}
                for record in found.failures]
    sensitivities = [{"metric": metric, "key": effect.key, "share": effect.share, "low": effect.interval[0] if effect.interval else None,
                      "high": effect.interval[1] if effect.interval else None, "total": effect.total, "span": effect.span}
                     for metric in (objective.split(":")[0] for objective in found.definition.objectives) for effect in found.effects(metric)]
    files = []
    for name, rows in (("points.csv", found.rows), ("costs.csv", found.costs), ("failures.csv", failures), ("effects.csv", sensitivities)):
        write_whole(folder / name, csv_of(rows))
        files.append(folder / name)
    try:
        arrow, parquet = require("pyarrow", "Parquet"), require("pyarrow.parquet", "Parquet")
    except ImportError:
        return files
    scratch = folder / ".points.parquet"
    parquet.write_table(arrow.Table.from_pylist(found.rows), scratch)
    scratch.replace(folder / "points.parquet")
    return [*files, folder / "points.parquet"]

# Makes what the report needs beside the runs: components and clusters, models, and the verdicts of the statements.
# SPDX-License-Identifier: Apache-2.0
"""`analyse(...)` calls `glint characterize` and `glint model` on the runs; `verdicts(...)` judges the statements on every machine and form of scenes."""
from __future__ import annotations

import csv
import dataclasses
import io
import json
import pathlib
from typing import Any, TextIO

from ..derived import metrics
from .plan import COMPUTE_MACHINES, DESKTOP_OF, JUDGED_MACHINES
from .running import Runs, ask
from .statements import Table, evaluate, flips, read_series

COMPUTE = "compute"  # in the column `form` of metrics.csv


@dataclasses.dataclass
class Findings:
    """Holds the analysis: folders with results by set, and what could not be made, with the reason."""

    folder: pathlib.Path
    missing: list[str]

    def characterization(self, name: str) -> dict[str, Any] | None:
        path = self.folder / name / "characterization.json"
        return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else None

    def models(self, name: str) -> list[dict[str, str]]:
        path = self.folder / name / "models.csv"
        return list(csv.DictReader(io.StringIO(path.read_text(encoding="utf-8")))) if path.is_file() else []


def common_metrics() -> list[str]:
    """Returns the metrics that have a meaning without rays: those of the GPU, which the table has before the first of the RT units'."""
    names = list(metrics())
    return names[:names.index("rt_insn")]


def joint_table(rays: pathlib.Path, programs: pathlib.Path) -> str:
    """Returns one table of both suites with the common metrics."""
    out = io.StringIO()
    columns = ["workload", *common_metrics()]
    table = csv.DictWriter(out, columns, extrasaction="ignore", lineterminator="\n")
    table.writeheader()
    for path in (rays, programs):
        with path.open(newline="", encoding="utf-8") as file:
            table.writerows(csv.DictReader(file))
    return out.getvalue()


def analyse(runs: Runs, glint: str, out: TextIO) -> Findings:
    found = Findings(runs.folder / "analysis", [])
    found.folder.mkdir(parents=True, exist_ok=True)

    def call(name: str, what: str, words: list[str]) -> None:
        print(f"analysis: {name} ({what})", file=out, flush=True)
        (found.folder / name).mkdir(parents=True, exist_ok=True)
        problem = ask([glint, *words], f"{what} of {name}")
        found.missing += [problem] if problem else []
    for one in runs.sets:
        table = runs.path(one.name) / "metrics.csv"
        if not table.is_file() or not one.name.startswith(("generated/", "files/", "compute/")):
            continue
        machine, place = one.name.split("/")[1], str(found.folder / one.name)
        if not one.name.startswith("compute/"):
            desktop = runs.path(one.name.replace(machine, DESKTOP_OF.get(machine, "none"))) / "metrics.csv"
            against = ["--against", str(desktop)] if desktop.is_file() else []
            call(one.name, "characterisation", ["characterize", str(table), "--out", place, *against])
        only = ["--statistics-only"] if machine not in ("mobile", "desktop") else []  # The interval model knows no other of these machines.
        assets = ["--assets", one.words[one.words.index("--assets") + 1]] if "--assets" in one.words else []
        call(one.name, "models", ["model", str(runs.path(one.name)), *only, *assets, "--out", f"{place}/models.csv"])
    for machine in COMPUTE_MACHINES:
        tables = [runs.path(f"{name}/{machine}") / "metrics.csv" for name in ("generated", "compute")]
        if all(table.is_file() for table in tables):
            table = found.folder / f"joint-{machine}.csv"
            table.write_text(joint_table(*tables), encoding="utf-8")
            call(f"joint/{machine}", "characterisation", ["characterize", str(table), "--out", str(found.folder / f"joint/{machine}")])
    return found


def _table(path: pathlib.Path) -> Table | None:
    return Table.read(path, stands_for_all=True) if path.is_file() else None


def verdicts(runs: Runs) -> dict[str, list[tuple[int, str, str, str]]]:
    """Returns the verdicts of every machine that has a desktop, by form and machine. A suite of fewer than 46 workloads stands for all."""
    out = {}
    for form in ("generated", "files"):
        for machine in JUDGED_MACHINES:
            table = _table(runs.path(f"{form}/{machine}") / "metrics.csv")
            if table is None:
                continue
            others: dict[str, Any] = {"desktop": _table(runs.path(f"{form}/{DESKTOP_OF[machine]}") / "metrics.csv")}
            if form == "generated":  # the other runs have generated scenes
                others |= {"large": _table(runs.path(f"large/{machine}") / "metrics.csv"), "bandwidth": _table(runs.path(f"bandwidth/{machine}-twice") / "metrics.csv"),
                           "bandwidth_base": _table(runs.path(f"bandwidth/{machine}") / "metrics.csv"), "series": series(runs, machine)}
            out[f"{machine}, {form}"] = evaluate(table, **{name: value for name, value in others.items() if value is not None})
    return out


def series(runs: Runs, machine: str) -> dict[str, list[dict[str, float]]]:
    """Returns the samples of the runs of Figure 6 by workload."""
    return {path.parent.name: read_series(path) for path in sorted(runs.path(f"series/{machine}").glob("*/series.csv"))}


def causes(runs: Runs) -> dict[str, list[str]]:
    """Returns for each statement the groups of the ablation that change its verdict: as a step, alone, or back."""
    folder = runs.path("ablation")
    if not (folder / "from/metrics.csv").is_file() or not (folder / "to/metrics.csv").is_file():
        return {}
    first, others = flips(folder)
    at_end = set(others.get("to", {}))
    out: dict[str, list[str]] = {}
    steps = sorted(name for name in others if name.startswith("step-"))
    for text in first:
        flipped, said = False, []
        for name in steps:
            now = text in others[name]
            if now != flipped:
                said.append(f"step {name[8:]} {'flips it' if now else 'flips it back'}")
            flipped = now
        if flipped != (text in at_end):
            said.append("the last step flips it" if text in at_end else "the last step flips it back")
        said += [f"{name[6:]} alone flips it" for name, changed in sorted(others.items()) if name.startswith("alone-") and text in changed]
        words = "without {} it does not flip" if text in at_end else "the second configuration without {} flips it"
        said += [words.format(name[8:]) for name, changed in sorted(others.items()) if name.startswith("without-") and (text in changed) != (text in at_end)]
        out[text] = said
    return out

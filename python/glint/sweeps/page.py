# Writes the page of a sweep: one file that a browser opens from disk, without a network.
# SPDX-License-Identifier: Apache-2.0
"""`page_of(collection, folder)` gives the page. Its script (page/page.js) draws, filters and sorts; the data are in the page."""
from __future__ import annotations

import html
import json
import os
import pathlib
from typing import Any

from ..derived import metrics
from ..errors import SweepError
from ..patterns import near
from .collecting import Collection
from .planning import title_of
from .sensitivity import pareto

_PARTS = pathlib.Path(__file__).with_name("page")
_MORE = ("ipc", "thread_ipc", "simt_efficiency", "rt_occupancy", "rt_efficiency")  # whose larger values are the better ones, unless the sweep says otherwise
_FAILURES = 200  # that the page lists
_SECOND = "dram_utilization"
_PAGE = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title>
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'">
<meta name="viewport" content="width=device-width"><style>{style}</style></head>
<body><main id="page"></main>
<script type="application/json" id="data">{data}</script>
<script>{script}</script></body></html>
"""


def objectives_of(texts: list[str]) -> list[tuple[str, bool]]:
    """Returns the objectives of a sweep ("cycles", "thread_ipc:max") and whether more is better. Raises SweepError for a name that is no metric."""
    out = []
    for text in texts:
        name, _, aim = text.partition(":")
        if name not in metrics() or aim not in ("", "min", "max"):
            raise SweepError(f"`objectives` has '{text}': an objective is a metric, and then :min or :max{near(name, metrics())}")
        out.append((name, aim == "max" if aim else name in _MORE))
    return out


def page_of(found: Collection, folder: str | pathlib.Path) -> str:
    """Returns the page. `folder` is where it will lie, from which links to the points' own pages lead into the store."""
    parts = {name: (_PARTS / f"page.{name}").read_text(encoding="utf-8") for name in ("js", "css")}
    data = json.dumps(_data(found, pathlib.Path(folder)), separators=(",", ":")).replace("</", "<\\/")
    return _PAGE.format(title=html.escape(f"Sweep {found.definition.name}"), style=parts["css"], data=data, script=parts["js"])


def _data(found: Collection, folder: pathlib.Path) -> dict[str, Any]:
    objectives = objectives_of(found.definition.objectives)
    names = [name for name in metrics() if any(row.get(name) is not None for row in found.rows)]
    columns = {name: _column([row.get(name) for row in found.rows]) for name in ("id", "workload", "config", "seed", *found.keys, *names)}
    axes = objectives if len(objectives) > 1 else [*objectives, *((name, False) for name in names if name != objectives[0][0] and name in (_SECOND, "dram_util", "ipc"))][:2]
    links = {}
    if found.definition.report:
        links = {"prefix": os.path.relpath(pathlib.Path(found.store) / "points", folder.resolve()), "file": "report.html"}
    return {
        "name": found.definition.name, "count": len(found.rows), "missing": found.missing, "store": found.store, "columns": columns, "factors": found.factors, "keys": found.keys,
        "metrics": {name: [metrics()[name].unit, metrics()[name].doc] for name in names}, "objectives": objectives, "axes": axes, "front": pareto(found.rows, axes), "links": links,
        "effects": {name: [[effect.key, _short(effect.share), [_short(value) for value in effect.interval or ()], _short(effect.total), _short(effect.span),
                            [[level, _short(mean), count] for level, mean, count in effect.levels]] for effect in found.effects(name)] for name, _ in objectives},
        "failures": [[record["id"], record["kind"], title_of(record), record["message"]] for record in found.failures[:_FAILURES]], "failed": len(found.failures)}


def _column(values: list[Any]) -> list[Any]:
    """Returns a column, or its one value in a list when all values are the same."""
    short = [_short(value) for value in values]
    return short[:1] if short and all(value == short[0] for value in short) else short


def _short(value: Any) -> Any:
    """Returns a number with the digits that a figure can show."""
    if not isinstance(value, float):
        return value
    return int(value) if value.is_integer() and abs(value) < 2**53 else float(f"{value:.7g}")

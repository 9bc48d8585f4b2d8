# Writes the report of `glint paper`: one page with an anchor for every table and figure of the paper.
# SPDX-License-Identifier: Apache-2.0
"""`page_of(...)` returns the page. figures.py makes what its sections show."""
from __future__ import annotations

import html
import itertools
from typing import Iterable

from .analysis import Findings, causes, verdicts
from .figures import SECTIONS, Scene
from .running import Runs

_STYLE = """body{font:14px/1.45 sans-serif;max-width:1100px;margin:1.5em auto;padding:0 1em;color:#222}h1{font-size:1.5em}h2{font-size:1.2em;border-top:1px solid #ddd;padding-top:.7em}
h3{font-size:1em;margin-bottom:.2em}table{border-collapse:collapse;font-size:12px}td,th{padding:2px 7px;border:1px solid #ddd;text-align:left;vertical-align:top}nav a{margin-right:.8em;white-space:nowrap}
.yes{background:#dff0d8}.no{background:#f6dcdc}.open{background:#eee}.scroll{overflow-x:auto}svg{max-width:none;font-family:sans-serif}details{margin:.3em 0}"""
_CLASS = {"holds": "yes", "does not hold": "no", "cannot be judged": "open"}


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """Returns a table of texts. A cell may begin with its class, "yes|", "no|" or "open|"."""
    def cell(text: str) -> str:
        kind, bar, rest = text.partition("|")
        marked = bar and kind in _CLASS.values()
        return f'<td class="{kind}">{html.escape(rest)}</td>' if marked else f"<td>{html.escape(text)}</td>"
    body = "".join(f"<tr>{''.join(map(cell, row))}</tr>" for row in rows)
    return f'<div class="scroll"><table><tr>{"".join(f"<th>{html.escape(name)}</th>" for name in head)}</tr>{body}</table></div>'


def statements_of(runs: Runs) -> str:
    judged, why = verdicts(runs), causes(runs)
    if not judged:
        return "<p>No machine has been run yet.</p>"
    columns = list(judged)
    counts = table(["", *_CLASS], ([name, *(str(sum(verdict == kind for _, _, verdict, _ in rows)) for kind in _CLASS)] for name, rows in judged.items()))
    rows, details = [], []
    for row in zip(*judged.values()):
        item, text = row[0][:2]
        cause = "; ".join(why.get(text, [])[:4]) or ("no step of the ablation changes it" if text in why else "")
        rows.append([str(item), text, *(f"{_CLASS[verdict]}|{verdict}" for _, _, verdict, _ in row), *([cause] if why else [])])
        figures = table(["machine, scenes", "figures"], ([name, said] for name, (_, _, _, said) in zip(columns, row)))
        more = "".join(f"<li>{html.escape(line)}</li>" for line in why.get(text, []))
        details.append(f"<details><summary>{item}: {html.escape(text)}</summary>{figures}<ul>{more}</ul></details>")
    head = ["item", "statement, with the bound that stands for its words", *columns, *(["cause, by ablation from mobile to vulkan-sim-mobile"] if why else [])]
    return counts + table(head, rows) + "<h3>Figures behind the verdicts</h3>" + "".join(details)


def page_of(runs: Runs, found: Findings, title: str) -> str:
    """Returns the page of what has been run so far. A section whose runs are missing says so."""
    scene = Scene(runs, found)
    parts = [("statements", "The paper's statements", statements_of(runs))]
    for anchor, name, make in SECTIONS:
        parts.append((anchor, name, make(scene) or "<p>Its runs are not there.</p>"))
    missing = "".join(f"<li>{html.escape(line)}</li>" for line in itertools.chain((f"{one.name} is not complete" for one in runs.sets if not runs.is_done(one)), found.missing))
    if missing:
        parts.insert(0, ("missing", "What is missing", f"<ul>{missing}</ul>"))
    links = "".join(f'<a href="#{anchor}">{html.escape(name)}</a>' for anchor, name, _ in parts)
    body = "".join(f'<h2 id="{anchor}">{html.escape(name)}</h2>{text}' for anchor, name, text in parts)
    return (f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{html.escape(title)}</title><meta name="viewport" content="width=device-width"><style>{_STYLE}</style></head>'
            f"<body><h1>{html.escape(title)}</h1><nav>{links}</nav>{body}</body></html>\n")

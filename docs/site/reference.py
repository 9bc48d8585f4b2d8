# Writes the reference pages from what the command itself tells: commands and options, policies, presets, keys, statistics, ops.
# SPDX-License-Identifier: Apache-2.0
"""Writes pages into the site's copy of docs/. Generated pages that are committed are written anew, so that they fit the command."""
import pathlib
import re
import subprocess
import tomllib
from typing import Any

import help_text
import policy_table


def _run(glint, *words):
    return subprocess.run([glint, *words], capture_output=True, text=True, check=True).stdout


def write(glint: str, root: pathlib.Path, source: pathlib.Path) -> None:
    """Writes all generated pages. `root` is the project, and `source` the site's copy of docs/."""
    import update_golden
    for name, text in update_golden.generated(glint):
        if name.startswith("docs/"):
            path = source / pathlib.Path(name).relative_to("docs")
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
    (source / "reference").mkdir(exist_ok=True)
    for name, text in {"commands": commands(glint), "policies": policies(glint), "presets": presets(glint, root), "python": python()}.items():
        (source / f"reference/{name}.md").write_text(text)
    _link_instructions(source)


def commands(glint: str) -> str:
    """Returns the page with every command's own help."""
    pages = help_text.read_all(glint)
    top = pages.pop("")
    out = ["# Commands\n\nThis page has what `glint COMMAND --help` prints. The page [errors](../errors.md) explains exit codes. A command writes the data that you asked for to stdout, and everything else to stderr.\n", _tables(top)]
    out += [f"## {name}\n\n{page.summary}.\n\n```text\n{page.usage}\n```\n\n{_tables(page)}" for name, page in pages.items()]
    return "\n".join(out)


def _tables(page: help_text.Help) -> str:
    """Returns the sections of a help text (Options, Positionals) as tables of what is written and what it means."""
    out = []
    for heading, entries in page.sections:
        out += [f"**{heading}:**\n"] if heading != "Options" else []
        out += ["| written | meaning |\n|---|---|"] + [f"| {_words(entry.written)} | {_cell(entry.meaning)} |" for entry in entries] + [""]
    return "\n".join(out)


def _words(name: str) -> str:
    """Returns `--option`, then what it takes."""
    option, _, takes = name.partition(" ")
    return f"`{option}`" + (f" {_cell(takes)}" if takes else "")


def _cell(text: str) -> str:
    return re.sub(r"([|<*_\[{])", r"\\\1", text)


def policies(glint: str) -> str:
    """Returns the page of what can be chosen by name, by key."""
    by_key: dict[str, list[tuple[str, str]]] = {}
    folders: dict[str, str] = {}
    for folder, key, name, doc in policy_table.listed(glint):
        by_key.setdefault(key, []).append((name, doc))
        folders[key] = folder
    text = ["# Policies\n\nA policy is a choice that the configuration makes by name. Each policy is one file of its folder; [this page](../howto/policy.md) shows how to add one. `glint list policies` prints all of them.\n"]
    for key, rows in by_key.items():
        title = f"`{key}`" if not key.startswith("(") else "Statistics files"
        text.append(f"## {title}\n\nFolder `{folders[key]}`.\n\n| name | what it does |\n|---|---|")
        text += [f"| `{name}` | {doc} |" for name, doc in rows] + [""]
    return "\n".join(text)


def presets(glint: str, root: pathlib.Path) -> str:
    """Returns the presets side by side, with every key in which two of them differ."""
    listed = [line.split(maxsplit=1) for line in _run(glint, "list", "configs").splitlines()]
    bases = {name: tomllib.loads((root / f"configs/{name}.toml").read_text()).get("base") for name, _ in listed}
    names = [name for name, base in bases.items() if not base]
    values = {name: _values(_run(glint, "describe", "--markdown", "--config", name)) for name in bases}
    differ = [key for key in values[names[0]] if len({values[name].get(key) for name in names}) > 1]
    text = [f"# Presets\n\nThe presets differ in {len(differ)} of {len(values[names[0]])} keys. The source of each number stands in the preset's file in `configs/`.\n", "| preset | what it is |\n|---|---|"]
    text += [f"| `{name}` | {doc} |" for name, doc in listed]
    text.append(f"\n| key | {' | '.join(names)} |\n|---|{'---|' * len(names)}")
    text += [f"| `{key}` | {' | '.join(values[name].get(key, '').replace('_', '_<wbr>') for name in names)} |" for key in differ]  # so that all columns fit
    text += ["\n## Presets with a base\n\nThese presets differ from their bases in the following keys.\n", "| preset | base | keys |\n|---|---|---|"]
    for name, base in bases.items():
        if base:
            changed = [f"`{key}` {value}" for key, value in values[name].items() if value != values[base].get(key)]
            text.append(f"| `{name}` | `{base}` | {', '.join(changed) or 'none; the file states those of the paper again'} |")
    return "\n".join(text) + "\n"


def _values(markdown: str) -> dict[str, str]:
    """Returns key and value of the rows of `glint describe --markdown`."""
    rows = (line.split("|") for line in markdown.splitlines() if line.startswith("| `"))
    return {row[1].strip(" `"): row[2].strip() for row in rows}


# Lists the public names of the package by section. A name of __all__ that no section has ends the build.
_PYTHON = {
    "Runs": ("Run", "Facts", "labels"), "Statistics": ("Stats", "Stat", "Histogram"), "Metrics": ("metrics", "Metric", "Metrics"), "Tables": ("Table",), "Traces": ("Trace", "Slice"),
    "Folders of runs": ("Runs", "Bench", "Sweep"), "Comparison": ("compare", "Change", "speedup"), "Characterisation": ("Characterization",),
    "Starting runs": ("run", "sweep", "find_glint"), "Pictures": ("read_image",),
    "Errors": ("GlintError", "MissingFile", "IncompleteRun", "SchemaError", "UnknownName", "MissingPackage", "CommandFailed")}


def python() -> str:
    """Returns the page of the Python package, from its docstrings, by the names that users write."""
    import glint
    left = set(glint.__all__) - {"plot"} - {name for names in _PYTHON.values() for name in names}
    if left:
        raise SystemExit(f"error: docs/site/reference.py has no section for glint's {', '.join(sorted(left))}")
    text = ["# Python package\n\nThis page is generated from the package. Read the [guide](../python.md) first.\n"]
    text += [f"## {title}\n\n" + "".join(_documented(glint, "glint", name) for name in names) for title, names in _PYTHON.items()]
    figures = sorted(glint.plot.__all__, key=lambda name: (name != "save", name.isupper(), name))
    return "\n".join(text) + f"\n## Figures\n\n{glint.plot.__doc__}\n" + "".join(_documented(glint.plot, "glint.plot", name) for name in figures)


def _documented(module: Any, path: str, name: str) -> str:
    thing = getattr(module, name)
    if name.isupper():
        shown = ", ".join(f"`{key}`" for key in thing) if isinstance(thing, dict) else f"{thing} inches"
        return f"`{path}.{name}`: {shown}.\n\n"
    kind = "autoclass" if isinstance(thing, type) else "autofunction"
    members = "   :members:\n   :undoc-members:\n" if kind == "autoclass" and not issubclass(thing, Exception) else ""
    return f"```{{eval-rst}}\n.. {kind}:: {path}.{name}\n{members}```\n\n"


def _link_instructions(source: pathlib.Path) -> None:
    """Links the tables of ops by preset, which are files to load and not pages."""
    names = sorted(path.name for path in (source / "instructions").glob("*.csv"))
    if names:
        with open(source / "isa.md", "a", encoding="utf-8") as page:
            page.write("\n## Times by preset\n\nThese CSV files have unit, latency and interval of every op: " + ", ".join(f"{{download}}`{name} <instructions/{name}>`" for name in names) + ".\n")

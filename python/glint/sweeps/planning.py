# Makes the points of a sweep: checks all of them before the first runs, and names each by what it depends on.
# SPDX-License-Identifier: Apache-2.0
"""`plan(definition, program)` gives the points, each of which has the id of its contents."""
from __future__ import annotations

import concurrent.futures
import hashlib
import itertools
import json
import os
import pathlib
from typing import Any, Callable, Iterable

from ..errors import SweepError
from ..fingerprint import file_hash, files_of
from .constraints import Constraint
from .definition import Definition
from .program import Program, ask

SCHEMA = 1  # of a point; another one gives other ids
_SHOWN = 10  # points that a message names
_SLICE = 500  # points that one process checks at a time


def plan(definition: Definition, program: Program) -> list[dict[str, Any]]:
    """Returns the points of a sweep in order. Raises SweepError, which names every kind of wrong point, before anything runs.

    A point has `index`, `id`, `workload`, `config`, `set` (texts by key), `seed`, `options`, `design`, and the estimates `memory` (bytes) and `weight`.
    """
    try:
        raw = _raw(definition, program)
    except SweepError as error:
        raise SweepError(definition.told(str(error))) from error
    kept = _within_constraints(definition, program, raw)
    if not kept:
        raise SweepError(definition.told(f"the sweep has no points: its `constraints` leave none of {len(raw)}; widen them, or sweep other values"))
    asked = [{"workload": one["workload"], "config": one["config"], "settings": [f"{key}={value}" for key, value in one["set"].items()], "oracles": definition.oracles,
              "options": [*one["options"], f"--threads={definition.threads}"], "keys": list(one["set"])} for one in kept]
    answers = _answers(program, asked)
    if wrong := refusal([title_of(one) for one in kept], answers, lambda message: f"{definition.places.of(message)}: " if definition.places else ""):
        raise SweepError(wrong)
    names = _Contents(program)
    points = []
    for index, (one, answer) in enumerate(zip(kept, answers)):
        identity = [SCHEMA, names.program, names.assets, names.workload(one["workload"]), answer["config"], names.options(one["options"]), one["seed"], definition.stats, definition.report]
        made = {"index": index, "id": hashlib.sha256(json.dumps(identity).encode()).hexdigest()[:32], **one, "resolved": answer.get("keys") or {}, "memory": answer["memory"],
                "weight": answer["weight"]}
        points.append(made)
    return points


def _raw(definition: Definition, program: Program) -> list[dict[str, Any]]:
    """Returns workloads x configurations x points of designs x seeds. The points of a design stay together, because samples are read as a whole."""
    found = []
    chosen = definition.settings_of_points()
    for workload, config, (design, settings), seed in itertools.product(definition.workloads, definition.configs, chosen, definition.seeds):
        takes_seed = _takes_seed(workload, program)
        if not takes_seed and seed != definition.seeds[0]:
            continue  # Only scenes have a seed.
        options = sorted([*definition.options, *([f"--seed={seed}"] if takes_seed else [])])
        texts = {key: text_of(key, value) for key, value in settings.items()}
        found.append({"workload": workload, "config": config, "set": texts, "seed": seed if takes_seed else None, "options": options, "design": design, "values": settings})
    return found


def _takes_seed(workload: str, program: Program) -> bool:
    return workload not in program.facts["programs"] and pathlib.PurePath(workload).suffix.lower() in ("", ".obj", ".gltf", ".glb")


def text_of(key: str, value: Any) -> str:
    """Returns a value as `--set` takes it."""
    value = value.item() if hasattr(value, "item") else value
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(json.dumps(one) if isinstance(one, str) else text_of(key, one) for one in value) + "]"
    if isinstance(value, (str, int, float)):
        return str(value)
    raise SweepError(f"'{key}' is {value!r}: a number, a text, true or false is needed")


def _within_constraints(definition: Definition, program: Program, raw: list[dict[str, Any]]) -> list[dict[str, Any]]:
    if not definition.constraints:
        return raw
    constraints = [Constraint(text) for text in definition.constraints]
    asked = [{"workload": definition.workloads[0], "config": config, "oracles": definition.oracles, "all_keys": True} for config in definition.configs]
    answers = ask(program.path, asked)[1:]
    for config, answer in zip(definition.configs, answers):
        if "error" in answer:
            raise SweepError(definition.told(f"config '{config}': {answer['error']}"))
    bases = {config: {key: number_of(text) for key, text in answer["keys"].items()} for config, answer in zip(definition.configs, answers)}
    kept = []
    for one in raw:
        values = {**bases[one["config"]], **one["values"], "workload": one["workload"], "config": one["config"], "seed": one["seed"]}
        try:
            if all(constraint.holds(values) for constraint in constraints):
                kept.append(one)
        except SweepError as error:
            raise SweepError(definition.told(str(error))) from error
    return kept


def number_of(text: Any) -> Any:
    """Returns the number, truth or text that the text of a value stands for."""
    if not isinstance(text, str):
        return text
    if text in ("true", "false"):
        return text == "true"
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text.strip('"')


def _answers(program: Program, asked: list[dict[str, Any]]) -> list[dict[str, Any]]:
    slices = [asked[i:i + _SLICE] for i in range(0, len(asked), _SLICE)]
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        return [answer for part in pool.map(lambda one: ask(program.path, one)[1:], slices) for answer in part]


def refusal(titles: list[str], answers: Iterable[dict[str, Any]], place_of: Callable[[str], str] = lambda message: "") -> str:
    """Returns what is wrong with points, each of which has a title and an answer of the program, or an empty text. `place_of` gives the place of a message."""
    wrong: dict[str, list[str]] = {}
    for title, answer in zip(titles, answers):
        if "error" in answer:
            wrong.setdefault(answer["error"], []).append(title)
    if not wrong:
        return ""
    count = sum(map(len, wrong.values()))
    lines = [f"{count} of {len(titles)} points are wrong, so nothing was run:"]
    for message, some in list(wrong.items())[:_SHOWN]:
        more = f" (and {len(some) - 1} more)" if len(some) > 1 else ""
        lines += [f"  {place_of(message)}{some[0]}{more}", *(f"    {line}" for line in message.splitlines())]
    if len(wrong) > _SHOWN:
        lines.append(f"  ... and {len(wrong) - _SHOWN} other messages")
    return "\n".join(lines)


def title_of(point: dict[str, Any]) -> str:
    """Returns a point in words: workload, configuration, settings, seed."""
    settings = " ".join(f"{key}={value}" for key, value in point["set"].items())
    seed = f" seed={point['seed']}" if point.get("seed") not in (None, 1) else ""
    return f"{pathlib.PurePath(point['workload']).name} on {pathlib.PurePath(point['config']).name}{' ' if settings else ''}{settings}{seed}"


class _Contents:
    """Names files by their contents. Each is read once."""

    def __init__(self, program: Program):
        self.program = [program.hash, program.facts["shaders"], program.facts["plugins"]]
        self._known: dict[str, Any] = {}
        self.assets = self._contents(os.environ["GLINT_ASSETS"]) if os.environ.get("GLINT_ASSETS") else None

    def workload(self, name: str) -> Any:
        return self._known.setdefault(name, self._contents(name) or name)

    def options(self, words: list[str]) -> list[Any]:
        out = []
        for word in words:
            option, _, value = word.partition("=")
            if word not in self._known:
                found = self._contents(value) if value else None
                self._known[word] = [option, found] if found else word
            out.append(self._known[word])
        return out

    def _contents(self, name: str) -> Any:
        path = pathlib.Path(name)
        if path.is_dir():
            return [[str(one.relative_to(path)), file_hash(one)] for one in sorted(path.rglob("*")) if one.is_file()]
        return [[one.name, file_hash(one)] for one in files_of(path)] if path.is_file() else None

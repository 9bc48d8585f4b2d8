# Makes short names of runs from what differs between them, with no more words than needed.
# SPDX-License-Identifier: Apache-2.0
"""`labels(runs)` returns names; `named(runs)` also returns the two halves of a label: what ran, and what it ran on."""
from __future__ import annotations

import dataclasses
import pathlib
from typing import Any, Callable, Hashable, Sequence

from .run_directory import Run

BETWEEN = " · "  # separates the words of a label
_KEYS = 2  # keys shown if runs differ in more; more are shown only if fewer would not tell runs apart
_RAYS = {"rays.bounces": "bounces", "rays.shadow_rays": "shadow rays", "rays.ao_rays": "AO rays", "rays.ao_reach": "AO reach", "seed": "seed"}
_CROP = ("crop.x", "crop.y", "crop.frame_width", "crop.frame_height")


@dataclasses.dataclass(frozen=True)
class Named:
    """Holds the names of a run among other runs.

    Attributes:
        label: Tells the run from all others.
        task: Says what ran: the workload, and size, samples and seed where runs differ in them. Runs of the same work have the same task.
        config: Says what it ran on: preset or file, and changed keys. Each run of one task has its own.
    """
    label: str
    task: str
    config: str


def labels(runs: Sequence[Run]) -> list[str]:
    """Returns short names made from what differs between the runs, or from their directories when nothing differs."""
    return [one.label for one in named(runs)]


def named(runs: Sequence[Run]) -> list[Named]:
    """Returns label, task and configuration of each run."""
    runs = list(runs)
    keys = _changed_keys(runs)
    shown = _telling_apart(runs, keys)
    facts = _facts(runs)
    many_workloads, many_presets = len(runs) == 1 or _differ(runs, lambda run: run.workload), _differ(runs, lambda run: run.config_name)
    tasks = [BETWEEN.join([run.workload, *words]) for run, words in zip(runs, facts)]
    tasks = _numbered(tasks, [_work(run) for run in runs])
    changes = [[f"{key}={_text(run.config[key])}" for key in shown if key in keys[i]] for i, run in enumerate(runs)]
    configs = [BETWEEN.join([run.config_name, *words]) for run, words in zip(runs, changes)]
    configs = _repeats(configs, tasks)
    found = [BETWEEN.join(([run.workload] if many_workloads else []) + ([run.config_name] if many_presets else []) + words + changed) or run.workload
             for run, words, changed in zip(runs, facts, changes)]
    return [Named(*one) for one in zip(_repeats(_with_directories(found, runs), [""] * len(runs)), tasks, configs)]


def _text(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _differ(runs: Sequence[Run], of: Callable[[Run], Hashable]) -> bool:
    return len({of(run) for run in runs}) > 1


def _work(run: Run) -> tuple[Any, ...]:
    """Returns the facts that tell the work of two runs apart, whatever it ran on."""
    return tuple(str(run.info.get(name)) for name in ("scene.name", "scene.form", "scene.hash", "shader", "width", "height", *_CROP, "samples", *_RAYS))


def _facts(runs: Sequence[Run]) -> list[list[str]]:
    """Returns for each run size, samples and similar facts where runs differ in them, and the shader where the workload does not name it."""
    texts: list[Callable[[Run], str]] = [
        lambda run: f"{run.info['width']}x{run.info['height']}" if run.info.get("width") else "",
        lambda run: "at {},{} of {}x{}".format(*(run.info.get(name, 0) for name in _CROP)) if run.info.get("crop.frame_width") else "",
        lambda run: f"{run.info['samples']} spp" if run.info.get("samples") else ""]
    for name, word in _RAYS.items():
        texts.append(lambda run, name=name, word=word: f"{word} {run.info[name]}" if name in run.info else "")  # type: ignore[misc]
    used = [text for text in texts if len({text(run) for run in runs} - {""}) > 1]
    shaders: dict[str, set[str]] = {}
    for run in runs:
        shaders.setdefault(run.workload, set()).add(str(run.info.get("shader", "")))
    return [([str(run.info.get("shader", "")).split(" ")[0]] if len(shaders[run.workload]) > 1 else []) + [text(run) for text in used if text(run)] for run in runs]


def _changed_keys(runs: Sequence[Run]) -> list[list[str]]:
    """Returns for each run the keys that its label may show: those set on its command line, and those that differ from a run of the same preset or file."""
    names = list(dict.fromkeys([key for run in runs for key in _set(run)] + [key for run in runs for key in run.config]))
    values = {key: [_text(run.config.get(key)) for run in runs] for key in names}
    differing = [key for key in names if len(set(values[key])) > 1]
    within: dict[str, set[str]] = {}
    for name in {run.config_name for run in runs}:
        of = [i for i, run in enumerate(runs) if run.config_name == name]
        within[name] = {key for key in differing if len({values[key][i] for i in of}) > 1}
    return [[key for key in differing if key in run.config and (key in within[run.config_name] or key in _set(run))] for run in runs]


def _set(run: Run) -> list[str]:
    """Returns the keys that the command line of a run set."""
    words = run.info.get("command", [])
    words = words if isinstance(words, list) else []
    pairs = [word for option, word in zip(words, words[1:]) if option == "--set"] + [word.removeprefix("--set=") for word in words if str(word).startswith("--set=")]
    return [str(pair).partition("=")[0] for pair in pairs if "=" in str(pair)]


def _telling_apart(runs: Sequence[Run], keys: list[list[str]]) -> list[str]:
    """Returns as many keys as are needed to tell configurations apart as well as all keys do, and at least two if there are two."""
    shown: list[str] = []
    every = list(dict.fromkeys(key for own in keys for key in own))

    def apart(some: list[str]) -> int:
        return len({(run.config_name, *(_text(run.config[key]) if key in own else "" for key in some)) for run, own in zip(runs, keys)})

    for key in every:
        if apart([*shown, key]) > apart(shown):
            shown.append(key)
    shown += [key for key in every if key not in shown][:max(0, _KEYS - len(shown))]
    return [key for key in every if key in shown]


def _with_directories(names: list[str], runs: Sequence[Run]) -> list[str]:
    """Appends to names that several runs share the end of their directory, as much of it as differs."""
    out = list(names)
    for name in {name for name in names if names.count(name) > 1}:
        same = [i for i, one in enumerate(names) if one == name]
        paths = [runs[i].directory.resolve() for i in same]
        for parts in range(1, max(len(path.parts) for path in paths) + 1):
            ends = [pathlib.PurePath(*path.parts[-parts:]).as_posix() for path in paths]
            if len(set(ends)) == len(set(paths)):
                break
        for i, end in zip(same, ends):
            out[i] = f"{name}{BETWEEN}{end}"
    return out


def _numbered(names: list[str], identities: list[Any]) -> list[str]:
    """Returns the names, with a number after those of a second or later identity of the same name."""
    met: dict[str, list[Any]] = {}
    out = []
    for name, identity in zip(names, identities):
        known = met.setdefault(name, [])
        if identity not in known:
            known.append(identity)
        at = known.index(identity)
        out.append(f"{name} ({at + 1})" if at else name)
    return out


def _repeats(names: list[str], groups: list[str]) -> list[str]:
    """Returns the names, with a number after the second and later ones of a group."""
    met: dict[tuple[str, str], int] = {}
    out = []
    for name, group in zip(names, groups):
        met[name, group] = met.get((name, group), 0) + 1
        out.append(f"{name} ({met[name, group]})" if met[name, group] > 1 else name)
    return out

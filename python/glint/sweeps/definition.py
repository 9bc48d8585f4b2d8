# Reads what a sweep is: sweep.toml, or the same as a dictionary.
# SPDX-License-Identifier: Apache-2.0
"""`Definition.read(path)` and `Definition.of(dictionary)` check every name before anything runs."""
from __future__ import annotations

import dataclasses
import math
import os
import pathlib
import re
import tomllib
from typing import Any, Callable, Mapping

from ..documents import flat
from ..errors import MissingPackage, SweepError
from ..patterns import near
from .constraints import Constraint
from .design import METHODS, check_values, number_of_points, points_of
from .places import Places

_KEYS = ("name", "store", "workloads", "configs", "seeds", "replicas", "run", "set", "design", "constraints", "stats", "report", "objectives", "limits", "retry", "engine",
         "threads", "slurm", "dask")
_OWN = {"out": "the store has a folder for each point", "config": "use `configs`", "set": "use [set] and [[design]]", "seed": "use `seeds` or `replicas`", "stats": "use `stats`",
        "threads": "use `threads`", "json": "the results go to the store", "progress-fd": "it is Glint's own"}
_FILES = ("launch", "shader-dir", "assets", "include")  # options of [run] that name files
ENGINES = ("local", "slurm", "dask")
_NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]{0,63}")  # of a sweep, and of its folder in the store
RETRIES = {"crash": 1, "timeout": 0, "memory": 1, "lost": 2}
_MOST_POINTS = 4_000_000  # Choice: the list of points of such a sweep takes some 12 GB of memory (docs/scale.md).
_DESIGN = ("method", "points", "seed", "keys", "list")


@dataclasses.dataclass
class Definition:
    """Holds a sweep: what docs/sweeps.md says of each key of the file."""
    name: str
    workloads: list[str]
    configs: list[str] = dataclasses.field(default_factory=lambda: ["mobile"])
    seeds: list[int] = dataclasses.field(default_factory=lambda: [1])
    options: list[str] = dataclasses.field(default_factory=list)
    oracles: list[str] = dataclasses.field(default_factory=list)
    settings: dict[str, Any] = dataclasses.field(default_factory=dict)
    designs: list[dict[str, Any]] = dataclasses.field(default_factory=list)
    constraints: list[str] = dataclasses.field(default_factory=list)
    stats: str = "compact"
    report: bool = False
    objectives: list[str] = dataclasses.field(default_factory=lambda: ["cycles"])
    timeout: float | None = None
    memory_limit: int | None = None
    retry: dict[str, int] = dataclasses.field(default_factory=lambda: dict(RETRIES))
    engine: str = "local"
    threads: int = 1
    slurm: dict[str, Any] = dataclasses.field(default_factory=dict)
    dask: dict[str, Any] = dataclasses.field(default_factory=dict)
    store: str | None = None
    places = None  # a Places, which tells the lines of the sweep's file; it is kept nowhere

    @staticmethod
    def read(path: str | pathlib.Path) -> "Definition":
        """Returns the sweep of a file. Paths in it count from the file's folder. Raises SweepError, which names the file and what is wrong."""
        path = pathlib.Path(path)
        text = _text_of(path)
        places = Places(str(path), text)
        try:
            tree = tomllib.loads(text)
            if "name" not in tree and not _NAME.fullmatch(path.stem):
                raise SweepError(f"the sweep has no `name`, and that of its file, {path.stem!r}, cannot be a folder's: give it a `name` of letters, digits, '_', '-' and '.'")
            made = Definition.of({"name": path.stem, **tree}, path.resolve().parent)
        except tomllib.TOMLDecodeError as error:
            what, _, where = str(error).partition(" (at ")
            line = re.match(r"line (\d+)", where)
            raise SweepError(f"{path}:{line[1] if line else max(1, len(text.splitlines()))}: the file is no TOML: {what}") from error
        except (SweepError, MissingPackage) as error:
            raise type(error)(places.told(str(error))) from error
        made.places = places
        return made

    def told(self, message: str) -> str:
        """Returns a message about the sweep behind the line of its file that it speaks of. A sweep of a dictionary has no lines."""
        return self.places.told(message) if self.places else message

    @staticmethod
    def of(tree: Mapping[str, Any], folder: str | pathlib.Path = ".") -> "Definition":
        """Returns the sweep of a dictionary that has the form of sweep.toml. Paths in it count from `folder`."""
        _known(tree, _KEYS, "the sweep")
        _check_texts(tree)
        folder = pathlib.Path(folder).resolve()
        limits, retry = _table(tree, "limits"), _table(tree, "retry")
        _known(limits, ("timeout", "memory"), "[limits]")
        _check_replicas(tree)
        _known(retry, RETRIES, "[retry]")
        options, oracles = _options(_table(tree, "run"), folder)
        made = Definition(
            name=_name(tree.get("name", "sweep")), workloads=[_path(one, folder) for one in _texts(tree, "workloads", None)],
            configs=[_path(one, folder) for one in _texts(tree, "configs", ["mobile"])], seeds=_seeds(tree), options=options, oracles=oracles,
            settings=flat(_table(tree, "set")), designs=_designs(tree.get("design", [])), constraints=_texts(tree, "constraints", []),
            stats=_word(tree, "stats", ("compact", "full"), "compact"), report=_flag(tree, "report"), objectives=_objectives(_texts(tree, "objectives", ["cycles"])),
            timeout=_limit(limits, "timeout", seconds_of), memory_limit=_limit(limits, "memory", bytes_of),
            retry={**RETRIES, **{kind: _whole(count, f"[retry] {kind}", 0) for kind, count in retry.items()}},
            engine=_word(tree, "engine", ENGINES, "local"), threads=_whole(tree.get("threads", 1), "threads", 1), slurm=_slurm(_table(tree, "slurm")),
            dask=_chunked(_table(tree, "dask"), "dask"), store=_store(tree, folder))
        _known(made.dask, ("scheduler", "chunk"), "[dask]")
        if not isinstance(made.dask.get("scheduler", ""), str):
            raise SweepError(f"`[dask] scheduler` is {made.dask['scheduler']!r}: a text is needed, such as \"tcp://host:8786\"")
        if made.report and made.stats != "full":
            raise SweepError("`report` needs stats = \"full\": a report shows every unit, and compact statistics have totals alone")
        for text in made.constraints:
            if not text.strip():
                raise SweepError("`constraints` has an empty text: remove it")
            Constraint(text)
        made._check_designs()
        return made

    def _check_designs(self) -> None:
        both = [key for key in self.swept if key in self.settings]
        if both:
            raise SweepError(f"[set] has '{both[0]}', and a design has it, too: remove one of them")
        count = sum(number_of_points(one["method"], one["keys"], one.get("points"), one["list"]) for one in self.designs)
        if count > _MOST_POINTS:
            raise SweepError(f"[[design]] has {count:,} points, and a sweep may have {_MOST_POINTS:,}: take fewer values, or sample them with another `method`")
        parts = {"workloads": len(self.workloads), "configs": len(self.configs), "points of [[design]]": count if self.designs else 1, "seeds": len(self.seeds)}
        if math.prod(parts.values()) > _MOST_POINTS:
            told = " x ".join(f"{number:,} {name}" for name, number in parts.items())
            raise SweepError(f"the sweep has {told} = {math.prod(parts.values()):,} points, and it may have {_MOST_POINTS:,}: take fewer, or make several sweeps into one store")
        self.settings_of_points()

    def settings_of_points(self) -> list[tuple[int, dict[str, Any]]]:
        """Returns the number of the design and the settings of every point, before workloads, configurations, seeds and constraints."""
        if not self.designs:
            return [(0, dict(self.settings))]
        return [(i, {**self.settings, **point}) for i, one in enumerate(self.designs)
                for point in points_of(one["method"], one.get("keys", {}), one.get("points"), one.get("seed", 1), one.get("list", []))]

    @property
    def swept(self) -> list[str]:
        """Returns the keys that differ between points, in the order of the file."""
        names = [key for one in self.designs for key in (*one.get("keys", {}), *(name for point in one.get("list", []) for name in point))]
        return list(dict.fromkeys(names))


def seconds_of(given: Any) -> float:
    """Returns the seconds of a number or of a text such as "90 s", "10 min" or "2 h"."""
    match = re.fullmatch(r"\s*([\d.]+)\s*(s|min|h|d)?\s*", str(given))
    try:
        value = float(match[1]) * {"s": 1, "min": 60, "h": 3600, "d": 86400, None: 1}[match[2]] if match else 0
    except ValueError:
        value = 0
    if value <= 0:
        raise SweepError(f"{given!r} is no time: examples are \"90 s\", \"10 min\" and \"2 h\"")
    return value


def bytes_of(given: Any) -> int:
    """Returns the bytes of a number of GB or of a text such as "500 MB" or "4 GB"."""
    match = re.fullmatch(r"\s*([\d.]+)\s*(MB|GB)?\s*", str(given))
    try:
        value = int(float(match[1]) * {"MB": 1e6, "GB": 1e9, None: 1e9}[match[2]]) if match else 0
    except ValueError:
        value = 0
    if value <= 0:
        raise SweepError(f"{given!r} is no amount of memory: examples are \"500 MB\" and \"4 GB\"")
    return value


def _limit(limits: Mapping[str, Any], name: str, read: Callable[[Any], Any]) -> Any:
    try:
        return read(limits[name]) if name in limits else None
    except SweepError as error:
        raise SweepError(f"`[limits] {name}`: {error}") from error


def _known(table: Mapping[str, Any], names: Any, where: str) -> None:
    for key in table:
        if key not in names:
            raise SweepError(f"{where} has no key '{key}'{near(key, list(names))}")


def _table(tree: Mapping[str, Any], key: str) -> dict[str, Any]:
    found = tree.get(key, {})
    if not isinstance(found, Mapping):
        raise SweepError(f"[{key}] is {found!r}: a table is needed")
    return dict(found)


def _name(given: Any) -> str:
    if not isinstance(given, str) or not _NAME.fullmatch(given):
        raise SweepError(f"`name` is {given!r}, which cannot be a folder's: letters, digits, '_', '-' and '.' are allowed, up to 64 of them")
    return given


def _texts(tree: Mapping[str, Any], key: str, otherwise: list[str] | None) -> list[str]:
    given = tree.get(key, otherwise)
    if given is None:
        raise SweepError(f"`{key}` is missing: a list of texts is needed, such as {key} = [\"WKND_SH\"]")
    given = [given] if isinstance(given, (str, pathlib.PurePath)) else given
    if not isinstance(given, (list, tuple)) or not all(isinstance(one, (str, pathlib.PurePath)) for one in given) or (otherwise is None and not given):
        raise SweepError(f"`{key}` is {given!r}: a list of texts is needed")
    return _different([str(one) for one in given], key)


def _check_texts(tree: Any, key: str = "") -> None:
    """Raises SweepError for a text that no command line can carry."""
    if isinstance(tree, str) and "\0" in tree:
        raise SweepError(f"'{key}' has a text with a zero byte in it: {tree!r}")
    for name, value in tree.items() if isinstance(tree, Mapping) else ((key, one) for one in tree) if isinstance(tree, (list, tuple)) else ():
        _check_texts(name, name)
        _check_texts(value, name)


def _store(tree: Mapping[str, Any], folder: pathlib.Path) -> str | None:
    given = tree.get("store")
    if given is not None and not isinstance(given, (str, pathlib.PurePath)):
        raise SweepError(f"`store` is {given!r}: the path of a folder is needed")
    return None if given is None else str((folder / given).resolve())


def _different(values: list[Any], key: str) -> list[Any]:
    check_values(key, values)
    return values


def _objectives(texts: list[str]) -> list[str]:
    if not texts:
        raise SweepError("`objectives` is []: a sweep needs one metric at least, such as \"cycles\"")
    if texts != ["cycles"]:
        from .page import objectives_of  # which workers do not need
        objectives_of(texts)
    return texts


def _word(tree: Mapping[str, Any], key: str, words: tuple[str, ...], otherwise: str) -> str:
    if tree.get(key, otherwise) not in words:
        raise SweepError(f"`{key}` is {tree[key]!r}: it is one of {', '.join(words)}")
    return tree.get(key, otherwise)


def _flag(tree: Mapping[str, Any], key: str) -> bool:
    if not isinstance(tree.get(key, False), bool):
        raise SweepError(f"`{key}` is {tree[key]!r}: it is true or false")
    return tree.get(key, False)


def _whole(value: Any, what: str, least: int) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or value < least:
        raise SweepError(f"`{what}` is {value!r}: a whole number from {least} is needed")
    return value


def _check_replicas(tree: Mapping[str, Any]) -> None:
    if isinstance(tree.get("replicas"), int) and tree["replicas"] > _MOST_POINTS:
        raise SweepError(f"`replicas` is {tree['replicas']:,}, and a sweep may have {_MOST_POINTS:,} points")


def _seeds(tree: Mapping[str, Any]) -> list[int]:
    if "seeds" in tree and "replicas" in tree:
        raise SweepError("`seeds` and `replicas` say the same: replicas = 3 means seeds = [1, 2, 3]")
    if "replicas" in tree:
        return list(range(1, _whole(tree["replicas"], "replicas", 1) + 1))
    given = tree.get("seeds", [1])
    if not isinstance(given, list) or not given:
        raise SweepError(f"`seeds` is {given!r}: a list of whole numbers is needed")
    return _different([_whole(one, "seeds", 0) for one in given], "seeds")


def _path(given: str, folder: pathlib.Path) -> str:
    """Returns the path of a file beside the sweep's, or the text itself where there is no such file."""
    return str(folder / given) if os.path.exists(folder / given) and ("." in given or "/" in given) else given


def _options(table: dict[str, Any], folder: pathlib.Path) -> tuple[list[str], list[str]]:
    """Returns the words of [run] on the command line, and the oracles that it names."""
    words, oracles = [], []
    for name, value in table.items():
        option = name.replace("_", "-")
        if option in _OWN:
            raise SweepError(f"[run] has '{name}': {_OWN[option]}")
        for one in value if isinstance(value, list) else [value]:
            if option == "oracle":
                oracles.append(str(one))
            elif isinstance(one, bool):
                words += [f"--{option}"] if one else []
            elif isinstance(one, (str, int, float)):
                words.append(f"--{option}={_path(one, folder) if option in _FILES and isinstance(one, str) else one}")
            else:
                raise SweepError(f"[run] has {name} = {one!r}: a text, a number, true or a list of them is needed")
    return sorted(words), oracles


def _designs(given: Any) -> list[dict[str, Any]]:
    out = []
    if not isinstance(given, (list, tuple, Mapping)):
        raise SweepError(f"`design` is {given!r}: a table [[design]] is needed")
    for one in [given] if isinstance(given, Mapping) else given:
        if not isinstance(one, Mapping):
            raise SweepError(f"a design is {one!r}: a table [[design]] is needed")
        _known(one, _DESIGN, "[[design]]")
        design = dict(one)
        design.setdefault("method", "list" if "list" in design else "grid")
        if design["method"] not in METHODS:
            raise SweepError(f"`method` is {design['method']!r}: it is one of {', '.join(METHODS)}")
        if "points" in design:
            _whole(design["points"], "points", 1)
            if design["method"] in ("grid", "list"):
                raise SweepError(f"the method \"{design['method']}\" takes no `points`, because it has all of its points: leave it out, or choose a `method` that samples")
        _whole(design.get("seed", 1), "seed", 0)
        if not isinstance(design.get("keys", {}), Mapping):
            raise SweepError("[design.keys] is not a table of keys")
        design["keys"] = _ranges(design.get("keys", {}))
        listed = design.get("list", [])
        if not isinstance(listed, list) or not all(isinstance(point, Mapping) for point in listed):
            raise SweepError("`list` is not a list of tables, { \"rt.warps\" = 4 } each")
        design["list"] = [flat(dict(point)) for point in listed]
        if (design["method"] == "list") != bool(design["list"]):
            raise SweepError("the method \"list\" needs `list`, and no other method has it")
        out.append(design)
    return out


def _ranges(table: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Returns axes by dotted key. A table with `low` is a range, and any other table is a part of a key."""
    out: dict[str, Any] = {}
    for name, value in table.items():
        if isinstance(value, Mapping) and "low" not in value and "high" not in value:
            out.update(_ranges(value, f"{prefix}{name}."))
        else:
            out[prefix + name] = value
    return out


def _slurm(table: dict[str, Any]) -> dict[str, Any]:
    _known(table, ("options", "setup", "chunk", "python"), "[slurm]")
    options = table.get("options", [])
    if not isinstance(options, list) or not all(isinstance(one, str) for one in options):
        raise SweepError(f"`[slurm] options` is {options!r}: a list of texts is needed")
    for name in ("setup", "python"):
        if not isinstance(table.get(name, ""), str):
            raise SweepError(f"`[slurm] {name}` is {table[name]!r}: a text is needed")
    return {**_chunked(table, "slurm"), "options": options}


def _chunked(table: dict[str, Any], name: str) -> dict[str, Any]:
    if "chunk" in table:
        _whole(table["chunk"], f"[{name}] chunk", 1)
    return table


def _text_of(path: pathlib.Path) -> str:
    try:
        data = path.read_bytes()
    except OSError as error:
        raise SweepError(f"{path}: the file cannot be read: {error.strerror}") from error
    try:
        return data.decode()
    except UnicodeDecodeError as error:
        line = data[:error.start].count(b"\n") + 1
        raise SweepError(f"{path}:{line}: the file is no TOML: byte 0x{data[error.start]:02x} does not belong to a text in UTF-8") from error

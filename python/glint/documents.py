# The JSON files of runs, read with clear words about what is wrong with them.
# SPDX-License-Identifier: Apache-2.0
"""`read_json`, `read_text` and `flat` of run.json, stats.json, heat/maps.json, config.toml and sweep.json."""
from __future__ import annotations

import json
import pathlib
from typing import Any

from .errors import SchemaError


def read_text(path: pathlib.Path) -> str:
    """A text file; SchemaError where it is not UTF-8."""
    try:
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise SchemaError(f"{path}: no text in UTF-8, the file is damaged: {error}") from error


def read_json(path: pathlib.Path) -> dict[str, Any]:
    """A JSON object; SchemaError where the file is none, was cut short, or has numbers that are not finite."""
    def refuse(word: str) -> Any:
        raise SchemaError(f"{path}: '{word}' is no number: the file is damaged")

    try:
        tree = json.loads(read_text(path), parse_constant=refuse)
    except (json.JSONDecodeError, RecursionError) as error:
        raise SchemaError(f"{path}: no JSON, or cut short: {error}") from error
    if not isinstance(tree, dict):
        raise SchemaError(f"{path}: no JSON object")
    return tree


def flat(tree: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    """Values of nested objects by dotted name."""
    out: dict[str, Any] = {}
    for name, value in tree.items():
        if isinstance(value, dict):
            out.update(flat(value, f"{prefix}{name}."))
        else:
            out[prefix + name] = value
    return out

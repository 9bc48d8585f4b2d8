# Reads the JSON files of runs, and says clearly what is wrong with a damaged file.
# SPDX-License-Identifier: Apache-2.0
"""`read_json`, `read_text` and `flat` read run.json, stats.json, heat/maps.json, config.toml and sweep.json."""
from __future__ import annotations

import json
import pathlib
from typing import Any

from .errors import SchemaError


def read_text(path: pathlib.Path) -> str:
    """Returns the contents of a text file. Raises SchemaError when it is not UTF-8."""
    try:
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise SchemaError(f"{path}: the text is not UTF-8, so the file is damaged: {error}") from error


def read_json(path: pathlib.Path) -> dict[str, Any]:
    """Returns a JSON object. Raises SchemaError when the file is not one, was cut short, or has numbers that are not finite."""
    def refuse(word: str) -> Any:
        raise SchemaError(f"{path}: '{word}' is not a number: the file is damaged")

    try:
        tree = json.loads(read_text(path), parse_constant=refuse)
    except (json.JSONDecodeError, RecursionError) as error:
        raise SchemaError(f"{path}: the file is not JSON, or was cut short: {error}") from error
    if not isinstance(tree, dict):
        raise SchemaError(f"{path}: the file is not a JSON object")
    return tree


def flat(tree: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    """Returns the values of nested objects by dotted name."""
    out: dict[str, Any] = {}
    for name, value in tree.items():
        if isinstance(value, dict):
            out.update(flat(value, f"{prefix}{name}."))
        else:
            out[prefix + name] = value
    return out

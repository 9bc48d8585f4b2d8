# Imports the modules of a package when their names are first asked for.
# SPDX-License-Identifier: Apache-2.0
"""A task of a cluster starts a process of Python that needs a part of the package, and importing all of it takes as long as running a small point."""
from __future__ import annotations

import importlib
from typing import Any, Callable, Mapping


def getter(package: str, homes: Mapping[str, str]) -> Callable[[str], Any]:
    """Returns a package's `__getattr__`. `homes` names the module of each name, and the module itself where both are equal."""

    def get(name: str) -> Any:
        if name not in homes:
            raise AttributeError(f"module '{package}' has no attribute '{name}'")
        module = importlib.import_module(f".{homes[name]}", package)
        return module if homes[name] == name else getattr(module, name)

    return get

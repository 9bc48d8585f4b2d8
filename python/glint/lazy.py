# Imports the modules of a package when their names are first asked for.
# SPDX-License-Identifier: Apache-2.0
"""A task of a cluster starts a process of Python that needs a part of the package, and importing all of it takes as long as running a small point."""
from __future__ import annotations

import importlib
import sys
from typing import Any, Callable, Mapping


def public(package: str, names: Mapping[str, str], *own: str) -> tuple[list[str], Callable[[str], Any], Callable[[], list[str]]]:
    """Returns a package's `__all__`, `__getattr__` and `__dir__`. `names` has the public names of each module, separated by blanks; a name that is equal to
    its module's is the module itself. `own` are names that the package has itself."""
    homes = {name: module for module, all_of_it in names.items() for name in all_of_it.split()}
    exported = sorted([*homes, *own])

    def get(name: str) -> Any:
        if name not in homes:
            raise AttributeError(f"module '{package}' has no attribute '{name}'")
        module = importlib.import_module(f".{homes[name]}", package)
        return module if homes[name] == name else getattr(module, name)

    def listed() -> list[str]:
        return sorted({*vars(sys.modules[package]), *exported})

    return exported, get, listed

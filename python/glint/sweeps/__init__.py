# Runs sweeps: workloads over many configurations, on this machine or on a cluster, each point once.
# SPDX-License-Identifier: Apache-2.0
"""`run(sweep)` runs a sweep, `status(sweep)` says how far it is, and `collect(sweep)` gives its results. docs/sweeps.md is the guide."""
from __future__ import annotations

from ..errors import SweepError
from ..lazy import getter

_NAMES = {"collecting": "Collection collect", "definition": "Definition", "running": "Engine Status read run status", "store": "Store"}
_HOMES = {name: module for module, names in _NAMES.items() for name in names.split()}
__all__ = sorted([*_HOMES, "SweepError"])
__getattr__ = getter(__name__, _HOMES)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

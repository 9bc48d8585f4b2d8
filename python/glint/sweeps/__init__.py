# Runs sweeps: workloads over many configurations, on this machine or on a cluster, each point once.
# SPDX-License-Identifier: Apache-2.0
"""`run(sweep)` runs a sweep, `status(sweep)` says how far it is, and `collect(sweep)` gives its results. docs/sweeps.md is the guide."""
from __future__ import annotations

from ..errors import SweepError
from ..lazy import public

_NAMES = {"collecting": "Collection collect", "definition": "Definition", "running": "Engine Status read run status", "store": "Store"}
__all__, __getattr__, __dir__ = public(__name__, _NAMES, "SweepError")

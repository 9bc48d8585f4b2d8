# Runs sweeps: workloads over many configurations, on this machine or on a cluster, each point once.
# SPDX-License-Identifier: Apache-2.0
"""`run(sweep)` runs a sweep, `status(sweep)` says how far it is, and `collect(sweep)` gives its results. docs/sweeps.md is the guide."""
from __future__ import annotations

from ..errors import SweepError
from .collecting import Collection, collect
from .definition import Definition
from .running import Engine, Status, read, run, status
from .store import Store

__all__ = ["Collection", "Definition", "Engine", "Status", "Store", "SweepError", "collect", "read", "run", "status"]

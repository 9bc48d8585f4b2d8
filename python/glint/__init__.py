# Reads, compares, draws and starts runs of Glint in Python.
# SPDX-License-Identifier: Apache-2.0
"""Reads the files that `glint` leaves. Reading needs only the standard library; some functions need numpy, pandas or matplotlib.

    >>> import glint
    >>> run = glint.run("SHIP_SH", out="out/ship", size=(64, 64))      # or glint.Run("out/ship")
    >>> run.stats["gpu.cycles"], run.stats.sum("core.instructions"), run.metrics["rt_occupancy"]
    >>> glint.plot.instruction_mix([run]).savefig("mix.pdf")           # `glint.plot` needs matplotlib
"""
from __future__ import annotations

import importlib
from typing import Any

from .characterization import Characterization
from .collection import Bench, Runs, Sweep
from .comparison import Change, compare, speedup
from .errors import CommandFailed, GlintError, IncompleteRun, MissingFile, MissingPackage, SchemaError, UnknownName
from .images import read_image
from .labelling import labels
from .launch import find_glint, run, sweep
from .derived import Metric, Metrics, metrics
from .run_directory import Estimate, Facts, Run
from .statistics import Histogram, Stat, Stats
from .table import Table
from .trace import Slice, Trace

__all__ = ["Bench", "Change", "Characterization", "CommandFailed", "Estimate", "Facts", "GlintError", "Histogram", "IncompleteRun", "Metric", "Metrics", "MissingFile", "MissingPackage",
           "Run", "Runs", "SchemaError", "Slice", "Stat", "Stats", "Sweep", "Table", "Trace", "UnknownName", "compare", "find_glint", "labels",
           "metrics", "plot", "read_image", "run", "speedup", "sweep"]


def __getattr__(name: str) -> Any:
    if name == "plot":  # imported late, because its functions import matplotlib
        return importlib.import_module(".plot", __name__)
    raise AttributeError(f"module 'glint' has no attribute '{name}'")

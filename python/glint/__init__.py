# Reads, compares, draws and starts runs of Glint in Python.
# SPDX-License-Identifier: Apache-2.0
"""Reads the files that `glint` leaves. Reading needs only the standard library; some functions need numpy, pandas or matplotlib.

    >>> import glint
    >>> run = glint.run("SHIP_SH", out="out/ship", size=(64, 64))      # or glint.Run("out/ship")
    >>> run.stats["gpu.cycles"], run.stats.sum("core.instructions"), run.metrics["rt_occupancy"]
    >>> glint.plot.instruction_mix([run]).savefig("mix.pdf")           # `glint.plot` needs matplotlib
"""
from __future__ import annotations

from .lazy import public

# These are the public names of each module. A module is imported when one of its names is first asked for.
_NAMES = {
    "axes_sweep": "sweep",
    "characterization": "Characterization",
    "collection": "Bench Runs Sweep",
    "comparison": "Change compare speedup",
    "derived": "Metric Metrics metrics",
    "errors": "CommandFailed GlintError IncompleteRun MissingFile MissingPackage SchemaError UnknownName",
    "images": "read_image",
    "labelling": "labels",
    "launch": "find_glint run",
    "plot": "plot",  # the module itself, whose functions import matplotlib
    "run_directory": "Estimate Facts Run",
    "statistics": "Histogram Stat Stats",
    "table": "Table",
    "trace": "Slice Trace",
}
__all__, __getattr__, __dir__ = public(__name__, _NAMES)

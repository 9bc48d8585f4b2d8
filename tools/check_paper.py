#!/usr/bin/env python3
# Says which statements of the LumiBench paper about the order of its workloads hold for a metrics.csv of `glint bench`.
# SPDX-License-Identifier: Apache-2.0
"""Is the command of `glint.paper.statements`, which `glint paper` judges with."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "python"))
from glint.paper.statements import main  # noqa: E402

if __name__ == "__main__":
    main()

# Asks the simulator about points, and holds what all points of a sweep depend on.
# SPDX-License-Identifier: Apache-2.0
"""`Program(path)` is the simulator, and `words_of(point, ...)` are the words that run a point. A task of a cluster imports this module and not the planning."""
from __future__ import annotations

import json
import os
import signal
import subprocess
from typing import Any, Sequence

from ..errors import CommandFailed
from ..fingerprint import file_hash

VARIABLES = ("GLINT_ASSETS", "GLINT_PLUGINS")  # of the environment, that change what a run computes


class Program:
    """Holds what all points of a sweep depend on: the program, its shaders and its plugins."""

    def __init__(self, path: str):
        self.path = path
        self.hash = file_hash(path)
        self.stamp = stamp_of(path)
        self.facts = ask(path, [])[0]


def stamp_of(path: str) -> list[int]:
    """Returns size and time of a file, by which a changed program is noticed without reading it."""
    about = os.stat(path)
    return [about.st_size, about.st_mtime_ns]


def ask(program: str, points: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Returns what `glint describe --points` of a program says: the facts of the program, then an answer for each point."""
    text = "".join(json.dumps(point) + "\n" for point in points)
    done = subprocess.run([program, "describe", "--points", "-"], input=text, capture_output=True, text=True, check=False)
    lines = done.stdout.splitlines()
    if done.returncode or len(lines) != len(points) + 1:
        raise CommandFailed(f"{_end_of(done)}, so nothing was run\n  note: its command was `{program} describe --points -`, with {len(points)} points", done.returncode, done.stderr)
    return [json.loads(line) for line in lines]


def _end_of(done: subprocess.CompletedProcess[str]) -> str:
    """Returns how the process that was to check points ended, in words, and what to do."""
    if done.returncode >= 0:
        return f"the process that checks points ended with exit code {done.returncode}: {done.stderr.strip() or 'it said nothing'}"
    name = signal.Signals(-done.returncode).name if -done.returncode in list(signal.Signals) else f"signal {-done.returncode}"
    why = ", as the system does when memory ends," if name == "SIGKILL" else ""
    return f"the process that checks points was ended{why} by {name}: give the same command again"


def words_of(point: dict[str, Any], oracles: Sequence[str], stats: str) -> list[str]:
    """Returns the words of a point's command line after `glint`, without the folder that it writes to."""
    settings = [f"--set={key}={value}" for key, value in point["set"].items()]
    return ["run", point["workload"], f"--config={point['config']}", *(f"--oracle={name}" for name in oracles), *settings, *point["options"], f"--stats={stats}"]

# Runs the sets of a plan one after another, each with `glint bench` or `glint ablate`, which keep what is complete.
# SPDX-License-Identifier: Apache-2.0
"""`run(...)` runs a plan, and `state(...)` says how much of it is there. Killed at any moment, the next call goes on where it ended."""
from __future__ import annotations

import json
import pathlib
import subprocess
import sys
import time
from typing import TextIO

from .plan import Set


class Runs:
    """Holds the folder of the runs of a plan."""

    def __init__(self, folder: str | pathlib.Path, sets: list[Set]):
        self.folder, self.sets = pathlib.Path(folder), sets

    def path(self, name: str) -> pathlib.Path:
        return self.folder / "runs" / name

    def command(self, glint: str, one: Set, jobs: int) -> list[str]:
        words = [glint, *one.words, "-j", str(jobs), "--out", str(self.path(one.name))]
        return words if one.is_ablation else [*words, "--resume"]  # an ablation always resumes

    def is_done(self, one: Set) -> bool:
        """Returns true when a call of this plan has completed the set. The set's own command decides anew whether all of it is still as it should be."""
        try:
            return json.loads(self._mark(one).read_text(encoding="utf-8")) == list(one.words)
        except (OSError, ValueError):
            return False

    def mark(self, one: Set) -> None:
        path = self._mark(one)
        part = path.with_suffix(".part")
        part.write_text(json.dumps(list(one.words)) + "\n", encoding="utf-8")
        part.replace(path)

    def _mark(self, one: Set) -> pathlib.Path:
        return self.path(one.name) / "set.json"


def text_of(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 90 else f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"


def run(runs: Runs, glint: str, jobs: int, out: TextIO = sys.stderr) -> list[str]:
    """Runs every set, and returns the names of those that failed. What is complete is only checked. Ctrl-C goes to the running command, which keeps what has ended."""
    failed: list[str] = []
    spent, done = 0.0, 0.0  # seconds and weight of the sets that this call has run
    total = sum(one.weight for one in runs.sets if not runs.is_done(one))
    for number, one in enumerate(runs.sets, 1):
        fresh = not runs.is_done(one)
        left = ""
        if fresh and done > 0:
            left = f", about {text_of(spent * (total - done) / done)} left"
        print(f"[{number}/{len(runs.sets)}] {one.name} ({one.shows}){left}", file=out, flush=True)
        begin = time.monotonic()
        code = _call(runs.command(glint, one, jobs), quiet=not fresh)
        if code < 0 or code in (130, 143):
            raise KeyboardInterrupt
        if code:
            failed.append(one.name)
        elif fresh:
            runs.mark(one)
        if fresh:
            done += one.weight
            spent += time.monotonic() - begin
    return failed


def _call(words: list[str], quiet: bool = False) -> int:
    """Runs a command to its end, also after Ctrl-C, which the command has got as well. The code is then 130: Python may lose that of a command that ends in the moment of the signal."""
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL if quiet else None)
    stopped = False
    while True:
        try:
            code = process.wait()
            return 130 if stopped else code
        except KeyboardInterrupt:
            stopped = True


def ask(words: list[str], what: str) -> str | None:
    """Runs a command of the analysis. Returns None, or why it failed: `what` and the command's message."""
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if not done.returncode:
        return None
    message = (done.stderr.strip() or done.stdout.strip()).splitlines()
    return f"{what}: {message[0] if message else f'exit code {done.returncode}'}"

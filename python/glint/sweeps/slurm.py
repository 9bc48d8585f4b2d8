# Runs tasks as job arrays of Slurm, by its own commands: sbatch, squeue, scancel, scontrol.
# SPDX-License-Identifier: Apache-2.0
"""`SlurmCluster` keeps no state of its own: the names of its jobs say which tasks they run, so that another process finds them again."""
from __future__ import annotations

import pathlib
import re
import shlex
import shutil
import subprocess
import sys

from ..errors import SweepError
from .cluster import Cluster
from .definition import Definition
from .folder import SweepFolder

_PACKAGE = str(pathlib.Path(__file__).resolve().parents[2])
_SPARE = 200_000_000  # bytes that a task's Python takes besides the run
_MAX_ARRAY = 1001  # Slurm's own default
_GRACE = 60  # seconds between the signal that a task is to end, and its end


class SlurmCluster(Cluster):
    """Submits arrays of tasks. What a site needs besides (account, partition, time, modules) goes through as it is.

    Args:
        definition: The sweep; its [slurm] table has `options` for sbatch, `setup` (lines of shell before a task), `chunk` and `python`.
        run: The name of the run's folder.
        options: Further options for sbatch.
        chunk: Points of a task.
    """

    def __init__(self, definition: Definition, folder: SweepFolder, run: str, options: tuple[str, ...] = (), chunk: int = 0):
        for command in ("sbatch", "squeue", "scancel"):
            if not shutil.which(command):
                raise SweepError(f"the engine \"slurm\" needs the command {command}, which is not on the PATH")
        self.chunk = chunk or definition.slurm.get("chunk", 0)
        self._folder, self._run = folder, run
        self._options = [*definition.slurm.get("options", []), *options]
        self._setup = definition.slurm.get("setup", "")
        self._python = definition.slurm.get("python", sys.executable)
        self._arrays: list[str] = []

    def submit(self, tasks: list[pathlib.Path], memory: int, threads: int) -> None:
        largest = self._largest_array()
        for first in range(0, len(tasks), largest):
            self._array(tasks[first:first + largest], memory, threads)

    def _array(self, tasks: list[pathlib.Path], memory: int, threads: int) -> None:
        attempt, offset = tasks[0].stem.split("-")
        name = f"{self._prefix(self._run)}{attempt}-{offset}"
        place = tasks[0].parent
        words = ["sbatch", "--parsable", f"--job-name={name}", f"--array=0-{len(tasks) - 1}", "--requeue", f"--signal=B:TERM@{_GRACE}", f"--cpus-per-task={threads}",
                 f"--mem={-(-(memory + _SPARE) // 1_000_000)}M", f"--output={place}/slurm-{attempt}-%a.log", "--open-mode=append", f"--chdir={place}", *self._options]
        script = "\n".join(["#!/bin/sh", self._setup, f"PYTHONPATH={shlex.quote(_PACKAGE)}${{PYTHONPATH:+:$PYTHONPATH}}", "export PYTHONPATH",
                            f"exec {shlex.quote(self._python)} -S -m glint.sweeps.worker {shlex.quote(str(place))}/{attempt}-$(({offset} + SLURM_ARRAY_TASK_ID)).json", ""])
        done = subprocess.run(words, input=script, capture_output=True, text=True, check=False)
        if done.returncode:
            self.cancel()
            raise SweepError(f"sbatch refused the tasks: {done.stderr.strip()}\n  note: its command was {shlex.join(words)}")
        self._arrays.append(done.stdout.strip().split(";")[0])

    def _prefix(self, run: str) -> str:
        return f"glint-{self._folder.name}-{run}-"

    def _largest_array(self) -> int:
        done = subprocess.run(["scontrol", "show", "config"], capture_output=True, text=True, check=False)
        found = re.search(r"MaxArraySize\s*=\s*(\d+)", done.stdout)
        return max(1, int(found[1]) - 1 if found else _MAX_ARRAY - 1)

    def live(self) -> set[pathlib.Path]:
        return {task for _, task in self._queue()}

    def _queue(self) -> list[tuple[str, pathlib.Path]]:
        """Returns the job's name and the task of everything of this sweep that waits or runs. Another sweep's name may begin with this one's."""
        words = ["squeue", "--noheader", "--array", "--me", "--format=%j|%K", "--states=PENDING,RUNNING,SUSPENDED,CONFIGURING,COMPLETING,REQUEUED,RESIZING,STOPPED,PREEMPTED"]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        if done.returncode:
            raise SweepError(f"squeue does not answer, and what was submitted goes on: {done.stderr.strip()}\n  note: `glint sweep resume` finds it again")
        runs = {self._prefix(run.name): run for run in self._folder.runs()}
        out = []
        for line in done.stdout.splitlines():
            if match := re.fullmatch(r"(.*-)(\d+)-(\d+)\|(\d+)", line.strip()):
                prefix, attempt, offset, index = match.groups()
                if prefix in runs:
                    out.append((line.partition("|")[0], runs[prefix] / f"{attempt}-{int(offset) + int(index)}.json"))
        return out

    def cancel(self) -> None:
        names = sorted({name for name, _ in self._queue()})
        if names:
            subprocess.run(["scancel", "--me", f"--name={','.join(names)}"], capture_output=True, check=False)

    def log(self, task: pathlib.Path) -> str:
        attempt, number = task.stem.split("-")
        logs = [task.parent / f"slurm-{attempt}-{int(number) % self._largest_array()}.log"]
        return "".join(path.read_text(encoding="utf-8", errors="replace")[-65536:] for path in logs if path.is_file())

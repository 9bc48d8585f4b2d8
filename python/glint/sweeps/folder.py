# Keeps what a store knows of one sweep: its definition, its points, the tasks that were handed out, and how far it is.
# SPDX-License-Identifier: Apache-2.0
"""`SweepFolder(store, name)` is the folder `sweeps/NAME` of a store."""
from __future__ import annotations

import contextlib
import dataclasses
import json
import os
import pathlib
import socket
import time
from typing import Any, Iterable

from ..documents import read_json, read_text
from ..errors import SchemaError, SweepError
from ..patterns import near
from .definition import Definition
from .store import Store, write_whole

_COUNT = "points"
_ANEW = "\n  note: `glint sweep run` of the sweep's file writes it again, and runs nothing that is done; remove the folder when the sweep is not needed any more"
_FRESH = 15  # seconds that a note of progress counts, when its process cannot be asked


class SweepFolder:
    def __init__(self, store: Store, name: str):
        self.name = name
        self.place = store.folder / "sweeps" / name

    @staticmethod
    def names(store: Store) -> list[str]:
        return sorted(path.name for path in (store.folder / "sweeps").iterdir() if (path / "sweep.json").is_file())

    @staticmethod
    def all(store: Store) -> "list[SweepFolder]":
        """Returns the folders of all sweeps that have named points, also of damaged ones."""
        folders = [SweepFolder(store, path.name) for path in sorted((store.folder / "sweeps").iterdir())]
        return [folder for folder in folders if any((folder.place / name).exists() for name in ("sweep.json", "points.jsonl"))]

    @staticmethod
    def existing(store: Store, name: str) -> "SweepFolder":
        """Returns the folder of a sweep that has been planned. Raises SweepError with near names when there is none."""
        found = SweepFolder(store, name)
        if not (found.place / "sweep.json").is_file():
            known = SweepFolder.names(store)
            raise SweepError(f"{store.folder}: there is no sweep '{name}'{near(name, known)}; the store has: {', '.join(known) or 'none'}")
        return found

    def save(self, definition: Definition, points: list[dict[str, Any]]) -> None:
        """Keeps a plan, in the place of an earlier one. The last line of its list says how many points there are, so that a list that was cut is known."""
        self.place.mkdir(parents=True, exist_ok=True)
        write_whole(self.place / "points.jsonl", "".join(json.dumps(point) + "\n" for point in [*points, {_COUNT: len(points)}]))
        write_whole(self.place / "sweep.json", json.dumps({"schema": 1, "definition": dataclasses.asdict(definition)}, indent=1) + "\n")

    @property
    def definition(self) -> Definition:
        try:
            return Definition(**read_json(self.place / "sweep.json")["definition"])
        except (TypeError, KeyError, SchemaError) as error:
            raise SchemaError(f"{self.place}/sweep.json: the file is damaged, or of another version of Glint: {error}{_ANEW}") from error

    @property
    def points(self) -> list[dict[str, Any]]:
        try:
            *points, last = [json.loads(line) for line in read_text(self.place / "points.jsonl").splitlines()]
            if last[_COUNT] == len(points) == sum("id" in point for point in points):
                return points
        except (OSError, ValueError, KeyError, TypeError):
            pass
        raise SchemaError(f"{self.place}/points.jsonl: the list of points is missing, was cut short, or is damaged{_ANEW}")

    def new_run(self) -> pathlib.Path:
        """Returns a new folder for the tasks of one run. Its name tells the runs of all hosts apart."""
        for number in range(10000):
            path = self.place / "runs" / f"{time.strftime('%m%d%H%M%S')}{socket.gethostname()[:8]}{os.getpid()}x{number}"
            try:
                path.mkdir(parents=True)
                return path
            except FileExistsError:
                pass
        raise SweepError(f"{self.place}/runs: no folder for the run can be made")

    def runs(self) -> list[pathlib.Path]:
        return sorted(path for path in (self.place / "runs").glob("*") if path.is_dir())

    def ended_runs(self, with_tasks: bool) -> list[pathlib.Path]:
        """Returns the folders of runs of this host whose process was killed; those that handed out tasks only when asked for."""
        out = []
        for run in self.runs():
            try:
                note = read_json(run / "progress.json")
            except (OSError, SchemaError):
                continue
            if note.get("host") == socket.gethostname() and not os.path.exists(f"/proc/{note.get('pid')}") and (with_tasks or not any(run.glob("0-*.json"))):
                out.append(run)
        return out

    def stop_all(self) -> int:
        """Asks all runs of the sweep to stop, wherever they are. Returns how many there are."""
        for run in self.runs():
            (run / "stop").touch()
        return len(self.runs())

    def note(self, run: pathlib.Path, progress: dict[str, Any]) -> None:
        """Notes how far a run is, for `status` in another shell. A note that cannot be written is left out."""
        with contextlib.suppress(OSError):
            write_whole(run / "progress.json", json.dumps({**progress, "host": socket.gethostname(), "pid": os.getpid(), "when": time.time()}) + "\n")

    def progress(self) -> Iterable[dict[str, Any]]:
        """Returns the notes of runs that go on."""
        for run in self.runs():
            try:
                note = read_json(run / "progress.json")
            except (OSError, SchemaError):
                continue
            here = note.get("host") == socket.gethostname()
            if os.path.exists(f"/proc/{note.get('pid')}") if here else time.time() - note.get("when", 0) < _FRESH:
                yield note

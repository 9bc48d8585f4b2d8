# Reads the command line of `glint sweep` and does what it asks for.
# SPDX-License-Identifier: Apache-2.0
"""`main()` is the whole command. apps/glint/commands/sweep.cpp declares the same options for help and completions."""
from __future__ import annotations

import argparse
import dataclasses
import io
import json
import pathlib
import shutil
import sys
from typing import Any, Callable, NoReturn

from ..errors import CommandFailed, GlintError, StoreFull
from ..launch import find_glint
from .cleaning import clean
from .collecting import collect, write
from .folder import SweepFolder
from .page import objectives_of, page_of
from .planning import plan
from .program import Program
from .running import DEFAULT_STORE, Engine, opened, read, run, status, text_of
from .slurm import SlurmCluster
from .store import Store, write_whole


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        raise GlintError(message)


def parser() -> argparse.ArgumentParser:
    made = _Parser(prog="glint sweep", allow_abbrev=False)
    made.add_argument("action", choices=list(_ACTIONS))
    made.add_argument("sweep", nargs="?")
    for name in ("store", "engine", "scheduler", "out", "point", "python"):
        made.add_argument(f"--{name}")
    for name in ("workers", "chunk"):
        made.add_argument(f"--{name}", type=int, default=0)
    made.add_argument("--memory", type=float, default=0.0)
    made.add_argument("--slurm", action="append", default=[])
    for name in ("detach", "failed", "yes", "json", "dry-run"):
        made.add_argument(f"--{name}", action="store_true")
    return made


def main(words: list[str] | None = None) -> int:
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")  # A path need not be a text of the terminal's encoding.
    try:
        given = parser().parse_args(words)
        return _ACTIONS[given.action](given)
    except GlintError as error:
        print(f"{'' if 'error: ' in str(error) else 'error: '}{error}", file=sys.stderr)
        return 1 if isinstance(error, StoreFull) or (isinstance(error, CommandFailed) and error.code not in (2, None)) else 2
    except BrokenPipeError:
        return 1
    except OSError as error:
        print(f"error: {f'{error.filename}: {error.strerror}' if error.filename else error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130


def _sweep(given: argparse.Namespace) -> str:
    if not given.sweep:
        raise GlintError(f"`glint sweep {given.action}` needs the sweep: its file, or its name in the store")
    return given.sweep


def _run(given: argparse.Namespace) -> int:
    named = _sweep(given)
    if given.action == "run" and not pathlib.Path(named).is_file():
        raise GlintError(f"{named}: there is no such file (`glint sweep resume NAME` goes on with a sweep of the store)")
    if pathlib.Path(named).is_file():
        definition, store = read(named), given.store
    else:
        kept_in, folder = opened(named, given.store)
        definition, store = folder.definition, str(kept_in.folder)
        kept_in.close()
    if given.dry_run:
        points = plan(definition, Program(find_glint()))
        weight = sum(point["memory"] for point in points) / len(points)
        print(f"{definition.name}: {len(points)} points, {len({point['id'] for point in points})} different, all of them right; {weight / 1e6:.0f} MB a point")
        return 0
    engine = Engine(given.engine, None, given.workers, given.memory, given.scheduler, given.chunk, tuple(given.slurm), given.detach)
    found = run(definition, store, engine=engine, failed=given.failed, progress=sys.stderr)
    print(text_of(found))
    if found.stopped:
        print(f"stopped; `glint sweep resume {named}` goes on", file=sys.stderr)
        return 128 + found.stopped
    return 1 if found.failures or (found.left and not given.detach) else 0


def _status(given: argparse.Namespace) -> int:
    if not given.sweep:
        store = Store(given.store or DEFAULT_STORE, new=False)
        names = SweepFolder.names(store)
        print("\n".join(text_of(status(name, store.folder)) for name in names) or f"{store.folder}: there is no sweep")
        return 0
    found = status(given.sweep, given.store)
    if given.json:
        print(json.dumps({**dataclasses.asdict(found), "left": found.left}, indent=1))
    else:
        print(text_of(found))
    return 0


def _cancel(given: argparse.Namespace) -> int:
    store, folder = opened(_sweep(given), given.store)
    store.check_writable()
    count = folder.stop_all()
    if shutil.which("squeue") and any(folder.place.glob("runs/*/0-*.json")):
        SlurmCluster(folder.definition, folder, "").cancel()
    store.close()
    print(f"{folder.name}: {count} run{'' if count == 1 else 's'} asked to stop; what is done stays in the store")
    return 0


def _open(given: argparse.Namespace) -> int:
    if not given.point or not given.out:
        raise GlintError("`glint sweep open` needs --point, the id of a point, and --out, a new folder")
    store = Store(given.store or (read(given.sweep).store if given.sweep and pathlib.Path(given.sweep).is_file() else None) or DEFAULT_STORE, new=False)
    found = [id for id in store.points() if id.startswith(given.point)]
    if len(found) != 1:
        raise GlintError(f"{store.folder}: {len(found)} points begin with '{given.point}'")
    print(store.unpack(found[0], given.out))
    return 0


def _gc(given: argparse.Namespace) -> int:
    print(clean(Store(given.store or DEFAULT_STORE, new=False), given.yes))
    return 0


def _collect(given: argparse.Namespace) -> int:
    named = _sweep(given)
    found = collect(named, given.store)
    folder = pathlib.Path(given.out or f"out/sweep-{found.definition.name}")
    folder.mkdir(parents=True, exist_ok=True)
    objectives_of(found.definition.objectives)
    files = write(found, folder) if given.action == "collect" else []
    if found.rows:
        write_whole(folder / "report.html", page_of(found, folder))
        files.append(folder / "report.html")
    missing = f", {found.missing} not run yet" if found.missing else ""
    print(f"{found.definition.name}: {len(found.rows)} points, {len(found.failures)} failed{missing}")
    print("\n".join(f" {path}" for path in files))
    if given.action == "collect" and not any(path.suffix == ".parquet" for path in files):
        print("note: points.parquet was left out, because pyarrow is not installed (docs/sweeps.md)", file=sys.stderr)
    if found.damaged:
        print(f"warning: points with damaged files: {len(found.damaged)}, such as {found.damaged[0]}: `glint sweep gc --yes` removes them, and `resume` runs them again", file=sys.stderr)
    return 0


_ACTIONS: dict[str, Callable[[Any], int]] = {"run": _run, "status": _status, "resume": _run, "cancel": _cancel, "collect": _collect, "report": _collect, "open": _open, "gc": _gc}

# Reads the command line of `glint paper` and does what it asks for.
# SPDX-License-Identifier: Apache-2.0
"""`main()` is the whole command. apps/glint/commands/paper.cpp declares the same options for help and completions."""
from __future__ import annotations

import argparse
import os
import pathlib
import shlex
import sys
from typing import NoReturn

from ..errors import GlintError
from ..launch import find_glint
from .analysis import analyse, verdicts
from .page import page_of
from .plan import Options, plan
from .running import Runs, run, text_of


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        raise GlintError(message)


def parser() -> argparse.ArgumentParser:
    made = _Parser(prog="glint paper", allow_abbrev=False)
    for name in ("subset", "list", "report", "small"):
        made.add_argument(f"--{name}", action="store_true")
    made.add_argument("-j", "--jobs", type=int, default=0)
    made.add_argument("--assets", default=os.environ.get("GLINT_ASSETS", ""))
    made.add_argument("--out", default="out/paper")
    made.add_argument("--size", default="128x128")
    made.add_argument("--spp", type=int, default=2)
    made.add_argument("--workloads", nargs="+", default=[])
    made.add_argument("--programs", nargs="+", default=[])
    made.add_argument("--python")
    return made


def main(words: list[str] | None = None) -> int:
    try:
        given = parser().parse_args(words)
        return _paper(given)
    except GlintError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("stopped; the same command goes on from here", file=sys.stderr)
        return 130


def _paper(given: argparse.Namespace) -> int:
    if given.assets and not pathlib.Path(given.assets).is_dir():
        raise GlintError(f"--assets: '{given.assets}' is not a folder")
    options = Options(given.subset, given.assets, given.size, given.spp, given.small, tuple(given.workloads), tuple(given.programs))
    runs, glint = Runs(given.out, plan(options)), find_glint()
    if given.list:
        for one in runs.sets:
            print(f"{'done' if runs.is_done(one) else '    '}  {one.name:34} {one.shows}\n      {shlex.join(runs.command('glint', one, given.jobs))}")
        left = sum(one.weight for one in runs.sets if not runs.is_done(one))
        print(f"{len(runs.sets)} sets, {sum(map(runs.is_done, runs.sets))} of them complete; about {text_of(left)} of processor time left")
        return 0
    _make_folder(given.out)
    failed = [] if given.report else run(runs, glint, given.jobs)
    return _conclude(runs, glint, options, failed)


def _make_folder(folder: str) -> None:
    """Makes the folder of the results before anything runs, so that a folder that cannot be made is told once."""
    try:
        pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise GlintError(f"--out: the folder '{folder}' cannot be made ({error.strerror}); name another one") from None


def _conclude(runs: Runs, glint: str, options: Options, failed: list[str]) -> int:
    found = analyse(runs, glint, sys.stderr)
    kind = f"{'trial' if options.names else 'short form' if options.subset else 'all'}, {options.size}, {options.spp} spp"
    page = runs.folder / "report.html"
    page.write_text(page_of(runs, found, f"The LumiBench paper by Glint ({kind})"), encoding="utf-8")
    for name, rows in verdicts(runs).items():
        counts = {verdict: sum(row[2] == verdict for row in rows) for verdict in ("holds", "does not hold", "cannot be judged")}
        print(f"{name}: " + ", ".join(f"{count} {verdict}" for verdict, count in counts.items()))
    for line in found.missing:
        print(f"warning: {line}", file=sys.stderr)
    print(page)
    if failed:
        print(f"error: {len(failed)} sets are not complete: {' '.join(failed)}", file=sys.stderr)
    return 1 if failed else 0

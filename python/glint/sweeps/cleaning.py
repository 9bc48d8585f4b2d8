# Removes from a store what no sweep names, and what killed processes left.
# SPDX-License-Identifier: Apache-2.0
"""`clean(store, remove)` says what is there to remove, and removes it when it is told to."""
from __future__ import annotations

import os
import pathlib
import shutil

from . import index
from .execution import remove_left_scratch
from .folder import SweepFolder
from .running import slurm_tasks
from .store import Store


def clean(store: Store, remove: bool) -> str:
    """Returns what was, or would be, removed. It reads the whole store, with every file. Points that run at this moment stay. Damaged points run again."""
    named = {point["id"] for name in SweepFolder.names(store) for point in SweepFolder.existing(store, name).points}
    unnamed = [id for id in store.points() if id not in named]
    damaged = [id for id in store.points() if id in named and store.damage(id)]
    failures = [id for id in store.failed() if id not in named]
    folders = [SweepFolder.existing(store, name) for name in SweepFolder.names(store)]
    scratch = store.left_over() + [run for folder in folders for run in folder.ended_runs(with_tasks=not slurm_tasks(folder))]
    if remove:
        for id in unnamed + damaged:
            _remove_point(store, id)
        for id in failures:
            store.forget_failure(id)
        for path in scratch:
            shutil.rmtree(path) if path.is_dir() else path.unlink(missing_ok=True)
        remove_left_scratch()
        index.forget(store)
    what = f"{len(unnamed)} points and {len(failures)} failures that no sweep names, {len(damaged)} points with damaged files, {len(scratch)} folders that killed processes left"
    return f"{store.folder}: removed {what}" if remove else f"{store.folder}: {what} (--yes removes them)"


def _remove_point(store: Store, id: str) -> None:
    if not store.lock(id):
        return
    try:
        scratch: pathlib.Path = store.scratch(id)
        os.rename(store.point(id), scratch)  # so that no half of a point is ever in the store
        shutil.rmtree(scratch)
    except FileNotFoundError:
        pass
    finally:
        store.unlock(id)

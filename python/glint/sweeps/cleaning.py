# Removes from a store what no sweep names, and what killed processes left.
# SPDX-License-Identifier: Apache-2.0
"""`clean(store, remove)` says what is there to remove, and removes it when it is told to."""
from __future__ import annotations

import contextlib

from . import index
from .execution import remove_left_scratch
from .folder import SweepFolder
from .running import slurm_tasks
from .store import Store, remove as remove_path


def clean(store: Store, remove: bool) -> str:
    """Returns what was, or would be, removed. It reads the whole store, with every file. Points that run at this moment stay. Damaged points run again."""
    if remove:
        store.check_writable()
    named = _named(store)
    damaged = [id for id in store.points() if id in named and store.damage(id)]
    with store.plans_kept_still() if remove else contextlib.nullcontext():
        if remove:
            named = _named(store)  # again, because sweeps may have begun meanwhile
        unnamed = [id for id in store.points() if id not in named]
        failures = [id for id in store.failed() if id not in named]
        folders = [SweepFolder.existing(store, name) for name in SweepFolder.names(store)]
        scratch = store.left_over() + [run for folder in folders for run in folder.ended_runs(with_tasks=not slurm_tasks(folder))]
        if remove:
            for id in unnamed + damaged:
                _remove_point(store, id, even_whole=id not in named)
            for id in failures:
                store.forget_failure(id)
            for path in scratch:
                remove_path(path)
            remove_left_scratch()
            index.forget(store)
    what = f"{len(unnamed)} points and {len(failures)} failures that no sweep names, {len(damaged)} points with damaged files, {len(scratch)} folders that killed processes left"
    return f"{store.folder}: removed {what}" if remove else f"{store.folder}: {what} (--yes removes them)"


def _named(store: Store) -> set[str]:
    """Returns the points that sweeps name. Raises SchemaError when a list of points is damaged or missing, because nobody knows then what it named."""
    return {point["id"] for folder in SweepFolder.all(store) for point in folder.points}


def _remove_point(store: Store, id: str, even_whole: bool) -> None:
    if not store.lock(id):
        return
    try:
        if even_whole or store.damage(id):  # Somebody may have run it again.
            store.discard(id)
    except FileNotFoundError:
        pass
    finally:
        store.unlock(id)

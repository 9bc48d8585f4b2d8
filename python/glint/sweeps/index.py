# Keeps the records of points in one SQLite file, so that tables of large sweeps need not open every folder.
# SPDX-License-Identifier: Apache-2.0
"""`records(store, ids)` reads many points. The file is a cache: it may be removed, and is made anew from the folders."""
from __future__ import annotations

import contextlib
import json
import sqlite3
from typing import Any, Iterable

from ..errors import GlintError
from .store import Store

_FILE = "index.sqlite"
_STEP = 500  # ids of one question
_KEPT = ("id", "workload", "config", "set", "seed", "options", "partial", "metrics", "cost", "files")


def records(store: Store, ids: Iterable[str]) -> dict[str, dict[str, Any]]:
    """Returns the records of those points that the store has. Only points that the index does not know are read from their folders."""
    wanted = list(dict.fromkeys(ids))
    try:
        with contextlib.closing(_opened(store)) as index:
            found = _known(index, wanted)
            new = _read(store, [id for id in wanted if id not in found])
            index.executemany("insert or replace into points values (?, ?)", [(id, json.dumps(record)) for id, record in new.items()])
            index.commit()
    except (sqlite3.DatabaseError, ValueError):  # damaged, locked for long, or the file system has no locks
        forget(store)
        found, new = {}, _read(store, wanted)
    both = {**found, **new}
    return {id: both[id] for id in wanted if id in both}


def forget(store: Store) -> None:
    """Removes the index. It is made anew when it is next needed."""
    for end in ("-journal", ""):  # A journal that stayed alone would be played back into the next index.
        with contextlib.suppress(OSError):
            (store.folder / f"{_FILE}{end}").unlink(missing_ok=True)


def _opened(store: Store) -> sqlite3.Connection:
    index = sqlite3.connect(store.folder / _FILE, timeout=10)
    try:
        index.execute("create table if not exists points (id text primary key, record text not null)")
    except sqlite3.DatabaseError:
        index.close()
        raise
    return index


def _known(index: sqlite3.Connection, ids: list[str]) -> dict[str, dict[str, Any]]:
    found = {}
    for i in range(0, len(ids), _STEP):
        some = ids[i:i + _STEP]
        for id, record in index.execute(f"select id, record from points where id in ({','.join('?' * len(some))})", some):
            found[id] = json.loads(record)
    return found


def _read(store: Store, ids: list[str]) -> dict[str, dict[str, Any]]:
    found = {}
    for id in ids:
        try:
            record = store.read(id)
        except (OSError, GlintError):
            continue  # The point is not there, or damaged: nobody has its numbers.
        if isinstance(record.get("metrics"), dict) and isinstance(record.get("cost"), dict) and isinstance(record["cost"].get("failed_attempts"), list):
            found[id] = {key: record.get(key) for key in _KEPT}
    return found

# Keeps the points of all sweeps, each in a folder named by what it depends on, and locks those that run.
# SPDX-License-Identifier: Apache-2.0
"""`Store(folder)` finds, locks and commits points. docs/scale.md says what it assumes of the file system."""
from __future__ import annotations

import contextlib
import errno
import fcntl
import itertools
import json
import os
import pathlib
import re
import shutil
import socket
import struct
import threading
import time
import zipfile
import zlib
from typing import Any, Iterator

from ..documents import read_json
from ..errors import GlintError, StoreFull, SweepError

SCHEMA = 1
_MARK = "glint-store.json"
_NO_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP, errno.EINVAL)
_PLANS = 1 << 61  # the lock of plans; those of points are below 1 << 60
_OF_A_FAILURE = {"id": str, "kind": str, "message": str, "workload": str, "config": str, "set": dict}
_STALE = 86400  # seconds after which a scratch folder of another host is taken to be left over


class Store:
    """Holds a folder of points, which is made when it is `new`. Raises SweepError when the folder is something else.

    A point is in the store when its record is: its folder appears whole, by one rename. Whoever runs a point holds its lock, a range of one byte of the
    file `locks`, which the system gives back when its process ends, however it ends. Without locks a point may run twice, and the first result stays.
    """

    def __init__(self, folder: str | pathlib.Path, new: bool = True):
        self.folder = pathlib.Path(folder).resolve()
        mark = self.folder / _MARK
        if not mark.is_file() and not new:
            raise SweepError(f"{self.folder}: there is no store of sweeps here: name the right folder with --store")
        if not mark.is_file():
            self._begin(mark)
        try:
            schema = read_json(mark).get("schema")
        except GlintError as error:
            raise SweepError(f"{error}\n  note: when the file is removed, `glint sweep run` marks the store again") from error
        if schema != SCHEMA:
            raise SweepError(f"{mark}: the store is of another version of Glint: use another folder, or the Glint that made it")
        self._locks: int | None = None  # which a store that is only read does not have
        self._held: set[int] = set()
        self._guard = threading.Lock()
        self._count = itertools.count()

    def _begin(self, mark: pathlib.Path) -> None:
        if self.folder.exists() and (not self.folder.is_dir() or any(self.folder.iterdir())):
            # Another process may just be beginning it.
            if not self.folder.is_dir() or {path.name for path in self.folder.iterdir()} - {"points", "failures", "sweeps", "tmp", "locks", "index.sqlite", _MARK}:
                raise SweepError(f"{self.folder}: this folder is no store of sweeps and not empty: name another one with --store")
        try:
            for name in ("points", "failures", "sweeps", "tmp"):
                (self.folder / name).mkdir(parents=True, exist_ok=True)
            write_whole(mark, json.dumps({"schema": SCHEMA}) + "\n")
        except OSError as error:
            raise SweepError(f"{self.folder}: no store can be made here: {error.strerror}: name another folder with --store") from error

    def close(self) -> None:
        """Gives back all locks."""
        if self._locks is not None:
            os.close(self._locks)
            self._locks = None

    def check_writable(self) -> None:
        """Raises SweepError when this process may not change the store."""
        if not os.access(self.folder, os.W_OK):
            raise SweepError(f"{self.folder}: the store can only be read here: name another one with --store, or copy it")

    def point(self, id: str) -> pathlib.Path:
        """Returns the folder of a point, which may not exist yet."""
        return self.folder / "points" / id[:3] / id

    def has(self, id: str) -> bool:
        return os.path.isfile(self.point(id) / "point.json")

    def read(self, id: str) -> dict[str, Any]:
        """Returns the record of a point that the store has. Raises SchemaError when it is damaged."""
        return read_json(self.point(id) / "point.json")

    def failure(self, id: str) -> pathlib.Path:
        return self.folder / "failures" / id[:3] / f"{id}.json"

    def read_failure(self, id: str) -> dict[str, Any] | None:
        """Returns how a point failed, or None when it did not or its record is damaged."""
        try:
            record = read_json(self.failure(id))
        except (OSError, GlintError):
            return None
        return record if all(isinstance(record.get(name), kind) for name, kind in _OF_A_FAILURE.items()) else None

    def lock(self, id: str) -> bool:
        """Takes the lock of a point. Returns False when somebody else holds it."""
        place = int(id[:15], 16)
        with self._guard:
            if place in self._held:
                return False
            if not self._range(fcntl.F_WRLCK, place):
                return False
            self._held.add(place)
            return True

    def unlock(self, id: str) -> None:
        place = int(id[:15], 16)
        with self._guard:
            self._held.discard(place)
            self._range(fcntl.F_UNLCK, place)

    @contextlib.contextmanager
    def plans_kept_still(self) -> Iterator[None]:
        """Waits until nobody else changes which points the sweeps name, or removes what they do not name, and keeps it so."""
        with self._guard:
            self._range(fcntl.F_WRLCK, _PLANS, fcntl.F_OFD_SETLKW)
        try:
            yield
        finally:
            with self._guard:
                self._range(fcntl.F_UNLCK, _PLANS)

    def _range(self, kind: int, place: int, command: int = fcntl.F_OFD_SETLK) -> bool:
        if self._locks is None:
            self._locks = os.open(self.folder / "locks", os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
        # A lock of an open file description does not end when another one of the same process is closed.
        wanted = struct.pack("hhqqi4x", kind, os.SEEK_SET, place, 1, 0)
        try:
            fcntl.fcntl(self._locks, command, wanted)
        except OSError as error:
            if error.errno in (errno.EAGAIN, errno.EACCES):
                return False
            if error.errno not in _NO_LOCKS:
                raise
        return True

    def commit(self, id: str, files: dict[str, pathlib.Path], record: dict[str, Any]) -> None:
        """Puts a point into the store: some files, and point.json with the record. If somebody was faster, their point stays.

        Raises StoreFull when the store cannot take it. Nothing of the point is left then.
        """
        scratch = self.scratch(id)
        try:
            self._fill(scratch, files, record)
            self._appear(id, scratch)
        except OSError as error:
            raise self._full(error) from error
        finally:
            shutil.rmtree(scratch, ignore_errors=True)
        self.forget_failure(id)

    def _full(self, error: OSError) -> StoreFull:
        return StoreFull(f"{self.folder}: the store takes no further point: {error}\n  note: what is done stays, and `glint sweep resume` goes on when this is mended")

    def _fill(self, scratch: pathlib.Path, files: dict[str, pathlib.Path], record: dict[str, Any]) -> None:
        scratch.mkdir()
        for name, path in files.items():
            shutil.copyfile(path, scratch / name)
        (scratch / "point.json").write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
        for name in (*files, "point.json"):  # The first one mostly takes the others along.
            _sync(scratch / name)

    def _appear(self, id: str, scratch: pathlib.Path) -> None:
        place = self.point(id)
        place.parent.mkdir(exist_ok=True)
        try:
            os.rename(scratch, place)
        except OSError as error:
            if error.errno not in (errno.ENOTEMPTY, errno.EEXIST, errno.ENOTDIR):
                raise
            if not self.has(id):  # Something is there that is no point.
                self.discard(id)
                os.rename(scratch, place)

    def discard(self, id: str) -> None:
        """Removes a point, or what is in its place. No half of a point is ever in the store. The caller holds its lock."""
        scratch = self.scratch(id)
        os.rename(self.point(id), scratch)
        remove(scratch)

    def fail(self, id: str, record: dict[str, Any]) -> None:
        """Records how a point failed, in the place of an earlier failure."""
        place = self.failure(id)
        try:
            place.parent.mkdir(exist_ok=True)
            write_whole(place, json.dumps(record, indent=1) + "\n", self.scratch(id))
        except OSError as error:
            raise self._full(error) from error

    def forget_failure(self, id: str) -> None:
        self.failure(id).unlink(missing_ok=True)

    def failed(self) -> set[str]:
        """Returns the ids of all failed points. Their number counts, and not the number of points."""
        return {name[:-5] for folder in _entries(self.folder / "failures") for name in _names(folder) if name.endswith(".json")}

    def scratch(self, id: str) -> pathlib.Path:
        """Returns a name that nobody else uses. It says who uses it, so that gc knows what is left over."""
        return self.folder / "tmp" / f"{socket.gethostname()}-{os.getpid()}-{next(self._count)}-{id[:8]}"

    def damage(self, id: str) -> str:
        """Returns what is wrong with a point that is there, or an empty text. It reads all of its files."""
        try:
            for name, about in self.read(id)["files"].items():
                data = (self.point(id) / name).read_bytes()
                if len(data) != about["bytes"] or f"{zlib.crc32(data):08x}" != about["crc32"]:
                    return f"{name} is not as the run left it"
        except (OSError, GlintError, KeyError, TypeError, AttributeError) as error:
            return f"its record cannot be read: {error}"
        return ""

    def points(self) -> Iterator[str]:
        """Gives the ids of all points, and of what lies in their places. It reads every folder of the store."""
        for folder in _entries(self.folder / "points"):
            yield from (name for name in _names(folder) if re.fullmatch("[0-9a-f]{32}", name))

    def unpack(self, id: str, folder: str | pathlib.Path) -> pathlib.Path:
        """Makes a point's run directory again, for `glint report`, `glint compare` or `glint.Run`, and returns it."""
        folder = pathlib.Path(folder)
        if folder.exists() and any(folder.iterdir()):
            raise SweepError(f"{folder}: the folder is not empty")
        if damage := self.damage(id):
            raise SweepError(f"{self.point(id)}: the point is damaged: {damage}\n  note: `glint sweep gc --yes` removes it, and `glint sweep resume` runs it again")
        folder.mkdir(parents=True, exist_ok=True)
        try:
            with zipfile.ZipFile(self.point(id) / "run.zip") as packed:
                for name in packed.namelist():
                    if name.startswith("/") or ".." in pathlib.PurePosixPath(name).parts:
                        raise SweepError(f"{self.point(id)}/run.zip: the name {name!r} leaves the folder: the file is damaged")
                packed.extractall(folder)
        except (OSError, zipfile.BadZipFile) as error:
            raise SweepError(f"{self.point(id)}: the point cannot be unpacked: {error}") from error
        return folder

    def left_over(self) -> list[pathlib.Path]:
        """Returns scratch folders whose process has ended, or that are a day old when their host is another one."""
        out = []
        for path in _entries(self.folder / "tmp"):
            host, pid, *_ = path.name.rsplit("-", 3) if path.name.count("-") >= 3 else (path.name, "")
            try:
                here = host == socket.gethostname() and pid.isdigit()
                if (here and not os.path.exists(f"/proc/{pid}")) or (not here and time.time() - path.stat().st_mtime > _STALE):
                    out.append(path)
            except FileNotFoundError:
                pass
        return out


def write_whole(path: pathlib.Path, text: str, scratch: pathlib.Path | None = None) -> None:
    """Writes a file that is never seen half: under another name first, then renamed."""
    scratch = scratch or path.with_name(f".{path.name}.{socket.gethostname()}.{os.getpid()}.{threading.get_ident()}")
    try:
        scratch.write_text(text, encoding="utf-8")
        os.replace(scratch, path)
    except OSError as error:
        with contextlib.suppress(OSError):
            scratch.unlink(missing_ok=True)
        raise OSError(error.errno, error.strerror, str(path)) from error


def remove(path: pathlib.Path) -> None:
    """Removes a file or a folder, if it is there."""
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)


def _sync(path: pathlib.Path) -> None:
    with open(path, "rb") as file:
        os.fsync(file.fileno())


def _entries(folder: pathlib.Path) -> list[pathlib.Path]:
    return [folder / name for name in _names(folder)]


def _names(folder: pathlib.Path) -> list[str]:
    try:
        return sorted(os.listdir(folder))
    except (FileNotFoundError, NotADirectoryError):
        return []

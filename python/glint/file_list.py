# Compares files with the lengths and sums that their folder lists, so that a damaged file is noticed.
# SPDX-License-Identifier: Apache-2.0
"""`ListedFiles` reads "files" of run.json or bench.json, as report/files/file_list.cpp writes it."""
from __future__ import annotations

import pathlib
import zlib
from typing import Any

from .errors import SchemaError


class ListedFiles:
    """Holds what the files of a folder held when they were written.

    Args:
        directory: The folder.
        index: The name of the file that has the list.
        listed: The value of "files" in it, or None when an earlier version of Glint wrote none.
        advice: Says how to get whole files again.

    Raises SchemaError when the list is none.
    """

    def __init__(self, directory: pathlib.Path, index: str, listed: Any, advice: str):
        self.directory, self.index, self.advice = directory, index, advice
        self.is_known = listed is not None
        self._sums: dict[str, tuple[int, str]] = {}
        self._whole: set[str] = set()
        try:
            for name, entry in ({} if listed is None else listed).items():
                self._sums[name] = int(entry["bytes"]), str(entry["crc32"])
        except (AttributeError, KeyError, TypeError, ValueError) as error:
            raise SchemaError(f"{directory / index}: 'files' is no list of lengths and sums: the file is damaged") from error

    def check(self, name: str) -> None:
        """Raises SchemaError when the file has another length or other contents than the list says. A file is read once for this."""
        if name in self._whole or name not in self._sums:
            return
        path, (length, wanted) = self.directory / name, self._sums[name]
        data = path.read_bytes()
        found = f"{zlib.crc32(data):08x}"
        if len(data) != length:
            how = "it was cut short" if len(data) < length else "something was added to it"
            raise SchemaError(f"{path}: the file has {len(data)} bytes, and {self.index} says {length}: {how}: {self.advice}")
        if found != wanted:
            raise SchemaError(f"{path}: the contents of the file have CRC-32 {found}, and {self.index} says {wanted}: it was changed: {self.advice}")
        self._whole.add(name)

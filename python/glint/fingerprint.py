# Finds what a run depends on besides its command line: the program, the configuration's values, the contents of its files.
# SPDX-License-Identifier: Apache-2.0
"""`Fingerprints` tell a sweep whether a complete point would give the same result today."""
from __future__ import annotations

import pathlib
import re
from typing import Any

_NAMED = re.compile(rb'"([^"\n]{1,255})"|([\w./+-]+\.\w+)')  # files that a text may name: quoted, or a word with an ending
_SCANNED = 16 << 20  # bytes; only texts name other files, and texts are smaller


class Fingerprints:
    """Makes texts that differ when something that a run reads differs. Each file is read once."""

    def __init__(self, program: str):
        self._known: dict[str, str] = {"program": file_hash(pathlib.Path(program))}

    def of(self, workload: str, config: str) -> str:
        """Returns the fingerprint of a run. `config` is what `glint describe --points` calls the values of its configuration."""
        if workload not in self._known:
            self._known[workload] = " ".join(f"{path.name}:{file_hash(path)}" for path in files_of(pathlib.Path(workload)))
        return _sum(" ".join((self._known["program"], config, self._known[workload])))


def files_of(path: pathlib.Path) -> list[pathlib.Path]:
    """Returns a file and all files that it names directly or indirectly (shaders and meshes, their includes), or [] for a scene's name."""
    found: dict[pathlib.Path, None] = {}
    left = [path] if path.is_file() else []
    while left:
        one = left.pop()
        if one.resolve() in found:
            continue
        found[one.resolve()] = None
        if one.stat().st_size <= _SCANNED:
            names = {(quoted or word).decode("utf-8", "replace") for quoted, word in _NAMED.findall(one.read_bytes())}
            left += [one.parent / name for name in sorted(names) if "\0" not in name and _is_file(one.parent / name)]
    return sorted(found)


def _is_file(path: pathlib.Path) -> bool:
    try:
        return path.is_file()
    except OSError:  # the text cannot be a file's name
        return False


def _sum(text: str) -> str:
    import hashlib  # here, because loading it takes a twentieth of the time of a cluster's task to start, which hashes nothing
    return hashlib.sha256(text.encode()).hexdigest()


def file_hash(path: Any) -> str:
    """Returns the SHA-256 of a file."""
    import hashlib
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()

# Finds what a run depends on besides its command line: the program, the configuration's values, the contents of its files.
# SPDX-License-Identifier: Apache-2.0
"""`Fingerprints` tell a sweep whether a complete point would give the same result today."""
from __future__ import annotations

import pathlib
import re
import subprocess
from typing import Any, Mapping

from .errors import CommandFailed

_NAMED = re.compile(rb'"([^"\n]{1,255})"|([\w./+-]+\.\w+)')  # files that a text may name: quoted, or a word with an ending
_SCANNED = 16 << 20  # bytes; only texts name other files, and texts are smaller


class Fingerprints:
    """Makes texts that differ when something that a run reads differs. Each file is read once."""

    def __init__(self, program: str):
        self._program = program
        self._known: dict[str, str] = {"program": file_hash(pathlib.Path(program))}

    def of(self, workload: str, config: str, settings: Mapping[str, str]) -> str:
        """Returns the fingerprint of a run. Raises CommandFailed when the program refuses the configuration."""
        keys = f"config {config} {sorted(settings.items())}"
        if keys not in self._known:
            self._known[keys] = self._configuration(config, settings)
        if workload not in self._known:
            self._known[workload] = " ".join(f"{path.name}:{file_hash(path)}" for path in files_of(pathlib.Path(workload)))
        text = " ".join((self._known["program"], self._known[keys], self._known[workload]))
        return _sum(text)

    def _configuration(self, config: str, settings: Mapping[str, str]) -> str:
        words = [self._program, "describe", "--config", config]
        for key, value in settings.items():
            words += ["--set", f"{key}={value}"]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        if done.returncode:
            raise CommandFailed(f"{' '.join(words)}\nended with exit code {done.returncode}: {done.stderr.strip()}", done.returncode, done.stderr)
        return _sum(done.stdout)


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

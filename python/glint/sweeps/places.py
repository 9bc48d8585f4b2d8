# Finds the lines of a sweep's file that messages speak of.
# SPDX-License-Identifier: Apache-2.0
"""`Places(path, text).told(message)` puts "sweep.toml:7: " in front of a message."""
from __future__ import annotations

import re

_NAMED = re.compile(r"`([^`]+)`|'([^']+)'|\"([^\"]+)\"|(\[\[?[a-z.]+\]\]?)|--([a-z][a-z-]*)")
_KEY = re.compile(r"""["']?([A-Za-z0-9_][\w.-]*)["']?\s*=(?!=)""")


class Places:
    """Holds the lines of a file of TOML, with the keys that each of them gives a value.

    The reader of TOML in Python's library tells no lines, so that they are found by the names that a message quotes.
    """

    def __init__(self, path: str, text: str):
        self._path = path
        self._lines: list[tuple[str, str, list[str]]] = []  # its table, its text, and its keys
        table = ""
        for line in text.splitlines():
            text_of_line = "" if line.lstrip().startswith("#") else line
            if header := re.match(r"\s*\[\[?\s*([\w.\"' -]+?)\s*\]\]?\s*(?:#.*)?$", text_of_line):
                table = re.sub(r"[\"' ]", "", header[1])
            self._lines.append((table, text_of_line, [f"{table}.{key}" for key in _KEY.findall(text_of_line)]))

    def of(self, message: str) -> str:
        """Returns the file and the line that a message most likely speaks of, or the file alone where no name of the message is in it."""
        asked = re.split(r",? did you mean|\n\s*note:", message)[0]
        words = [next(filter(None, match)) for match in _NAMED.findall(asked)]
        scores = [sum(self._score(line, word) for word in words) for line in self._lines]
        best = max(scores, default=0)
        return f"{self._path}:{scores.index(best) + 1}" if best else self._path

    def told(self, message: str) -> str:
        """Returns the message behind its place."""
        return f"{self.of(message)}: {message}"

    @staticmethod
    def _score(line: tuple[str, str, list[str]], word: str) -> int:
        """Returns how much a line has to do with a word: most when it gives a key of that name a value."""
        table, text, keys = line
        if section := re.match(r"\[\[?([a-z.]+)\]\]?\s*", word):  # "[run]", or "[run] size"
            own = table == section[1] or table.startswith(f"{section[1]}.")
            rest = word[section.end():]
            return 0 if not own or not text.strip() else 1 + (Places._score(line, rest) if rest else 0)
        name = "." + word.replace("`", "")
        if any(key.replace("_", "-").endswith(name.replace("_", "-")) for key in keys):
            return 4
        return 1 if word in text else 0

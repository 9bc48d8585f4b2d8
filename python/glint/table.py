# Reads a table from a CSV file: columns of numbers and text, and a DataFrame if pandas is there.
# SPDX-License-Identifier: Apache-2.0
"""Series, profiles, metrics and the files of `glint characterize` are such tables."""
from __future__ import annotations

import csv
import io
import pathlib
import re
from typing import Any, Iterator

from .documents import read_text
from .errors import SchemaError, UnknownName
from .optional import require
from .patterns import near

# These stay text: a workload may be called 001.
_NAMES = {"workload", "scene", "form", "shader", "config", "config_hash", "metric", "component", "by", "stage", "op", "file", "name", "run"}
_INTEGER = re.compile(r"[+-]?[0-9]+")
_FLOAT = re.compile(r"[+-]?(?:(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|inf|nan|-nan)")


class Table:
    """Holds columns by name. A cell is an int, a float, a string, or None when it is empty. Columns of names hold strings.

    Attributes:
        columns: The names, in order.
    """

    def __init__(self, columns: list[str], rows: list[list[Any]]):
        self.columns = columns
        self._rows = rows

    @classmethod
    def read(cls, path: pathlib.Path, needs: tuple[str, ...] = (), whole: bool = False) -> Table:
        """Reads a CSV file with a header line. Raises SchemaError when a column of `needs` is missing or a row is cut short.

        With `whole` the last line needs a line end, too, because a number that was cut short is still a number.
        """
        text = read_text(path)
        try:
            lines = list(csv.reader(io.StringIO(text, newline="")))
        except csv.Error as error:
            raise SchemaError(f"{path}: this is not a table: {error}") from error
        if not lines:
            raise SchemaError(f"{path}: the file is empty")
        if whole and not text.endswith("\n"):
            raise SchemaError(f"{path}:{len(lines)}: the last line has no end: the file was cut short")
        header = lines[0]
        for number, line in enumerate(lines[1:], 2):
            if len(line) != len(header):
                raise SchemaError(f"{path}:{number}: {len(line)} fields, but the header has {len(header)}: the file is damaged or was cut short")
        missing = [name for name in needs if name not in header]
        if missing:
            raise SchemaError(f"{path}: there is no column {', '.join(missing)}: another version of Glint wrote the file")
        reads = [_text if name in _NAMES else _cell for name in header]
        return cls(header, [[read(cell) for read, cell in zip(reads, line)] for line in lines[1:]])

    def __len__(self) -> int:
        return len(self._rows)

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return (dict(zip(self.columns, row)) for row in self._rows)

    def __getitem__(self, column: str) -> list[Any]:
        """Returns a column as a list. Raises UnknownName when there is no such column."""
        at = self._index(column)
        return [row[at] for row in self._rows]

    def where(self, **equal: Any) -> Table:
        """Returns the rows in which each named column has the given value. Raises UnknownName when there is no such column."""
        at = {self._index(name): value for name, value in equal.items()}
        return Table(self.columns, [row for row in self._rows if all(row[i] == value for i, value in at.items())])

    def _index(self, column: str) -> int:
        if column not in self.columns:
            raise UnknownName(f"there is no column '{column}'{near(column, self.columns)} The columns are: {', '.join(self.columns)}")
        return self.columns.index(column)

    def frame(self) -> Any:
        """Returns a pandas.DataFrame. Raises MissingPackage without pandas."""
        return require("pandas", "Table.frame()").DataFrame(self._rows, columns=self.columns)


def _text(text: str) -> str | None:
    return text or None


def _cell(text: str) -> Any:
    if _INTEGER.fullmatch(text):
        return int(text)
    if _FLOAT.fullmatch(text):
        return float(text)
    return text or None

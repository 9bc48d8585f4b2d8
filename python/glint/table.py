# A table read from a CSV file: columns of numbers and text, without pandas; with it, a DataFrame.
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

_NAMES = {"workload", "scene", "form", "shader", "config", "config_hash", "metric", "component", "by", "stage", "op", "file", "name", "run"}  # a workload may be called 001
_INTEGER = re.compile(r"[+-]?[0-9]+")
_FLOAT = re.compile(r"[+-]?(?:(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|inf|nan|-nan)")


class Table:
    """Columns by name; a cell is an int, a float, a string, or None where it is empty. Columns of names hold strings.

    Attributes:
        columns: names, in order.
    """

    def __init__(self, columns: list[str], rows: list[list[Any]]):
        self.columns = columns
        self._rows = rows

    @classmethod
    def read(cls, path: pathlib.Path, needs: tuple[str, ...] = (), whole: bool = False) -> Table:
        """Reads a CSV file with a header line; SchemaError when a column of `needs` is missing or a row is cut short.

        With `whole` the last line has to be ended too: numbers that were cut short are numbers.
        """
        text = read_text(path)
        try:
            lines = list(csv.reader(io.StringIO(text, newline="")))
        except csv.Error as error:
            raise SchemaError(f"{path}: no table: {error}") from error
        if not lines:
            raise SchemaError(f"{path}: empty")
        if whole and not text.endswith("\n"):
            raise SchemaError(f"{path}:{len(lines)}: the last line has no end: the file was cut short")
        header = lines[0]
        for number, line in enumerate(lines[1:], 2):
            if len(line) != len(header):
                raise SchemaError(f"{path}:{number}: {len(line)} fields, {len(header)} expected: the file is damaged or was cut short")
        missing = [name for name in needs if name not in header]
        if missing:
            raise SchemaError(f"{path}: no column {', '.join(missing)}: written by another version of Glint")
        reads = [_text if name in _NAMES else _cell for name in header]
        return cls(header, [[read(cell) for read, cell in zip(reads, line)] for line in lines[1:]])

    def __len__(self) -> int:
        return len(self._rows)

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return (dict(zip(self.columns, row)) for row in self._rows)

    def __getitem__(self, column: str) -> list[Any]:
        """A column as a list; UnknownName where there is none."""
        at = self._index(column)
        return [row[at] for row in self._rows]

    def where(self, **equal: Any) -> Table:
        """The rows in which each named column has the given value; UnknownName where there is no such column."""
        at = {self._index(name): value for name, value in equal.items()}
        return Table(self.columns, [row for row in self._rows if all(row[i] == value for i, value in at.items())])

    def _index(self, column: str) -> int:
        if column not in self.columns:
            raise UnknownName(f"no column '{column}'{near(column, self.columns)} There are: {', '.join(self.columns)}")
        return self.columns.index(column)

    def frame(self) -> Any:
        """A pandas.DataFrame; MissingPackage without pandas."""
        return require("pandas", "Table.frame()").DataFrame(self._rows, columns=self.columns)


def _text(text: str) -> str | None:
    return text or None


def _cell(text: str) -> Any:
    if _INTEGER.fullmatch(text):
        return int(text)
    if _FLOAT.fullmatch(text):
        return float(text)
    return text or None

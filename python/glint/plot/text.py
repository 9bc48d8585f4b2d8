# Measures text in figures, and breaks long names so that they fit.
# SPDX-License-Identifier: Apache-2.0
"""Widths are measured with the font before anything is drawn, and a figure grows by what its names need."""
from __future__ import annotations

import dataclasses
import functools
import re
from typing import Sequence

from ..optional import require

LINE = 1.3  # height of a line over the size of its type, as matplotlib stacks lines, with a little space
_SOFT = re.compile(r".+?(?: · |, |$)")  # between the words of a label
_SPACE = re.compile(r".+?(?: |$)")
_HARD = re.compile(r".+?(?:[ ._/=-]|$)")  # within a word that is too long for a line


@functools.lru_cache(maxsize=65536)
def width_of(text: str, size: float) -> float:
    """Returns the width in inches of a line of text of `size` points."""
    if not text.strip():
        return 0.0
    paths, fonts = require("matplotlib.textpath", "glint.plot"), require("matplotlib.font_manager", "glint.plot")
    width, _, _ = paths.text_to_path.get_text_width_height_descent(text, fonts.FontProperties(size=size), ismath=False)
    return float(width) / 72


def wrapped(text: str, inches: float, size: float, breaks: Sequence[re.Pattern[str]] = (_SOFT, _SPACE, _HARD)) -> list[str]:
    """Returns the lines of a text, none wider than `inches` if its words allow it. Lines break between words, and within a word only if it is too long."""
    lines = [""]
    for piece in _pieces(text, inches, size, breaks):
        if lines[-1] and width_of((lines[-1] + piece).rstrip(" ·"), size) > inches:
            lines.append("")
        lines[-1] += piece
    return [line.rstrip(" ·") for line in lines]


def _pieces(text: str, inches: float, size: float, breaks: Sequence[re.Pattern[str]]) -> list[str]:
    if not breaks:
        return [text]
    out = []
    for piece in breaks[0].findall(text):
        out += [piece] if width_of(piece.rstrip(" ·"), size) <= inches else _pieces(piece, inches, size, breaks[1:])
    return out


@dataclasses.dataclass(frozen=True)
class Fitted:
    """Holds names as they are drawn.

    Attributes:
        texts: The names with line breaks.
        size: The size of the type in points.
        lines: The number of lines of the longest name.
        width, height: The size in inches of the largest name before it is turned.
        upright: Whether the names are turned by 90 degrees.
    """
    texts: list[str]
    size: float
    lines: int
    width: float
    height: float
    upright: bool = False

    @property
    def below(self) -> float:
        """Returns the height in inches that the names take below an axis."""
        return self.width if self.upright else self.height


def fitted(names: Sequence[str], inches: float, size: float, upright: bool = False, breaks: Sequence[re.Pattern[str]] = (_SOFT, _SPACE, _HARD)) -> Fitted:
    """Returns the names in lines of at most `inches`, if their words allow it."""
    split = [wrapped(name, inches, size, breaks) for name in names]
    lines = max((len(one) for one in split), default=1)
    width = max((width_of(line, size) for one in split for line in one), default=0.0)
    return Fitted(["\n".join(one) for one in split], size, lines, width, lines * size * LINE / 72, upright)


def below_groups(names: Sequence[str], each: float, size: float) -> Fitted:
    """Returns names below groups of bars `each` inches wide: side by side if their words fit, otherwise upright in as few inches as possible."""
    flat = fitted(names, 0.94 * each, size, breaks=(_SOFT, _SPACE))
    if flat.width <= 0.97 * each and flat.lines <= 4:
        return flat
    for inches in (1.2, 1.5, 1.9, 2.4):
        found = fitted(names, inches, size, upright=True)
        if found.height <= max(each, size * LINE / 72):
            return found
    return fitted(names, 1e3, size, upright=True)

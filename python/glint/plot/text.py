# Text in figures: how wide it is, and where long names are broken so that they fit.
# SPDX-License-Identifier: Apache-2.0
"""Widths are measured with the font, before anything is drawn: a figure grows by what its names need."""
from __future__ import annotations

import dataclasses
import functools
import re
from typing import Sequence

from ..optional import require

LINE = 1.3  # a line's height over the size of its type, as matplotlib stacks them, and a little air
_SOFT = re.compile(r".+?(?: · |, |$)")  # between the words of a label
_SPACE = re.compile(r".+?(?: |$)")
_HARD = re.compile(r".+?(?:[ ._/=-]|$)")  # within a word that is too long for a line


@functools.lru_cache(maxsize=65536)
def width_of(text: str, size: float) -> float:
    """Inches that a line of text of `size` points takes."""
    if not text.strip():
        return 0.0
    paths, fonts = require("matplotlib.textpath", "glint.plot"), require("matplotlib.font_manager", "glint.plot")
    width, _, _ = paths.text_to_path.get_text_width_height_descent(text, fonts.FontProperties(size=size), ismath=False)
    return float(width) / 72


def wrapped(text: str, inches: float, size: float, breaks: Sequence[re.Pattern[str]] = (_SOFT, _SPACE, _HARD)) -> list[str]:
    """The lines of a text, none wider than `inches` where its words allow: broken between words, within them only where one is too long."""
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
    """Names as they are drawn.

    Attributes:
        texts: with line breaks.
        size: of the type, in points.
        lines: of the longest.
        width, height: inches that the largest takes, unturned.
        upright: turned by 90 degrees.
    """
    texts: list[str]
    size: float
    lines: int
    width: float
    height: float
    upright: bool = False

    @property
    def below(self) -> float:
        """Inches that they take below an axis."""
        return self.width if self.upright else self.height


def fitted(names: Sequence[str], inches: float, size: float, upright: bool = False, breaks: Sequence[re.Pattern[str]] = (_SOFT, _SPACE, _HARD)) -> Fitted:
    """The names in lines of at most `inches`, where their words allow."""
    split = [wrapped(name, inches, size, breaks) for name in names]
    lines = max((len(one) for one in split), default=1)
    width = max((width_of(line, size) for one in split for line in one), default=0.0)
    return Fitted(["\n".join(one) for one in split], size, lines, width, lines * size * LINE / 72, upright)


def below_groups(names: Sequence[str], each: float, size: float) -> Fitted:
    """Names below groups of bars `each` inches wide: beside each other where their words fit, else upright in as few inches as fit."""
    flat = fitted(names, 0.94 * each, size, breaks=(_SOFT, _SPACE))
    if flat.width <= 0.97 * each and flat.lines <= 4:
        return flat
    for inches in (1.2, 1.5, 1.9, 2.4):
        found = fitted(names, inches, size, upright=True)
        if found.height <= max(each, size * LINE / 72):
            return found
    return fitted(names, 1e3, size, upright=True)

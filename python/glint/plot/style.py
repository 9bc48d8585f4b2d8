# Defines how figures look: one column of a two-column paper, Okabe and Ito's colours, small sans-serif type.
# SPDX-License-Identifier: Apache-2.0
"""Sets sizes and colours of all figures, and saves figures."""
from __future__ import annotations

import contextlib
import pathlib
from typing import Any, Iterator, Sequence

from ..errors import GlintError
from ..optional import require
from .text import fitted, width_of

COLUMN = 3.3  # inches, slightly less than the width of a column in IEEE and ACM papers
# The colours are those of Okabe and Ito (2008), "Color Universal Design"; grey, pale and dark are neutral.
COLOURS = {"blue": "#0072B2", "sky": "#56B4E9", "green": "#009E73", "orange": "#E69F00", "red": "#D55E00", "pink": "#CC79A7",
           "yellow": "#F0E442", "grey": "#8A929C", "pale": "#D3D7DC", "dark": "#454C55"}
RUN_COLOURS = ["blue", "orange", "green", "pink", "sky", "red", "yellow", "dark"]
_SETTINGS = {
    "font.size": 7, "axes.titlesize": 7, "axes.labelsize": 7, "xtick.labelsize": 6.5, "ytick.labelsize": 6.5, "legend.fontsize": 6.5,
    "axes.linewidth": 0.5, "xtick.major.width": 0.5, "ytick.major.width": 0.5, "xtick.major.size": 2, "ytick.major.size": 2,
    "axes.spines.top": False, "axes.spines.right": False, "axes.axisbelow": True, "legend.frameon": False,
    "legend.handlelength": 0.9, "legend.handleheight": 0.9, "legend.columnspacing": 0.9, "legend.handletextpad": 0.4,
    "lines.linewidth": 0.9, "pdf.fonttype": 42, "svg.fonttype": "none", "savefig.dpi": 300,
}  # fonttype 42 keeps text as text, which publishers ask for


def run_colour(index: int) -> str:
    """Returns the colour of the index-th run or series. The colours repeat after eight."""
    return COLOURS[RUN_COLOURS[index % len(RUN_COLOURS)]]


@contextlib.contextmanager
def styled() -> Iterator[None]:
    """Applies the settings of this package to figures made within the context."""
    with require("matplotlib", "glint.plot").rc_context(_SETTINGS):
        yield


def new_figure(height: float, rows: int = 1, columns: int = 1, width: float = COLUMN, **options: Any) -> tuple[Any, Any]:
    """Returns a figure of `width` x `height` inches, and its axes (an array if there are several)."""
    figure = require("matplotlib.figure", "glint.plot").Figure(figsize=(width, height), layout="constrained", dpi=150)
    figure.get_layout_engine().set(w_pad=0.02, h_pad=0.02)
    return figure, figure.subplots(rows, columns, **options)


def legend(figure: Any, handles: Sequence[Any], names: Sequence[str]) -> None:
    """Adds a legend above the axes, with as many columns as fit into the width. The figure grows by the legend's height."""
    size, beside = _SETTINGS["legend.fontsize"], 0.22  # inches: the colour, and the space between columns
    room = figure.get_figwidth() - 0.1
    found = fitted(names, room - beside, size)
    widths = [max(width_of(line, size) for line in text.split("\n")) + beside for text in found.texts]
    for rows in range(1, len(names) + 1):  # matplotlib fills column by column
        columns = -(-len(names) // rows)
        if sum(max(widths[at:at + rows]) for at in range(0, len(names), rows)) <= room:
            break
    heights = [(1.28 + 1.22 * text.count("\n")) * size / 72 for text in found.texts]  # a line with its spacing, and further lines
    extra = 0.06 + max(sum(heights[at:at + rows]) for at in range(0, len(names), rows))
    height = figure.get_figheight() + extra
    figure.set_figheight(height)
    figure.get_layout_engine().set(rect=(0, 0, 1, 1 - extra / height))
    figure.legend(handles, found.texts, loc="upper center", ncols=columns, borderaxespad=0, borderpad=0.2, labelspacing=0.25)


def save(figure: Any, path: str | pathlib.Path) -> pathlib.Path:
    """Writes .pdf, .svg or .png, with the same bytes each time, and makes the folder. Returns the path. Raises GlintError for other endings."""
    path = pathlib.Path(path)
    if path.suffix not in (".pdf", ".svg", ".png"):
        raise GlintError(f"{path}: figures are .pdf, .svg or .png")
    path.parent.mkdir(parents=True, exist_ok=True)
    dates = {".pdf": {"CreationDate": None}, ".svg": {"Date": None}}  # a date would change the bytes
    with require("matplotlib", "glint.plot").rc_context({**_SETTINGS, "svg.hashsalt": "glint"}):
        figure.savefig(path, metadata=dates.get(path.suffix))
    return path

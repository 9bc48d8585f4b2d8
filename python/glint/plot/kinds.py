# Draws the few kinds of charts of which all figures consist: stacked bars, grouped bars, lines in panels, histograms, spreads.
# SPDX-License-Identifier: Apache-2.0
"""Each function takes plain numbers and computes shares itself. It makes a figure, or draws into given axes."""
from __future__ import annotations

import dataclasses
from typing import Any, Sequence

from .style import COLOURS, COLUMN, legend, new_figure, run_colour, styled
from .text import Fitted, below_groups, fitted, wrapped

MOST_GROUPS = 24  # groups that fit into the width of a column; a whole suite takes both columns
MOST_ROWS = 48  # rows that fit into the height of a page
_PAGE = 8.5  # inches that rows may take on a page


@dataclasses.dataclass(frozen=True)
class Part:
    """Holds a part of stacked bars: its name, its colour and its value in each row."""
    name: str
    colour: str
    values: Sequence[float]


def stacked(rows: Sequence[str], parts: Sequence[Part], x_label: str, share: bool = True, width: float = COLUMN,
            scale: Sequence[float] | None = None, key: bool = True) -> Any:
    """Draws horizontal stacked bars, the first row at the top. With `share` each row adds up to 100 %, and `scale` gives other lengths.

    `key` adds a legend. If a page has no room for all rows, they are split into two halves side by side, over both columns.
    """
    used = [part for part in parts if any(part.values)]
    totals = [sum(part.values[i] for part in used) for i in range(len(rows))]
    lengths = scale if scale is not None else [100.0] * len(rows) if share else totals
    sheet = _Rows(rows, width)
    with styled():
        figure, axes = new_figure(0.36 + sheet.height, columns=sheet.halves, width=sheet.width, squeeze=False)
        handles: list[Any] = []
        for half in range(sheet.halves):
            some = sheet.half(half)
            handles = _stack(axes[0, half], some, used, [length / all_of if all_of else 0.0 for length, all_of in zip(lengths, totals)])
            sheet.draw(axes[0, half], half, max(lengths, default=1) or 1, x_label)
        if key:
            legend(figure, handles, [part.name for part in used])
        return figure


def panels(rows: Sequence[str], measures: Sequence[tuple[str, Sequence[Part], Sequence[float]]], x_label: str) -> Any:
    """Draws horizontal stacked bars of several measures, (name, parts, wholes) each, in axes side by side. A bar's length is its share of the whole.

    The parts of all measures have the same names and colours. If a page has no room for all rows, they are split into two halves, over both columns.
    """
    shown = [i for i, part in enumerate(measures[0][1]) if any(any(parts[i].values) for _, parts, _ in measures)]
    longest = max((100 * sum(part.values[i] for part in parts) / wholes[i] for _, parts, wholes in measures for i in range(len(rows)) if wholes[i]), default=1)
    sheet = _Rows(rows, COLUMN, beside=len(measures))
    with styled():
        figure, axes = new_figure(0.5 + sheet.height, columns=sheet.halves * len(measures), width=sheet.width, squeeze=False)
        handles: list[Any] = []
        for half in range(sheet.halves):
            some = sheet.half(half)
            for index, (name, parts, wholes) in enumerate(measures):
                own = axes[0, half * len(measures) + index]
                handles = _stack(own, some, [parts[i] for i in shown], [100 / whole if whole else 0.0 for whole in wholes])
                sheet.draw(own, half, longest, x_label, named=index == 0)
                own.set_title(name)
        legend(figure, handles, [measures[0][1][i].name for i in shown])
        return figure


class _Rows:
    """Lays out rows of horizontal bars: how their names are broken, how high they are, and into how many halves they are split.

    Attributes:
        halves: 2 when the figure uses both columns of a page, else 1.
        width: The width of the figure in inches.
        height: The height of all rows in inches.
    """

    def __init__(self, rows: Sequence[str], width: float, beside: int = 1):
        self.count, self.beside = len(rows), beside
        for self.halves in (1, 2):
            self.width = width if self.halves == 1 else 2.1 * COLUMN
            each = -(-len(rows) // self.halves)
            self.many = each > MOST_GROUPS  # a whole suite has smaller rows and type
            share = 0.42 if beside == 1 else 0.36
            self.names = fitted(rows, share * self.width / self.halves, 5 if self.many else 6.5)
            least, air = (0.1, 0.03) if self.many else (0.17, 0.07)
            self.row = max(least, self.names.height + air)
            self.height = self.row * max(2, each)
            if each <= MOST_ROWS and self.height <= _PAGE:
                break
        self.each = each

    def half(self, index: int) -> range:
        return range(index * self.each, min(self.count, (index + 1) * self.each))

    def draw(self, axes: Any, half: int, longest: float, x_label: str, named: bool = True) -> None:
        """Sets names, scale and label of the axes of a half."""
        some = self.half(half)
        axes.set_yticks(range(len(some)), [self.names.texts[i] if named else "" for i in some])
        axes.tick_params(axis="y", length=0, labelsize=self.names.size)
        axes.set_ylim(max(len(some), self.each if self.halves > 1 else 0) - 0.4, -0.6)  # rows of both halves have the same height
        axes.set_xlim(0, longest * 1.001)
        room = (self.width / self.halves - self.names.width - 0.2) / self.beside - 0.05
        axes.set_xlabel("\n".join(wrapped(x_label, room, 7)))
        axes.grid(axis="x", color=COLOURS["pale"], linewidth=0.4)


def _stack(axes: Any, rows: range, parts: Sequence[Part], factors: Sequence[float]) -> list[Any]:
    """Draws the rows' bars, each value times the factor of its row. Returns a handle for each part."""
    left, handles = [0.0] * len(rows), []
    for part in parts:
        values = [factors[i] * part.values[i] for i in rows]
        handles.append(axes.barh(range(len(rows)), values, 0.72, left, color=COLOURS[part.colour], linewidth=0))
        left = [a + b for a, b in zip(left, values)]
    return handles


def grouped(groups: Sequence[str], series: Sequence[Part], y_label: str, axes: Any = None, percent: bool = False, top: float | None = None) -> Any:
    """Draws vertical bars side by side, with a group for each label. None leaves a gap. Without `axes` it makes a figure with a legend."""
    with styled():
        names = group_names(groups)
        figure, own = (None, axes) if axes is not None else new_figure(1.4 + names.below, width=width_for(len(groups)))
        wide = 0.8 / max(1, len(series))
        factor = 100 if percent else 1
        handles = []
        for index, one in enumerate(series):
            places = [place - 0.4 + wide * (index + 0.5) for place in range(len(groups))]
            values = [factor * value if value is not None else 0 for value in one.values]
            handles.append(own.bar(places, values, wide * 0.94, color=COLOURS.get(one.colour, one.colour), linewidth=0))
        if len(groups) < 3:  # the bars of a single run do not fill the figure
            own.set_xlim(-1.1, len(groups) + 0.1)
        else:
            own.set_xlim(-0.6, len(groups) - 0.4)
        own.set_xticks(range(len(groups)), names.texts, rotation=90 if names.upright else 0, fontsize=names.size)
        own.tick_params(axis="x", length=0)
        own.set_ylabel(y_label)
        own.set_ylim(0, top)
        own.grid(axis="y", color=COLOURS["pale"], linewidth=0.4)
        if figure is not None and len(series) > 1:
            legend(figure, handles, [one.name for one in series])
        return figure if figure is not None else handles


def group_names(groups: Sequence[str]) -> Fitted:
    """Returns the names of groups of bars as `grouped` sets them. A figure needs `below` inches for them."""
    each = (width_for(len(groups)) - 0.55) / (len(groups) if len(groups) > 2 else len(groups) + 1.2)
    return below_groups(groups, each, 5 if len(groups) > MOST_GROUPS else 6.5)


def ranked(rows: Sequence[str], series: Sequence[Part], x_label: str, percent: bool = False) -> Any:
    """Draws horizontal bars: a row for each label, and in it a bar for each series. The first row is at the top."""
    with styled():
        thick = 0.8 / max(1, len(series))
        figure, axes = new_figure(0.36 + max(0.14, 0.08 * len(series)) * max(2, len(rows)))
        handles = []
        for index, one in enumerate(series):
            places = [place - 0.4 + thick * (index + 0.5) for place in range(len(rows))]
            values = [(100 if percent else 1) * value if value is not None else 0 for value in one.values]
            handles.append(axes.barh(places, values, thick * 0.94, color=COLOURS.get(one.colour, one.colour), linewidth=0))
        axes.set_yticks(range(len(rows)), rows)
        axes.tick_params(axis="y", length=0)
        axes.set_ylim(len(rows) - 0.4, -0.6)
        axes.set_xlabel("\n".join(wrapped(x_label, COLUMN - 0.3 - fitted(rows, COLUMN, 6.5).width, 7)))
        axes.grid(axis="x", color=COLOURS["pale"], linewidth=0.4)
        if len(series) > 1:
            legend(figure, handles, [one.name for one in series])
        return figure


def width_for(groups: int) -> float:
    """Returns the width in inches: one column, or both for a whole suite."""
    return COLUMN if groups <= MOST_GROUPS else 2.1 * COLUMN


def lines(panels: Sequence[tuple[str, Sequence[tuple[str, Sequence[float], Sequence[float]]]]], x_label: str) -> Any:
    """Draws panels above each other, (label, [(name, x, y), ...]) each. The lines are steps from 0 on; each value holds until its x."""
    with styled():
        figure, axes = new_figure(0.55 + 0.72 * len(panels), rows=len(panels), sharex=True, squeeze=False)
        handles = []
        for panel, (label, series) in zip(axes[:, 0], panels):
            handles = [panel.step([0, *x], [*y[:1], *y], where="pre", color=run_colour(i))[0] for i, (_, x, y) in enumerate(series)]
            panel.set_ylabel(label)
            panel.set_ylim(bottom=0)
            panel.grid(color=COLOURS["pale"], linewidth=0.4)
        figure.align_ylabels(axes[:, 0])
        axes[-1, 0].set_xlabel(x_label)
        axes[-1, 0].set_xlim(left=0)
        names = [name for name, _, _ in panels[0][1]] if panels else []
        if len(names) > 1:
            legend(figure, handles, names)
        return figure


def histogram(series: Sequence[tuple[str, str, Any]], x_label: str, y_label: str) -> Any:
    """Draws histograms, (name, colour, statistics.Histogram) each, as shares of their own sums. Bins beyond 99.5 % of all values are cut off."""
    with styled():
        figure, axes = new_figure(1.5)
        handles, right = [], 0.0
        for _, colour, one in series:
            total = sum(one.counts) or 1
            handles.append(axes.stairs([100 * count / total for count in one.counts], one.edges, color=COLOURS.get(colour, colour), linewidth=0.9))
            seen = 0.0
            for edge, count in zip(one.edges[1:], one.counts):
                seen += count
                if seen >= 0.995 * total:
                    right = max(right, edge)
                    break
        axes.set_xlim(0, right or None)
        axes.set_ylim(bottom=0)
        axes.set_xlabel(x_label)
        axes.set_ylabel(y_label)
        axes.grid(axis="y", color=COLOURS["pale"], linewidth=0.4)
        if len(series) > 1:
            legend(figure, handles, [name for name, _, _ in series])
        return figure


def spread(rows: Sequence[str], histograms: Sequence[Any], x_label: str) -> Any:
    """Draws a row for each histogram: a line from the 5th to the 95th percentile, a bar over the middle half, a mark at the median.

    A line that ends in the last bin, which is open, has an arrow at its end, because the percentile may be larger.
    """
    sheet = _Rows(rows, COLUMN)
    marks = [[quantile(one, share) for share in (0.05, 0.25, 0.5, 0.75, 0.95)] for one in histograms]
    longest = max((mark[-1] for mark in marks), default=1) or 1
    beyond = [sum(one.counts) > 0 and one.counts[-1] > 0.05 * sum(one.counts) for one in histograms]
    with styled():
        figure, axes = new_figure(0.36 + sheet.height, columns=sheet.halves, width=sheet.width, squeeze=False)
        handles: list[Any] = []
        for half in range(sheet.halves):
            own, some = axes[0, half], sheet.half(half)
            outer = own.hlines(range(len(some)), [marks[i][0] for i in some], [marks[i][4] for i in some], color=COLOURS["grey"], linewidth=0.7)
            inner = own.barh(range(len(some)), [marks[i][3] - marks[i][1] for i in some], 0.6, [marks[i][1] for i in some], color=COLOURS["sky"], linewidth=0)
            middle = own.plot([marks[i][2] for i in some], range(len(some)), "|", color=COLOURS["dark"], markersize=60 * sheet.row * 0.6, markeredgewidth=0.9)[0]
            ends = own.plot([marks[i][4] for i in some if beyond[i]], [place for place, i in enumerate(some) if beyond[i]], ">", color=COLOURS["grey"], markersize=2.5, linewidth=0)[0]
            handles = [outer, inner, middle, ends]
            sheet.draw(own, half, 1.02 * longest, x_label)
        shown = 4 if any(beyond) else 3
        legend(figure, handles[:shown], ["5 to 95 %", "25 to 75 %", "median", "or more"][:shown])
        return figure


def quantile(histogram: Any, share: float) -> float:
    """Returns the value below which `share` of a histogram lies, as if its bins were filled evenly, or 0 for an empty histogram."""
    wanted, seen = share * sum(histogram.counts), 0.0
    for low, high, count in zip(histogram.edges, histogram.edges[1:], histogram.counts):
        if count and seen + count >= wanted:
            return float(low + (high - low) * (wanted - seen) / count)
        seen += count
    return 0.0

# Draws the figures of the report as SVG: bars, lines, points, a tree, and radar diagrams.
# SPDX-License-Identifier: Apache-2.0
"""Each function returns the text of one `<svg>`. Numbers that are None leave a gap."""
from __future__ import annotations

import html
import math
from typing import Sequence

COLOURS = ("#3465a4", "#d9822b", "#5b9a52", "#a8435a", "#7a5ca8", "#8a6d3b", "#3f9aa5", "#888888")
Values = Sequence[float | None]


def _svg(width: float, height: float, body: list[str]) -> str:
    return f'<svg viewBox="0 0 {width:.0f} {height:.0f}" width="{width:.0f}" height="{height:.0f}" font-size="10">{"".join(body)}</svg>'


def _text(x: float, y: float, text: str, more: str = "") -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" {more}>{html.escape(text)}</text>'


def short(value: float) -> str:
    for limit, unit in ((1e9, "G"), (1e6, "M"), (1e4, "k")):
        if abs(value) >= limit:
            return f"{value / (1e3 if unit == 'k' else limit):.3g}{unit}"
    return f"{value:.3g}"


def _legend(labels: Sequence[str], x: float) -> list[str]:
    out = []
    for index, label in enumerate(labels):
        out.append(f'<rect x="{x:.0f}" y="2" width="9" height="9" fill="{COLOURS[index % len(COLOURS)]}"/>' + _text(x + 12, 10, label))
        x += 24 + 6 * len(label)
    return out


def _axis(left: float, top: float, width: float, height: float, most: float) -> list[str]:
    out = []
    for part in range(5):
        y = top + height * (1 - part / 4)
        out.append(f'<line x1="{left}" x2="{left + width:.1f}" y1="{y:.1f}" y2="{y:.1f}" stroke="#ddd"/>' + _text(left - 4, y + 3, short(most * part / 4), 'text-anchor="end"'))
    return out


def bars(names: Sequence[str], series: dict[str, Values], *, stacked: bool = False, logarithmic: bool = False) -> str:
    """Draws a group of bars for each name, beside each other or stacked."""
    left, top, height, each = 52.0, 18.0, 130.0, 26.0 if stacked else 10.0 * len(series) + 8
    rows = list(series.values())

    def scaled(value: float | None) -> float:
        value = value or 0.0
        return math.log10(max(value, 1.0)) if logarithmic else value
    heights = [[scaled(row[i]) for row in rows] for i in range(len(names))]
    most = max([sum(column) if stacked else max(column, default=0) for column in heights] or [0]) or 1.0
    body = _legend(list(series), left)
    if logarithmic:
        body += [_text(left - 4, top + height * (1 - power / most) + 3, short(10.0 ** power), 'text-anchor="end"') for power in range(0, int(most) + 1, max(1, int(most) // 4))]
    else:
        body += _axis(left, top, each * len(names), height, most)
    wide = each - 6 if stacked else (each - 8) / max(len(rows), 1)
    for i, name in enumerate(names):
        x, y = left + i * each + 3, top + height
        for k, value in enumerate(heights[i]):
            tall = height * value / most
            y = (y if stacked else top + height) - tall
            title = f"{name}, {list(series)[k]}: {'none' if rows[k][i] is None else short(rows[k][i] or 0)}"
            body.append(f'<rect x="{x + (0 if stacked else k * wide):.1f}" y="{y:.1f}" width="{wide:.1f}" height="{tall:.1f}" fill="{COLOURS[k % len(COLOURS)]}"><title>{html.escape(title)}</title></rect>')
        at = (left + (i + 0.5) * each, top + height + 8)
        body.append(_text(*at, name, f'transform="rotate(60 {at[0]:.1f} {at[1]:.1f})"'))
    return _svg(left + each * len(names) + 30, top + height + 70, body)


def lines(series: dict[str, list[tuple[float, float]]], x_name: str) -> str:
    """Draws one line for each series of (x, y)."""
    left, top, width, height = 52.0, 18.0, 420.0, 120.0
    points = [point for line in series.values() for point in line]
    if not points:
        return ""
    right, most = max(x for x, _ in points) or 1.0, max(y for _, y in points) or 1.0
    body = _legend(list(series), left) + _axis(left, top, width, height, most)
    for index, line in enumerate(series.values()):
        path = " ".join(f"{left + width * x / right:.1f},{top + height * (1 - y / most):.1f}" for x, y in line)
        body.append(f'<polyline points="{path}" fill="none" stroke="{COLOURS[index % len(COLOURS)]}"/>')
    body.append(_text(left + width, top + height + 14, f"{short(right)} {x_name}", 'text-anchor="end"'))
    return _svg(left + width + 10, top + height + 20, body)


def points(named: dict[str, tuple[float, float]], x_name: str, y_name: str) -> str:
    """Draws points on logarithmic axes, with the line where both are equal."""
    size, left, top = 220.0, 52.0, 10.0
    values = [value for point in named.values() for value in point if value > 0]
    if not values:
        return ""
    low, high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
    high += high == low

    def at(value: float) -> float:
        return size * (math.log10(max(value, 10.0 ** low)) - low) / (high - low)
    body = [f'<rect x="{left}" y="{top}" width="{size}" height="{size}" fill="none" stroke="#888"/>', f'<line x1="{left}" y1="{top + size}" x2="{left + size}" y2="{top}" stroke="#bbb"/>']
    for power in range(low, high + 1):
        body.append(_text(left - 4, top + size - at(10.0 ** power) + 3, short(10.0 ** power), 'text-anchor="end"') + _text(left + at(10.0 ** power), top + size + 12, short(10.0 ** power), 'text-anchor="middle"'))
    for name, (x, y) in named.items():
        body.append(f'<circle cx="{left + at(x):.1f}" cy="{top + size - at(y):.1f}" r="3" fill="{COLOURS[0]}"><title>{html.escape(name)}: {short(x)}, {short(y)}</title></circle>')
    body.append(_text(left + size / 2, top + size + 26, x_name, 'text-anchor="middle"') + _text(12, top + size / 2, y_name, f'text-anchor="middle" transform="rotate(-90 12 {top + size / 2})"'))
    return _svg(left + size + 20, top + size + 34, body)


def tree(names: Sequence[str], joins: Sequence[Sequence[float]], leaves: Sequence[int], clusters: Sequence[int], marked: Sequence[bool]) -> str:
    """Draws a dendrogram: `joins` is SciPy's linkage matrix, `leaves` the rows from the top. Marked names are bold."""
    each, left, width = 13.0, 110.0, 380.0
    farthest = max((join[2] for join in joins), default=1.0) or 1.0
    place = {leaf: (0.0, (row + 0.5) * each) for row, leaf in enumerate(leaves)}
    body = [_text(left - 6, place[leaf][1] + 3, names[leaf], f'text-anchor="end" fill="{COLOURS[clusters[leaf] % len(COLOURS)]}"' + (' font-weight="bold"' if marked[leaf] else "")) for leaf in leaves]
    for number, (first, second, distance, _) in enumerate(joins, len(names)):
        x = width * distance / farthest
        ends = [place[int(first)], place[int(second)]]
        path = f"M{left + ends[0][0]:.1f} {ends[0][1]:.1f}H{left + x:.1f}V{ends[1][1]:.1f}H{left + ends[1][0]:.1f}"
        body.append(f'<path d="{path}" fill="none" stroke="#555"/>')
        place[number] = (x, (ends[0][1] + ends[1][1]) / 2)
    return _svg(left + width + 10, each * len(names) + 6, body)


def radar(title: str, axes: Sequence[str], values: Sequence[float]) -> str:
    """Draws a Kiviat diagram of values from 0 to 1."""
    middle, radius, count = 70.0, 48.0, len(axes)

    def at(index: int, value: float) -> str:
        angle = 2 * math.pi * index / count
        return f"{middle + radius * value * math.sin(angle):.1f},{middle + 8 - radius * value * math.cos(angle):.1f}"
    outer = " ".join(at(i, 1.0) for i in range(count))
    inner = " ".join(at(i, value) for i, value in enumerate(values))
    legend = "; ".join(f"{i + 1} {axis} {value:.2f}" for i, (axis, value) in enumerate(zip(axes, values)))
    body = [f"<title>{html.escape(f'{title}: {legend}')}</title>", f'<polygon points="{outer}" fill="none" stroke="#ccc"/><polygon points="{inner}" fill="{COLOURS[0]}55" stroke="{COLOURS[0]}"/>']
    for i in range(count):
        x, y = (float(part) for part in at(i, 1.16).split(","))
        body.append(_text(x, y + 3, str(i + 1), 'text-anchor="middle" fill="#777"'))
    return _svg(140, 146, [*body, _text(middle, 10, title, 'text-anchor="middle"')])

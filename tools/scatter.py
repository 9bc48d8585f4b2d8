"""Draws pairs of numbers as points on logarithmic axes, as SVG: what was measured against what Glint computes."""
# SPDX-License-Identifier: Apache-2.0
import math
from typing import NamedTuple

COLOURS = ["#1f6fb4", "#c8651b", "#3a8f4d", "#8a5ab8", "#b33a4b"]
SIDE, LEFT, TOP, RIGHT = 460, 84, 20, 36


class Point(NamedTuple):
    name: str
    group: str
    measured: float
    computed: float


def ticks(low, high):
    """Returns 1, 2 and 5 times the powers of ten from `low` to `high`, or the powers alone when these are many."""
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    factors = (1, 2, 5) if math.log10(high / low) < 2.5 else (1,)
    return [factor * 10 ** power for power in powers for factor in factors if low <= factor * 10 ** power <= high]


def limits(values):
    """Returns the ends of an axis for `values`: 1, 2 or 5 times a power of ten each."""
    low, high = min(values), max(values)
    steps = [factor * 10 ** power for power in range(math.floor(math.log10(low)) - 1, math.ceil(math.log10(high)) + 2) for factor in (1, 2, 5)]
    return max(step for step in steps if step <= low), min(step for step in steps if step >= high)


def scatter(points, title, measured, computed, lines=((1, False),), names=6, centre=1):
    """Returns the picture. `measured` and `computed` are the titles of the axes. Each of `lines` is a ratio and whether its line is dashed. The
    `names` points whose ratio is furthest from `centre` carry their names."""
    low, high = limits([value for point in points for value in point[2:]])
    place = lambda value: SIDE * math.log(value / low) / math.log(high / low)
    x, y = lambda value: LEFT + place(value), lambda value: TOP + SIDE - place(value)
    groups = list(dict.fromkeys(point.group for point in points))
    colour = {group: COLOURS[i % len(COLOURS)] for i, group in enumerate(groups)}
    far = sorted(points, key=lambda point: -abs(math.log(point.computed / point.measured / centre)))[:names]
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {LEFT + SIDE + RIGHT} {TOP + SIDE + 60}" font-family="sans-serif" font-size="12">',
           f"<title>{title}</title>", f'<rect x="{LEFT}" y="{TOP}" width="{SIDE}" height="{SIDE}" fill="#fff" stroke="#888"/>']
    for tick in ticks(low, high):
        out += [f'<line x1="{x(tick):.1f}" y1="{TOP}" x2="{x(tick):.1f}" y2="{TOP + SIDE}" stroke="#ddd"/>',
                f'<line x1="{LEFT}" y1="{y(tick):.1f}" x2="{LEFT + SIDE}" y2="{y(tick):.1f}" stroke="#ddd"/>',
                f'<text x="{x(tick):.1f}" y="{TOP + SIDE + 18}" text-anchor="middle">{tick:,.0f}</text>',
                f'<text x="{LEFT - 6}" y="{y(tick) + 4:.1f}" text-anchor="end">{tick:,.0f}</text>']
    for ratio, is_dashed in lines:
        begin, end = max(low, low / ratio), min(high, high / ratio)
        dash = ' stroke-dasharray="5 4"' if is_dashed else ""
        out.append(f'<line x1="{x(begin):.1f}" y1="{y(begin * ratio):.1f}" x2="{x(end):.1f}" y2="{y(end * ratio):.1f}" stroke="#888"{dash}/>')
    for point in points:
        at_x, at_y = x(point.measured), y(point.computed)
        out.append(f'<circle cx="{at_x:.1f}" cy="{at_y:.1f}" r="4" fill="{colour[point.group]}" fill-opacity="0.75"/>')
        if point in far:
            above = point.computed / point.measured > centre
            out.append(f'<text x="{at_x + (-7 if above else 7):.1f}" y="{at_y + 4:.1f}" text-anchor="{"end" if above else "start"}" font-size="10">'
                       f"{point.name}</text>")
    width = 10 + 7 * max(len(group) for group in groups)
    for i, group in enumerate(groups if len(groups) > 1 else []):
        height = TOP + SIDE - 6 - 18 * (len(groups) - i)
        out += [f'<circle cx="{LEFT + SIDE - width - 10}" cy="{height}" r="4" fill="{colour[group]}"/>',
                f'<text x="{LEFT + SIDE - width}" y="{height + 4}">{group}</text>']
    out += [f'<text x="{LEFT + SIDE / 2}" y="{TOP + SIDE + 42}" text-anchor="middle">{measured}</text>',
            f'<text transform="translate(16 {TOP + SIDE / 2}) rotate(-90)" text-anchor="middle">{computed}</text>', "</svg>"]
    return "\n".join(out) + "\n"

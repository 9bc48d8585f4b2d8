#!/usr/bin/python3
"""Draws the figures of docs/validation.md from that page's own tables, so that a figure and its table cannot differ.

Usage: draw_validation.py [--check]
It writes the pictures of FIGURES to docs/images. With --check it writes nothing, and the exit status is 1
when a picture is not what the tables give.
"""
# SPDX-License-Identifier: Apache-2.0
import argparse
import re
import sys
from pathlib import Path

from scatter import Point, scatter

DOCS = Path(__file__).resolve().parent.parent / "docs"


def number(text):
    return float(text.replace(",", "").replace("*", ""))


def tables(page):
    """Returns the tables of the page: the heading that each lies under, and its rows by column. Equal names of columns get a number."""
    heading, rows, found = "", [], []
    for line in page.splitlines() + [""]:
        if line.startswith("#"):
            heading = line.lstrip("# ")
        if line.startswith("|"):
            rows.append([cell.strip() for cell in line.strip("|").split("|")])
        elif rows:
            names = [name + (f" {rows[0][:i].count(name) + 1}" if name in rows[0][:i] else "") for i, name in enumerate(rows[0])]
            found.append((heading, [dict(zip(names, row)) for row in rows[2:]]))
            rows = []
    return found


def kernels(page, headings):
    """Returns the kernels of the last table of cycles under each heading, with the heading's text for a group."""
    points = []
    for heading, group in headings.items():
        under = [rows for at, rows in tables(page) if at == heading and {"kernel", "cycles", "hardware"} <= rows[0].keys()]
        if not under:
            raise SystemExit(f"draw_validation.py: docs/validation.md has no table of cycles under '{heading}'")
        points += [Point(row["kernel"], group, number(row["hardware"]), number(row["cycles"])) for row in under[-1]]
    return points


def vulkan_sim(page):
    """Returns the frames of the table that has "Vulkan-Sim -> Glint" in its first column's title."""
    rows = next(rows for _, rows in tables(page) if "Vulkan-Sim -> Glint" in rows[0])
    pairs = [(row["Vulkan-Sim -> Glint"], *map(number, re.split(r"\s*->\s*", row["cycles"]))) for row in rows]
    return [Point(name, "frames", theirs, ours) for name, theirs, ours in pairs]


BAND = ((1, False), (1.25, True), (0.8, True))
HARDWARE, GLINT = "H100, cycles", "Glint, preset h100, cycles"
FIGURES = {
    "calibration": lambda page: scatter(kernels(page, {"h200: calibration kernels": "calibration"}), "Cycles of the twelve calibration kernels",
                                        HARDWARE, GLINT, BAND),
    "kernels_unseen": lambda page: scatter(kernels(page, {"h100: kernels unseen": "unseen", "h100: kernels compared blind": "blind",
                                                          "h100: kernels compared later": "later"}),
                                           "Cycles of kernels that the preset was not fitted to", HARDWARE, GLINT, BAND, names=6),
    "vulkan_sim": lambda page: scatter(vulkan_sim(page), "Cycles of seven frames in Vulkan-Sim and in Glint", "Vulkan-Sim 2.0, cycles",
                                       "Glint, preset vulkan-sim-desktop, cycles", BAND, names=7),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    page = (DOCS / "validation.md").read_text()
    old = []
    for name, draw in FIGURES.items():
        path, picture = DOCS / "images" / f"{name}.svg", draw(page)
        if not options.check:
            path.write_text(picture)
        elif not path.exists() or path.read_text() != picture:
            old.append(name)
    if old:
        print(f"draw_validation.py: run tools/draw_validation.py, because docs/validation.md has changed: {', '.join(old)}", file=sys.stderr)
    return 1 if old else 0


if __name__ == "__main__":
    sys.exit(main())

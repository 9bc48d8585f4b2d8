# Draws a whole suite: components, clusters and Kiviat plots, from what `glint characterize` wrote.
# SPDX-License-Identifier: Apache-2.0
"""Each function takes a `Characterization`, its folder (docs/characterization.md), or a `Bench` that was characterised."""
from __future__ import annotations

import math
import pathlib
from typing import Any

from ..characterization import Characterization
from ..collection import Bench
from ..errors import GlintError, UnknownName
from ..patterns import near
from .style import COLOURS, COLUMN, legend, new_figure, run_colour, styled

Suite = Characterization | Bench | str | pathlib.Path


def _suite(suite: Suite) -> Characterization:
    return suite if isinstance(suite, Characterization) else Characterization(suite.directory if isinstance(suite, Bench) else suite)


def scree(suite: Suite) -> Any:
    """Draws the eigenvalues of the components, with the kept ones in colour, and their cumulative variance."""
    table = _suite(suite).eigenvalues
    shown = min(len(table), max(10, 2 * sum(table["kept"])))
    with styled():
        figure, axes = new_figure(1.5)
        colours = [COLOURS["blue" if kept else "pale"] for kept in table["kept"][:shown]]
        axes.bar(range(1, shown + 1), table["eigenvalue"][:shown], color=colours, linewidth=0)
        axes.axhline(1, color=COLOURS["dark"], linewidth=0.6, linestyle="--")
        axes.set_xticks(range(1, shown + 1, 1 + shown // 12))
        axes.set_xlabel("component")
        axes.set_ylabel("eigenvalue")
        share = axes.twinx()
        share.plot(range(1, shown + 1), [100 * value for value in table["cumulative"][:shown]], color=COLOURS["orange"], marker=".", markersize=3)
        share.set_ylim(0, 100)
        share.set_ylabel("variance together (%)")
        share.spines["right"].set_visible(True)
        return figure


def components(suite: Suite, x: str = "PC1", y: str = "PC2") -> Any:
    """Draws the workloads in two components, with a colour and a mark for each cluster. The workloads of the subset are named."""
    found = _suite(suite)
    scores, clusters = found.scores, found.clusters
    places = {name: (a, b) for name, a, b in zip(scores["workload"], scores[x], scores[y])}
    marks = "osD^vP*X<>"
    with styled():
        figure, axes = new_figure(2.6)
        numbers, handles = sorted(set(clusters.values())), []
        for index, number in enumerate(numbers):
            members = [places[name] for name, cluster in clusters.items() if cluster == number]
            handles.append(axes.scatter([a for a, _ in members], [b for _, b in members], s=14, color=run_colour(index), marker=marks[index % len(marks)], linewidth=0))
        for name in found.subset:
            axes.annotate(name, places[name], xytext=(3, 3), textcoords="offset points", fontsize=5.5)
        axes.set_xlabel(x)
        axes.set_ylabel(y)
        axes.grid(color=COLOURS["pale"], linewidth=0.4)
        legend(figure, handles, [f"cluster {number}" if number == numbers[0] else str(number) for number in numbers])
        return figure


def dendrogram(suite: Suite) -> Any:
    """Draws which workloads are alike (LumiBench, Figure 3): mergers at their distance, with a colour for each cluster. Names of the subset are bold."""
    found = _suite(suite)
    leaves = list(found.clusters)
    row_of = {name: row for row, name in enumerate(found.scores["workload"])}
    numbers = sorted(set(found.clusters.values()))
    nodes = {float(row_of[name]): (float(place), 0.0, found.clusters[name]) for place, name in enumerate(leaves)}  # place, height, cluster
    with styled():
        figure, axes = new_figure(0.4 + 0.1 * max(8, len(leaves)))
        for index, (first, second, distance, _) in enumerate(found.linkage):
            (a, low_a, of_a), (b, low_b, of_b) = nodes[first], nodes[second]
            cluster = of_a if of_a == of_b else None  # None: above the cut
            colour = COLOURS["grey"] if cluster is None else run_colour(numbers.index(cluster))
            axes.plot([low_a, distance, distance, low_b], [a, a, b, b], color=colour, linewidth=0.8, solid_joinstyle="miter")
            nodes[float(len(leaves) + index)] = ((a + b) / 2, distance, cluster)
        axes.set_yticks(range(len(leaves)), leaves, fontsize=5)
        for label, name in zip(axes.get_yticklabels(), leaves):
            label.set_fontweight("bold" if name in found.subset else "normal")
        axes.tick_params(axis="y", length=0)
        axes.set_ylim(len(leaves) - 0.4, -0.6)
        axes.set_xlim(left=0)
        axes.set_xlabel("distance")
        return figure


def kiviat(suite: Suite, workloads: list[str] | None = None) -> Any:
    """Draws a star of the chosen metrics for each workload (LumiBench, Figure 4), by default of the subset. The first metric points up, and the others follow clockwise."""
    found = _suite(suite)
    table = found.kiviat
    metrics = table.columns[1:]
    rows = {row["workload"]: [row[metric] for metric in metrics] for row in table}
    names = found.subset if workloads is None else workloads
    for name in names:
        if name not in rows:
            raise UnknownName(f"there is no workload '{name}'{near(name, rows)}")
    if not names:
        raise GlintError("a Kiviat figure needs at least one workload")
    across = 4 if len(names) <= 12 else 8
    down = math.ceil(len(names) / across)
    width = COLUMN if across == 4 else 2.1 * COLUMN
    angles = [2 * math.pi * i / len(metrics) for i in range(len(metrics))]
    with styled():
        cell = width / across
        figure, axes = new_figure(cell * 1.12 * down + 0.28 + 0.11 * math.ceil(len(metrics) / 2), rows=down, columns=across, width=width, subplot_kw={"projection": "polar"}, squeeze=False)
        for axis in axes.flat[len(names):]:
            axis.set_axis_off()
        for axis, name in zip(axes.flat, names):
            axis.set_theta_zero_location("N")
            axis.set_theta_direction(-1)
            axis.fill([*angles, angles[0]], [*rows[name], rows[name][0]], color=run_colour(found.clusters[name] - 1), alpha=0.45, linewidth=0)
            axis.plot([*angles, angles[0]], [*rows[name], rows[name][0]], color=run_colour(found.clusters[name] - 1), linewidth=0.7)
            axis.set_ylim(0, 1)
            axis.set_yticks([0.5, 1], ["", ""])
            axis.set_xticks(angles, [str(i + 1) for i in range(len(metrics))], fontsize=4.5)
            axis.tick_params(pad=-4)
            axis.grid(color=COLOURS["pale"], linewidth=0.3)
            axis.spines["polar"].set_linewidth(0.3)
            axis.set_title(name, fontsize=5.5, pad=3)
        words = [f"{i + 1} {metric}" for i, metric in enumerate(metrics)]
        lines = ["   ".join(words[i:i + 4]) for i in range(0, len(words), 4)]
        figure.supxlabel("\n".join(lines), fontsize=5.5)
        return figure

# Tests that figures can be read at the width of a column: no name is cut or lies on another, and bars have room.
# SPDX-License-Identifier: Apache-2.0
"""usage: layout_test.py GLINT SOURCE_DIR. The test needs matplotlib and numpy, and says so when they are missing."""
import warnings

import python_case
from python_case import GLINT, ROOT, PythonTest

python_case.need("matplotlib", "numpy")


def texts_of(figure):
    """Returns every text that is drawn: labels, titles, legends, and the ticks within the axes."""
    found = [text for legend in figure.legends for text in legend.get_texts()] + list(figure.texts)
    for axes in figure.axes:
        found += [axes.title, axes.xaxis.label, axes.yaxis.label]
        for axis in (axes.xaxis, axes.yaxis):
            low, high = sorted(axis.get_view_interval())
            found += [tick.label1 for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high and tick.label1.get_visible()]
    return [text for text in found if text.get_text().strip() and text.get_visible()]


class Layout(PythonTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        tiny = {"size": (8, 8), "spp": 1, "glint": GLINT}
        axes = {"core.warps": [16, 32], "rt.warps": [1, 4], "memory.l1.size": [4096, 65536]}
        cls.sweep = cls.glint.sweep("WKND_SH", axes, out=cls.folder / "sweep", profile=True, sample=500, **tiny)
        cls.sizes = [cls.glint.run("SHIP_SH", out=cls.folder / f"size{i}", size=size, spp=spp, config=config, glint=GLINT)
                     for i, (size, spp, config) in enumerate((((16, 16), 2, "mobile"), ((24, 16), 1, "mobile"), ((16, 16), 1, "desktop")))]
        cls.mixed = [cls.ship, cls.wknd, cls.glint.run("SHIP_SH", out=cls.folder / "one_warp", set={"rt.warps": 1}, **tiny)]
        cls.suite = [cls.ship] * 46

    def readable(self, figure):
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # matplotlib warns of axes that have no room
            FigureCanvasAgg(figure).draw()
        renderer, edge = figure.canvas.get_renderer(), figure.bbox
        for text in texts_of(figure):
            box = text.get_window_extent(renderer)
            inside = box.x0 >= edge.x0 - 1 and box.x1 <= edge.x1 + 1 and box.y0 >= edge.y0 - 1 and box.y1 <= edge.y1 + 1
            self.assertTrue(inside, f"'{text.get_text()}' is cut: {box} in {edge}")
        for axes in figure.axes:
            box = axes.get_window_extent(renderer)
            self.assertGreater(box.width / figure.dpi, 0.9)
            self.assertGreater(box.height / figure.dpi, 0.3)
            for legend in figure.legends:
                self.assertFalse(box.overlaps(legend.get_window_extent(renderer)), "the legend lies on the axes")
            for axis, which in ((axes.xaxis, "x"), (axes.yaxis, "y")):
                ticks = [one for one in texts_of(figure) if one in [tick.label1 for tick in axis.get_major_ticks()]]
                spans = sorted(getattr(one.get_window_extent(renderer), f"interval{which}").tolist() for one in ticks)
                for (_, end), (begin, _) in zip(spans, spans[1:]):
                    self.assertLess(end, begin + 1.5, f"names of the {which} axis lie on each other")

    def test_a_timeline_with_every_warp_slot_can_be_read(self):
        run = self.glint.run("WKND_PT", out=self.folder / "traced", options=["--trace"], size=(128, 96), spp=1, glint=GLINT)
        for by in ("state", "stage"):
            figure = self.glint.plot.timeline(run, by=by)
            self.assertGreater(len(figure.axes[0].get_yticks()), 16)
            self.readable(figure)

    def test_every_figure_of_every_choice_of_runs_can_be_read(self):
        kinds = ("geometry", "stages", "cpi_stack", "rt_use", "l1_reads", "ray_nodes", "ipc")  # one figure of each kind
        for choice, some in (("sweep", self.glint.plot.FIGURES), ("mixed", kinds), ("sizes", kinds), ("suite", kinds), ("ship", kinds)):
            for name in some:
                figure = self.glint.plot.FIGURES[name]
                with self.subTest(figure=name, runs=choice):
                    self.readable(figure(getattr(self, choice)))
        for figure in (self.glint.plot.ops, self.glint.plot.op_counts, self.glint.plot.op_latency, self.glint.plot.stage_cycles, self.glint.plot.series, self.glint.plot.limits):
            with self.subTest(figure=figure.__name__):
                self.readable(figure(self.sweep))

    def test_names_in_a_figure_are_told_apart_by_what_is_drawn(self):
        for figure in (self.glint.plot.cpi_stack(self.sweep), self.glint.plot.rt_use(self.sweep)):
            axis = figure.axes[0].yaxis if len(figure.axes[0].get_yticklabels()) == 8 else figure.axes[0].xaxis
            names = [label.get_text().replace("\n", " ") for label in axis.get_ticklabels()]
            self.assertEqual(len(set(names)), 8)
            self.assertTrue(all("memory.l1.size=" in name and "core.warps=" in name for name in names), names)

    def test_ipc_has_a_bar_a_run_of_its_height(self):
        for runs in (list(self.sweep.values()), self.sizes, self.mixed, [self.ship, self.ship]):
            bars = [bar.get_height() for bar in self.glint.plot.ipc(runs).axes[0].patches]
            self.assertEqual(sorted(bar for bar in bars if bar), sorted(run.ipc for run in runs))
        figure = self.glint.plot.ipc([*self.sweep.values(), self.sizes[2]])  # nine configurations for eight colours
        self.assertEqual(len(figure.axes[0].get_yticklabels()), 9)
        self.assertEqual([bar.get_width() for bar in figure.axes[0].patches][8], self.sizes[2].ipc)

    def test_spreads_of_many_runs_are_rows_with_their_quantiles(self):
        from glint.plot.kinds import quantile
        figure = self.glint.plot.ray_nodes(self.suite)
        self.assertEqual(len(figure.axes[0].get_yticklabels()), 46)
        histogram = self.ship.stats.histogram("rt.ray_nodes")
        bar = figure.axes[0].patches[0]
        self.assertAlmostEqual(bar.get_x(), quantile(histogram, 0.25))
        self.assertAlmostEqual(bar.get_x() + bar.get_width(), quantile(histogram, 0.75))
        from glint.plot.kinds import spread
        open_ended = spread(["a", "b"], [self.glint.Histogram([0, 10, 20], counts, "cycle") for counts in ([9, 1], [99, 1])], "cycles")
        # 10 % lie beyond, 1 % does not.
        self.assertEqual([list(line.get_ydata()) for line in open_ended.axes[0].lines if line.get_marker() == ">"], [[0]])
        self.readable(open_ended)
        even = self.glint.Histogram([0, 10, 20, 30], [2, 0, 2], "node")
        self.assertEqual([quantile(even, share) for share in (0.25, 0.5, 0.75)], [5, 10, 25])

    def test_what_has_a_colour_a_run_is_refused_for_more_runs_than_colours(self):
        for figure in (self.glint.plot.ops, self.glint.plot.series):
            self.assertRaisesRegex(self.glint.GlintError, "colour for each run.*choose", figure, [self.ship] * 9)

    def test_a_series_begins_at_cycle_0(self):
        line = self.glint.plot.series(self.ship).axes[0].lines[0]
        self.assertEqual((line.get_xdata()[0], line.get_xdata()[1]), (0, self.ship.series["cycle"][0]))
        self.assertEqual(list(line.get_ydata()), [self.ship.series["ipc"][0], *self.ship.series["ipc"]])

    def test_limits_are_the_shares_of_the_statistics(self):
        figure = self.glint.plot.limits(self.ship)
        self.readable(figure)
        names = [label.get_text() for label in figure.axes[0].get_yticklabels()]
        shares = dict(zip(names, (bar.get_width() for bar in figure.axes[0].patches)))
        stats, config = self.ship.stats, self.ship.config
        self.assertAlmostEqual(shares["issue slots"], 100 * stats.sum("core.instructions") / stats.sum("core.issue_slots::*"))
        self.assertAlmostEqual(shares["DRAM"], 100 * self.ship.metrics["dram_util"])
        tests = stats.sum("rt.triangle_tests") * config["rt.triangle.interval"] / config["rt.triangle.units"]
        self.assertAlmostEqual(shares["RT unit: triangle tests"], 100 * tests / stats.sum("rt.unit_cycles"))
        self.assertAlmostEqual(shares["L2 to L1"], 100 * 32 * stats.sum("l1.sectors_fetched::*") / self.ship.seconds / self.ship.info["memory_peaks.network_bytes_per_second"])
        self.assertTrue(all(0 < share <= 100 for share in shares.values()), shares)

    def test_changes_are_the_ratios_of_the_metrics(self):
        before, after = self.sweep["WKND_SH-core.warps=16-rt.warps=1-memory.l1.size=4096"], self.sweep["WKND_SH-core.warps=16-rt.warps=4-memory.l1.size=65536"]
        figure = self.glint.plot.changes(before, after)
        self.readable(figure)
        for label, bar in zip(figure.axes[0].get_yticklabels(), figure.axes[0].patches):
            name = label.get_text().replace("\n", "")
            self.assertAlmostEqual(1 + bar.get_width(), after.metrics[name] / before.metrics[name], msg=name)
        self.assertRaisesRegex(self.glint.GlintError, "no metric changed", self.glint.plot.changes, before, before)

    def test_counts_of_ops_are_shares_of_the_instructions(self):
        figure = self.glint.plot.op_counts(self.ship, top=1000)
        self.assertAlmostEqual(sum(bar.get_width() for bar in figure.axes[0].patches), 100)

    def test_what_a_pipeline_did_not_record_is_left_out_or_refused_and_not_drawn_as_0(self):
        run = self.glint.run(ROOT / "examples/spheres/pipeline.toml", out=self.folder / "pipeline", glint=GLINT)
        self.assertEqual([axes.get_ylabel() for axes in self.glint.plot.geometry(run).axes], ["cycles"])
        self.assertRaisesRegex(self.glint.GlintError, "traversal ratio", self.glint.plot.traversal, run)
        for name in ("geometry", "cpi_stack", "rt_use", "ipc"):
            self.readable(self.glint.plot.FIGURES[name](run))

    def test_statistics_that_a_run_does_not_have_are_no_zeros(self):
        import json
        import shutil
        there = self.folder / "older"
        shutil.copytree(self.ship.directory, there)
        tree = json.loads((there / "stats.json").read_text())
        for unit in tree["gpu"].values() if isinstance(tree["gpu"], dict) else []:
            if isinstance(unit, dict) and isinstance(unit.get("raygen"), dict):
                unit["raygen"].pop("latency", None)
        (there / "stats.json").write_text(json.dumps(tree))
        record = json.loads((there / "run.json").read_text())
        del record["files"]  # The sums are those of the file before.
        (there / "run.json").write_text(json.dumps(record))
        self.assertRaisesRegex(self.glint.SchemaError, "core.raygen.latency.*run it again", self.glint.plot.stages, self.glint.Run(there))


if __name__ == "__main__":
    python_case.main()

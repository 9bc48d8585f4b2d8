# Tests the figures of the Python package: every figure is drawn, a column wide, and shows the numbers of the statistics.
# SPDX-License-Identifier: Apache-2.0
"""usage: plot_test.py GLINT SOURCE_DIR. The test needs matplotlib, numpy and pandas, and says so when they are missing."""
import python_case
from python_case import PythonTest

python_case.need("matplotlib", "numpy", "pandas")


class Figures(PythonTest):
    def widths(self, figure, panel=0):
        """Returns the lengths of all bars, row by row."""
        rows = {}
        for bar in figure.axes[panel].patches:
            rows.setdefault(round(bar.get_y() + bar.get_height() / 2, 3), []).append(bar.get_width())
        return [rows[place] for place in sorted(rows)]

    def test_every_figure_is_drawn_for_one_run_and_for_several(self):
        plot = self.glint.plot
        for name, figure in plot.FIGURES.items():
            for suffix, runs in (("one.pdf", self.ship), ("two.svg", [self.ship, self.wknd])):
                with self.subTest(figure=name, runs=suffix):
                    drawn = figure(runs)
                    self.assertAlmostEqual(drawn.get_figwidth(), 3.3)
                    self.assertGreater(plot.save(drawn, self.folder / f"{name}_{suffix}").stat().st_size, 3000)
        for figure in (plot.series, plot.ops, plot.op_latency, plot.stage_cycles, plot.picture):
            self.assertGreater(plot.save(figure(self.ship), self.folder / f"{figure.__name__}.pdf").stat().st_size, 3000)

    def test_bars_are_the_shares_of_the_statistics(self):
        count, latency = self.widths(self.glint.plot.instruction_mix(self.ship))
        self.assertAlmostEqual(count[0], self.ship.metrics["ins_alu%"])
        self.assertAlmostEqual(latency[-1], self.ship.metrics["lat_rt%"])
        self.assertAlmostEqual(sum(count), 100)

    def test_bars_of_stages_are_their_shares_of_instructions_and_of_latency(self):
        figure, stats = self.glint.plot.stages(self.wknd), self.wknd.stats
        rows = [label.get_text() for label in figure.axes[0].get_yticklabels()]
        self.assertEqual(rows, ["ray generation", "intersection", "closest hit", "miss"])
        for panel, (part, whole) in enumerate((("instructions", "core.instructions"), ("latency", "core.latency_by_class::*"))):
            bars = self.widths(figure, panel)
            self.assertAlmostEqual(sum(map(sum, bars)), 100)
            for row, stage in zip(bars, ("raygen", "intersection", "closest_hit", "miss")):
                self.assertAlmostEqual(sum(row), 100 * stats.sum(f"core.{stage}.{part}::*") / stats.sum(whole))
            self.assertAlmostEqual(bars[0][-1], 100 * stats.sum(f"core.raygen.{part}::rt") / stats.sum(whole))

    def test_a_cpi_stack_adds_up_to_the_cycles_of_an_instruction(self):
        stats = self.ship.stats
        stack = self.widths(self.glint.plot.cpi_stack(self.ship))[0]
        self.assertAlmostEqual(sum(stack), stats.sum("core.issue_slots::*") / stats.sum("core.instructions"))
        self.assertAlmostEqual(stack[0], 1.0)  # the cycle that issues

    def test_stages_of_a_miss_add_up_to_its_latency(self):
        self.assertAlmostEqual(sum(self.widths(self.glint.plot.miss_stages(self.wknd))[0]), self.wknd.metrics["avg_mf_latency"])

    def test_reads_of_all_askers_are_all_reads(self):
        self.assertAlmostEqual(sum(map(sum, self.widths(self.glint.plot.l1_reads(self.ship)))), 100)

    def test_the_same_figure_has_the_same_bytes(self):
        save, dram = self.glint.plot.save, self.glint.plot.dram
        for suffix in ("pdf", "svg", "png"):
            first, second = (save(dram(self.ship), self.folder / f"{i}.{suffix}").read_bytes() for i in (1, 2))
            self.assertEqual(first, second, suffix)

    def test_a_map_of_cost_has_its_unit_and_the_scale_of_the_run(self):
        import json
        import numpy
        heat = self.wknd.directory / "heat"
        heat.mkdir(exist_ok=True)
        numpy.save(heat / "nodes.npy", numpy.arange(256, dtype=numpy.uint32).reshape(16, 16))
        (heat / "maps.json").write_text(json.dumps({"schema": 1, "maps": [{"name": "nodes", "unit": "node", "doc": "", "p99": 252.0, "max": 255.0}]}))
        self.assertEqual((self.wknd.map_names, self.wknd.map("nodes").sum()), (["nodes"], 255 * 128))
        figure = self.glint.plot.cost_map(self.wknd, "nodes")
        self.assertEqual((figure.axes[0].images[0].get_clim(), figure.axes[1].get_ylabel()), ((0, 252), "nodes (node)"))
        self.assertRaisesRegex(self.glint.MissingFile, "no map 'rays'; the run has: nodes", self.glint.plot.cost_map, self.wknd, "rays")

    def bars(self, figure):
        """Returns the length of all bars of a timeline by row, from the top."""
        lengths = [0.0] * len(figure.axes[0].get_yticks())
        for collection in figure.axes[0].collections:
            for path in collection.get_paths():
                box = path.get_extents()
                lengths[round((box.y0 + box.y1) / 2)] += box.width
        return lengths

    def test_a_timeline_has_the_cycles_of_the_warps_and_of_the_rays(self):
        plot = self.glint.plot
        run = self.glint.run("WKND_PT", out=self.folder / "traced", options=["--trace"], size=(32, 32), spp=1, glint=python_case.GLINT)
        trace, whole = run.trace, (run.trace.begin, run.trace.end)
        for sm in (0, 1):
            for by in ("state", "stage"):
                figure = plot.timeline(run, sm=sm, window=whole, by=by)
                names = [label.get_text() for label in figure.axes[0].get_yticklabels()]
                lengths = dict(zip(names, self.bars(figure)))
                self.assertAlmostEqual(sum(n for name, n in lengths.items() if name.startswith("warp")), run.stats[f"gpu.core[{sm}].resident_cycles"])
                self.assertAlmostEqual(sum(n for name, n in lengths.items() if name.startswith("RT")), run.stats[f"gpu.rt_unit[{sm}].rt.warp_latency_sum"])
        part = plot.timeline(run, window=(6000, 7000))
        self.assertEqual(part.axes[0].get_xlim(), (6000, 7000))
        self.assertLessEqual(max(self.bars(part)), 1000)
        for suffix in ("pdf", "svg", "png"):
            first, second = (plot.save(plot.timeline(run), self.folder / f"t{i}.{suffix}").read_bytes() for i in (1, 2))
            self.assertEqual(first, second, suffix)
        self.assertRaisesRegex(self.glint.GlintError, f"the SMs 0 to {trace.sms - 1}", plot.timeline, run, sm=trace.sms)
        self.assertRaisesRegex(self.glint.GlintError, "did nothing from cycle", plot.timeline, run, window=(10**9, 10**9 + 1))
        self.assertRaisesRegex(self.glint.GlintError, "'state' or 'stage'", plot.timeline, run, by="warp")
        self.assertRaisesRegex(self.glint.GlintError, "--trace", plot.timeline, self.ship)
        damaged = self.folder / "damaged.json.gz"
        for content in (b"no gzip", trace.path.read_bytes()[:2000]):
            damaged.write_bytes(content)
            self.assertRaisesRegex(self.glint.SchemaError, "not a trace", self.glint.Trace, damaged)

    def test_figures_take_the_path_of_a_run_or_of_a_folder_of_runs(self):
        plot = self.glint.plot
        sweep = self.glint.sweep("WKND_SH", {"rt.warps": [1, 4]}, out=self.folder / "points", size=(8, 8), spp=1, glint=python_case.GLINT)
        self.assertEqual(len(self.widths(plot.cpi_stack(sweep.directory))), 2)
        self.assertEqual(self.widths(plot.cpi_stack(str(self.ship.directory))), self.widths(plot.cpi_stack(self.ship)))
        self.command("bench", "WKND_PT", "WKND_AO", "--size", "8x8", "--spp", "1", "--out", self.folder / "bench")
        self.assertEqual(len(self.widths(plot.cpi_stack(self.folder / "bench"))), 2)
        self.assertRaisesRegex(self.glint.MissingFile, "nowhere", plot.cpi_stack, "nowhere")
        (self.folder / "bench/models.csv").write_text("workload,cycles,model:a\nWKND_PT,100,90\nWKND_AO,50,60\n")
        bench = self.glint.Bench(self.folder / "bench")
        self.assertEqual(len(plot.model_fit(bench).axes[0].collections[0].get_offsets()), 2)
        self.assertRaisesRegex(self.glint.MissingFile, "glint characterize", plot.scree, bench)

    def test_what_cannot_be_drawn_is_refused_with_a_reason(self):
        plot, Error = self.glint.plot, self.glint.GlintError
        self.assertRaisesRegex(Error, "at least one run", plot.dram, [])
        self.assertRaisesRegex(Error, "--sample", plot.series, self.wknd)
        self.assertRaisesRegex(Error, "--profile", plot.ops, self.wknd)
        self.assertRaisesRegex(Error, ".pdf, .svg or .png", plot.save, plot.dram(self.wknd), self.folder / "figure.xyz")

    def test_frames_and_pictures_have_the_shapes_that_are_documented(self):
        self.assertEqual(self.ship.image.shape, (16, 16, 3))
        png = self.glint.read_image(self.ship.directory / "image.png")
        self.assertLess(abs(self.ship.image.clip(0, 1) - png).max(), 1 / 255)
        frame = self.ship.series.frame()
        self.assertEqual((list(frame.columns)[:2], len(frame)), (["cycle", "ipc"], len(self.ship.series)))


TABLES = {
    "eigenvalues": "component,eigenvalue,share,cumulative,kept\nPC1,2,0.7,0.7,1\nPC2,0.9,0.3,1,0\n",
    "scores": "workload,PC1,PC2\nA_PT,0,0\nB_PT,1,0\nC_PT,5,1\nD_PT,9,2\n",
    "linkage": "first,second,distance,leaves\n0,1,1,2\n2,3,4,2\n4,5,7,4\n",
    "leaves": "position,row,workload,cluster\n0,0,A_PT,1\n1,1,B_PT,1\n2,2,C_PT,2\n3,3,D_PT,2\n",
    "subset": "cluster,workload,distance_to_centre\n1,A_PT,0\n2,D_PT,1\n",
    "kiviat": "workload,ipc,dram_util,rays\nA_PT,0,0.5,1\nB_PT,1,0,0\nC_PT,0.2,1,0.3\nD_PT,0.1,0.2,0.3\n"}


class Suites(PythonTest):
    def setUp(self):
        self.there = self.folder / "characterization"
        self.there.mkdir(exist_ok=True)
        for name, text in TABLES.items():
            (self.there / f"{name}.csv").write_text(text)

    def test_a_dendrogram_joins_at_the_distances_of_the_linkage(self):
        axes = self.glint.plot.dendrogram(self.folder).axes[0]
        self.assertEqual([max(line.get_xdata()) for line in axes.lines], [1, 4, 7])
        self.assertEqual(list(axes.lines[2].get_ydata()), [0.5, 0.5, 2.5, 2.5])  # between the middles of both pairs
        bold = [label.get_text() for label in axes.get_yticklabels() if label.get_fontweight() == "bold"]
        self.assertEqual(bold, ["A_PT", "D_PT"])

    def test_every_figure_of_a_suite_is_drawn(self):
        plot = self.glint.plot
        for figure in (plot.scree, plot.components, plot.dendrogram, plot.kiviat):
            drawn = figure(self.glint.Characterization(self.folder))
            self.assertAlmostEqual(drawn.get_figwidth(), 3.3)
            self.assertGreater(plot.save(drawn, self.folder / f"{figure.__name__}.pdf").stat().st_size, 3000)
        self.assertEqual(len([axis for axis in plot.kiviat(self.folder, ["A_PT", "B_PT", "C_PT"]).axes if axis.get_title()]), 3)

    def test_predictions_stand_at_their_cycles_with_the_r_squared_of_the_regression(self):
        (self.folder / "models.csv").write_text("workload,cycles,model:half,model:noise,input\nA,100,50,7,1\nB,200,100,3,1\nC,400,200,5,1\n")
        figure = self.glint.plot.model_fit(self.folder)
        self.assertEqual(figure.axes[0].collections[0].get_offsets().tolist(), [[100, 50], [200, 100], [400, 200]])
        names = [text.get_text() for text in figure.legends[0].get_texts()]
        self.assertEqual(names, ["half (R² 1.000)", "noise (R² 0.107)"])
        errors = self.glint.plot.model_errors(self.folder)
        self.assertEqual([round(bar.get_width(), 6) for bar in errors.axes[0].patches], [-50, -50, -50, -93, -98.5, -98.75])
        for cycles in ("nan", "-5", "x", ""):
            (self.folder / "models.csv").write_text(f"workload,cycles,model:half\nA,{cycles},50\n")
            self.assertRaisesRegex(self.glint.SchemaError, "cycles", self.glint.plot.model_fit, self.folder)
        self.assertRaisesRegex(self.glint.SchemaError, "no column cycles", self.glint.plot.model_fit, self.there / "kiviat.csv")
        self.assertRaisesRegex(self.glint.SchemaError, "model:NAME", self.glint.plot.model_fit, self.glint.Table(["workload", "cycles"], [["A", 1]]))

    def test_workloads_whose_names_are_like_numbers_keep_them(self):
        for name, text in TABLES.items():
            (self.there / f"{name}.csv").write_text(text.replace("A_PT", "001").replace("B_PT", "nan").replace("C_PT", "1e3").replace("D_PT", "1_0"))
        self.assertEqual(list(self.glint.Characterization(self.folder).clusters), ["001", "nan", "1e3", "1_0"])
        for figure in (self.glint.plot.components, self.glint.plot.dendrogram, self.glint.plot.kiviat):
            figure(self.folder)
        self.assertRaisesRegex(self.glint.UnknownName, "no workload '002'", self.glint.plot.kiviat, self.folder, ["002"])
        self.assertRaisesRegex(self.glint.GlintError, "at least one", self.glint.plot.kiviat, self.folder, [])

    def test_a_linkage_that_does_not_fit_is_refused(self):
        (self.there / "linkage.csv").write_text("first,second,distance,leaves\n0,1,1,2\n")
        self.assertRaisesRegex(self.glint.SchemaError, "1 rows, but 4 workloads need 3", self.glint.plot.dendrogram, self.folder)
        self.assertRaisesRegex(self.glint.MissingFile, "glint characterize", self.glint.Characterization, self.folder / "nowhere")


if __name__ == "__main__":
    python_case.main()

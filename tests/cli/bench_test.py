# Tests workloads by name, suites of them, their metrics, and the paper's statements with the real binary.
# SPDX-License-Identifier: Apache-2.0
"""usage: bench_test.py GLINT SOURCE_DIR"""
import csv
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

GLINT, ROOT = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
SMALL = ["--size", "16x16", "--spp", "1"]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "python"))
sys.path.insert(0, str(ROOT / "tests/cli"))
from glint.paper import statements as check_paper  # noqa: E402
from glint_case import read_png  # noqa: E402


class BenchTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def glint(self, code, *arguments):
        done = subprocess.run([GLINT, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, timeout=300)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def total(self, run, name):
        """Returns the sum of the statistics of a run whose path ends so."""
        with open(self.folder / run / "stats.csv", newline="") as file:
            return sum(int(row["value"]) for row in csv.DictReader(file) if row["path"].endswith(name))

    def metrics(self, folder="out"):
        with open(self.folder / folder / "metrics.csv", newline="") as file:
            return {row["workload"]: row for row in csv.DictReader(file)}


class Workloads(BenchTest):
    def test_there_are_46_workloads_and_the_subset_is_that_of_the_papers_table_2(self):
        rows = [line.split() for line in self.glint(0, "list", "workloads").stdout.splitlines()]
        moving = [row[0] for row in rows if row[3:4] == ["lumibench-motion,"]]
        self.assertEqual(moving, ["WKND_PT_MOTION", "BUNNY_SH_MOTION", "SPNZA_AO_MOTION"])
        rows = [row for row in rows if row[0] not in moving]
        self.assertEqual(len(rows), 46)
        self.assertEqual(len({row[1] for row in rows}), 16)
        self.assertEqual([row[0] for row in rows if row[1] == "CHSNT"], ["CHSNT_PT"])
        self.assertEqual({row[0] for row in rows if row[-1] == "subset"}, set(check_paper.SUBSET))

    def test_a_workload_by_name_is_its_scene_with_its_shaders(self):
        self.glint(0, "run", "ship_ao", *SMALL, "--out", "a")
        self.glint(0, "run", "SHIP", "--shader", "ao", *SMALL, "--out", "b")
        self.assertEqual((self.folder / "a/stats.csv").read_bytes(), (self.folder / "b/stats.csv").read_bytes())
        self.assertIn("--shader", self.glint(2, "run", "SHIP_AO", "--shader", "sh", *SMALL).stderr)

    def rays(self, *arguments):
        """Returns the numbers of all rays and of those that may end at any hit."""
        self.glint(0, "run", *arguments, *SMALL, "--out", "out")
        lines = self.glint(0, "stats", "out", "--format", "metrics").stdout.splitlines()
        values = {line.split()[0]: line.split()[1] for line in lines}
        return int(float(values["rays_total"])), int(float(values["rays_any"]))

    def test_the_counts_of_rays_are_those_of_the_options(self):
        self.assertEqual(self.rays("WKND_PT", "--bounces", "1"), (256, 0))
        three, six = self.rays("SHIP_AO", "--ao-rays", "3"), self.rays("SHIP_AO", "--ao-rays", "6")
        self.assertEqual((three[0] - three[1], six[0] - six[1]), (256, 256))  # one primary ray per pixel
        self.assertEqual((three[1] % 3, six[1]), (0, 2 * three[1]))
        self.assertGreater(three[1], 0)
        one, four = self.rays("SHIP_SH", "--shadow-rays", "1"), self.rays("SHIP_SH", "--shadow-rays", "4")
        self.assertEqual((one[0] - one[1], four[1]), (256, 4 * one[1]))  # outdoors, all rays go the same way


    def test_longer_occlusion_rays_meet_more_and_darken_the_picture(self):
        def light(*options):
            self.glint(0, "run", "SHIP_AO", *SMALL, *options, "--mode", "functional", "--out", "out")
            return sum(read_png(self.folder / "out/image.png")[2])

        self.assertEqual(light("--ao-reach", "0"), light())
        self.assertGreater(light("--ao-reach", "1"), light("--ao-reach", "10"))
        self.assertGreater(light("--ao-reach", "10"), light("--ao-reach", "60"))
        self.assertEqual(json.loads((self.folder / "out/run.json").read_text())["rays"]["ao_reach"], 60)
        self.glint(2, "run", "SHIP_AO", "--ao-reach", "101")


class Bench(BenchTest):
    def test_metrics_of_a_suite_are_those_of_its_runs(self):
        done = self.glint(0, "bench", "WKND_PT", "ship_sh", *SMALL, "-j", "2", "--out", "out")
        self.assertNotIn("\x1b", done.stdout)
        metrics = self.metrics()
        self.assertEqual(list(metrics), ["WKND_PT", "SHIP_SH"])  # in the paper's order
        self.glint(0, "run", "SHIP_SH", *SMALL, "--out", "alone")
        stats = json.loads((self.folder / "alone/stats.json").read_text())["gpu"]
        self.assertEqual(float(metrics["SHIP_SH"]["cycles"]), stats["cycles"]["value"])
        units = [unit["rt"] for name, unit in stats.items() if name.startswith("rt_unit")]
        self.assertEqual(float(metrics["SHIP_SH"]["rays_total"]), sum(unit["rays"]["value"] for unit in units))
        row = metrics["WKND_PT"]
        self.assertEqual((float(row["procedurals"]), float(row["blas_count"]), float(row["n_raygen"])), (487, 487, 256))
        self.assertEqual(float(row["n_chit"]) + float(row["n_miss"]), float(row["rays_total"]))
        self.assertAlmostEqual(sum(float(row[m]) for m in ("%internal", "%tlas_leaf", "%leaf")), 100)
        self.assertAlmostEqual(sum(float(row[f"ins_{c}%"]) for c in ("alu", "sfu", "mem", "tex", "ctrl", "rt")), 100)

    def test_every_formula_has_a_value_in_a_run_and_only_those_without_are_empty(self):
        self.glint(0, "run", "WKND_PT", *SMALL, "--out", "out")
        lines = [line.split() for line in self.glint(0, "stats", "out", "--format", "metrics").stdout.splitlines()]
        self.assertEqual(len(lines), 87)
        self.assertEqual({line[0] for line in lines if line[1] == "-"}, {"rt_store_q_max", "rt_store_cycles"})
        peer = self.glint(0, "stats", "out", "--format", "vulkan-sim").stdout
        self.assertRegex(peer, r"(?m)^rt_avg_nodes_per_ray = \d")
        missing = re.findall(r"(?m)^# (\S+): there is nothing to divide", peer)
        self.assertEqual(missing, ["rt_overall_miss_rate"] if "rt_overall_miss_rate" in missing else [])
        self.assertEqual(self.glint(0, "stats", "out").stdout, (self.folder / "out/stats.txt").read_text())
        self.glint(2, "stats", "nowhere", "--format", "metrics")

    def test_spreads_of_nodes_and_times_have_each_ray_once(self):
        self.glint(0, "run", "WKND_PT", *SMALL, "--out", "out")
        with open(self.folder / "out/stats.csv", newline="") as file:
            values = {row[0]: float(row[1]) for row in list(csv.reader(file))[1:]}
        total = lambda end: sum(value for name, value in values.items() if end in name)
        self.assertGreater(total(".rt.rays"), total(".rt.finished_rays"))
        self.assertEqual(total(".rt.ray_nodes::"), total(".rt.rays"))
        self.assertEqual(total(".rt.ray_latency::"), total(".rt.rays"))

    def test_a_functional_run_gives_the_metrics_that_it_counts_and_says_who_counts_the_others(self):
        rows = {}
        for mode in ("timing", "functional"):
            self.glint(0, "bench", "WKND_PT", *SMALL, "--mode", mode, "--out", mode)
            with open(self.folder / mode / "metrics.csv", newline="") as file:
                [rows[mode]] = csv.DictReader(file)
        for name in ("insn", "w_icount", "simt_efficiency", "ins_alu%", "ins_rt%", "rays_total", "avg_nodes_per_ray", "box_tests", "tri_tests", "traversal_ratio"):
            self.assertTrue(rows["functional"][name], name)
            self.assertAlmostEqual(float(rows["functional"][name]), float(rows["timing"][name]), msg=name)
        self.assertEqual((rows["functional"]["cycles"], rows["functional"]["l2_bw"]), ("", ""))
        run = next(path.parent for path in (self.folder / "functional").glob("*/run.json"))
        for kind in ("metrics", "vulkan-sim"):
            text = self.glint(0, "stats", str(run), "--format", kind).stdout
            self.assertIn("only the timing machine counts it", text)
        self.assertIn("functional machine counts it", self.glint(0, "describe", "gpu.nodes_per_ray").stdout)

    def test_writes_of_the_rt_unit_include_hits_that_are_stored_one_by_one(self):
        self.glint(0, "run", "SHIP_SH", *SMALL, "--config", "vulkan-sim-mobile", "--out", "run")
        hits = self.total("run", "rt.hit_writes")
        self.assertGreater(hits, 0)
        metrics = self.glint(0, "stats", "run", "--format", "metrics").stdout
        self.assertEqual(re.search(r"^rt_writes +(\d+) ", metrics, re.M)[1], str(hits))
        # Each ray has read a record of its own, and 12 bytes for a hit, beside the binding table.
        self.glint(0, "run", "SHIP_SH", *SMALL, "--config", "vulkan-sim-mobile", "--set", "core.local_by_thread=false", "--out", "beside")
        rays, reads = ([self.total(run, name) for run in ("run", "beside")] for name in ("rt.rays", "l1.reads::shader_binding"))
        self.assertEqual(rays[0], rays[1])
        self.assertLessEqual(reads[1] + rays[0], reads[0])
        self.assertLessEqual(reads[0], reads[1] + 2 * rays[0])
        self.assertEqual(*((self.folder / run / "image.pfm").read_bytes() for run in ("run", "beside")))
        self.assertIn(f"rt_writes = {hits}\n", self.glint(0, "stats", "run", "--format", "vulkan-sim").stdout)

    def test_report_and_model_take_the_runs_of_metrics_csv_and_name_the_others(self):
        self.glint(0, "bench", "BUNNY_SH", "BUNNY_AO", *SMALL, "--out", "b")
        for other in ("WKND_SH", "SHIP_SH"):
            self.glint(0, "run", other, *SMALL, "--out", f"b/{other}")
        model = self.glint(0, "model", "b", "--statistics-only")
        with open(self.folder / "b/models.csv", newline="") as file:
            self.assertEqual([row["workload"] for row in csv.DictReader(file)], ["BUNNY_AO", "BUNNY_SH"])
        report = self.glint(0, "report", "b", "-o", "page.html")
        for done in (model, report):
            self.assertRegex(done.stderr, "left out.*: SHIP_SH WKND_SH\n")
        facts = json.loads((self.folder / "b/SHIP_SH/run.json").read_text())
        (self.folder / "b/SHIP_SH/run.json").write_text(json.dumps(facts | {"exit": 4}))  # a failed run must spoil nothing
        self.glint(0, "report", "b", "-o", "page.html")
        self.glint(0, "model", "b", "--statistics-only")

    def test_the_workloads_that_move_have_eight_frames_and_rows_of_their_sums(self):
        self.glint(0, "bench", "lumibench-motion", *SMALL, "--mode", "functional", "--out", "out")
        self.assertEqual(list(self.metrics()), ["WKND_PT_MOTION", "BUNNY_SH_MOTION", "SPNZA_AO_MOTION"])
        for name in self.metrics():
            run = json.loads((self.folder / "out" / name / "run.json").read_text())
            self.assertEqual(len(run["frames"]), 8)
            rays = sum(self.total(f"out/{name}/{frame}", "gpu.rays") for frame in run["frames"])
            self.assertEqual(self.total(f"out/{name}", "gpu.rays"), rays)
        self.glint(0, "run", "wknd_pt_motion", "--frames", "3", *SMALL, "--mode", "functional", "--out", "one")
        self.assertEqual((self.folder / "one/frame-0003/image.pfm").read_bytes(), (self.folder / "out/WKND_PT_MOTION/frame-0003/image.pfm").read_bytes())

    def test_resume_leaves_out_what_is_complete_and_runs_again_what_another_configuration_left(self):
        def runs(*more):
            return re.findall(r"(?m)^ *\d+/\d+ (\w+)", self.glint(0, "bench", "SHIP_SH", "WKND_SH", *SMALL, "--out", "out", *more).stdout)
        self.assertEqual(sorted(runs()), ["SHIP_SH", "WKND_SH"])
        first = self.metrics()
        self.assertEqual(runs("--resume"), [])
        self.assertEqual(self.metrics(), first)
        (self.folder / "out/SHIP_SH/workload.json").unlink()
        self.assertEqual(runs("--resume"), ["SHIP_SH"])
        self.assertEqual(sorted(runs("--resume", "--set", "core.warps=8")), ["SHIP_SH", "WKND_SH"])
        self.assertEqual(sorted(runs()), ["SHIP_SH", "WKND_SH"])

    def test_runs_of_a_bench_note_what_its_options_ask_for(self):
        notes = ["--profile", "--sample", "500", "--heat", "--trace", "--trace-window", "100:2000"]
        self.glint(0, "bench", "SHIP_SH", *SMALL, "--out", "out", *notes)
        self.glint(0, "run", "SHIP_SH", *SMALL, "--out", "alone", *notes)
        for name in ("profile.csv", "source.json", "series.csv", "heat/maps.json", "trace.json.gz"):
            self.assertEqual((self.folder / "out/SHIP_SH" / name).read_bytes(), (self.folder / "alone" / name).read_bytes(), name)
        self.assertIn("1 of them complete", self.glint(0, "bench", "SHIP_SH", *SMALL, "--out", "out", *notes, "--resume").stdout)
        self.assertIn("0 of them complete", self.glint(0, "bench", "SHIP_SH", *SMALL, "--out", "out", "--profile", "--resume").stdout)
        self.assertIn("the functional machine has none", self.glint(2, "bench", "SHIP_SH", "--mode", "functional", "--profile", "--out", "other").stderr)

    def test_a_workload_that_fails_does_not_stop_the_others_and_the_exit_status_says_so(self):
        self.glint(0, "run", "SHIP_SH", *SMALL, "--out", "out/SHIP_SH")
        (self.folder / "out/SHIP_SH/stats.csv").unlink()
        (self.folder / "out/SHIP_SH/stats.csv").mkdir()  # a folder that no file can replace
        done = self.glint(1, "bench", "SHIP_SH", "WKND_SH", *SMALL, "--out", "out")
        self.assertIn("FAILED", done.stdout)
        self.assertIn("SHIP_SH", done.stderr)
        self.assertEqual(list(self.metrics()), ["WKND_SH"])

    def test_workloads_whose_scenes_have_no_files_in_the_assets_folder_are_left_out_by_name(self):
        (self.folder / "data/SHIP").mkdir(parents=True)
        (self.folder / "data/SHIP/karimSchooner.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        done = self.glint(0, "bench", "SHIP_SH", "CRNVL", *SMALL, "--mode", "functional", "--assets", "data", "--out", "out")
        self.assertIn("1 workloads: ", done.stdout)
        self.assertIn("left out, because their scenes have no files in 'data': CRNVL_PT CRNVL_SH CRNVL_AO\n", done.stdout)
        self.assertEqual([(name, row["form"]) for name, row in self.metrics().items()], [("SHIP_SH", "original")])
        done = self.glint(2, "bench", "CRNVL", *SMALL, "--assets", "data", "--out", "none")
        self.assertIn("no workload has a scene with files in the assets folder 'data'", done.stderr)
        self.assertFalse((self.folder / "none").exists())

    def test_an_interrupted_suite_keeps_what_is_finished_and_leaves_no_process(self):
        bench = subprocess.Popen([GLINT, "bench", "SHIP_SH", "PARK_PT", *SMALL, "-j", "2", "--out", "out"], cwd=self.folder,
                                 stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        deadline = time.monotonic() + 250
        while not (self.folder / "out/SHIP_SH/workload.json").exists() and time.monotonic() < deadline:
            time.sleep(0.02)
        children = pathlib.Path(f"/proc/{bench.pid}/task/{bench.pid}/children").read_text().split()
        bench.send_signal(signal.SIGINT)
        out, err = bench.communicate(timeout=60)
        if "PARK_PT" in self.metrics():
            self.skipTest("the second workload was faster than the signal")
        self.assertEqual(bench.returncode, 130, out + err)
        self.assertIn("--resume", err)
        self.assertEqual(list(self.metrics()), ["SHIP_SH"])
        self.assertFalse((self.folder / "out/PARK_PT/workload.json").exists())
        self.assertEqual([pid for pid in children if os.path.exists(f"/proc/{pid}")], [])

    def test_max_cycles_ends_long_launches_and_their_rows_are_marked_as_partial(self):
        self.glint(0, "bench", "SHIP_SH", "WKND_SH", *SMALL, "--out", "out")
        cycles = {name: int(float(row["cycles"])) for name, row in self.metrics().items()}
        short, long = sorted(cycles, key=cycles.get)
        limit = str((cycles[short] + cycles[long]) // 2)
        done = self.glint(6, "bench", "SHIP_SH", "WKND_SH", *SMALL, "--out", "out", "--max-cycles", limit)
        self.assertIn(f"--max-cycles has ended these launches, which metrics.csv does not have: {long}\n", done.stderr)
        self.assertRegex(done.stdout, rf"{long} .* cycles .*  partial\n")
        self.assertEqual({name: int(float(row["cycles"])) for name, row in self.metrics().items()}, {short: cycles[short]})
        summary = (self.folder / "out/summary.txt").read_text()
        self.assertIn(f"{long} (partial)", summary)
        self.assertNotIn(f"{short} (partial)", summary)
        facts = json.loads((self.folder / f"out/{long}/run.json").read_text())
        self.assertEqual((facts["exit"], facts["partial"]["reason"]), (6, "max_cycles"))
        again = self.glint(0, "bench", "SHIP_SH", "WKND_SH", *SMALL, "--out", "out", "--resume")
        self.assertIn("1 of them complete", again.stdout)
        self.assertEqual({name: int(float(row["cycles"])) for name, row in self.metrics().items()}, cycles)
        self.assertIn("the functional machine has none", self.glint(2, "bench", "SHIP_SH", "--mode", "functional", "--max-cycles", "9").stderr)

    def test_names_that_are_none_are_refused_with_the_nearest(self):
        self.assertIn("did you mean 'SHIP_SH'?", self.glint(2, "bench", "SHIP_SK").stderr)
        self.assertIn("CHSNT_SH", self.glint(2, "bench", "CHSNT_SH").stderr)
        self.assertFalse((self.folder / "out").exists())


class Paper(unittest.TestCase):
    """Tests the statements of the paper on figures made for them."""

    def table(self, **changes):
        rows = []
        for name in check_paper.SUBSET:
            row = {"workload": name, "dram_eff": "0.6", "rt_efficiency": {"PT": "0.2", "AO": "0.4", "SH": "0.6"}[name[-2:]], "ins_alu%": "70",
                   "ins_mem%": "20", "ins_sfu%": "1", "ins_tex%": "1", "ins_ctrl%": "7", "ins_rt%": "1", "thread_ipc": "5"}
            row.update({metric: value for (workload, metric), value in changes.get("cells", {}).items() if workload == name})
            rows.append(row)
        return check_paper.Table(rows)

    def verdicts(self, table, part, **others):
        return [verdict for _, text, verdict, _ in check_paper.evaluate(table, **others) if part in text]

    def test_an_order_that_is_there_holds_and_one_that_is_not_does_not(self):
        self.assertEqual(self.verdicts(self.table(), "RT efficiency is lowest for PT"), ["holds"])
        broken = self.table(cells={("BUNNY_AO", "rt_efficiency"): "0.9"})
        self.assertEqual(self.verdicts(broken, "RT efficiency is lowest for PT"), ["does not hold"])
        self.assertEqual(self.verdicts(self.table(), "ALU is the most frequent"), ["holds"])
        self.assertEqual(self.verdicts(self.table(cells={("WKND_PT", "ins_mem%"): "71"}), "ALU is the most frequent"), ["does not hold"])

    def test_a_bound_is_kept_on_both_sides(self):
        for value, verdict in (("0.47", "does not hold"), ("0.48", "holds"), ("0.88", "holds"), ("0.89", "does not hold")):
            self.assertEqual(self.verdicts(self.table(cells={("BATH_PT", "dram_eff"): value}), "DRAM efficiency lies within"), [verdict], value)

    def test_what_lacks_rows_cells_or_another_run_cannot_be_judged(self):
        self.assertEqual(self.verdicts(self.table(), "CHSNT_PT's traversal ratio"), ["cannot be judged"])
        self.assertEqual(self.verdicts(self.table(cells={("BATH_PT", "dram_eff"): ""}), "DRAM efficiency lies within"), ["cannot be judged"])
        self.assertEqual(self.verdicts(self.table(), "IPC is higher on desktop"), ["cannot be judged"])
        self.assertEqual(self.verdicts(self.table(), "IPC is higher on desktop", desktop=self.table()), ["does not hold"])

    def test_a_series_is_stable_when_its_means_stop_moving(self):
        def series(late, start=3):
            ipc = [0.0, 9.0, 1.0] + [4.0] * 20 + [late] * 20
            return {"SHIP_SH": [{"cycles": 100.0, "instructions": 100 * x, "ipc": x, "l1d_reads": 10.0, "l1d_miss_rate": x / 10, "rt_warps": 4.0 if i >= start else 0.0}
                                for i, x in enumerate(ipc)]}
        for late, verdict in ((4.0, "holds"), (12.0, "does not hold")):
            self.assertEqual(self.verdicts(self.table(), "become stable", series=series(late)), [verdict])
        self.assertEqual(self.verdicts(self.table(), "become stable"), ["cannot be judged"])
        # Both are said: all samples, and those since the RT units are full.
        for start, said in ((3, "without the start-up it does not hold"), (0, "without the start-up it holds")):
            [figures] = [figures for _, text, _, figures in check_paper.evaluate(self.table(), series=series(4.0, start)) if "become stable" in text]
            self.assertIn(said, figures)

    def test_misses_of_the_shaders_follow_from_the_rates(self):
        cells = {"acc_internal": "80", "acc_instance_leaf": "0", "acc_quad_leaf": "20", "acc_proc_leaf": "0", "rt_miss_rate": "0.25",
                 "l1d_miss_rate": "0.125", "l1d_shader_miss_rate": "0.0833333333333333333"}  # 300 shader reads, 25 of them misses
        table = self.table(cells={("BUNNY_AO", metric): value for metric, value in cells.items()})
        rt, shader = check_paper.rt_and_shader_misses(table, "BUNNY_AO")
        self.assertAlmostEqual(rt, 25)
        self.assertAlmostEqual(shader, 25)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])

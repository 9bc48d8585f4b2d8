# Compares the Python reader with the command: both give the same numbers, and errors say clearly what is wrong with a run.
# SPDX-License-Identifier: Apache-2.0
"""usage: reader_test.py GLINT SOURCE_DIR. The test needs only the standard library."""
import json
import pathlib
import shutil
import subprocess
import sys
import unittest.mock

import python_case
from python_case import GLINT, ROOT, SMALL, PythonTest


class Numbers(PythonTest):
    def test_every_number_of_stats_csv_is_read_with_its_unit(self):
        lines = [line.split(",", 3) for line in self.command("stats", self.ship.directory, "--format", "csv").splitlines()[1:]]
        there = {path: (value, unit) for path, value, unit, _ in self.ship.stats.rows()}
        self.assertGreater(len(there), 1000)
        for path, value, unit, _ in lines:
            if path in there:  # histograms are lists
                self.assertEqual((float(value), unit), (float(there[path][0]), there[path][1]), path)
        missing = [path for path in there if path not in {line[0] for line in lines}]
        self.assertEqual(missing, [])

    def test_every_metric_is_what_the_command_computes(self):
        for run in (self.ship, self.wknd):
            lines = [line.split()[:2] for line in self.command("stats", run.directory, "--format", "metrics").splitlines()]
            self.assertEqual([name for name, _ in lines], list(run.metrics))
            for name, text in lines:
                mine = run.metrics[name]
                if mine is None:
                    self.assertRaises(ValueError, float, text)
                else:  # the command prints six digits
                    self.assertAlmostEqual(mine, float(text), delta=1e-5 * abs(mine) + 1e-12, msg=name)

    def test_sums_over_instances_and_parts_agree_with_each_other(self):
        stats = self.ship.stats
        self.assertEqual(stats.sum("core.instructions"), sum(stats[f"gpu.core[{i}].instructions"] for i in range(8)))
        self.assertEqual(sum(stats.parts("core.issue_slots").values()), stats.sum("gpu.core[*].issue_slots::*"))
        self.assertEqual(sum(stats.histogram("rt.ray_nodes").counts), stats.sum("rt.rays"))
        self.assertEqual(stats.about("gpu.cycles").unit, "cycle")

    def test_series_and_profile_add_up_to_the_statistics(self):
        self.assertEqual(sum(self.ship.series["instructions"]), self.ship.stats.sum("core.instructions"))
        self.assertEqual(sum(self.ship.profile.where(by="instruction")["issues"]), self.ship.stats.sum("core.instructions"))
        self.assertEqual(sum(self.ship.folded.values()), self.ship.stats.sum("core.issue_slots::*"))

    def test_configuration_is_read_by_dotted_key(self):
        self.assertEqual((self.ship.config["core.warps"], self.ship.config["core.issue"]), (32, "gto"))
        self.assertEqual(self.ship.info["scene.name"], "SHIP")
        self.assertEqual(self.ship.workload, "SHIP_SH")

    def test_a_run_with_compact_statistics_has_the_same_metrics_and_totals(self):
        compact = self.glint.run("SHIP_SH", out=self.folder / "compact", sample=1000, options=["--stats", "compact"], **SMALL)
        same = [name for name in self.glint.metrics() if name != "sim_rate"]
        self.assertEqual([compact.metrics[name] for name in same], [self.ship.metrics[name] for name in same])
        self.assertEqual(compact.cycles, self.ship.cycles)
        self.assertEqual(compact.stats["gpu.core[*].instructions"], self.ship.stats.sum("gpu.core[*].instructions"))
        self.assertEqual(compact.stats.parts("core.issue_slots"), self.ship.stats.parts("core.issue_slots"))
        self.assertEqual(len(compact.series), len(self.ship.series))

    def test_compare_lists_the_changes_of_the_command_in_its_order(self):
        other = self.glint.run("SHIP_SH", out=self.folder / "slow", set={"memory.l1.size": 16384}, **SMALL)
        printed = [line.split()[0] for line in self.command("compare", self.ship.directory, other.directory).split("\n\n")[0].splitlines()]
        mine = self.glint.compare(self.ship, other)
        self.assertGreater(len(mine), 10)
        self.assertEqual([change.metric for change in mine], [name for name in printed if name in self.glint.metrics()])

    def test_reading_imports_nothing_but_the_standard_library(self):
        code = "import sys, glint; r = glint.Run(sys.argv[1]); r.metrics['thread_ipc']; r.series; r.profile; print(set(sys.modules) & {'numpy', 'pandas', 'matplotlib'})"
        out = subprocess.run([sys.executable, "-c", code, self.ship.directory], capture_output=True, text=True, check=True).stdout
        self.assertEqual(out.strip(), "set()")


class Wrong(PythonTest):
    def copy(self, name):
        there = self.folder / name
        shutil.copytree(self.ship.directory, there, dirs_exist_ok=True)
        return there

    def test_a_folder_that_is_no_run_is_refused(self):
        self.assertRaisesRegex(self.glint.MissingFile, "no run.json", self.glint.Run, self.folder)
        self.assertRaisesRegex(self.glint.MissingFile, "no such folder", self.glint.Run, self.folder / "nowhere")

    def test_a_run_that_failed_is_refused_with_its_own_message(self):
        with self.assertRaises(self.glint.CommandFailed) as caught:
            self.glint.run("SHIP_SH", out=self.folder / "stuck", options=["--max-instructions", "10"], **SMALL)
        self.assertEqual(caught.exception.code, 4)
        self.assertRaisesRegex(self.glint.IncompleteRun, "exit code 4.*no end in sight", self.glint.Run, self.folder / "stuck")
        self.assertEqual(self.glint.Run(self.folder / "stuck", partial=True).info["exit"], 4)

    def test_another_schema_and_damaged_files_are_refused(self):
        there = self.copy("other")
        record = json.loads((there / "run.json").read_text())
        (there / "run.json").write_text(json.dumps({**record, "schema": 99}))
        self.assertRaisesRegex(self.glint.SchemaError, "schema is 99", self.glint.Run, there)
        there = self.copy("cut")
        record.pop("files")  # as in runs of earlier versions, so that only the form of a file tells
        (there / "run.json").write_text(json.dumps(record))
        for name, read in (("stats.json", lambda run: run.stats), ("series.csv", lambda run: run.series), ("config.toml", lambda run: run.config)):
            text = (there / name).read_text()
            (there / name).write_text(text.rstrip()[:-20] if name == "stats.json" else text[: text.rindex("\n", 0, -1) + 3])  # ends within a line
            with self.assertWarns(UserWarning):
                run = self.glint.Run(there)
            self.assertRaisesRegex(self.glint.SchemaError, name, read, run)

    def test_what_a_run_did_not_record_is_named_with_its_option(self):
        self.assertRaisesRegex(self.glint.MissingFile, "--sample", lambda: self.wknd.series)
        self.assertRaisesRegex(self.glint.MissingFile, "--profile", lambda: self.wknd.profile)
        self.assertRaisesRegex(self.glint.MissingFile, "no map", self.wknd.map, "cycles")

    def test_a_functional_run_has_no_cycles(self):
        run = self.glint.run("WKND_PT", out=self.folder / "functional", mode="functional", **SMALL)
        self.assertRaisesRegex(self.glint.UnknownName, "functional run has no cycles", lambda: run.cycles)

    def test_unknown_names_are_answered_with_near_ones(self):
        self.assertRaisesRegex(self.glint.UnknownName, "gpu.cycles", lambda: self.ship.stats["gpu.cycels"])
        self.assertRaisesRegex(self.glint.UnknownName, "rt_occupancy", lambda: self.ship.metrics["rt_ocupancy"])
        self.assertRaisesRegex(self.glint.UnknownName, "core.warps", lambda: self.ship.config["core.warp"])

    def test_a_missing_package_is_named(self):
        with unittest.mock.patch.dict(sys.modules, {"numpy": None, "pandas": None}):
            self.assertRaisesRegex(self.glint.MissingPackage, "numpy.*python3-numpy", lambda: self.glint.Run(self.ship.directory).image)
            self.assertRaisesRegex(self.glint.MissingPackage, "python3-pandas", self.ship.series.frame)

    def test_a_command_that_is_not_there_is_named(self):
        self.assertRaisesRegex(self.glint.CommandFailed, "no such program", self.glint.find_glint, "/nowhere/glint")


class Folders(PythonTest):
    def test_a_sweep_has_a_run_a_point_and_is_not_run_twice(self):
        lines = []
        axes = {"rt.warps": [4, 16], "core.issue": ["gto", "lrr"]}
        sweep = self.glint.sweep("SHIP_SH", axes, out=self.folder / "sweep", progress=lines.append, **SMALL)
        self.assertEqual((len(sweep), len(lines)), (4, 4))
        self.assertEqual([(row["rt.warps"], row["core.issue"]) for row in sweep.rows(["cycles"])], [(4, "gto"), (4, "lrr"), (16, "gto"), (16, "lrr")])
        again = self.glint.sweep("SHIP_SH", axes, out=self.folder / "sweep", progress=lines.append, **SMALL)
        self.assertEqual((len(again), len(lines)), (4, 4))
        self.glint.sweep("SHIP_SH", axes, out=self.folder / "sweep", progress=lines.append, **{**SMALL, "spp": 2})
        self.assertEqual(len(lines), 8)  # other options are other points

    def test_a_bench_has_the_metrics_of_its_table_and_names_what_failed(self):
        there = self.folder / "bench"
        subprocess.run([GLINT, "bench", "SHIP_SH", "WKND_PT", "--size", "16x16", "--spp", "1", "--out", there], check=True, capture_output=True)
        bench = self.glint.Bench(there)
        table = {row["workload"]: row for row in bench.table}
        for row in bench.rows():
            for name in self.glint.metrics():
                self.assertAlmostEqual(row[name] or 0, table[row["workload"]][name] or 0, delta=1e-9 * abs(row[name] or 0), msg=name)
        (there / "WKND_PT/stats.json").unlink()
        record = json.loads((there / "SHIP_SH/run.json").read_text())
        (there / "SHIP_SH/run.json").write_text(json.dumps({**record, "exit": 5, "message": "stuck"}))
        self.assertRegex(self.glint.Bench(there).failed["SHIP_SH"], "exit code 5: stuck")


if __name__ == "__main__":
    python_case.main()

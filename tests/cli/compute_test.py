# Tests the compute suite as a user meets it: `glint run PROGRAM`, `glint bench compute` and their messages.
# SPDX-License-Identifier: Apache-2.0
"""usage: compute_test.py GLINT SOURCE_DIR"""
import csv
import json

from glint_case import GlintTest, main


class Compute(GlintTest):
    def rows(self, name):
        with (self.folder / name).open(newline="") as file:
            return list(csv.DictReader(file))

    def programs(self):
        """Returns the names of the suite, without those that are another language's form of one."""
        names = [line.split()[0] for line in self.glint("list", "programs").stdout.splitlines()]
        return [name for name in names if not name.endswith("-ptx")]

    def test_a_run_keeps_the_sum_of_its_launches_and_a_table_of_them(self):
        done = self.glint("run", "bfs", "--small", "--out", "one")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("checked    4 096 values, all as in the reference", done.stdout)
        launches, statistics = self.rows("one/launches.csv"), self.statistics("one")
        self.assertEqual([row["kernel"] for row in launches[:3]], ["bfs_expand", "bfs_advance", "bfs_expand"])
        self.assertEqual(sum(int(row["cycles"]) for row in launches), statistics["gpu.cycles"])
        facts = json.loads((self.folder / "one/run.json").read_text())
        self.assertEqual((facts["scene"]["name"], facts["scene"]["form"], facts["scene"]["note"]), ("bfs", "compute", "4,096 nodes"))

    def test_a_bench_of_the_suite_has_a_row_for_each_program_and_resumes(self):
        self.assertEqual(len(self.programs()), 13)
        done = self.glint("bench", "compute", "--small", "--mode", "functional", "--out", "all", "-j", "2")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual([row["workload"] for row in self.rows("all/metrics.csv")], self.programs())
        again = self.glint("bench", "compute", "--small", "--mode", "functional", "--out", "all", "--resume")
        self.assertIn(f"{len(self.programs())} of them complete: small inputs, functional", again.stdout)

    def test_scenes_and_programs_stand_in_one_table(self):
        done = self.glint("bench", "NN", "WKND_SH", "--small", "--size", "16x16", "--out", "both")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual([row["workload"] for row in self.rows("both/metrics.csv")][0], "WKND_SH")

    def test_options_that_all_workloads_of_a_sweep_get_are_no_errors_where_nothing_reads_them(self):
        done = self.glint("run", "bfs", "--small", "--size", "8x8", "--seed", "3", "--launch", "x.toml", "--out", "run")
        self.assertEqual(done.returncode, 0, done.stderr)
        warnings = [line for line in done.stderr.splitlines() if line.startswith("warning: ")]
        self.assertEqual(warnings, ["warning: --launch changes nothing, because only a kernel (.ptx) has a launch file", "warning: --size changes nothing, because only scenes read it",
                                    "warning: --seed changes nothing, because only scenes read it"])
        self.assertNotIn("changes nothing", self.glint("run", "WKND_SH", "--size", "2x2", "--spp", "1", "--out", "scene").stderr)

    def test_options_that_mean_nothing_are_refused(self):
        self.expect(2, ["--small belongs to compute programs, and 'WKND' is none"], "run", "WKND", "--small")
        self.expect(2, ["--fov belongs to scenes, and 'bfs' is none", "--small"], "run", "bfs", "--fov", "40")
        self.expect(2, ["--profile, --sample, --heat and --trace cannot be used"], "run", "bfs", "--profile")
        self.expect(2, ["-I and -D cannot be used"], "run", "bfs", "-D", "N=1")
        for file in ("a.capsule", "a.ptx", "a.amber"):
            self.expect(2, [f"-I and -D cannot be used with '{file}'"], "run", file, "-I", "parts")
        self.expect(2, ["--json cannot be used with Amber scripts"], "run", "a.amber", "--json")
        self.expect(2, ["the bench has none"], "bench", "WKND_SH", "--small")
        self.expect(2, ["the bench has none"], "bench", "compute", "--fov", "40")
        self.expect(2, ["did you mean 'bfs'?"], "bench", "bfss")
        self.assertFalse((self.folder / "out").exists())

    def test_a_run_that_is_ended_early_says_so(self):
        self.expect(6, ["ended early"], "run", "bfs", "--small", "--max-cycles", "3000", "--out", "part")
        self.assertEqual(len(self.rows("part/launches.csv")), 1)


if __name__ == "__main__":
    main()

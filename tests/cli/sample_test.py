# Tests what a sampled run leaves, what it refuses, and how two of them are compared.
# SPDX-License-Identifier: Apache-2.0
"""usage: sample_test.py GLINT SOURCE_DIR"""
import sys

import glint_case
from glint_case import ROOT, GlintTest

sys.path.insert(0, str(ROOT / "python"))
import glint  # noqa: E402

# The sample fills the part of the machine, which has 4 warps a core, several times.
FRAME = ["WKND_SH", "--size", "128x96", "--spp", "1", "--config", "mobile", "--set", "core.warps=4", "--stats", "compact"]
SAMPLE = [*FRAME, "--sample-pixels", "15%"]


class Sampling(GlintTest):
    def sample(self, out, *arguments):
        return self.run_into(out, *SAMPLE, *arguments)

    def test_a_sampled_run_has_estimates_with_intervals_and_says_what_was_sampled(self):
        said = self.sample("a", "--sample-seed", "3")
        self.assertIn("a sample of 15 %, seed 3", said)
        self.assertIn("95 % interval", said)
        statistics = self.statistics("a")
        for name in ("cycles", "ipc", "l1_hit_rate", "l2_hit_rate", "dram_utilisation"):
            value, low, high = (statistics[f"gpu.sample.{name}{end}"] for end in ("", "_low", "_high"))
            self.assertTrue(low < value < high, name)
        sample = self.facts("a")["sample"]
        self.assertEqual((sample["share"], sample["seed"], sample["by"], sample["scale"], sample["blocks"]), (0.15, 3, "position", 4, 384))
        self.assertGreater(len((self.folder / "a/sample.csv").read_text().splitlines()), 3)
        # Metrics of the sample alone would be taken for those of the launch.
        metrics = self.glint("stats", "a", "--format", "metrics").stdout
        self.assertIn(f"{statistics['gpu.sample.cycles']:.6g}", metrics)
        self.assertIn("gpu.sample.*", metrics)
        self.expect(2, ["timed only a sample of its launch", "without --sample-pixels"], "model", "a")

    def test_a_whole_run_in_the_same_folder_leaves_no_sample_behind(self):
        self.sample("a")
        self.assertEqual(self.glint("run", *FRAME, "--out", "a").returncode, 0)
        self.assertFalse((self.folder / "a/sample.csv").exists())
        self.assertNotIn("sample", self.facts("a"))

    def test_runs_of_the_same_blocks_are_compared_in_pairs(self):
        self.sample("a")
        self.sample("slow", "--set", "rt.warps=1")
        self.sample("other", "--sample-seed", "2")
        paired = self.glint("compare", "a", "slow").stdout
        self.assertIn("Both runs have timed the same blocks", paired)
        self.assertRegex(paired, r"cycles .*\+.* significant")
        equal = self.glint("compare", "a", "a").stdout
        self.assertNotRegex(equal, r"% +significant")
        self.assertIn("different blocks", self.glint("compare", "a", "other").stdout)
        self.expect(1, ["failed: cycles>5%"], "compare", "a", "slow", "--fail-on", "cycles>5%")

    def test_blocks_can_be_chosen_by_what_they_cost(self):
        self.sample("a")
        for way in ("uniform", "cost", "heat"):
            self.sample(way, "--sample-by", way)
            sample = self.facts(way)["sample"]
            self.assertEqual(sample["by"], way)
            whole, there = (self.statistics(out)["gpu.sample.cycles"] for out in ("a", way))
            self.assertNotEqual(whole, there)
            self.assertIn("different blocks", self.glint("compare", "a", way).stdout)
        self.expect(2, ["--sample-by"], "run", *SAMPLE, "--sample-by", "colour")
        self.expect(2, ["--sample-by needs --sample-pixels"], "run", *FRAME, "--sample-by", "cost")

    def test_a_bench_samples_pixels_and_launches_and_shows_intervals(self):
        words = ["bench", "WKND_SH", "gaussian", "--small", "--size", "128x96", "--spp", "1", "--set", "core.warps=8", "-j", "1", "--out", "bench"]
        done = self.glint(*words, "--sample-pixels", "15%", "--sample-launches", "8", "--sample-seed", "3")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"WKND_SH +[\d ]+ +\+- \d+\.\d %")
        rows = self.rows("bench/estimates.csv")
        for workload in ("WKND_SH", "gaussian"):
            found = {row["estimate"]: row for row in rows if row["workload"] == workload}
            self.assertTrue(float(found["cycles"]["low"]) < float(found["cycles"]["value"]) < float(found["cycles"]["high"]))
            self.assertEqual(float(found["cycles"]["value"]), glint.Run(self.folder / "bench" / workload).estimates["cycles"].value)
        self.expect(2, ["--sample-launches belongs to"], "bench", "WKND_SH", "--sample-launches", "8")
        self.expect(2, ["--sample-pixels belongs to"], "bench", "gaussian", "--sample-pixels", "8%")
        self.expect(2, ["cannot be used with --mode functional"], "bench", "WKND_SH", "--sample-pixels", "8%", "--mode", "functional")

    def test_the_python_package_has_the_estimates(self):
        self.sample("a")
        run, statistics = glint.Run(self.folder / "a"), self.statistics("a")
        self.assertTrue(run.is_sampled)
        self.assertEqual(run.cycles, round(statistics["gpu.sample.cycles"]))
        self.assertEqual(run.ipc, statistics["gpu.sample.ipc"])
        self.assertEqual(run.estimates["l1_hit_rate"].low, statistics["gpu.sample.l1_hit_rate_low"])
        self.assertEqual(run.metrics["cycles"], statistics["gpu.sample.cycles"])
        self.assertIsNone(run.metrics["simt_efficiency"])

    def test_points_of_a_sweep_carry_intervals(self):
        self.write("two.toml", """name = "two"
workloads = ["WKND_SH"]
[run]
size = "128x96"
spp = 1
sample-pixels = "15%"
[[design]]
method = "grid"
keys = { rt.warps = [1, 4], core.warps = [4] }
""")
        rows = self.collect("two.toml")
        self.assertEqual(len(rows), 2)
        for row in rows:
            self.assertTrue(float(row["cycles_low"]) < float(row["cycles"]) < float(row["cycles_high"]))
            self.assertTrue(float(row["l1_hit_rate_low"]) < float(row["l1_hit_rate"]))

    def test_what_cannot_be_sampled_is_refused(self):
        for share in ("5", "0%", "51%", "x%", "-1%", "nan%"):
            self.expect(2, ["expected more than 0% and at most 50%"], "run", *FRAME, f"--sample-pixels={share}")
        self.expect(2, ["a sample of 1 % has"], "run", *FRAME, "--sample-pixels", "1%")
        for options in (["--mode", "functional"], ["--profile"], ["--sample", "100"], ["--heat"], ["--max-cycles", "5"]):
            self.expect(2, ["--sample-pixels cannot be used with"], "run", *SAMPLE, *options)
        self.expect(2, ["--sample-pixels cannot be used with --frames"], "run", *SAMPLE, "--frames", "0:1")
        self.expect(2, ["--sample-pixels cannot be used with 'bfs'"], "run", "bfs", "--sample-pixels", "5%")


if __name__ == "__main__":
    glint_case.main()

# Tests runs of several launches of which a sample is timed: what they leave, what they refuse, how they are compared.
# SPDX-License-Identifier: Apache-2.0
"""usage: launch_sample_test.py GLINT SOURCE_DIR"""
import sys

import glint_case
from glint_case import ROOT, GlintTest

sys.path.insert(0, str(ROOT / "python"))
import glint  # noqa: E402

PROGRAM = ["gaussian", "--small"]  # 30 launches of two kernels
FRAMES = ["WKND", "--shader", "sh", "--size", "24x24", "--spp", "1", "--frames", "0:5"]


class LaunchSampling(GlintTest):
    def check_cover(self, sampled, whole):
        """Checks that the intervals of a sampled run hold what the whole run counted."""
        estimates, truth = glint.Run(self.folder / sampled).estimates, glint.Run(self.folder / whole)
        for name, value in (("cycles", truth.cycles), ("ipc", truth.ipc), ("instructions", truth.cycles * truth.ipc)):
            one = estimates[name]
            self.assertTrue(one.low * 0.999 <= value <= one.high * 1.001, f"{name}: {value} and {one}")

    def test_a_program_is_estimated_from_some_of_its_launches(self):
        said = self.run_into("a", *PROGRAM, "--sample-launches", "8", "--sample-seed", "3")
        self.assertIn("seed 3: 8 of 30 launches were timed", said)
        self.assertIn("all as in the reference", said)
        self.run_into("whole", *PROGRAM)
        self.check_cover("a", "whole")
        sample = self.facts("a")["sample"]
        self.assertEqual((sample["seed"], sample["launches"], sample["timed"]), (3, 30, 8))
        timed, launches, signatures = self.rows("a/sample.csv"), self.rows("a/launches.csv"), self.rows("a/signatures.csv")
        self.assertEqual(sum(float(row["weight"]) for row in timed), 30)
        self.assertEqual({row["launch"] for row in timed}, {row["launch"] for row in launches if row["cycles"]})
        self.assertEqual([row["kernel"] for row in signatures], [row["kernel"] for row in launches])
        self.assertEqual(len({(row["cluster"], row["kernel"]) for row in signatures}), sample["clusters"])
        # The first launch of each kernel finds data that nothing has touched, so it stands for itself.
        first = {row["launch"] for i, row in enumerate(signatures) if row["kernel"] not in [one["kernel"] for one in signatures[:i]]}
        self.assertEqual(len(first), 2)
        self.assertEqual([row["weight"] for row in timed if row["launch"] in first], ["1", "1"])
        # Each cluster of several launches has two timed ones at least.
        for cluster in {row["cluster"] for row in signatures}:
            size = sum(row["cluster"] == cluster for row in signatures)
            self.assertGreaterEqual(sum(row["cluster"] == cluster for row in timed), min(2, size))

    def test_a_share_is_a_number_of_launches_and_threads_change_nothing(self):
        self.run_into("one", *PROGRAM, "--sample-launches", "20%", "--threads", "1")
        self.run_into("two", *PROGRAM, "--sample-launches", "6", "--threads", "2")
        self.assertEqual((self.folder / "one/sample.csv").read_bytes(), (self.folder / "two/sample.csv").read_bytes())
        self.assertEqual((self.folder / "one/stats.json").read_bytes(), (self.folder / "two/stats.json").read_bytes())

    def test_frames_leave_all_pictures_and_the_directories_of_the_timed_ones(self):
        self.run_into("a", *FRAMES, "--sample-launches", "3")
        self.run_into("whole", *FRAMES)
        self.check_cover("a", "whole")
        frames = self.facts("a")["frames"]
        self.assertEqual(len(frames), 3)
        for frame in frames:
            self.assertEqual((self.folder / "a" / frame / "image.pfm").read_bytes(), (self.folder / "whole" / frame / "image.pfm").read_bytes())
        self.assertEqual((self.folder / "a/animation.png").read_bytes(), (self.folder / "whole/animation.png").read_bytes())
        self.assertEqual(len(self.rows("a/frames.csv")), 3)
        self.assertFalse((self.folder / "whole/sample.csv").exists())

    def test_a_list_of_launches_saves_what_all_of_them_have_left(self):
        pipeline = str(ROOT / "examples/temporal/pipeline.toml")
        self.run_into("a", pipeline, "--sample-launches", "9")
        self.run_into("whole", pipeline)
        facts, whole = self.facts("a"), self.facts("whole")
        self.assertEqual(len(facts["launches"]), 9)
        self.assertEqual(len(whole["launches"]), 24)
        self.assertTrue(set(facts["launches"]) < set(whole["launches"]))
        for name in facts["saved"]:
            self.assertEqual((self.folder / "a" / name).read_bytes(), (self.folder / "whole" / name).read_bytes(), name)
        self.check_cover("a", "whole")

    def test_samples_of_the_same_launches_are_compared_in_pairs(self):
        sampled = [*PROGRAM, "--sample-launches", "8"]
        self.run_into("a", *sampled)
        self.run_into("slow", *sampled, "--set", "memory.noc.request_latency=200")
        self.run_into("other", *sampled, "--sample-seed", "2")
        said = self.glint("compare", "a", "slow").stdout
        self.assertIn("Both runs have timed the same launches", said)
        self.assertRegex(said, r"cycles .*\+.* significant")
        self.assertIn("different launches", self.glint("compare", "a", "other").stdout)

    def test_a_sweep_carries_the_intervals(self):
        self.write("two.toml", """name = "two"
workloads = ["WKND_SH"]
[run]
size = "24x24"
spp = 1
frames = "0:5"
sample-launches = 3
[[design]]
method = "grid"
keys = { core.warps = [4, 8] }
""")
        rows = self.collect("two.toml")
        self.assertEqual(len(rows), 2)
        for row in rows:
            self.assertTrue(float(row["cycles_low"]) < float(row["cycles"]) < float(row["cycles_high"]))

    def test_a_sweep_samples_the_launches_of_a_program(self):
        self.write("program.toml", """name = "program"
workloads = ["gaussian"]
seeds = [1, 2]
[run]
small = true
sample-launches = 8
[[design]]
method = "grid"
keys = { core.warps = [8, 16] }
""")
        rows = self.collect("program.toml")
        self.assertEqual([row["core.warps"] for row in rows], ["8", "16"])  # A program has no seed.
        for row in rows:
            self.assertTrue(float(row["cycles_low"]) < float(row["cycles"]) < float(row["cycles_high"]))
        self.write("wrong.toml", (self.folder / "program.toml").read_text().replace("sample-launches = 8", "sample-pixels = '5%'"))
        self.expect(2, ["--sample-pixels cannot be used with 'gaussian'"], "sweep", "run", "wrong.toml")

    def test_what_cannot_be_sampled_is_refused(self):
        for number in ("0", "-3", "2.5", "x", "100%", "0%"):
            self.expect(2, ["expected a number of launches or a share"], "run", *PROGRAM, f"--sample-launches={number}")
        self.expect(2, ["a sample of 3 launches is too small", "at least 6 (20 %)"], "run", *PROGRAM, "--sample-launches", "3")
        self.expect(2, ["a sample of 30 launches leaves nothing out"], "run", *PROGRAM, "--sample-launches", "30")
        self.expect(2, ["the run has 1 launch, and a sample needs as many"], "run", "nn", "--small", "--sample-launches", "1")
        self.expect(2, ["--sample-launches needs --frames"], "run", "WKND", "--sample-launches", "2")
        self.expect(2, ["cannot be used together"], "run", *FRAMES, "--sample-launches", "2", "--sample-pixels", "5%")
        self.expect(2, ["--sample-seed needs"], "run", *PROGRAM, "--sample-seed", "2")
        self.expect(2, ["which has one launch"], "run", str(ROOT / "examples/mandelbrot/mandelbrot.comp"), "--sample-launches", "2")
        for options in (["--mode", "functional"], ["--max-cycles", "5"]):
            self.expect(2, ["--sample-launches cannot be used with"], "run", *PROGRAM, "--sample-launches", "8", *options)


if __name__ == "__main__":
    glint_case.main()

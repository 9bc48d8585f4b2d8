# What `glint run --profile --sample` leaves, and what `glint annotate` shows of it. Runs the real binary.
# SPDX-License-Identifier: Apache-2.0
"""usage: profile_test.py GLINT SOURCE_DIR"""
import csv
import re

import glint_case
from glint_case import ROOT, GlintTest

SMALL = ["--size", "16x16", "--spp", "1"]


class Profile(GlintTest):
    def glint(self, code, *arguments):
        done = super().glint(*arguments)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def stats(self, name):
        lines = (self.folder / "out/stats.txt").read_text().splitlines()
        return sum(float(line.split()[1]) for line in lines if re.match(name + " ", line))

    def test_profile_series_and_statistics_of_a_run_agree(self):
        self.glint(0, "run", "WKND", *SMALL, "--profile", "--sample", "1000", "--out", "out")
        rows = list(csv.DictReader((self.folder / "out/profile.csv").read_text().splitlines()))
        slots = sum(int(r["cycles"]) for r in rows if r["by"] != "line")
        self.assertEqual(slots, self.stats(r"gpu\.core\[\d+\]\.issue_slots::\w+"))
        issues = sum(int(r["issues"]) for r in rows if r["by"] == "instruction")
        self.assertEqual(issues, self.stats(r"gpu\.core\[\d+\]\.instructions"))
        folded = (self.folder / "out/profile.folded").read_text().splitlines()
        self.assertEqual(sum(int(line.rsplit(" ", 1)[1]) for line in folded), slots)
        series = list(csv.DictReader((self.folder / "out/series.csv").read_text().splitlines()))
        self.assertEqual(sum(float(r["instructions"]) for r in series), issues)

    def test_annotate_shows_the_source_lines_with_their_share(self):
        self.glint(0, "run", "WKND", *SMALL, "--profile", "--out", "out")
        shown = self.glint(0, "annotate", "out", "raygen.rgen").stdout
        source = next(ROOT.glob("shaders/path_tracing/raygen.rgen")).read_text().splitlines()
        trace = next(line for line in source if "traceRayEXT" in line)
        row = next(line for line in shown.splitlines() if trace.strip() in line)
        self.assertRegex(row, r"^ *\d+\.\d % +\d")
        everything = self.glint(0, "annotate", "out").stdout
        shares = [float(x) for x in re.findall(r"(?m)^ \w+ +[\d ]+? +(\d+\.\d) %", everything)]
        self.assertAlmostEqual(sum(shares), 100.0, delta=1.0)

    def test_what_cannot_be_shown_is_refused_with_a_way_out(self):
        self.assertIn("--profile", self.glint(2, "annotate", "nowhere").stderr)
        self.glint(0, "run", "WKND", *SMALL, "--profile", "--out", "out")
        self.assertIn("raygen.rgen", self.glint(2, "annotate", "out", "other.glsl").stderr)
        self.assertIn("functional", self.glint(2, "run", "WKND", *SMALL, "--mode", "functional", "--profile").stderr)
        self.glint(2, "annotate", "out/stats.csv")


if __name__ == "__main__":
    glint_case.main()

# `glint characterize`: its tables, its page in a real browser, and what it refuses.
# SPDX-License-Identifier: Apache-2.0
"""usage: characterize_test.py GLINT SOURCE_DIR SUITE...; the suite Browser needs Chromium and says so where there is none."""
import csv
import re
import shutil
import subprocess
import sys

import glint_case
from glint_case import ROOT, GlintTest

METRICS = ROOT / "tests/unit/characterize/data/metrics.csv"
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
SKIPPED = 77


class Characterize(GlintTest):
    def table(self, name):
        with open(self.folder / "out" / name, newline="") as file:
            return list(csv.DictReader(file))

    def run_on(self, *arguments):
        done = self.glint("characterize", *arguments, "-o", "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout


class Tables(Characterize):
    def test_every_table_is_there_and_they_agree_with_each_other(self):
        text = self.run_on(METRICS)
        workloads = [row["workload"] for row in self.table("scores.csv")]
        self.assertEqual(len(workloads), 46)
        kept = [row for row in self.table("eigenvalues.csv") if row["kept"] == "1"]
        self.assertTrue(all(float(row["eigenvalue"]) > 1 for row in kept))
        self.assertEqual(len(self.table("scores.csv")[0]) - 1, len(kept))
        self.assertEqual(sorted(row["workload"] for row in self.table("leaves.csv")), sorted(workloads))
        self.assertEqual(len(self.table("linkage.csv")), 45)
        self.assertEqual(int(self.table("linkage.csv")[-1]["leaves"]), 46)
        clusters = {row["workload"]: row["cluster"] for row in self.table("leaves.csv")}
        subset = self.table("subset.csv")
        self.assertEqual([clusters[row["workload"]] for row in subset], [row["cluster"] for row in subset])
        self.assertEqual(len({row["workload"].split("_")[0] for row in subset}), 8)
        for row in subset:
            self.assertIn(row["workload"], text)
        axes = [row["metric"] for row in self.table("metrics_chosen.csv")]
        kiviat = self.table("kiviat.csv")
        self.assertEqual(list(kiviat[0])[1:], axes)
        for axis in axes:
            values = [float(row[axis]) for row in kiviat]
            self.assertEqual((min(values), max(values)), (0, 1))

    def test_the_same_command_gives_the_same_bytes(self):
        self.run_on(METRICS)
        first = {path.name: path.read_bytes() for path in (self.folder / "out").iterdir()}
        self.run_on(METRICS)
        self.assertEqual(first, {path.name: path.read_bytes() for path in (self.folder / "out").iterdir()})
        self.assertEqual(len(first), 11)

    def test_linkage_clusters_and_metrics_are_what_was_asked_for(self):
        self.run_on(METRICS, "--linkage", "ward", "--clusters", "5", "--metrics", "3")
        self.assertEqual(len(self.table("subset.csv")), 5)
        self.assertEqual(len(self.table("metrics_chosen.csv")), 3)

    def test_a_subset_tells_the_speed_up_of_all(self):
        (self.folder / "suite").mkdir()
        rows = METRICS.read_text().splitlines()
        column = rows[0].split(",").index("cycles")
        twice = [rows[0]] + [",".join([*row.split(",")[:column], str(float(row.split(",")[column]) / 2), *row.split(",")[column + 1:]]) for row in rows[1:]]
        (self.folder / "suite/metrics.csv").write_text("\n".join(twice))
        text = self.run_on(METRICS, "--against", "suite")
        self.assertRegex(text, r"representatives: +mean 2\.000.*mean \+0\.0 %")

    def test_a_table_of_ones_own_needs_no_columns_of_glint(self):
        name = self.write("own.csv", "program,loads,branches\nA,1,5\nB,2,3\nC,9,1\nD,8,2\n")
        self.run_on(name, "--clusters", "2", "--metrics", "1")
        self.assertEqual(len(self.table("standardised.csv")), 4)

    def test_bad_input_is_refused_with_the_reason(self):
        self.expect(2, ["nowhere.csv"], "characterize", "nowhere.csv")
        (self.folder / "empty").mkdir()
        self.expect(2, ["empty/metrics.csv", "glint bench"], "characterize", "empty")
        self.expect(2, ["expected at least 3"], "characterize", self.write("two.csv", "workload,a,b\nX,1,2\nY,2,1\n"))
        self.expect(2, ["no column 'cycles'"], "characterize", METRICS, "-o", "out", "--against", self.write("other.csv", "workload,a\nX,1\n"))


class Browser(Characterize):
    def test_every_figure_is_drawn_and_the_console_says_nothing(self):
        (self.folder / "suite").mkdir()
        shutil.copy(METRICS, self.folder / "suite")
        self.write("suite/models.csv", "workload,cycles,model:one,model:other,inputs\nA,1000,1500,900,1\nB,2000,1000,2500,2\nC,40000,41000,38000,3\n")
        self.run_on("suite")
        done = subprocess.run([CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={self.folder}/profile", "--enable-logging=stderr", "--window-size=1280,900",
                               "--virtual-time-budget=20000", "--dump-dom", f"file://{self.folder}/out/characterization.html"], capture_output=True, text=True, timeout=280)
        console = [line for line in done.stderr.splitlines() if "CONSOLE" in line]
        self.assertIn('data-ready="yes"', done.stdout, "\n".join(console))
        self.assertEqual(console, [])
        figures = {re.search(r'id="([\w-]+)"', head).group(1): body for head, body in re.findall(r"<figure ([^>]*id=[^>]*)>(.*?)</figure>", done.stdout, re.S)}
        self.assertEqual(set(figures), {"scree", "plane-1-2", "plane-3-4", "dendrogram", "kiviats", "model-cycles", "model-errors"})
        for workload in (row["workload"] for row in self.table("scores.csv")):
            self.assertIn(f">{workload}</text>", figures["dendrogram"])
            self.assertIn(f">{workload}</text>", figures["kiviats"])
        for name, least in (("scree", 20), ("plane-1-2", 46), ("plane-3-4", 46), ("dendrogram", 45), ("kiviats", 92), ("model-cycles", 6), ("model-errors", 6)):
            self.assertGreaterEqual(figures[name].count("<path"), least, name)


if __name__ == "__main__":
    if "Browser" in sys.argv and not CHROMIUM:
        print("SKIPPED: no Chromium here, so that no page is drawn")
        sys.exit(SKIPPED)
    glint_case.main()

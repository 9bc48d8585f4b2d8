# Tests `glint characterize`: its tables, the report's sections in a real browser, and what is refused.
# SPDX-License-Identifier: Apache-2.0
"""usage: characterize_test.py GLINT SOURCE_DIR SUITE...; the suite Browser needs Chromium and says so where there is none."""
import csv
import html
import json
import re
import shutil
import sys
import xml.etree.ElementTree

import glint_case
from glint_case import CHROMIUM, GlintTest, ROOT

METRICS = ROOT / "tests/unit/characterize/data/metrics.csv"
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


MODELS = "workload,cycles,model:one,model:other,inputs\nA,1000,1500.25,900,1\nB,2000,1000,2500,2\nC,40000,41000,38000,3\n"
FIGURES = {"scree", "plane-1-2", "plane-3-4", "dendrogram", "kiviats", "model-cycles", "model-errors"}


def plain(text):
    """Returns a number as the page shows it."""
    return float(text.replace("\u202f", "").replace("−", "-").removesuffix(" %"))


class Report(Characterize):
    def make_suite(self):
        """Makes a folder like that of a bench without its runs: metrics, models, characterisation."""
        (self.folder / "suite").mkdir()
        shutil.copy(METRICS, self.folder / "suite")
        self.write("suite/models.csv", MODELS)
        done = self.glint("characterize", "suite")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("glint report suite", done.stdout)
        shutil.copytree(self.folder / "suite/characterization", self.folder / "out")

    def page(self, *named):
        done = self.glint("report", *named, "-o", "page.html")
        self.assertEqual(done.returncode, 0, done.stderr)
        return (self.folder / "page.html").read_text()

    def static_rows(self, page, kind):
        """Returns the cells of a table that reads without script."""
        found = re.findall(rf'<table class="metrics" data-table="{kind}">.*?<tbody>(.*?)</tbody>', page, re.S)
        self.assertEqual(len(found), 1, kind)
        return [[re.sub(r"<[^>]*>", "", cell) for cell in re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row)] for row in re.findall(r"<tr>.*?</tr>", found[0], re.S)]

    def sections(self, page):
        return {name: text for name, text in re.findall(r'<section id="((?:characterization|models)[^"]*)">(.*?)</section>', page, re.S)}


class Page(Report):
    def test_tables_without_script_have_the_numbers_of_the_csv_files(self):
        self.make_suite()
        page = self.page("suite")
        leaves = [row["workload"] for row in self.table("leaves.csv")]
        for kind, skipped in (("scores", 2), ("kiviat", 2)):
            values = {row["workload"]: [float(value) for name, value in row.items() if name != "workload"] for row in self.table(f"{kind}.csv")}
            rows = self.static_rows(page, kind)
            self.assertEqual([row[0] for row in rows], leaves)
            for row in rows:
                self.same([plain(cell) for cell in row[skipped:]], values[row[0]])
        self.same([plain(row[1]) for row in self.static_rows(page, "eigenvalues")], [float(row["eigenvalue"]) for row in self.table("eigenvalues.csv")][:20])
        self.same([plain(row[3]) for row in self.static_rows(page, "linkage")], [float(row["distance"]) for row in self.table("linkage.csv")])
        self.assertEqual([(row[0], row[1]) for row in self.static_rows(page, "subset")], [(row["cluster"], row["workload"]) for row in self.table("subset.csv")])
        self.assertEqual([row[1] for row in self.static_rows(page, "metrics_chosen")], [row["metric"] for row in self.table("metrics_chosen.csv")])
        self.assertEqual([row[0] for row in self.static_rows(page, "dropped")], [row["metric"] for row in self.table("dropped.csv")])
        loadings = self.static_rows(page, "loadings")
        for row, known in zip(loadings, self.table("loadings.csv"), strict=True):
            for cell, value in zip(row[1:], list(known.values())[1:], strict=True):
                self.assertAlmostEqual(float(cell), float(value), delta=0.00501)
        self.assertEqual(self.static_rows(page, "predictions"), [["A", "1\u202f000", "1\u202f500", "+50.0 %", "900", "-10.0 %"], ["B", "2\u202f000", "1\u202f000", "-50.0 %", "2\u202f500", "+25.0 %"], ["C", "40\u202f000", "41\u202f000", "+2.5 %", "38\u202f000", "-5.0 %"]])
        self.assertEqual(self.static_rows(page, "models")[0][2:], ["34.2 %", "0.92", "50.0 %", "A"])

    def same(self, shown, known):
        """Returns a number with four digits below 1000."""
        for one, other in zip(shown, known, strict=True):
            self.assertAlmostEqual(one, other, delta=6e-4 * abs(other) + 1e-12)

    def test_each_command_has_its_section_and_the_page_is_small(self):
        self.make_suite()
        self.assertEqual(set(self.sections(self.page("suite/characterization"))), {"characterization"})
        self.assertEqual(set(self.sections(self.page("suite/models.csv"))), {"models"})
        self.assertEqual(set(self.sections(self.page("out", "suite"))), {"characterization", "characterization-2", "models"})
        page = self.page("suite")
        self.assertEqual(set(self.sections(page)), {"characterization", "models"})
        self.assertNotIn('id="configuration"', page)
        self.assertNotIn('id="metrics"', page)
        self.assertLess(len(page.encode()), 1_000_000)
        self.assertEqual(self.glint("report", "suite").stdout.strip(), "suite/report.html")
        self.assertEqual(self.glint("report", "suite/models.csv").stdout.strip(), "report.html")

    def test_runs_without_them_say_how_to_get_them_and_runs_that_changed_since_are_counted(self):
        self.assertEqual(self.glint("run", "WKND", "--shader", "sh", "--size", "8x8", "--spp", "1", "--out", "one").returncode, 0)
        self.make_suite()
        shutil.rmtree(self.folder / "suite/characterization")
        (self.folder / "suite/models.csv").unlink()
        for count, name in enumerate(("WKND_SH", "SHIP_SH", "REF_AO"), 1):
            shutil.copytree(self.folder / "one", self.folder / "suite" / name)
            sections = self.sections(self.page("suite"))
            self.assertEqual(set(sections), {"characterization", "models"} if count == 3 else set())
        self.assertIn("<code>glint characterize suite</code>", sections["characterization"])
        self.assertIn("<code>glint model suite</code>", sections["models"])
        self.assertEqual(self.sections(self.page("one")), {})
        self.assertEqual(self.glint("model", "suite", "--statistics-only").returncode, 0)
        self.assertEqual(self.glint("characterize", "suite").returncode, 0)
        sections = self.sections(self.page("suite"))
        self.assertIn("3 of the runs in this report have other cycles", sections["characterization"])
        self.assertNotIn("other cycles", sections["models"])
        cycles = json.loads((self.folder / "one/stats.json").read_text())["gpu"]["cycles"]["value"]
        models = (self.folder / "suite/models.csv").read_text()
        self.write("suite/models.csv", models.replace(f"SHIP_SH,{cycles}", f"SHIP_SH,{cycles + 1}"))
        self.assertIn("1 of the runs in this report has other cycles", self.sections(self.page("suite"))["models"])
        self.assertEqual(self.glint("model", "one", "--statistics-only").returncode, 0)
        self.assertIn("<th scope=\"row\">one</th>", self.sections(self.page("one"))["models"])

    def test_what_is_no_characterisation_or_another_versions_is_refused_with_the_reason(self):
        self.make_suite()
        path = self.folder / "suite/characterization/characterization.json"
        whole = json.loads(path.read_text())
        for broken, parts in ((path.read_text()[:500], ["not a characterisation"]), (json.dumps({**whole, "schema": 0}), ["schema 0, expected 1", "again with this one"]),
                              (json.dumps({name: value for name, value in whole.items() if name != "joins"}), ["joins", "damaged"]), (json.dumps({**whole, "leaves": [99]}), ["99", "damaged"])):
            path.write_text(broken)
            self.expect(2, [*parts, "glint characterize"], "report", "suite")
        self.expect(2, ["not a table of models", "glint model"], "report", self.write("other.csv", "a,b\n1,2\n"))


class Browser(Report):
    def load(self, *named):
        """Returns the page after its script has run, with all files that its figures hand out."""
        keep = """
          const kept = {}, show = () => { document.body.dataset.kept = JSON.stringify(kept); };
          let last = null;
          URL.createObjectURL = (blob) => { last = blob; return "#"; };
          HTMLAnchorElement.prototype.click = function () { last.text().then((text) => { kept[this.download] = text; show(); }); };
          document.querySelectorAll("figcaption button").forEach((button) => button.click());"""
        self.write("page.html", glint_case.when_ready(self.page(*named), keep))
        done = glint_case.opened(self.folder / "page.html")
        console = [line for line in done.stderr.splitlines() if "CONSOLE" in line]
        self.assertIn('data-ready="yes"', done.stdout, "\n".join(console))
        self.assertEqual(console, [])
        figures = {re.search(r'id="([\w-]+)"', head).group(1): body for head, body in re.findall(r"<figure ([^>]*id=[^>]*)>(.*?)</figure>", done.stdout, re.S)}
        return figures, json.loads(html.unescape(re.search(r'data-kept="([^"]*)"', done.stdout).group(1)))

    def test_every_figure_is_drawn_and_the_console_says_nothing(self):
        self.make_suite()
        figures, files = self.load("suite")
        self.assertEqual(set(figures), FIGURES)
        self.assertEqual(set(files), {f"{name}.{kind}" for name in FIGURES for kind in ("csv", "svg")})
        for workload in (row["workload"] for row in self.table("scores.csv")):
            self.assertIn(f">{workload}</text>", figures["dendrogram"])
            self.assertIn(f">{workload}</text>", figures["kiviats"])
        for name, least in (("scree", 20), ("plane-1-2", 46), ("plane-3-4", 46), ("dendrogram", 45), ("kiviats", 92), ("model-cycles", 6), ("model-errors", 6)):
            self.assertGreaterEqual(figures[name].count("<path"), least, name)
            self.assertGreaterEqual(len(list(xml.etree.ElementTree.fromstring(files[f"{name}.svg"]).iter("{http://www.w3.org/2000/svg}path"))), least, name)
            self.assertRegex(files[f"{name}.svg"], r'^<svg width="720" height="\d+" xmlns="http://www.w3.org/2000/svg"')
            self.assertIn("<summary>Table</summary>", figures[name])
        second, _ = self.load("out", "suite")
        self.assertEqual(set(second), FIGURES | {f"{name}-2" for name in FIGURES if not name.startswith("model")})

    def test_what_figures_hand_out_is_the_csv_files_to_the_last_bit(self):
        self.make_suite()
        _, files = self.load("suite")
        rows = {name: list(csv.reader(text.splitlines()))[1:] for name, text in files.items() if name.endswith(".csv")}
        number = lambda table, skipped: [[float(value) for value in row[skipped:]] for row in table]
        of = lambda name, *columns: [[float(row[column]) for column in columns] for row in self.table(name)]
        self.assertEqual([[float(row[1])] for row in rows["scree.csv"]], of("eigenvalues.csv", "eigenvalue"))
        for row, known in zip(rows["scree.csv"], self.table("eigenvalues.csv"), strict=True):
            self.assertAlmostEqual(float(row[2]), float(known["share"]), places=14)  # the last bit of a sum depends on its order
        self.assertEqual(number(rows["plane-1-2.csv"], 3), of("scores.csv", "PC1", "PC2"))
        self.assertEqual(number(rows["plane-3-4.csv"], 3), of("scores.csv", "PC3", "PC4"))
        clusters = {row["workload"]: row["cluster"] for row in self.table("leaves.csv")}
        self.assertEqual({row[0]: row[2] for row in rows["plane-1-2.csv"]}, clusters)
        self.assertEqual(number(rows["dendrogram.csv"], 1), of("linkage.csv", "first", "second", "distance", "leaves"))
        kiviat = {row.pop("workload"): [float(value) for value in row.values()] for row in self.table("kiviat.csv")}
        self.assertEqual({row[0]: [float(value) for value in row[2:]] for row in rows["kiviats.csv"]}, kiviat)
        models = [row.split(",") for row in MODELS.splitlines()[1:]]
        self.assertEqual([[row[0], *map(float, row[1:])] for row in rows["model-cycles.csv"]], [[row[0], *map(float, row[1:4])] for row in models])
        self.assertEqual(number(rows["model-errors.csv"], 1), [[abs(float(value) / float(row[1]) - 1) for value in row[2:4]] for row in models])

    def test_runs_and_their_suite_stand_on_one_page(self):
        for name in ("WKND_SH", "WKND_AO"):
            self.assertEqual(self.glint("run", "WKND", "--shader", name[-2:].lower(), "--size", "8x8", "--spp", "1", "--out", f"suite/{name}").returncode, 0)
        self.write("suite/models.csv", MODELS)
        shutil.copy(METRICS, self.folder / "suite")
        self.assertEqual(self.glint("characterize", "suite").returncode, 0)
        figures, _ = self.load("suite")
        self.assertLess(FIGURES | {"cpi-stack", "ipc", "deltas"}, set(figures))


if __name__ == "__main__":
    if "Browser" in sys.argv and not CHROMIUM:
        print("SKIPPED: no Chromium here, so that no page is drawn")
        sys.exit(SKIPPED)
    glint_case.main()

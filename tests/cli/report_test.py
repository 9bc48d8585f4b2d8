# `glint report`: the page is whole, loads nothing from elsewhere, and shows the numbers of stats.json, in a real browser too.
# SPDX-License-Identifier: Apache-2.0
"""usage: report_test.py GLINT SOURCE_DIR SUITE...; the suite Browser needs Chromium and says so where there is none."""
import csv
import html
import html.parser
import json
import math
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import glint_case
from glint_case import GLINT, ROOT, GlintTest

SMALL = ["--size", "16x16", "--spp", "1"]


def leaves(tree, path=""):
    """(pattern, instance, value) of every number of stats.json; a histogram is one value."""
    for name, child in tree.items():
        here = f"{path}.{name}" if path else name
        if not isinstance(child, dict):
            continue
        if "value" in child and "unit" in child:
            found = re.findall(r"\[(\d+)\]", here)
            pattern, instance = re.sub(r"\[\d+\]", "[*]", here), int(found[0]) if found else 0
            parts = child["value"].items() if isinstance(child["value"], dict) else [("", child["value"])]
            for part, value in parts:
                yield f"{pattern}::{part}" if part else pattern, instance, value
        else:
            yield from leaves(child, here)


def trimmed(bins):
    while bins and bins[-1] == 0:
        bins = bins[:-1]
    return bins


class Elements(html.parser.HTMLParser):
    """Attributes and text of elements, in order."""

    def __init__(self, text):
        super().__init__()
        self.found, self.open = [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.found.append([tag, dict(attributes), ""])
        if tag not in ("meta", "img", "br", "link", "input"):
            self.open.append(self.found[-1])

    def handle_endtag(self, tag):
        while self.open and self.open.pop()[0] != tag:
            pass

    def handle_data(self, data):
        for element in self.open:
            element[2] += data

    def having(self, attribute):
        return [(tag, attributes, text) for tag, attributes, text in self.found if attribute in attributes]


class ReportTest(GlintTest):
    @classmethod
    def setUpClass(cls):
        cls.shared = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.shared.cleanup)

        def run(out, *options):
            subprocess.run([GLINT, "run", *options, *SMALL, "--out", out], cwd=cls.shared.name, check=True, capture_output=True)

        run("wknd", "WKND", "--shader", "pt", "--profile", "--sample", "1000")
        run("slow", "WKND", "--shader", "pt", "--set", "rt.box.latency=40")

    def setUp(self):
        super().setUp()
        self.runs = {name: f"{self.shared.name}/{name}" for name in ("wknd", "slow")}

    def report(self, *names):
        done = self.glint("report", *[self.runs[name] for name in names], "-o", "report.html")
        self.assertEqual(done.returncode, 0, done.stderr)
        return (self.folder / "report.html").read_text()

    def document(self, page):
        return glint_case.page_document(page)

    def stats(self, name):
        return json.loads(pathlib.Path(self.runs[name], "stats.json").read_text())

    def equal_to_stats_json(self, stats, name):
        """How many numbers there are; `stats`: of the page, path by path."""
        count = 0
        for path, instance, value in leaves(self.stats(name)):
            there = stats[path] if stats[path] == 0 else stats[path][instance]
            self.assertEqual(trimmed(value) if isinstance(value, list) else value, there if there != 0 or not isinstance(value, list) else [], path)
            count += 1
        return count

    def total(self, name, pattern):
        return sum(value for path, _, value in leaves(self.stats(name)) if path == pattern)


class Page(ReportTest):
    def test_every_number_of_stats_json_is_in_the_page(self):
        run = self.document(self.report("wknd"))["runs"][0]
        self.assertGreater(self.equal_to_stats_json(run["stats"], "wknd"), 3000)
        series = list(csv.DictReader(pathlib.Path(self.runs["wknd"], "series.csv").read_text().splitlines()))
        self.assertEqual(run["series"]["ipc"], [float(row["ipc"]) for row in series])
        self.assertEqual(sum(op["issues"] for op in run["profile"]["ops"]), self.total("wknd", "gpu.core[*].instructions"))

    def test_the_page_loads_nothing_and_stays_small(self):
        page = self.report("wknd")
        elements = Elements(page)
        for tag, attributes, _ in elements.found:
            for name in ("src", "href", "data", "poster", "srcset", "action"):
                if name in attributes:
                    self.assertRegex(attributes[name], r"^(data:|#)", f"<{tag} {name}>")
        self.assertFalse([tag for tag, _, _ in elements.found if tag in ("link", "iframe", "object", "embed")])
        style = "".join(text for tag, _, text in elements.found if tag == "style")
        self.assertNotRegex(style, r"@import|url\(")
        policy = [attributes["content"] for tag, attributes, _ in elements.found if attributes.get("http-equiv") == "Content-Security-Policy"]
        self.assertEqual(len(policy), 1)
        self.assertIn("default-src 'none'", policy[0])
        pictures = sum(len(attributes["src"]) for tag, attributes, _ in elements.found if tag == "img")
        self.assertLess(len(page.encode()) - pictures, 1_000_000)
        sources = [attributes["src"] for tag, attributes, _ in elements.found if tag == "img"]
        self.assertEqual((len(sources), len(re.findall("data:image/png;base64,", page))), (1, 1))
        self.assertIn("Apache ECharts", page)
        self.assertIn("Redistribution and use in source and binary forms", page)

    def test_tables_without_script_have_every_metric_as_stats_gives_it(self):
        page = self.report("wknd", "slow")
        static = page[: page.index('id="data"')]
        rows = dict(re.findall(r'<tr><th scope="row"><code>([^<]+)</code></th>(<td.*?)</tr>', static[static.index('class="metrics"'):]))
        for column, name in enumerate(("wknd", "slow")):
            lines = self.glint("stats", self.runs[name], "--format", "metrics").stdout.splitlines()
            self.assertEqual(len(lines), 87)
            for metric, value in (line.split()[:2] for line in lines):
                if value == "-":
                    continue
                shown = re.findall(r'<td class="n">(.*?)</td>', rows[metric])[column]
                plain = float(shown.replace("\u202f", "").replace("−", "-"))
                self.assertAlmostEqual(plain, float(value), delta=abs(float(value)) * 6e-4 + 1e-12, msg=metric)

    def test_many_runs_have_their_key_metrics_without_script_and_weigh_little(self):
        sizes = {}
        for count in (1, 9, 46):
            page = self.report(*["wknd", "slow"][:count], *["slow"] * (count - 2))
            elements = Elements(page)
            sizes[count] = len(page.encode()) - sum(len(attributes["src"]) for tag, attributes, _ in elements.found if tag == "img")
            self.assertEqual("key figures of its" in page, count > 8)
        self.assertLess(sizes[46], 1_000_000)
        static = page[page.index('id="metrics"'):page.index('id="data"')]
        names = re.findall(r"<code>([\w%]+)</code></th>", static)
        rows = [[float(value.replace("\u202f", "").replace("−", "-")) for value in re.findall(r'<td class="n">(.*?)</td>', row)] for row in re.findall(r'<tr><th scope="row">.*?</tr>', static)]
        self.assertEqual((len(names), len(rows)), (10, 46))
        for row, run in zip(rows, self.document(page)["runs"]):
            for name, value in zip(names, row):
                self.assertAlmostEqual(value, run["metrics"][name], delta=abs(value) * 6e-4 + 1e-12, msg=name)

    def test_the_numbers_of_figures_read_without_script_too(self):
        page = self.report("wknd", "slow")
        there = re.search(r"<noscript>\n<section id=\"numbers\">(.*?)</noscript>", page, re.S).group(1)
        groups = {stat: dict((name, [int(value.replace("\u202f", "")) for value in re.findall(r'<td class="n">(.*?)</td>', cells)])
                             for name, cells in re.findall(r'<tr><th scope="row">(.*?)</th>(.*?)</tr>', rows, re.S))
                  for stat, rows in re.findall(r'<tbody data-of="([^"]*)">(.*?)</tbody>', there, re.S)}
        statistics = [{}, {}]
        for sums, run in zip(statistics, ("wknd", "slow")):
            for path, _, value in leaves(self.stats(run)):
                sums[path] = [a + b for a, b in zip(sums.get(path, [0] * len(value)), value)] if isinstance(value, list) else sums.get(path, 0) + value
        for stat in ("gpu.core[*].issue_slots", "gpu.core[*].raygen.instructions", "gpu.core[*].closest_hit.latency", "gpu.rt_unit[*].rt.cycles", "gpu.memory.core[*].l1.miss_stages"):
            parts = sorted({path.split("::")[1] for path in statistics[0] if path.startswith(stat + "::")})
            expected = {part: [sums[f"{stat}::{part}"] for sums in statistics] for part in parts}
            self.assertEqual(groups[stat], {part: values for part, values in expected.items() if any(values)}, stat)
        self.assertNotIn("gpu.core[*].any_hit.latency", groups)  # all 0
        bins = [[value for value in sums["gpu.rt_unit[*].rt.ray_nodes"]] for sums in statistics]
        self.assertEqual(list(groups["gpu.rt_unit[*].rt.ray_nodes"].values()), [list(pair) for pair in zip(*bins) if any(pair)])
        profile = self.document(page)["runs"][0]["profile"]["ops"]
        self.assertEqual(groups["profile: ops by latency"]["rt.trace"], [next(op["latency"] for op in profile if op["name"] == "rt.trace"), 0])

    def test_what_differs_from_the_preset_is_told(self):
        document = self.document(self.report("wknd", "slow"))
        self.assertEqual(document["runs"][0]["preset"], {"name": "mobile", "changes": {}})
        self.assertEqual(document["runs"][1]["preset"]["changes"], {"rt.box.latency": 13})
        self.assertEqual(document["runs"][1]["config"]["rt.box.latency"], 40)

    def test_an_own_configuration_is_compared_as_the_run_kept_it_with_a_preset_that_is_named(self):
        text = (ROOT / "configs/mobile.toml").read_text()
        written = {"same.toml": (ROOT / "configs/desktop.toml").read_text(), "mine.toml": text.replace("cores = 8 ", "cores = 3 ")}
        for name, content in written.items():
            self.write(name, content)
            self.runs[name] = f"run of {name}"
            done = self.glint("run", "WKND", "--shader", "pt", *SMALL, "--config", name, "--out", self.runs[name])
            self.assertEqual(done.returncode, 0, done.stderr)
        changes = lambda name: self.document(self.report(name))["runs"][0]["preset"]
        self.assertEqual(changes("same.toml"), {"name": "desktop", "changes": {}})
        expected = {"name": "mobile", "changes": {"cores": 8}}
        self.assertEqual(changes("mine.toml"), expected)
        self.write("mine.toml", text.replace("cores = 8 ", "cores = 6 "))
        self.assertEqual(changes("mine.toml"), expected)
        for name in written:
            (self.folder / name).unlink()
        self.assertEqual(changes("mine.toml"), expected)
        static = lambda *names: (page := self.report(*names))[: page.index('id="data"')]
        self.assertRegex(static("mine.toml"), "<code>mine.toml</code> is no preset: .* compared with mobile")
        self.assertIn("3<small>mobile 8</small>", static("mine.toml"))
        self.assertNotIn("Every key has", static("mine.toml"))
        self.assertIn("Every key has the value of desktop.", static("same.toml"))
        self.assertEqual(static("mine.toml", "mine.toml").count("is no preset"), 1)
        self.assertIn("Every key has the value of its run’s preset: mobile, desktop.", static("wknd", "same.toml"))

    def test_the_built_page_is_that_of_the_sources(self):
        for name in ("report.html", "report.css"):
            self.assertEqual((ROOT / "web/dist" / name).read_bytes(), (ROOT / "web/src" / name).read_bytes(), "run `npm run build` in web/")
        script = (ROOT / "web/dist/report.js").read_text()
        for module in (ROOT / "web/src").rglob("*.js"):
            for text in re.findall(r'(?:title|note): "([^"]{12,})"', module.read_text()):
                self.assertIn(text, script, f"{module}: run `npm run build` in web/")

    def test_keys_that_stalls_name_exist(self):
        keys = set(self.document(self.report("wknd"))["runs"][0]["config"])
        text = (ROOT / "web/src/sections/stalls.js").read_text()
        named = set(re.findall(r'"((?:core|memory|rt|compiler)\.[\w.]+)"', text))
        self.assertGreater(len(named), 20)
        self.assertEqual(named - keys, set())
        reasons = set(re.findall(r"^  (\w+): \[\"", text, re.M))
        slots = {path.split("::")[1] for path, _, _ in leaves(self.stats("wknd")) if "issue_slots::" in path}
        self.assertEqual(slots - reasons, {"issued"})

    def test_the_file_goes_where_it_is_asked_to(self):
        copy = self.folder / "copy"
        shutil.copytree(self.runs["wknd"], copy)
        self.assertEqual(self.glint("report", "copy").stdout.strip(), "copy/report.html")
        self.assertTrue((copy / "report.html").exists())
        self.assertEqual(self.glint("report", "copy", self.runs["slow"]).stdout.strip(), "report.html")
        self.assertTrue(self.glint("report", "copy", "-o", "-").stdout.startswith("<!doctype html>"))

    def test_the_folder_of_a_bench_stands_for_its_runs(self):
        for name in self.runs:
            shutil.copytree(self.runs[name], self.folder / "suite" / name)
        self.write("suite/metrics.csv", "workload\n")
        self.assertEqual(self.glint("report", "suite").stdout.strip(), "suite/report.html")
        page = self.document((self.folder / "suite/report.html").read_text())
        self.assertEqual([run["metrics"]["cycles"] for run in page["runs"]], [self.total(name, "gpu.cycles") for name in sorted(self.runs)])
        self.write("none/metrics.csv", "workload\n")
        self.expect(2, ["none", "no run directory", "glint bench"], "report", "none")

    def test_bad_input_is_refused_with_a_reason(self):
        copy = self.folder / "copy"
        shutil.copytree(self.runs["wknd"], copy)
        self.expect(2, ["no run directory", "nowhere"], "report", "nowhere")
        (self.folder / "empty").mkdir()
        self.expect(2, ["run.json", "no such file"], "report", "empty")
        run_json = (copy / "run.json").read_text()
        self.write("copy/run.json", run_json.replace('"schema": 1', '"schema": 0'))
        self.expect(2, ["schema 0, expected 1", "another version"], "report", "copy")
        self.write("copy/run.json", run_json.replace('"exit": 0', '"exit": 5, "message": "stuck"'))
        self.expect(2, ["the run failed: stuck"], "report", "copy")
        self.write("copy/run.json", run_json.replace('"mode": "timing"', '"mode": "functional"'))
        self.expect(2, ["--mode timing"], "report", "copy")
        self.write("copy/run.json", run_json[:200])
        self.expect(2, ["copy/run.json", "JSON"], "report", "copy")
        self.write("copy/run.json", run_json)
        self.write("copy/stats.json", (copy / "stats.json").read_text()[:1000])
        self.expect(2, ["copy/stats.json", "JSON"], "report", "copy")
        (copy / "stats.json").unlink()
        self.expect(2, ["copy/stats.json", "not finished"], "report", "copy")


class Compare(ReportTest):
    def test_compare_lists_what_changed_and_fails_on_a_condition(self):
        was, now = self.runs["wknd"], self.runs["slow"]
        cycles = [self.total(name, "gpu.cycles") for name in ("wknd", "slow")]
        change = 100 * (cycles[1] / cycles[0] - 1)
        done = self.glint("compare", was, now)
        self.assertEqual(done.returncode, 0, done.stderr)
        row = next(line.split() for line in done.stdout.splitlines() if line.startswith("cycles "))
        self.assertEqual([float(value) for value in row[1:3]], cycles)
        self.assertAlmostEqual(float(row[3]), change, delta=0.006)
        self.assertNotIn("\nrays_total", done.stdout)
        self.assertIn("\nrays_total", self.glint("compare", was, now, "--all").stdout)
        self.assertEqual(self.glint("compare", was, now, "--fail-on", f"cycles<{change - 0.1:.3f}%").returncode, 0)
        self.expect(1, ["failed: cycles<"], "compare", was, now, "--fail-on", "ipc<-99%", "--fail-on", f"cycles<{change + 0.1:.3f}%")
        self.assertIn("are equal", self.glint("compare", was, was).stdout)

    def test_compare_refuses_what_it_cannot_read(self):
        run = self.runs["wknd"]
        self.expect(2, ["METRIC<-2%"], "compare", run, run, "--fail-on", "ipc")
        self.expect(2, ["did you mean 'ipc'"], "compare", run, run, "--fail-on", "ipcs<1%")
        self.expect(2, ["nowhere"], "compare", run, "nowhere")

    def test_imgdiff_measures_pictures_and_draws_the_difference(self):
        same = self.glint("imgdiff", self.runs["wknd"], self.runs["slow"], "--min-psnr", "200")
        self.assertEqual(same.returncode, 0, same.stderr)
        self.assertRegex(same.stdout, r"PSNR +inf")
        done = self.glint("run", "WKND", "--shader", "pt", *SMALL, "--seed", "2", "--mode", "functional", "--out", "other")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.expect(1, ["PSNR below 200"], "imgdiff", self.runs["wknd"], "other", "--min-psnr", "200")
        self.assertEqual(self.glint("imgdiff", self.runs["wknd"], "other/image.png", "-o", "diff.png").returncode, 0)
        self.assertEqual((self.folder / "diff.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(self.glint("imgdiff", self.runs["wknd"], "other/image.png", "-o", "flip.png", "--metric", "flip").returncode, 0)
        self.assertNotEqual((self.folder / "flip.png").read_bytes(), (self.folder / "diff.png").read_bytes())
        self.assertRegex(same.stdout, r"FLIP +0\.000000")
        self.expect(1, ["FLIP 0.", "above 0.001"], "imgdiff", self.runs["wknd"], "other", "--max-flip", "0.001")
        self.expect(2, ["--ppd"], "imgdiff", self.runs["wknd"], "other", "--ppd", "0")
        self.expect(2, ["16x16", "8x8"], "imgdiff", self.runs["wknd"], self.small())
        self.expect(2, ["stats.csv"], "imgdiff", f"{self.runs['wknd']}/stats.csv", self.runs["slow"])

    def pfm(self, name, *pixels):
        """Of 16 by 12 pixels: black but for the first ones."""
        values = [channel for pixel in pixels for channel in pixel] + [0] * (576 - 3 * len(pixels))
        (self.folder / name).write_bytes(b"PF\n16 12\n-1.0\n" + b"".join(struct.pack("<48f", *values[y * 48 : y * 48 + 48]) for y in reversed(range(12))))
        return name

    def test_imgdiff_passes_no_gate_with_a_broken_picture(self):
        nan, inf = math.nan, math.inf
        black, broken = self.pfm("black.pfm"), self.pfm("nan.pfm", *[(nan, nan, nan)] * 192)
        gates = ["--min-psnr", "60", "--max-flip", "0.01"]
        for options in ([], gates, ["-o", "d.png"], ["-o", "f.png", "--metric", "flip"]):
            self.expect(1, ["failed: not finite", "192 of 192 pixels; the first at x 0, y 0 ", "nan nan nan in 'nan.pfm'"], "imgdiff", black, broken, *options)
        one = self.pfm("one.pfm", *[(0, 0, 0)] * 18, (0, inf, 0))
        done = self.expect(1, ["1 of 192 pixels; the first at x 2, y 1 from the top left: 0 inf 0 in 'one.pfm', 0 0 0 in 'black.pfm'"], "imgdiff", one, black, *gates)
        for measure in ("MSE", "PSNR", "SSIM", "FLIP"):
            self.assertRegex(done.stdout, f"{measure} +- ")
        self.assertRegex(done.stdout, "pixels apart +1 +of 192\nnot finite +1 ")
        self.expect(1, ["failed"], "imgdiff", one, self.pfm("other.pfm", *[(0, 0, 0)] * 18, (0, -inf, 0)))
        self.expect(0, ["warning: not finite in both", "192 pixels"], "imgdiff", broken, broken, "--min-psnr", "inf")

    def test_imgdiff_refuses_a_bound_that_cannot_fail(self):
        black, grey = self.pfm("black.pfm"), self.pfm("grey.pfm", (0.5, 0.5, 0.5))
        for option, value in (("--min-psnr", "nan"), ("--min-psnr", "-inf"), ("--max-flip", "nan"), ("--max-flip", "inf"), ("--max-flip", "2"), ("--ppd", "nan"), ("--min-psnr", "x")):
            self.expect(2, [option, value], "imgdiff", black, grey, option, value)
        self.expect(1, ["PSNR below inf"], "imgdiff", black, grey, "--min-psnr", "inf")

    def small(self):
        (self.folder / "small.pfm").write_bytes(b"PF\n8 8\n-1.0\n" + bytes(8 * 8 * 12))
        return "small.pfm"


CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")

# Presses all buttons below figures; data-kept of the body gets what they save.
HAND_OUT = """
  const kept = {};
  let last = null;
  URL.createObjectURL = (blob) => { last = blob; return "#"; };
  HTMLAnchorElement.prototype.click = function () { last.text().then((text) => { kept[this.download] = text; show(); }); };
  const show = () => { document.body.dataset.kept = JSON.stringify(kept); };
  document.querySelectorAll("figcaption button").forEach((button) => button.click());"""


class Browser(ReportTest):
    def load(self, *names, script=""):
        """The page's document after its script has run, and then `script`; the console must have said nothing."""
        page = self.report(*names)
        self.write("report.html", glint_case.when_ready(page, script))
        done = subprocess.run(
            [CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={self.folder}/profile", "--enable-logging=stderr", "--window-size=1280,900",
             "--virtual-time-budget=20000", "--dump-dom", f"file://{self.folder}/report.html"],
            capture_output=True, text=True, timeout=280)
        console = [line for line in done.stderr.splitlines() if "CONSOLE" in line]
        self.assertIn('data-ready="yes"', done.stdout, "the script did not end:\n" + "\n".join(console))
        self.assertEqual(console, [])
        return Elements(done.stdout), done.stdout

    def test_one_run_shows_the_numbers_of_stats_json(self):
        page, text = self.load("wknd")
        shown = {attributes["data-stat"]: (attributes["data-value"], words) for _, attributes, words in page.having("data-stat")}
        cycles = self.total("wknd", "gpu.cycles")
        self.assertEqual(float(shown["gpu.cycles"][0]), cycles)
        self.assertEqual(int(shown["gpu.cycles"][1].replace("\u202f", "")), cycles)
        self.assertEqual(float(shown["gpu.rt_unit[*].rt.rays"][0]), self.total("wknd", "gpu.rt_unit[*].rt.rays"))
        stalls = {path: sum(v for p, _, v in leaves(self.stats("wknd")) if p == path) for path in shown if "issue_slots" in path}
        self.assertEqual(len(stalls), 3)
        for path, value in stalls.items():
            self.assertEqual(float(shown[path][0]), value, path)
        all_waits = sorted((self.total("wknd", p) for p in {p for p, _, _ in leaves(self.stats("wknd")) if "issue_slots::" in p and not p.endswith("::issued")}), reverse=True)
        self.assertEqual(sorted(stalls.values(), reverse=True), all_waits[:3])
        self.tables_equal_stats(text, "wknd")
        table = re.search(r'<div id="all-metrics">(.*?)</table>', text, re.S).group(1)
        drawn = {name: float(value) for name, value in re.findall(r'<code>([^<]+)</code></th><td class="n" data-value="([^"]*)"', table)}
        given = [line.split()[:2] for line in self.glint("stats", self.runs["wknd"], "--format", "metrics").stdout.splitlines()]
        self.assertEqual(set(drawn), {name for name, value in given if value != "-"})
        for name, value in ((name, float(value)) for name, value in given if value != "-"):
            self.assertAlmostEqual(drawn[name], value, delta=abs(value) * 1e-5, msg=name)

    def tables_equal_stats(self, text, name):
        """Tables of figures have the sums of stats.json, and every figure has a drawing."""
        figures = {re.search(r'id="([\w-]+)"', head).group(1): body for head, body in re.findall(r'<figure ([^>]*id="[^>]*)>(.*?)</figure>', text, re.S)}
        for expected in ("cpi-stack", "instruction-mix", "stages", "stage-cycles", "ops", "op-latency", "rt-use", "traversal", "rt-cycles", "fetch-mix", "ray-nodes", "l1", "l2", "miss-stages", "dram", "dram-clocks", "series"):
            self.assertRegex(figures[expected], r"<svg.*<path", expected)
        rows = dict(re.findall(r'<tr><th scope="row">([^<]*)</th><td class="n" data-value="([^"]*)"', figures["cpi-stack"]))
        self.assertEqual(len(rows), 23)
        for reason, value in rows.items():
            self.assertEqual(float(value), self.total(name, f"gpu.core[*].issue_slots::{reason}"), reason)
        mix = re.search(r"by latency</th>(.*?)</tr>", figures["instruction-mix"], re.S).group(1)
        values = [float(value) for value in re.findall(r'data-value="([^"]*)"', mix)]
        classes = [self.total(name, f"gpu.core[*].latency_by_class::{part}") for part in ("alu", "sfu", "mem", "tex", "ctrl", "rt")]
        self.assertEqual(values, [*classes, sum(classes)])
        self.stages_equal_stats(figures["stages"], name)

    def stages_equal_stats(self, figure, name):
        """Counts and latencies of every stage and class, and what they add up to."""
        rows = {stage: [float(value) for value in re.findall(r'data-value="([^"]*)"', row)] for stage, row in re.findall(r'<tr><th scope="row">([^<]*)</th>(.*?)</tr>', figure, re.S)}
        self.assertEqual(list(rows), ["ray generation", "intersection", "closest hit", "miss"])
        for shown, stage in zip(rows, ("raygen", "intersection", "closest_hit", "miss")):
            expected = []
            for part in ("instructions", "latency"):
                classes = [self.total(name, f"gpu.core[*].{stage}.{part}::{one}") for one in ("alu", "sfu", "mem", "tex", "ctrl", "rt")]
                expected += [*classes, sum(classes)]
            self.assertEqual(rows[shown], expected, stage)
        self.assertEqual(sum(row[-1] for row in rows.values()), sum(value for path, _, value in leaves(self.stats(name)) if path.startswith("gpu.core[*].latency_by_class::")))

    def test_the_browser_reads_every_number_of_stats_json_whatever_the_page_holds_of_it(self):
        for names in (("wknd",), ("wknd", "slow")):
            _, text = self.load(*names, script=f"{glint_case.reader()} readDocument().then((data) => {{ document.body.dataset.kept = JSON.stringify(data.runs.map(({{ stats, metrics, config }}) => ({{ stats, metrics, config }}))); }});")
            kept = json.loads(html.unescape(re.search(r'data-kept="([^"]*)"', text).group(1)))
            for name, run in zip(names, kept):
                self.assertGreater(self.equal_to_stats_json(run["stats"], name), 3000)
                self.assertEqual(run["config"]["rt.box.latency"], 40 if name == "slow" else 13)
                self.assertEqual(run["metrics"]["cycles"], self.total(name, "gpu.cycles"))

    def test_a_damaged_page_and_an_old_browser_are_told(self):
        page = self.report("wknd")
        at = page.index('id="data">') + 1000
        for name, text, told in (("damaged", page[:at] + ("A" * 40) + page[at + 40:], "This page is damaged"), ("old", page.replace("<head>", "<head><script>delete window.DecompressionStream</script>", 1), "2023 or later")):
            self.write(f"{name}.html", text)
            done = subprocess.run([CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={self.folder}/profile", "--virtual-time-budget=20000", "--dump-dom", f"file://{self.folder}/{name}.html"],
                                  capture_output=True, text=True, timeout=280)
            self.assertRegex(done.stdout, rf'<p class="note failed">[^<]*{told}', name)
            self.assertNotIn('data-ready="yes"', done.stdout)

    def test_panes_of_the_source_view_have_the_instructions_of_stats_json_shader_by_shader(self):
        walk = """
          const sums = [], wait = () => document.documentElement.dataset.source === "yes" ? walk() : setTimeout(wait, 50);
          const walk = () => {
            const [program, , measure] = document.querySelectorAll(".picks select");
            for (const option of program.options) {
              program.value = option.value;
              program.dispatchEvent(new Event("change"));
              sums.push([...document.querySelectorAll(".pane")].map((pane) => ["cycles", "issues", "lanes", "sectors"].map((name) => Number(pane.dataset[name]))));
            }
            const list = document.querySelector(".pane.isa .lines"), press = (key) => list.dispatchEvent(new KeyboardEvent("keydown", { key }));
            program.value = program.options[0].value;
            program.dispatchEvent(new Event("change"));
            measure.value = "2";
            measure.dispatchEvent(new Event("change"));
            press("End");
            const last = document.querySelector(".pane.isa [aria-selected=true]").textContent;
            press("ArrowUp"), press("ArrowUp");
            const marked = [...document.querySelectorAll(".pane")].map((pane) => pane.querySelectorAll(".on").length);
            document.body.dataset.kept = JSON.stringify({ sums, last, marked, count: document.querySelectorAll(".pane.isa [role=option]").length });
          };
          wait();"""
        page, _ = self.load("wknd", script=walk)
        kept = json.loads(next(attributes["data-kept"] for tag, attributes, _ in page.found if tag == "body"))
        self.assertGreaterEqual(len(kept["sums"]), 4)
        issued = self.total("wknd", "gpu.core[*].instructions")
        profile = csv.DictReader(pathlib.Path(self.runs["wknd"], "profile.csv").read_text().splitlines())
        slots = sum(v for p, _, v in leaves(self.stats("wknd")) if "issue_slots::" in p) - sum(int(row["cycles"]) for row in profile if row["by"] == "no_warp")
        for pane in range(3):
            cycles, issues, lanes, sectors = (sum(program[pane][i] for program in kept["sums"]) for i in range(4))
            self.assertEqual(issues, issued)
            self.assertEqual(cycles, slots)
            self.assertEqual([lanes, sectors], [sum(program[2][i] for program in kept["sums"]) for i in (2, 3)])
        self.assertRegex(kept["last"], rf"{kept['count'] - 1}\D")
        self.assertEqual(kept["marked"][2], 1)
        self.assertGreaterEqual(min(kept["marked"][:2]), 1)

    def test_several_runs_stand_side_by_side_and_the_largest_change_comes_first(self):
        page, text = self.load("wknd", "slow")
        shown = [(attributes["data-stat"], float(attributes["data-value"])) for tag, attributes, _ in page.having("data-stat") if tag == "td"]
        self.assertEqual([value for stat, value in shown if stat == "gpu.cycles"], [self.total("wknd", "gpu.cycles"), self.total("slow", "gpu.cycles")])
        means = re.search(r'<table class="facts" id="means">(.*?)</table>', text, re.S).group(1)
        ratio = self.total("wknd", "gpu.cycles") / self.total("slow", "gpu.cycles")
        self.assertAlmostEqual(float(re.findall(r'data-value="([^"]*)"', means)[2]), ratio, places=9)
        deltas = re.search(r'<table class="deltas pair">(.*?)</table>', text, re.S).group(1)
        pairs = [[float(value) if value else None for value in re.findall(r'data-value="([^"]*)"', row)] for row in re.findall(r"<tr.*?</tr>", deltas, re.S)[1:]]
        self.assertGreater(len(pairs), 60)
        distance = [math.inf if a == 0 and b != 0 else abs(b / a - 1) if a else 0 for a, b in pairs]
        for before, after in zip(distance, distance[1:]):
            self.assertGreaterEqual(before * (1 + 1e-9), after)
        self.assertGreater(distance[0], 0)
        self.assertIn("rt.box.latency=40", text)

    def test_scenes_and_ops_of_several_runs_stand_beside_each_other(self):
        done = self.glint("run", "CORNELL", "--shader", "pt", *SMALL, "--profile", "--out", "cornell")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.runs["cornell"] = f"{self.folder}/cornell"
        page, text = self.load("wknd", "cornell")
        metrics = [run["metrics"] for run in self.document(self.report("wknd", "cornell"))["runs"]]
        figures = dict(re.findall(r'<figure id="([\w-]+)"[^>]*>(.*?)</figure>', text, re.S))
        rows = {name: [float(value) for value in re.findall(r'data-value="([^"]*)"', cells)] for name, cells in re.findall(r'<th scope="row">([^<]*)</th>(.*?)</tr>', figures["geometry"], re.S)}
        for name, metric in (("triangles", "triangles"), ("procedurals", "procedurals"), ("depth", "bvh_depth"), ("size (bytes)", "bvh_bytes"), ("cycles", "cycles")):
            self.assertEqual(rows[name], [run[metric] for run in metrics], name)
        for name in ("ops", "op-cycles", "op-latency", "geometry"):
            self.assertRegex(figures[name], r"<svg.*<path", name)
        _, text = self.load("wknd", "slow")
        self.assertNotIn('<figure id="geometry"', text)  # one scene, the same structures

    def test_configurations_are_told_apart_by_every_key_and_compared_for_the_same_work_only(self):
        """Copies of one run: three keys changed step by step, a run of another size, and the same run twice."""
        keys = ["requests_per_cycle", "request_bytes", "retires_per_cycle"]
        for copy, changed in {"one": 1, "two": 2, "three": 3, "large": 0, "again": 0}.items():
            shutil.copytree(self.runs["wknd"], self.folder / copy)
            config = (self.folder / copy / "config.toml").read_text()
            for key in keys[:changed]:
                config, count = re.subn(rf"(?m)^{key} *= *\S+", f"{key} = 16", config)
                self.assertEqual(count, 1, key)
            self.write(f"{copy}/config.toml", config)
            self.runs[copy] = copy
        run_json = (self.folder / "large/run.json").read_text()
        self.write("large/run.json", re.sub(r'"width": \d+', '"width": 640', run_json))
        _, text = self.load("wknd", "one", "two", "three", "large", "again")
        rows = re.findall(r'<th scope="row">([^<]*)</th><td class="n">(\d+)</td>', re.search(r'<table class="facts" id="means">(.*?)</table>', text, re.S).group(1))
        self.assertEqual(len(rows), 5)
        self.assertEqual(len({name for name, _ in rows}), 5)
        self.assertEqual([int(count) for _, count in rows].count(1), 4, rows)

    def test_runs_without_work_in_common_are_held_against_each_other_only_if_they_are_few(self):
        self.assertEqual(self.glint("run", "CORNELL", "--shader", "pt", *SMALL, "--out", "cornell").returncode, 0)
        self.runs["cornell"] = "cornell"
        for name in ("alpha", "beta", "kernel"):
            shutil.copytree(self.runs["wknd"], self.folder / name)
            facts = json.loads((self.folder / name / "run.json").read_text())
            facts["scene"]["name"] = facts["shader"] = name
            if name == "kernel":
                facts.update(width=0, height=0, samples=0)
            self.write(f"{name}/run.json", json.dumps(facts))
            self.runs[name] = name
        page, text = self.load("cornell", "wknd", "alpha", "kernel", script=HAND_OUT)
        self.assertIn("Metrics by their relative change against CORNELL pt", text)
        files = json.loads(next(attributes["data-kept"] for tag, attributes, _ in page.found if tag == "body"))
        rows = {row[0]: row[2:5] for row in csv.reader(files["changes.csv"].splitlines()[1:])}
        self.assertEqual(rows["proc_tests"], ["0", str(self.total("wknd", "gpu.rt_unit[*].rt.procedural_leaves")), ""])  # no "Infinity"
        self.assertGreater(float(rows["cycles"][2]), 0)
        self.assertIn(">kernel</text>", text)
        self.assertNotIn("kernel ·", text)  # it has no size
        _, text = self.load("cornell", "wknd", "alpha", "beta", "kernel")
        self.assertIn('<figure id="ipc"', text)
        self.assertNotIn("What changed most</h3>", text)

    def test_every_figure_hands_out_its_numbers_and_its_drawing(self):
        page, _ = self.load("wknd", script=HAND_OUT)
        files = json.loads(next(attributes["data-kept"] for tag, attributes, _ in page.found if tag == "body"))
        figures = [attributes["id"] for tag, attributes, _ in page.found if tag == "figure" and "id" in attributes]
        self.assertGreater(len(figures), 15)
        self.assertEqual(set(files), {f"{figure}.{kind}" for figure in figures for kind in ("csv", "svg")} | {"bounds.csv", "structure.csv"})
        for name, text in files.items():
            if name.endswith(".svg"):
                self.assertRegex(text, r'^<svg width="720" height="\d+" xmlns="http://www.w3.org/2000/svg"', name)
                self.assertTrue(list(xml.etree.ElementTree.fromstring(text).iter("{http://www.w3.org/2000/svg}path")), name)
            else:
                rows = list(csv.reader(text.splitlines()))
                self.assertEqual({len(row) for row in rows}, {len(rows[0])}, name)
        series = list(csv.reader(files["series.csv"].splitlines()))
        self.assertEqual(len(series) - 1, len(pathlib.Path(self.runs["wknd"], "series.csv").read_text().splitlines()) - 1)

    def test_a_kernel_without_picture_and_rays_is_shown_too(self):
        done = self.glint("run", ROOT / "shaders/kernels/saxpy.toml", "--out", "saxpy")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.runs["saxpy"] = f"{self.folder}/saxpy"
        page, text = self.load("saxpy")
        self.assertIn("saxpy", text)
        self.assertNotIn("NaN", re.sub(r"<script.*?</script>", "", text, flags=re.S))


if __name__ == "__main__":
    if "Browser" in sys.argv[3:] and not CHROMIUM:
        print("SKIPPED: no Chromium here (`apt-get install chromium`); the report was not looked at in a browser")
        sys.exit(77)
    glint_case.main()

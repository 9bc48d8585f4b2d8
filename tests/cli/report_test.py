# Tests what `glint report`, `compare` and `imgdiff` write: the page is whole, loads nothing from elsewhere, and holds the numbers of stats.json.
# SPDX-License-Identifier: Apache-2.0
"""usage: report_test.py GLINT SOURCE_DIR SUITE..."""
import base64
import csv
import json
import math
import pathlib
import re
import shutil
import struct
import tomllib
import urllib.parse

import glint_case
from glint_case import ROOT
from report_case import SMALL, Elements, ReportTest, leaves


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
        self.assertRegex(static("mine.toml"), "<code>mine.toml</code> is not a preset: .* compared with mobile")
        self.assertIn("3<small>mobile 8</small>", static("mine.toml"))
        self.assertNotIn("Every key has", static("mine.toml"))
        self.assertIn("Every key has the value of desktop.", static("same.toml"))
        self.assertEqual(static("mine.toml", "mine.toml").count("is not a preset"), 1)
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

    def test_a_sweep_has_a_row_for_each_point_that_leads_to_its_own_report(self):
        names = {"WKND-rt.warps=8": "wknd", "WKND-50% #2": "slow"}
        for name, run in names.items():
            shutil.copytree(self.runs[run], self.folder / "sweep" / name)
        shutil.copytree(self.runs["wknd"], self.folder / "sweep/failed")
        facts = json.loads((self.folder / "sweep/failed/run.json").read_text())
        self.write("sweep/failed/run.json", json.dumps(facts | {"exit": 4, "message": "it fell over"}))
        plan = {"workloads": ["WKND"], "axes": {"rt.warps": [8], "config": ["mobile"]}, "runs": [*names, "failed", "never"]}
        self.write("sweep/sweep.json", json.dumps(plan))
        done = self.glint("report", "sweep")
        self.assertEqual((done.returncode, done.stdout), (0, "sweep/report.html\n"), done.stderr)
        page = (self.folder / "sweep/report.html").read_text()
        section = page[page.index('<section id="sweep">'):]
        section = section[:section.index("</section>")]
        self.assertIn("2 of 4 points", section)
        metrics = [dict(line.split()[:2] for line in self.glint("stats", self.runs[run], "--format", "metrics").stdout.splitlines()) for run in names.values()]
        rows = re.findall(r'<tr><th scope="row"><a href="([^"]+)">([^<]+)</a></th>(.*?)</tr>', section)
        self.assertEqual([name for _, name, _ in rows], list(names))
        for (link, name, cells), known in zip(rows, metrics):
            self.assertTrue((self.folder / "sweep" / urllib.parse.unquote(link)).is_file(), link)
            shown = re.findall(r'<td class="n">(.*?)</td>', cells)
            config = tomllib.loads((self.folder / "sweep" / name / "config.toml").read_text())
            self.assertEqual(shown[:2], [str(config["rt"]["warps"]), "mobile"])
            self.assertEqual(shown[2].replace("\u202f", ""), known["cycles"])
        self.assertRegex(section, r"failed</th><td[^>]*>[^<]*it fell over")
        self.assertRegex(section, r"never</th><td[^>]*>it has not been run")
        own = (self.folder / "sweep/WKND-rt.warps=8/report.html").read_text()
        self.assertNotIn('<section id="sweep">', own)
        self.assertEqual(len(self.document(own)["runs"]), 1)
        # Links start at the page, wherever it is.
        self.assertEqual(self.glint("report", "sweep", "-o", "elsewhere.html").returncode, 0)
        self.assertIn('href="sweep/WKND-rt.warps=8/report.html"', (self.folder / "elsewhere.html").read_text())
        self.write("sweep/sweep.json", json.dumps(plan | {"runs": ["never"]}))
        self.expect(2, ["none of the 1 points", "goes on where it stopped"], "report", "sweep")
        self.write("sweep/sweep.json", '{"axes": 3}')
        self.expect(2, ["no plan of a sweep"], "report", "sweep")

    def test_the_page_of_a_bench_names_the_workloads_that_failed(self):
        done = self.glint("bench", "WKND_PT", "--size", "8x8", "--spp", "1", "--out", "b")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.glint("report", "b").returncode, 0)
        self.assertNotIn("Workloads that failed", (self.folder / "b/report.html").read_text())
        shutil.copytree(self.folder / "b/WKND_PT", self.folder / "b/SHIP_SH")
        facts = json.loads((self.folder / "b/SHIP_SH/run.json").read_text())
        self.write("b/SHIP_SH/run.json", json.dumps(facts | {"exit": 4, "message": "it <fell> over"}))
        self.assertEqual(self.glint("report", "b").returncode, 0)
        page = (self.folder / "b/report.html").read_text()
        self.assertRegex(page, r'(?s)<h2>Workloads that failed</h2>.*1 run that.*SHIP_SH</th><td[^>]*>[^<]*it &lt;fell&gt; over')

    def test_bad_input_is_refused_with_a_reason(self):
        copy = self.folder / "copy"
        shutil.copytree(self.runs["wknd"], copy)
        self.expect(2, ["not a run directory", "nowhere"], "report", "nowhere")
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
        self.expect(2, ["copy/stats.json", "cut short"], "report", "copy")
        (copy / "stats.json").unlink()
        self.expect(2, ["copy/stats.json", "the file is gone", "run it again"], "report", "copy")


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
        self.expect(1, ["failed: cycles<"], "compare", was, now, "--fail-on", "thread_ipc<-99%", "--fail-on", f"cycles<{change + 0.1:.3f}%")
        self.assertIn("are equal", self.glint("compare", was, was).stdout)

    def test_compare_lists_keys_that_differ_and_what_cycles_were_spent_on(self):
        done = self.glint("run", "WKND", "--shader", "pt", *SMALL, "--set", "rt.box.latency=40", "--set", "core.issue=lrr", "--out", "keys")
        self.assertEqual(done.returncode, 0, done.stderr)
        text = self.glint("compare", self.runs["wknd"], "keys").stdout
        _, keys, slots, rays = text.split("\n\n")
        rows = [line.split() for line in keys.splitlines()[1:]]
        self.assertEqual([row[0] for row in rows], ["core.issue", "rt.box.latency"])
        self.assertEqual((rows[0][2], rows[1][2:]), ("lrr", ["40", "cycle"]))
        for part, pattern in ((slots, "gpu.core[*].issue_slots"), (rays, "gpu.rt_unit[*].rt.cycles")):
            shares = [self.shares(run, pattern) for run in (self.runs["wknd"], "keys")]
            told = [line.split() for line in part.splitlines()[1:]]
            self.assertEqual({row[0] for row in told}, {name for name in shares[0] if abs(shares[0][name] - shares[1][name]) >= 0.5e-4})
            for name, before, _, after, _, points, _ in told:
                for value, right in ((before, shares[0][name]), (after, shares[1][name]), (points, shares[1][name] - shares[0][name])):
                    self.assertAlmostEqual(float(value), 100 * right, delta=0.0051)
            moved = [abs(float(row[5])) for row in told]
            self.assertEqual(moved, sorted(moved, reverse=True))
        same = self.glint("compare", self.runs["wknd"], self.runs["wknd"]).stdout
        self.assertNotIn("\n\n", same)
        self.assertIn("issued", self.glint("compare", self.runs["wknd"], self.runs["wknd"], "--all").stdout)

    def shares(self, run, pattern):
        """Returns the share of each part of a breakdown, summed over all units."""
        sums = {}
        with open(self.folder / run / "stats.csv", newline="") as file:
            for row in csv.DictReader(file):
                path, _, part = row["path"].partition("::")
                if part and re.sub(r"\[\d+\]", "[*]", path) == pattern:
                    sums[part] = sums.get(part, 0) + float(row["value"])
        return {part: value / sum(sums.values()) for part, value in sums.items()}

    def test_compare_says_that_runs_did_different_work(self):
        done = self.glint("run", "WKND", "--shader", "ao", *SMALL, "--seed", "7", "--out", "ambient")
        self.assertEqual(done.returncode, 0, done.stderr)
        said = self.glint("compare", self.runs["wknd"], "ambient")
        self.assertEqual(said.returncode, 0, said.stderr)
        for part in ("different work", "shader is pt in A and ao in B", "seed is 1 in A and 7 in B"):
            self.assertIn(part, said.stderr)

    def test_compare_takes_folders_of_benches(self):
        for name, more in (("one", ["WKND_PT", "WKND_AO"]), ("two", ["WKND_PT", "--set", "core.warps=4"])):
            done = self.glint("bench", *more, "--size", "8x8", "--spp", "1", "--out", name)
            self.assertEqual(done.returncode, 0, done.stderr)
        said = self.glint("compare", "one", "two", "--fail-on", "cycles>1000%")
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertTrue(said.stdout.startswith("== WKND_PT\n"), said.stdout)
        self.assertNotIn("WKND_AO", said.stdout)
        self.assertIn("1 of the 2 and 1 workloads are in both", said.stderr)
        self.expect(1, ["failed: WKND_PT: occupancy>0%"], "compare", "one", "two", "--fail-on", "occupancy>0%")

    def test_imgdiff_compares_what_two_pipelines_saved(self):
        fill = ("#version 460\nlayout(local_size_x = 8) in;\nlayout(set = 0, binding = 0, rgba32f) uniform image2D a;\n"
                "layout(set = 0, binding = 1, rgba32f) uniform image2D b;\n"
                "void main() { ivec2 at = ivec2(gl_GlobalInvocationID.xy); imageStore(a, at, vec4(0.5)); imageStore(b, at, vec4(VALUE)); }\n")
        images = "".join(f'[[image]]\nname = "{name}"\nset = 0\nbinding = {i}\nsize = [8, 4]\nformat = "rgba32f"\nsave = "{name}.pfm"\n'
                         for i, name in enumerate("ab"))
        self.write("fill.comp", fill)
        self.write("fill.toml", '[compute]\nshader = "fill.comp"\n[launch]\ngroups = [1, 4]\n' + images)
        for name, value in (("first", "0.25"), ("second", "0.5")):
            done = self.glint("run", "fill.toml", "-D", f"VALUE={value}", "--mode", "functional", "--out", name)
            self.assertEqual(done.returncode, 0, done.stderr)
        said = self.glint("imgdiff", "first", "second", "--min-psnr", "20")
        self.assertEqual(said.returncode, 1, said.stderr)
        a, b = said.stdout.split("== b.pfm\n")
        self.assertTrue(a.startswith("== a.pfm\n"), a)
        self.assertRegex(a, r"largest +0 ")
        self.assertRegex(b, r"largest +0\.25 ")
        self.expect(2, ["--out takes one picture"], "imgdiff", "first", "second", "-o", "d.png")
        self.write("fill.toml", (self.folder / "fill.toml").read_text().replace("b.pfm", "other.exr"))
        done = self.glint("run", "fill.toml", "-D", "VALUE=0.5", "--mode", "functional", "--out", "third")
        self.assertEqual(done.returncode, 0, done.stderr)
        said = self.glint("imgdiff", "first", "third", "--min-psnr", "inf")
        self.assertEqual(said.returncode, 0, said.stderr)
        for note in ("only 'first' has b.pfm", "only 'third' has other.exr"):
            self.assertIn(note, said.stderr)

    def test_the_page_of_a_pipeline_shows_every_image_by_its_name(self):
        self.write("fill.comp", "#version 460\nlayout(local_size_x = 8) in;\nlayout(binding = 0, rgba32f) uniform image2D a;\nlayout(binding = 1, rgba32f) uniform image2D b;\n"
                                "layout(binding = 2) buffer N { uint n[8]; };\nvoid main() { ivec2 at = ivec2(gl_GlobalInvocationID.xy); imageStore(a, at, vec4(0.5)); "
                                "imageStore(b, at, vec4(1)); n[at.x] = 7; }\n")
        self.write("fill.toml", "[compute]\nshader = 'fill.comp'\n[launch]\ngroups = [1, 4]\n"
                                "[[image]]\nname = 'albedo'\nbinding = 0\nsize = [8, 4]\nsave = ['albedo.exr', 'albedo.png']\n"
                                "[[image]]\nname = 'a\"<b'\nbinding = 1\nsize = [8, 4]\nsave = 'light.pfm'\n"
                                "[[buffer]]\nname = 'numbers'\nbinding = 2\ncount = 8\ntype = 'u32'\nsave = 'n.csv'\n")
        done = self.glint("run", "fill.toml", "--mode", "timing", "--out", "run")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads((self.folder / "run/run.json").read_text())["outputs"],
                         {"albedo.exr": {"name": "albedo", "kind": "image"}, "albedo.png": {"name": "albedo", "kind": "image"},
                          "light.pfm": {"name": "a\"<b", "kind": "image"}, "n.csv": {"name": "numbers", "kind": "buffer"}})
        done = self.glint("report", "run", "-o", "page.html")
        self.assertEqual(done.returncode, 0, done.stderr)
        page = (self.folder / "page.html").read_text()
        found = re.findall(r'data-map="image:([^"]*)" src="data:image/png;base64,([^"]*)"><figcaption>([^<]*)<', page)
        self.assertEqual([(name, caption.split(": ")[1]) for name, _, caption in found], [("0", "albedo (albedo.exr)"), ("1", "a&quot;&lt;b (light.pfm)")])
        for (_, data, _), grey in zip(found, (128, 255)):
            (self.folder / "shown.png").write_bytes(base64.b64decode(data))
            self.assertEqual(glint_case.read_png(self.folder / "shown.png"), (8, 4, bytes([grey] * 96)))

    def test_compare_refuses_what_it_cannot_read(self):
        run = self.runs["wknd"]
        self.expect(2, ["METRIC<-2%"], "compare", run, run, "--fail-on", "thread_ipc")
        self.expect(2, ["did you mean 'thread_ipc'"], "compare", run, run, "--fail-on", "thread_ipcs<1%")
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
        """Makes a picture of 16 by 12 pixels that is black except for the first ones."""
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


if __name__ == "__main__":
    glint_case.main()

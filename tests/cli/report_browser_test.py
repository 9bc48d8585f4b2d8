# Tests `glint report` in a real browser: its page loads without a word on the console, draws, and shows the numbers of stats.json.
# SPDX-License-Identifier: Apache-2.0
"""usage: report_browser_test.py GLINT SOURCE_DIR; needs Chromium and says so where there is none."""
import csv
import html
import json
import math
import pathlib
import re
import shutil
import sys
import xml.etree.ElementTree

import glint_case
from glint_case import CHROMIUM, ROOT
from report_case import SMALL, Elements, ReportTest, leaves


# This script presses all buttons below figures. data-kept of the body gets what they save.
HAND_OUT = """
  const kept = {};
  let last = null;
  URL.createObjectURL = (blob) => { last = blob; return "#"; };
  HTMLAnchorElement.prototype.click = function () { last.text().then((text) => { kept[this.download] = text; show(); }); };
  const show = () => { document.body.dataset.kept = JSON.stringify(kept); };
  document.querySelectorAll("figcaption button").forEach((button) => button.click());"""


class Browser(ReportTest):
    opened = {}  # what the browser printed, by the bytes of the page; several tests look at one page

    def load(self, *names, script=""):
        """Returns the page's document after its script and then `script` have run. The console must have said nothing."""
        page = glint_case.when_ready(self.report(*names), script)
        if page not in self.opened:
            self.write("report.html", page)
            self.opened[page] = glint_case.opened(self.folder / "report.html")
        done = self.opened[page]
        console = [line for line in done.stderr.splitlines() if "CONSOLE" in line]
        self.assertIn('data-ready="yes"', done.stdout, "the script did not end:\n" + "\n".join(console))
        self.assertEqual(console, [])
        return Elements(done.stdout), done.stdout

    def test_an_experiment_draws_its_speed_ups_beside_the_published_ones(self):
        done = self.glint("lab", "coop25", "--arms", "cooperative", "subwarps-of-4", "--workloads", "SHIP_PT", "--size", "16x16", "--out", self.folder / "lab")
        self.assertEqual(done.returncode, 0, done.stderr)
        document = json.loads((self.folder / "lab/lab.json").read_text())
        self.runs["lab"] = self.folder / "lab"
        self.addCleanup(self.runs.pop, "lab")
        _, text = self.load("lab")
        drawn = text[text.index('id="lab-means"'):text.index('id="lab-by-workload"')]
        self.assertIn("<svg", drawn)
        values = [float(value) for value in re.findall(r'data-value="([^"]+)"', drawn)]
        self.assertEqual(values, [number for arm in document["arms"][1:] for number in (arm["here"], arm["published"])])

    def test_a_sampled_run_shows_its_estimates_and_marks_what_counts_the_sample_alone(self):
        for out, latency in (("sampled", 48), ("changed", 148)):
            self.runs[out] = str(self.folder / out)
            done = self.glint("run", "gaussian", "--small", "--sample-launches", "8", "--set", f"memory.noc.request_latency={latency}", "--out", self.runs[out])
            self.assertEqual(done.returncode, 0, done.stderr)
        page, text = self.load("sampled")
        shown = {attributes["data-stat"]: float(attributes["data-value"]) for _, attributes, _ in page.having("data-stat")}
        self.assertNotIn("gpu.cycles", shown)
        table = {attributes["data-estimate"]: float(attributes["data-value"]) for _, attributes, _ in page.having("data-estimate")}
        for name in ("cycles", "ipc", "instructions", "l1_hit_rate", "l2_hit_rate", "dram_utilisation"):
            self.assertEqual(shown[f"gpu.sample.{name}"], self.total("sampled", f"gpu.sample.{name}"), name)
            self.assertEqual(table[name], shown[f"gpu.sample.{name}"], name)
        self.assertIn("8 of 30 launches were timed", text)
        self.assertLess(text.index('id="estimates"'), text.index('id="stalls"'))
        self.assertIn("not the whole run", text[text.index('id="stalls"'):])
        _, text = self.load("sampled", "changed")
        changes = text[text.index('id="estimates"'):]
        self.assertIn("Both runs have timed the same launches", changes)
        self.assertRegex(changes, r'data-change="cycles">\+[^<]*</td>.*?<strong>significant')

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
        """Checks that tables of figures have the sums of stats.json, and that every figure has a drawing."""
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
        """Checks that counts and latencies of every stage and class add up to those of the whole."""
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
            done = glint_case.opened(self.folder / f"{name}.html")
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

    def test_the_page_of_a_run_says_what_was_changed_in_its_scene_and_which_window_it_shows(self):
        done = self.glint("run", "WKND_SH", "--size", "16x16", "--spp", "1", "--fov", "40", "--light", "sky=off", "--crop", "4,8,8,4", "--out", "changed")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.runs["changed"] = f"{self.folder}/changed"
        _, text = self.load("changed")
        self.assertIn("The scene was changed: camera.fov = 40; light.sky = off.", text)
        self.assertIn("The picture is the window of a frame of 16×16 that begins at (4, 8).", text)
        _, text = self.load("wknd")
        self.assertNotIn("was changed", re.sub(r"<script.*?</script>", "", text, flags=re.S))

    def test_configurations_are_told_apart_by_every_key_and_compared_for_the_same_work_only(self):
        """Tests copies of one run: three keys changed step by step, a run of another size, and the same run twice."""
        keys = ["requests_per_cycle", "request_bytes", "retires_per_cycle"]
        for copy, changed in {"one": 1, "two": 2, "three": 3, "large": 0, "again": 0}.items():
            shutil.copytree(self.runs["wknd"], self.folder / copy)
            config = (self.folder / copy / "config.toml").read_text()
            for key in keys[:changed]:
                config, count = re.subn(rf"(?m)^{key} *= *\S+", f"{key} = 16", config)
                self.assertEqual(count, 1, key)
            self.write(f"{copy}/config.toml", config)
            record = json.loads((self.folder / copy / "run.json").read_text())
            del record["files"]  # The sums are those of the file before.
            if copy == "large":
                record["width"] = 640
            self.write(f"{copy}/run.json", json.dumps(record))
            self.runs[copy] = copy
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
        self.assertIn("Metrics come in order of their relative change against CORNELL pt", text)
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
    if not CHROMIUM:
        print("SKIPPED: no Chromium here (`apt-get install chromium`); the report was not looked at in a browser")
        sys.exit(77)
    glint_case.main()

# Tests that the maps and traces of `glint run --heat --trace` agree with the statistics, with the real binary.
# SPDX-License-Identifier: Apache-2.0
"""usage: cost_test.py GLINT SOURCE_DIR SUITE..."""
import ast
import base64
import collections
import gzip
import html
import json
import math
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile

import glint_case
from glint_case import CHROMIUM, GLINT, GlintTest


SMALL = ["--size", "24x16", "--spp", "1"]
TIMED = ["cycles", "active_cycles", "l1_misses"]
COUNTED = ["instructions", "rays", "nodes", "triangle_tests", "any_hit_calls", "intersection_calls"]
# These statistics of the timing machine and of the functional one are the sums of maps.
SUMS = {"instructions": r"gpu\.core\[\d+\]\.lane_instructions", "rays": r"gpu\.rt_unit\[\d+\]\.rt\.rays", "nodes": r"gpu\.rt_unit\[\d+\]\.rt\.nodes",
        "triangle_tests": r"gpu\.rt_unit\[\d+\]\.rt\.triangle_tests", "any_hit_calls": r"gpu\.core\[\d+\]\.any_hit\.invocations",
        "intersection_calls": r"gpu\.core\[\d+\]\.intersection\.invocations", "l1_misses": r"gpu\.memory\.core\[\d+\]\.l1\.misses::(?!instruction|constant)\w+"}
FUNCTIONAL_SUMS = {"instructions": r"gpu\.lanes::\w+", "rays": r"gpu\.rays", "nodes": r"gpu\.nodes", "triangle_tests": r"gpu\.triangle_tests"}


class CostTest(GlintTest):
    def run_glint(self, out, *arguments, code=0):
        done = self.glint("run", *arguments, "--out", out)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def stats(self, out, name):
        lines = (self.folder / out / "stats.txt").read_text().splitlines()
        found = [float(line.split()[1]) for line in lines if re.match(name + " ", line)]
        self.assertTrue(found, name)
        return sum(found)

    def map_of(self, out, name):
        """Returns the rows of numbers of heat/NAME.npy, read as NumPy's format 1.0 says."""
        data = (self.folder / out / "heat" / f"{name}.npy").read_bytes()
        self.assertEqual(data[:8], b"\x93NUMPY\x01\x00")
        length = struct.unpack("<H", data[8:10])[0]
        self.assertEqual((10 + length) % 64, 0)
        head = ast.literal_eval(data[10:10 + length].decode())
        self.assertFalse(head["fortran_order"])
        height, width = head["shape"]
        values = struct.unpack(f"<{height * width}{ {'<u4': 'I', '<f4': 'f'}[head['descr']] }".replace(" ", ""), data[10 + length:])
        return [values[y * width:(y + 1) * width] for y in range(height)]

    def sum_of(self, out, name):
        return sum(map(sum, self.map_of(out, name)))

    def files(self, out):
        return {path.name: path.read_bytes() for path in (self.folder / out / "heat").iterdir()}

    def trace(self, out):
        return json.loads(gzip.decompress((self.folder / out / "trace.json.gz").read_bytes()))

    def slices(self, out):
        return [event for event in self.trace(out)["traceEvents"] if event["ph"] == "X"]


class Heat(CostTest):
    def check_sums(self, out, sums):
        for name, statistic in sums.items():
            wanted = self.stats(out, statistic)
            self.assertAlmostEqual(self.sum_of(out, name), wanted, delta=1e-5 * wanted, msg=name)

    def test_the_pixels_of_a_map_add_up_to_the_statistic(self):
        self.run_glint("out", "WKND", *SMALL, "--heat")
        self.check_sums("out", SUMS)
        self.assertGreater(self.sum_of("out", "intersection_calls"), 0)
        self.assertEqual([len(row) for row in self.map_of("out", "rays")], [24] * 16)

    def test_misses_of_shared_reads_stacks_and_tables_are_charged_in_full(self):
        self.run_glint("out", "CHSNT", "--shader", "pt", "--size", "32x32", "--spp", "1", "--heat", "--set", "rt.coalescing=across_warps",
                       "--set", "rt.stack=short_stack", "--set", "rt.any_hit=deferred")
        self.check_sums("out", SUMS)
        self.assertGreater(self.sum_of("out", "any_hit_calls"), 0)
        self.assertGreater(self.sum_of("out", "triangle_tests"), 0)

    def test_divergence_is_what_simt_efficiency_lacks(self):
        self.run_glint("out", "WKND", *SMALL, "--heat")
        issued, idle = self.map_of("out", "instructions"), self.map_of("out", "divergence")
        slots = sum(n / (1 - d) for row, lost in zip(issued, idle) for n, d in zip(row, lost))
        wanted = self.stats("out", r"gpu\.core\[\d+\]\.lane_slots")
        self.assertAlmostEqual(slots, wanted, delta=0.001 * wanted)

    def test_cycles_lie_between_those_at_work_and_those_of_the_run(self):
        self.run_glint("out", "WKND", *SMALL, "--heat")
        whole = self.stats("out", r"gpu\.cycles")
        for all_, active in zip(self.map_of("out", "cycles"), self.map_of("out", "active_cycles")):
            for cycles, at_work in zip(all_, active):
                self.assertTrue(0 < at_work <= cycles < whole, (at_work, cycles, whole))

    def test_both_machines_count_the_same_and_only_one_has_cycles(self):
        self.run_glint("timing", "WKND", *SMALL, "--heat")
        self.run_glint("functional", "WKND", *SMALL, "--heat", "--mode", "functional")
        self.check_sums("functional", FUNCTIONAL_SUMS)
        for name in [*COUNTED, "divergence"]:
            self.assertEqual(self.map_of("functional", name), self.map_of("timing", name), name)
        for name in TIMED:
            self.assertFalse((self.folder / f"functional/heat/{name}.npy").exists())

    def test_watching_changes_no_statistic_and_threads_no_byte(self):
        self.run_glint("plain", "WKND", *SMALL)
        self.run_glint("one", "WKND", *SMALL, "--heat", "--threads", "1")
        self.run_glint("three", "WKND", *SMALL, "--heat", "--threads", "3")
        self.run_glint("stepped", "WKND", *SMALL, "--heat", "--no-skip")
        self.assertEqual((self.folder / "plain/stats.txt").read_bytes(), (self.folder / "one/stats.txt").read_bytes())
        self.assertEqual(self.files("one"), self.files("three"))
        self.assertEqual(self.files("one"), self.files("stepped"))

    def test_a_compute_launch_has_a_map_by_invocation(self):
        self.write("loop.comp", "#version 460\nlayout(local_size_x = 8, local_size_y = 4) in;\nlayout(binding = 0) buffer B { uint out_[]; };\n"
                   "void main() {\n  uint sum = 0;\n  for (uint i = 0; i < gl_GlobalInvocationID.y * 10; ++i) sum += i * i;\n"
                   "  out_[gl_GlobalInvocationID.y * 16 + gl_GlobalInvocationID.x] = sum;\n}\n")
        self.write("loop.toml", '[compute]\nshader = "loop.comp"\n\n[launch]\ngroups = [2, 2]\n\n[[buffer]]\nname = "sums"\nset = 0\nbinding = 0\ntype = "u32"\ncount = 128\n')
        done = self.glint("run", "loop.toml", "--heat", "--mode", "timing", "--out", "out")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        rows = self.map_of("out", "instructions")
        self.assertEqual((len(rows), len(rows[0])), (8, 16))
        for row in rows:
            self.assertEqual(len(set(row)), 1)
        for above, below in zip(rows, rows[1:]):  # ten more turns of the loop, of several instructions each
            self.assertGreaterEqual(below[0], above[0] + 10)
        self.check_sums("out", {"instructions": SUMS["instructions"], "l1_misses": SUMS["l1_misses"]})

    def test_a_run_without_maps_removes_those_of_the_last(self):
        self.run_glint("out", "WKND", *SMALL, "--heat", "--mode", "functional")
        self.run_glint("out", "WKND", *SMALL, "--mode", "functional")
        self.assertFalse((self.folder / "out/heat").exists())


class Trace(CostTest):
    def test_slices_nest_and_cover_what_the_statistics_say(self):
        self.run_glint("out", "WKND", *SMALL, "--trace")
        tracks, count, cycles = collections.defaultdict(list), collections.Counter(), collections.Counter()
        for event in self.slices("out"):
            tracks[event["pid"], event["tid"]].append(event)
            count[event["cat"]] += 1
            cycles[event["cat"]] += event["dur"]
        self.assertEqual(count["warp"], self.stats("out", r"gpu\.core\[\d+\]\.warps"))
        self.assertEqual(count["rays"], self.stats("out", r"gpu\.core\[\d+\]\.rt_warps"))
        self.assertEqual(cycles["rays"], self.stats("out", r"gpu\.rt_unit\[\d+\]\.rt\.warp_latency_sum"))
        resident = self.stats("out", r"gpu\.core\[\d+\]\.resident_cycles")
        self.assertEqual([cycles["warp"], cycles["stage"], cycles["state"]], [resident] * 3)
        order = {"warp": 0, "stage": 1, "state": 2, "rays": 0, "channel": 0}
        for events in tracks.values():
            open_ = []
            for event in events:
                while open_ and open_[-1][1] <= event["ts"]:
                    open_.pop()
                end = event["ts"] + event["dur"]
                self.assertEqual(order[event["cat"]], len(open_), event)
                self.assertTrue(not open_ or end <= open_[-1][1], event)
                open_.append((event["ts"], end))

    def test_rays_and_nodes_of_traces_are_those_of_the_run(self):
        self.run_glint("out", "WKND", *SMALL, "--trace")
        traces = [event["args"] for event in self.slices("out") if event["cat"] == "rays"]
        self.assertEqual(sum(args["nodes"] for args in traces), self.stats("out", r"gpu\.rt_unit\[\d+\]\.rt\.nodes"))
        self.assertEqual(sum(args["rays"] for args in traces), self.stats("out", r"gpu\.core\[\d+\]\.rt_lanes"))

    def test_requests_of_memory_channels_are_those_of_the_run_and_leave_gaps(self):
        self.run_glint("out", "WKND", *SMALL, "--trace")
        slices = [event for event in self.slices("out") if event["cat"] == "channel"]
        self.assertEqual(sum(event["args"]["requests"] for event in slices), self.stats("out", r"gpu\.memory\.partition\[\d+\]\.dram\.requests"))
        self.assertLess(sum(event["dur"] for event in slices), len({event["tid"] for event in slices}) * self.trace("out")["otherData"]["end"])

    def test_a_window_cuts_and_moves_nothing(self):
        self.run_glint("whole", "WKND", *SMALL, "--trace")
        self.run_glint("part", "WKND", *SMALL, "--trace", "--trace-window", "3000:7000")
        cut = lambda e: {**e, "ts": max(e["ts"], 3000), "dur": min(e["ts"] + e["dur"], 7000) - max(e["ts"], 3000)}
        key = lambda e: (e["pid"], e["tid"], e["ts"], -e["dur"], e["cat"], e["name"])
        inside = sorted((cut(e) for e in self.slices("whole") if e["ts"] < 7000 and e["ts"] + e["dur"] > 3000), key=key)
        self.assertGreater(len(inside), 100)
        self.assertEqual(sorted(self.slices("part"), key=key), inside)
        for event in self.trace("part")["traceEvents"]:
            self.assertTrue(event["ph"] == "M" or 3000 <= event["ts"] < 7000)

    def test_a_limit_ends_the_trace_early_and_says_so(self):
        self.run_glint("whole", "WKND", *SMALL, "--trace")
        done = self.run_glint("out", "WKND", *SMALL, "--trace", "--trace-limit", "4000")
        about = self.trace("out")["otherData"]
        self.assertTrue(about["cut"])
        cycles = self.stats("out", r"gpu\.cycles")
        self.assertGreater(about["asked_end"], cycles)  # its writes arrive later
        self.assertRegex(done.stderr, f"warning: the trace ends at cycle {about['end']} instead of {cycles:.0f}, .*4 000 events")
        self.assertIn(f"--trace-window {about['end']}: goes on", done.stderr)
        self.assertIn(f"of cycles 0 to {about['end']}, CUT at the limit", done.stdout)
        events = [event for event in self.trace("out")["traceEvents"] if event["ph"] != "M"]
        self.assertEqual(len(events), about["events"])
        self.assertLessEqual(len(events), 4000)
        # The slices that exist are the same as without a limit.
        self.run_glint("window", "WKND", *SMALL, "--trace", "--trace-window", f":{about['end']}")
        self.assertEqual(self.slices("out"), self.slices("window"))

    def test_a_window_after_the_end_of_the_run_is_told_with_the_cycle_of_the_end(self):
        done = self.run_glint("out", "WKND", *SMALL, "--trace", "--trace-window", "99999999:999999999")
        end = f"the run ended at cycle {self.stats('out', r'gpu[.]cycles'):.0f}"
        self.assertIn(f"warning: the trace is empty: {end}, and the window begins at 99999999", done.stderr)
        self.assertIn(f"trace.json.gz (EMPTY: {end}", done.stdout)
        self.assertEqual(self.slices("out"), [])
        whole = self.run_glint("whole", "WKND", *SMALL, "--trace", "--trace-window", "1000:999999999")
        self.assertNotIn("warning", whole.stderr)
        self.assertRegex(whole.stdout, rf"events of cycles 1000 to {self.stats('whole', 'gpu[.]cycles'):.0f}, and of writes on their way to memory until \d+;")

    def test_every_way_to_run_gives_the_same_bytes_and_cycles(self):
        ways = {"one": ["--threads", "1"], "two": ["--threads", "2"], "four": ["--threads", "4"], "stepped": ["--no-skip"]}
        for name, way in ways.items():
            self.run_glint(name, "WKND", *SMALL, "--trace", "--trace-limit", "6000", *way)
        self.run_glint("plain", "WKND", *SMALL)
        for name in ways:
            self.assertEqual((self.folder / name / "trace.json.gz").read_bytes(), (self.folder / "one/trace.json.gz").read_bytes(), name)
            self.assertEqual((self.folder / name / "stats.txt").read_bytes(), (self.folder / "plain/stats.txt").read_bytes(), name)

    def test_counters_are_the_time_series(self):
        self.run_glint("out", "WKND", *SMALL, "--trace", "--sample", "500")
        rows = [line.split(",") for line in (self.folder / "out/series.csv").read_text().splitlines()]
        ipc = [float(row[rows[0].index("ipc")]) for row in rows[1:]]
        shown = [event["args"]["instruction/cycle"] for event in self.trace("out")["traceEvents"] if event["ph"] == "C" and event["pid"] == 1 and event["name"] == "IPC"]
        self.assertEqual(len(shown), len(ipc))
        for value, wanted in zip(shown, ipc):
            self.assertAlmostEqual(value, wanted, places=4)

    def test_what_cannot_be_traced_is_refused_with_a_way_out(self):
        refused = lambda *arguments: self.run_glint("out", "WKND", *SMALL, *arguments, code=2).stderr
        self.assertIn("functional", refused("--trace", "--mode", "functional"))
        self.assertIn("--trace", refused("--trace-window", "1:2"))
        self.assertIn("FROM:TO", refused("--trace", "--trace-window", "1000"))
        self.assertIn("before it begins", refused("--trace", "--trace-window", "9:9"))
        self.assertRegex(refused("--trace", "--trace-limit", "10"), r"give at least \d+")


class WatchedRun(CostTest):
    @classmethod
    def setUpClass(cls):
        cls.shared = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.shared.cleanup)
        subprocess.run([GLINT, "run", "WKND", *SMALL, "--heat", "--trace", "--out", "watched"], cwd=cls.shared.name, check=True, capture_output=True)

    def setUp(self):
        super().setUp()
        shutil.copytree(pathlib.Path(self.shared.name, "watched"), self.folder / "out")

    def document(self, *arguments):
        done = self.glint("report", "out", *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.page = (self.folder / "out/report.html").read_text()
        data = glint_case.page_document(self.page)
        return data["runs"][0], data


class Report(WatchedRun):
    def test_the_page_has_every_map_with_its_numbers(self):
        run, data = self.document()
        index = json.loads((self.folder / "out/heat/maps.json").read_text())["maps"]
        self.assertEqual([map_["name"] for map_ in run["heat"]], [map_["name"] for map_ in index])
        for shown in run["heat"]:
            values = sorted(value for row in self.map_of("out", shown["name"]) for value in row)
            self.assertEqual((shown["min"], shown["max"]), (values[0], values[-1]), shown["name"])
            self.assertEqual(shown["p99"], values[math.ceil(0.99 * len(values)) - 1])
            self.assertAlmostEqual(shown["mean"], sum(values) / len(values), delta=1e-4 * values[-1])
        self.assertEqual(len(set(data["heat_scale"])), 17)

    def test_pictures_of_maps_have_a_pixel_a_pixel_in_the_colours_of_the_scale(self):
        run, data = self.document()
        nodes = next(map_ for map_ in run["heat"] if map_["name"] == "nodes")
        (self.folder / "nodes.png").write_bytes(base64.b64decode(nodes["picture"].split(",")[1]))
        width, height, pixels = glint_case.read_png(self.folder / "nodes.png")
        self.assertEqual((width, height), (24, 16))
        values = [value for row in self.map_of("out", "nodes") for value in row]
        colours = {value: pixels[3 * i:3 * i + 3].hex() for i, value in enumerate(values)}
        self.assertEqual(colours[max(values)], data["heat_scale"][-1][1:])
        light = lambda value: sum(weight * part for weight, part in zip((0.2126, 0.7152, 0.0722), bytes.fromhex(colours[value])))
        shown = sorted(value for value in colours if value <= nodes["top"])
        for low, high in zip(shown, shown[1:]):
            self.assertLessEqual(light(low), light(high) + 1, (low, high))

    def test_the_timeline_is_the_window_of_the_trace(self):
        run, _ = self.document("--timeline", "3000:7000", "--timeline-sm", "1")
        line = run["timeline"]
        self.assertEqual((line["core"], line["begin"], line["end"], line["cut"]), (1, 3000, 7000, False))
        shown = sorted((line["begin"] + begin, length, line["names"][name], thread) for thread, _, begin, length, name, *_ in line["slices"])
        cut = lambda e: (max(e["ts"], 3000), min(e["ts"] + e["dur"], 7000) - max(e["ts"], 3000), e["name"], e["tid"])
        wanted = sorted(cut(e) for e in self.slices("out") if e["pid"] == 3 and e["ts"] < 7000 and e["ts"] + e["dur"] > 3000)
        self.assertGreater(len(wanted), 10)
        self.assertEqual(shown, wanted)

    def test_the_timeline_is_bounded(self):
        line = self.document()[0]["timeline"]
        self.assertLessEqual(len(line["slices"]), 2000)
        self.assertGreater(line["end"], line["begin"])
        everything = self.document("--timeline", "0:")[0]["timeline"]
        self.assertLessEqual(len(everything["slices"]), 2000)
        self.assertEqual(everything["cut"], sum(e["pid"] == 2 for e in self.slices("out")) > 2000)

    def test_what_is_not_there_or_damaged_is_refused(self):
        self.expect(2, ["has no SM 8", "0 to 7"], "report", "out", "--timeline-sm", "8")
        self.expect(2, ["has nothing of cycles", "it shows"], "report", "out", "--timeline", "9000000:9000001")
        self.expect(2, ["FROM:TO"], "report", "out", "--timeline", "x")
        (self.folder / "out/heat/rays.npy").write_bytes(b"nothing")
        self.expect(2, ["heat/rays.npy", "run it again"], "report", "out")
        record = json.loads((self.folder / "out/run.json").read_text())
        record.pop("files")  # as in runs of earlier versions, so that only the form of a file tells
        (self.folder / "out/run.json").write_text(json.dumps(record))
        self.expect(2, ["heat/rays.npy"], "report", "out")
        shutil.rmtree(self.folder / "out/heat")
        (self.folder / "out/trace.json.gz").write_bytes(b"nothing\n")
        self.expect(2, ["trace.json.gz", "not a trace"], "report", "out")
        (self.folder / "out/trace.json.gz").unlink()
        self.assertEqual(self.glint("report", "out").returncode, 0)
        self.expect(2, ["no trace", "--trace"], "report", "out", "--timeline", "1:2")


class Browser(WatchedRun):
    def test_the_slider_uncovers_the_picture_and_a_click_changes_the_map(self):
        run, _ = self.document()
        keep = f"{glint_case.reader()} readDocument().then(({{ runs: [run] }}) => {{ document.body.dataset.kept = JSON.stringify([run.timeline.slices, run.heat, run.picture]); }});"
        script = ("const c = document.querySelector('.heat-run'); const r = c.querySelector('input[type=range]'); r.value = 20; r.dispatchEvent(new Event('input'));"
                  "c.querySelector('tr[data-map=rays] button').click();")
        self.write("page.html", glint_case.when_ready(self.page, script + keep))
        done = glint_case.opened(self.folder / "page.html")
        self.assertEqual([line for line in done.stderr.splitlines() if "CONSOLE" in line], [])
        self.assertIn('data-ready="yes"', done.stdout)
        slices, heat, picture = json.loads(html.unescape(re.search(r'data-kept="([^"]*)"', done.stdout).group(1)))
        self.assertEqual(sorted(slices), sorted(run["timeline"]["slices"]))
        self.assertEqual([begin for _, _, begin, *_ in slices], sorted(begin for _, _, begin, *_ in slices))
        self.assertEqual((heat, picture), (run["heat"], run["picture"]))
        over = re.search(r'<img class="over"[^>]*>', done.stdout).group(0)
        self.assertIn("inset(0px 0px 0px 20%)", over)
        self.assertIn('alt="Map of rays"', over)
        self.assertRegex(done.stdout, r'<tr data-map="rays" class="chosen">')
        drawn = re.search(r'<figure id="timeline-0".*?</figure>', done.stdout, re.S).group(0)
        self.assertGreater(drawn.count("<path"), 100)


if __name__ == "__main__":
    if CHROMIUM is None and "Browser" in sys.argv:
        print("skipped: no Chromium here (apt-get install chromium)")
        sys.exit(77)
    glint_case.main()

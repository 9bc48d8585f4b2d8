# Tests with the real binary what `glint run --profile --sample` leaves, and what `glint annotate` shows of it.
# SPDX-License-Identifier: Apache-2.0
"""usage: profile_test.py GLINT SOURCE_DIR"""
import csv
import json
import re
import shutil

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

    def figures(self, *options):
        """Returns the sum of the first column of `glint annotate`."""
        shown = self.glint(0, "annotate", "out", *options).stdout
        # Lines that did not run have only their number.
        return sum(int(n.replace(" ", "")) for n in re.findall(r"(?m)^ *(\d{1,3}(?: \d{3})*)  +(?:\d+  |\d+$|\()", shown[shown.index("issues"):]))

    def test_every_view_adds_up_to_the_statistics(self):
        self.glint(0, "run", "WKND", *SMALL, "--shader", "pt", "--profile", "--out", "out")
        issues = self.stats(r"gpu\.core\[\d+\]\.instructions")
        rows = list(csv.DictReader((self.folder / "out/profile.csv").read_text().splitlines()))
        self.assertEqual(self.figures("--view", "isa", "--measures", "issues"), issues)
        self.assertEqual(self.figures("--view", "spirv", "--measures", "issues"), issues)
        without_line = sum(int(r["issues"]) for r in rows if r["by"] == "instruction" and r["line"] == "0")
        self.assertEqual(self.figures("--measures", "issues"), issues - without_line)
        self.assertLess(without_line, issues / 100)
        document = json.loads((self.folder / "out/source.json").read_text())
        for row in rows:
            if row["by"] != "instruction":
                continue
            program, index = document["programs"][int(row["program"])], int(row["index"])
            self.assertEqual(program["shader"], row["shader"])
            self.assertIn(row["op"], program["isa"]["text"][index])
            self.assertEqual(program["isa"]["spirv"][index], int(row["spirv"]))
            if row["spirv"] != "0":
                self.assertEqual(program["spirv"]["line"][int(row["spirv"]) - 1], int(row["line"]))

    def test_stacks_tell_apart_the_calls_of_a_function_that_has_several(self):
        self.glint(0, "run", "WKND", *SMALL, "--shader", "pt", "--profile", "--out", "out")
        callers = {}
        for line in (self.folder / "out/profile.folded").read_text().splitlines():
            frames = line.rsplit(" ", 1)[0].split(";")
            if frames[0] == "gpu":
                continue
            self.assertEqual(frames[1], "main", line)
            for call, function in zip(frames[2::2], frames[3::2]):
                callers.setdefault(function, set()).add(call)
        self.assertGreater(max(len(calls) for calls in callers.values()), 1, callers)

    def test_views_of_spirv_and_of_everything_show_a_trace_below_its_line(self):
        self.glint(0, "run", "WKND", *SMALL, "--shader", "pt", "--profile", "--out", "out")
        everything = self.glint(0, "annotate", "out", "raygen.rgen", "--view", "all").stdout
        self.assertNotIn("\x1b", everything)
        self.assertRegex(everything, r"traceRayEXT[^\n]*\n(?:[^\n]*\n)*?[^\n]*OpTraceRayKHR[^\n]*\n(?:[^\n]*\n)*?[^\n]*rt\.trace")
        waits = self.glint(0, "annotate", "out", "raygen.rgen", "--view", "spirv", "--measures", "rt_wait,issues").stdout
        self.assertRegex(waits, r"(?m)^ +[1-9][\d ]* +\d[\d ]* +\d+  OpTraceRayKHR .* raygen\.rgen:\d+$")
        self.assertIn("rt_wait", self.glint(2, "annotate", "out", "--measures", "heat").stderr)
        (self.folder / "out/source.json").rename(self.folder / "out/away.json")
        self.assertIn("traceRayEXT", self.glint(0, "annotate", "out", "raygen.rgen").stdout)  # from the file itself
        self.assertIn("source.json", self.glint(2, "annotate", "out", "--view", "isa").stderr)

    def test_top_shows_the_costliest_lines_of_all_files_in_order(self):
        self.glint(0, "run", "WKND", *SMALL, "--profile", "--out", "out")
        lines = [row for row in csv.DictReader((self.folder / "out/profile.csv").read_text().splitlines()) if row["by"] == "line"]
        expected = sorted((int(row["cycles"]) for row in lines), reverse=True)[:4]
        shown = self.glint(0, "annotate", "out", "--top", "4", "--measures", "cycles,issues").stdout
        whole = sum(int(row["cycles"]) for row in csv.DictReader((self.folder / "out/profile.csv").read_text().splitlines()) if row["by"] == "instruction")
        table = shown[shown.index("The 4 of"):]
        self.assertEqual([f"{100 * cycles / whole:.1f}" for cycles in expected], re.findall(r"(?m)^ *(\d+\.\d) % +[\d ]+\S+:\d+  ", table))
        self.assertIn(f"The 4 of {len(lines)} lines that cost most", table)
        of_one = self.glint(0, "annotate", "out", "raygen.rgen", "--top", "2").stdout
        self.assertEqual(len(re.findall(r"raygen\.rgen:\d+", of_one)), 2)
        isa = self.glint(0, "annotate", "out", "raygen.rgen", "--view", "isa", "--top", "3").stdout
        self.assertEqual(len(re.findall(r"(?m)^ *\d+\.\d %.*  raygen\.rgen  +\d+", isa)), 3)
        self.assertIn("--top", self.glint(2, "annotate", "out", "--top", "0").stderr)

    def test_two_runs_are_compared_line_by_line_though_one_source_was_edited(self):
        shaders = self.folder / "mine"
        shutil.copytree(ROOT / "shaders", shaders)
        edited = shaders / "path_tracing/raygen.rgen"
        self.glint(0, "run", "WKND", *SMALL, "--profile", "--shader-dir", "mine/path_tracing", "--out", "a")
        text = edited.read_text()
        edited.write_text(text.replace("      traceRayEXT", "      // a line above the trace\n      traceRayEXT"))
        self.assertNotEqual(edited.read_text(), text)
        self.glint(0, "run", "WKND", *SMALL, "--profile", "--shader-dir", "mine/path_tracing", "--spp", "2", "--out", "b")

        def of_trace(run):
            return next(row for row in csv.DictReader((self.folder / run / "profile.csv").read_text().splitlines())
                        if row["by"] == "line" and row["file"].endswith("raygen.rgen") and "traceRayEXT" in source[run][int(row["line"]) - 1])

        source = {"a": text.splitlines(), "b": edited.read_text().splitlines()}
        was, now = of_trace("a"), of_trace("b")
        self.assertEqual(int(now["line"]), int(was["line"]) + 1)
        done = self.glint(0, "annotate", "a", "b", "--top", "3", "--measures", "rt_wait")
        self.assertIn("0 of its lines are only in A and 1 only in B", done.stderr)
        row = next(line for line in done.stdout.splitlines() if "traceRayEXT" in line)
        numbers = f"{int(was['rt_wait']):,}  {int(now['rt_wait']):,}".replace(",", " ")
        self.assertRegex(row, rf"^ *{numbers.replace('  ', ' +')} .* raygen\.rgen:{was['line']}>{now['line']} ")
        self.assertIn(f"{int(now['rt_wait']) / int(was['rt_wait']):.2f}", row)
        self.assertIn("raygen.rgen", self.glint(0, "annotate", "a", "b", "raygen.rgen").stdout)
        self.assertEqual(self.glint(0, "annotate", "a", "a").stderr, "")
        self.assertIn("by 'waits'", self.glint(2, "annotate", "a", "b", "--measures", "waits").stderr)
        self.assertIn("one measure", self.glint(2, "annotate", "a", "b", "--measures", "cycles,issues").stderr)
        self.assertIn("no counterpart", self.glint(2, "annotate", "a", "b", "--view", "isa").stderr)
        self.assertIn("not a run directory", self.glint(2, "annotate", "a", "nowhere", "raygen.rgen").stderr)
        self.glint(0, "run", "WKND", "--shader", "ao", *SMALL, "--profile", "--out", "ao")
        self.assertIn("shader is", self.glint(0, "annotate", "a", "ao").stderr)

    def test_what_cannot_be_shown_is_refused_with_a_way_out(self):
        self.assertIn("--profile", self.glint(2, "annotate", "nowhere").stderr)
        self.glint(0, "run", "WKND", *SMALL, "--profile", "--out", "out")
        self.assertIn("raygen.rgen", self.glint(2, "annotate", "out", "other.glsl").stderr)
        self.assertIn("functional", self.glint(2, "run", "WKND", *SMALL, "--mode", "functional", "--profile").stderr)
        self.glint(2, "annotate", "out/stats.csv")


if __name__ == "__main__":
    glint_case.main()

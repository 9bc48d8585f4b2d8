# Tests `glint paper`: its list, a trial that is killed and goes on, and the report.
# SPDX-License-Identifier: Apache-2.0
"""usage: paper_test.py GLINT SOURCE_DIR"""
import os
import re
import signal
import subprocess
import sys
import time
from unittest import mock

from glint_case import GLINT, ROOT, GlintTest, main

sys.path.insert(0, str(ROOT / "python"))
sys.dont_write_bytecode = True
from glint.paper import running  # noqa: E402
from glint.paper.command import parser  # noqa: E402
from glint.paper.plan import Options, plan  # noqa: E402

TRIAL = ["paper", "--subset", "--workloads", "SHIP_SH", "WKND_PT", "SHIP_PT", "--programs", "nn", "bfs", "pathfinder", "--small", "--size", "8x8", "--spp", "1", "-j", "2", "--out", "out"]
ANCHORS = ["statements", *(f"table-{i}" for i in range(1, 5)), *(f"figure-{i}" for i in (3, 4, *range(6, 16)))]


class Paper(GlintTest):
    def test_the_list_has_every_set_of_runs_and_runs_nothing(self):
        done = self.glint("paper", "--list", GLINT_ASSETS="")
        self.assertEqual(done.returncode, 0, done.stderr)
        sets = plan(Options())
        for one in sets:
            self.assertIn(f" {one.name} ", done.stdout)
        self.assertIn(f"{len(sets)} sets, 0 of them complete", done.stdout)
        self.assertIn("glint bench lumibench --config vulkan-sim-mobile --size 128x128 --spp 2 --stats compact -j 0 --out out/paper/runs/generated/vulkan-sim-mobile --resume", done.stdout)
        self.assertIn("glint ablate mobile vulkan-sim-mobile", done.stdout)
        self.assertNotIn("glint ablate", self.glint("paper", "--list", "--subset").stdout)
        self.assertIn(" files/mobile ", self.glint("paper", "--list", "--assets", ".").stdout)
        self.assertFalse((self.folder / "out").exists())

    def test_a_folder_that_cannot_be_made_is_told_before_anything_runs(self):
        (self.folder / "file").write_text("")
        done = self.glint("paper", "--subset", "--out", "file/out")
        self.assertEqual(done.returncode, 2)
        self.assertEqual(done.stdout, "")
        self.assertIn("--out: the folder 'file/out' cannot be made", done.stderr)

    def end_after(self, name, signal_number):
        """Starts the trial, sends the signal to all its processes once a set is complete, and returns its exit code and stderr."""
        process = subprocess.Popen([GLINT, *TRIAL], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True, env={**os.environ, "GLINT_ASSETS": ""})
        mark = self.folder / "out/runs" / name / "set.json"
        limit = time.monotonic() + 200
        while not mark.exists() and process.poll() is None and time.monotonic() < limit:
            time.sleep(0.05)
        self.assertIsNone(process.poll(), "the trial was faster than the signal")
        os.killpg(process.pid, signal_number)
        errors = process.communicate(timeout=60)[1]
        self.assertTrue(mark.exists())
        return process.returncode, errors

    def test_a_trial_that_is_stopped_and_killed_goes_on_where_it_was_and_leaves_every_table_and_figure(self):
        code, errors = self.end_after("generated/mobile", signal.SIGINT)
        self.assertEqual(code, 130, errors)
        self.assertIn("the same command goes on from here", errors)
        self.assertFalse((self.folder / "out/runs/generated/vulkan-sim-mobile/set.json").exists(), "a set began after Ctrl-C")
        first = self.folder / "out/runs/generated/mobile"
        self.assertEqual(self.end_after("generated/desktop", signal.SIGKILL)[0], -signal.SIGKILL)
        ended = {path: path.stat().st_mtime_ns for path in first.glob("*/workload.json")}
        self.assertEqual(len(ended), 3)
        self.assertRegex(self.glint(*TRIAL, "--list", GLINT_ASSETS="").stdout, r"(?m)^done +generated/mobile ")
        done = self.glint(*TRIAL, GLINT_ASSETS="")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(ended, {path: path.stat().st_mtime_ns for path in first.glob("*/workload.json")})
        self.assertRegex(done.stderr, r"\[24/24\] \S+ \(.*\)(, about \d+ \w+ left)?\n")
        self.assertRegex(done.stdout, r"(?m)^mobile, generated: \d+ holds, \d+ does not hold, \d+ cannot be judged$")
        self.check_page((self.folder / "out/report.html").read_text())

    def test_a_command_whose_code_is_lost_in_the_moment_of_ctrl_c_has_not_succeeded(self):
        process = mock.Mock()
        process.wait.side_effect = [KeyboardInterrupt, 0]
        with mock.patch.object(running.subprocess, "Popen", return_value=process):
            self.assertEqual(running._call(["glint"]), 130)

    def check_page(self, page):
        self.assertEqual([anchor for anchor in re.findall(r'<h2 id="([^"]+)"', page) if anchor != "missing"], ANCHORS)
        self.assertNotIn("Its runs are not there", page)
        self.assertNotIn('id="missing"', page)
        self.assertEqual(page.count("<details>"), 34)
        self.assertEqual(len(re.findall(r'<td class="(?:yes|no|open)">', page)), 3 * 34)  # on three machines
        self.assertIn("3 compute programs and 3 workloads of rays", page)
        self.assertIn("without the start-up", page)
        self.assertIn("<td>compute/mobile</td><td>Hong and Kim</td><td>3</td>", page)
        self.assertNotIn("http", page)

    def test_mistakes_are_told_before_anything_runs(self):
        self.expect(2, ["cannot start 'nowhere/python'", "needs Python 3.11"], "paper", "--python", "nowhere/python")
        self.expect(2, ["'nowhere' is not a folder"], "paper", "--assets", "nowhere")
        self.expect(2, ["--spp"], "paper", "--spp", "0")
        self.assertFalse((self.folder / "out").exists())

    def test_the_command_and_the_package_have_the_same_options(self):
        shown = set(re.findall(r"(?m)^ +(?:-\w,)?(--[a-z-]+)", self.glint("paper", "--help").stdout))
        known = {option for action in parser()._actions for option in action.option_strings if option.startswith("--")}
        self.assertEqual(shown, known)


if __name__ == "__main__":
    main()

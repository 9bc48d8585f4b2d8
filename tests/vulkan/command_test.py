# Tests `glint vulkan`, which runs a program on the driver and says what ran.
# SPDX-License-Identifier: Apache-2.0
"""usage: command_test.py MANIFEST SOURCE_DIR CLIENT GLINT"""
import json
import pathlib
import signal
import subprocess
import sys

import vulkan_case
from vulkan_case import VulkanTest

CLIENT, GLINT = (pathlib.Path(word).resolve() for word in sys.argv[3:5])


class Command(VulkanTest):
    def vulkan(self, *words, code=0):
        done = subprocess.run([GLINT, "vulkan", *map(str, words)], cwd=self.folder, capture_output=True, text=True, timeout=200)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def test_it_says_what_ran_and_what_was_timed_and_where_the_report_is(self):
        done = self.vulkan("--timing", "label:last; dispatch 1", "--out", "here", "--", CLIENT, "[three_launches]")
        self.assertRegex(done.stderr, r"glint: 2 of 3 launches were timed: \d+ cycles\n")
        self.assertRegex(done.stderr, r"\d+ cycles  dispatch 2: shader 1, here/launch-2-dispatch\n")
        self.assertIn("report: here/report.html\n", done.stderr)
        page = (self.folder / "here/report.html").read_text()
        for part in ('id="application"', 'data-figure="time-line"', 'data-table="launches"', 'data-table="shaders"',
                     '<a href="launch-1-dispatch/report.html">dispatch 1</a>'):
            self.assertIn(part, page)
        self.assertNotIn('id="trouble"', page)
        self.assertTrue((self.folder / "here/launch-1-dispatch/report.html").exists())

    def test_builds_of_structures_are_commands_of_the_time_line(self):
        done = self.vulkan("--timing", "all", "--out", "rays", "--", CLIENT, "a ray query meets the instances that an application has built")
        self.assertRegex(done.stderr, r"\n  ran: 1 dispatches, .*2 builds of acceleration structures\n")
        commands = json.loads((self.folder / "rays/index.json").read_text())["commands"]
        builds = [each for each in commands if each["kind"] == "build"]
        self.assertEqual([(each["level"], each["by"], each["update"]) for each in builds],
                         [("bottom", "device", False), ("top", "device", False)])
        for each in builds:
            self.assertEqual(each["begin"], each["end"])
            self.assertGreater(each["bytes"], 64)
        page = (self.folder / "rays/report.html").read_text()
        self.assertIn("The 2 builds of acceleration structures take no simulated time", page)
        self.assertIn("</span> builds of acceleration structures", page)

    def test_compact_statistics_leave_a_report_of_the_application_alone(self):
        self.vulkan("--timing", "dispatch 0", "--stats", "compact", "--out", "small", "--", CLIENT, "[three_launches]")
        launch = self.folder / "small/launch-0-dispatch"
        self.assertEqual(sorted(path.name for path in launch.iterdir()), ["config.toml", "run.json", "stats.csv"])
        self.assertLess(sum(path.stat().st_size for path in launch.iterdir()), 60_000)
        self.assertTrue((self.folder / "small/report.html").exists())

    def test_what_the_program_prints_and_its_exit_code_are_passed_on(self):
        done = self.vulkan("--", "sh", "-c", "echo '[a] b'; exit 7", code=7)
        self.assertEqual(done.stdout, "[a] b\n")
        self.assertIn("glint: no launch ran on Glint's device\n", done.stderr)
        self.vulkan("--", "sh", "-c", "kill -9 $$", code=128 + 9)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_a_signal_to_end_reaches_the_program(self):
        with subprocess.Popen([GLINT, "vulkan", "--", "sh", "-c", "echo here; exec tail -f /dev/null"], cwd=self.folder,
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as process:
            self.assertEqual(process.stdout.readline(), "here\n")
            process.send_signal(signal.SIGTERM)
            self.assertEqual(process.wait(60), 128 + signal.SIGTERM)

    def test_without_a_choice_nothing_is_timed_and_a_note_says_how(self):
        done = self.vulkan("--", CLIENT, "[three_launches]")
        self.assertIn("glint: 0 of 3 launches were timed: 0 cycles\n  ran: 3 dispatches\nnote: --timing", done.stderr)
        self.vulkan("--", CLIENT, "[three_launches]")
        self.assertEqual(sorted(path.name for path in (self.folder / "out").iterdir()), ["vulkan-test_vulkan", "vulkan-test_vulkan-2"])

    def test_a_wrong_choice_of_launches_is_refused_before_the_program_runs(self):
        for choice, message in (("nonsense", "--timing: 'nonsense' is none of 'all'"), ("dispatch 3-1", "'3-1' ends before it begins")):
            done = self.vulkan("--timing", choice, "--", "sh", "-c", "echo ran", code=2)
            self.assertIn(message, done.stderr)
            self.assertEqual(done.stdout, "")
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_a_launch_that_fails_is_told_with_its_line(self):
        done = self.vulkan("--set", "core.instruction_budget=100000", "--timing", "all", "--out", "lost", "--", CLIENT, "[endless_launch]")
        self.assertIn("failed: dispatch 0: ", done.stderr)
        self.assertIn("refused: vkQueueSubmit", done.stderr)
        self.assertIn('id="trouble"', (self.folder / "lost/report.html").read_text())

    def test_each_device_of_a_program_has_a_folder(self):
        done = self.vulkan("--out", "two", "--no-report", "--", "sh", "-c", f"{CLIENT} [three_launches]; {CLIENT} [three_launches]")
        self.assertEqual(done.stderr.count("glint: 0 of 3 launches were timed: 0 cycles"), 2)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["two", "two.2"])

    def test_wrong_words_are_refused_before_anything_runs(self):
        (self.folder / "full").mkdir()
        (self.folder / "full/file").write_text("")
        for words, said in ((["--", "./nothing"], "cannot start './nothing'"), (["--out", "full", "--", "true"], "is not empty"),
                            (["--config", "mobil", "--", "true"], "did you mean 'mobile'?"), ([], "PROGRAM is required"),
                            (["--set", "core.warps=8 x", "--", "true"], "has a space"), (["--queue", "graphics", "--", "true"], "--queue")):
            self.assertIn(said, self.vulkan(*words, code=2).stderr)


vulkan_case.main()

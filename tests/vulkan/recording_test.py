# Tests what the driver leaves of an application: run directories of timed launches, and the index above them.
# SPDX-License-Identifier: Apache-2.0
"""usage: recording_test.py MANIFEST SOURCE_DIR CLIENT GLINT"""
import json
import os
import pathlib
import signal
import subprocess
import sys

import vulkan_case
from vulkan_case import MANIFEST, VulkanTest

CLIENT, GLINT = (pathlib.Path(word).resolve() for word in sys.argv[3:5])


class Recording(VulkanTest):
    def application(self, test, **environment):
        """Runs a test of the client, which has to pass."""
        result = self.run_on_glint(CLIENT, test, **environment)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return result

    def index(self, folder):
        return json.loads((self.folder / folder / "index.json").read_text())

    def glint(self, *arguments):
        return subprocess.run([GLINT, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True, timeout=200)

    def test_each_timed_launch_is_a_run_and_the_index_has_all_launches(self):
        self.application("[three_launches]", GLINT_TIMING="label:last; dispatch 1", GLINT_OUT="all")
        self.assertEqual(sorted(path.name for path in (self.folder / "all").iterdir()),
                         ["index.json", "launch-1-dispatch", "launch-2-dispatch"])
        index = self.index("all")
        self.assertEqual((index["program"], index["state"], index["config"], index["timing"]),
                         ("test_vulkan", "ended", "mobile", "label:last; dispatch 1"))
        self.assertEqual(index["command"][1:], ["[three_launches]"])
        launches = [each for each in index["commands"] if each["kind"] == "dispatch"]
        self.assertEqual([(each["number"], each["shader"], each["label"], each["size"]) for each in launches],
                         [(0, "shader 1", "", [16, 1, 1]), (1, "shader 2", "", [16, 1, 1]), (2, "shader 1", "last", [16, 1, 1])])
        self.assertIsNone(launches[0]["cycles"])
        self.assertNotIn("folder", launches[0])
        for each in launches[1:]:
            folder = self.folder / "all" / each["folder"]
            stats = json.loads((folder / "stats.json").read_text())
            run = json.loads((folder / "run.json").read_text())
            self.assertEqual((run["exit"], run["mode"], run["shader"]), (0, "timing", each["shader"]))
            self.assertEqual(each["end"] - each["begin"], each["cycles"])
            self.assertIn(f"gpu.cycles,{each['cycles']},", (folder / "stats.csv").read_text())
            self.assertTrue(stats)
            self.assertEqual(self.glint("stats", folder, "--format", "metrics").returncode, 0)
        for before, after in zip(index["commands"], index["commands"][1:]):
            self.assertLessEqual(before["end"], after["begin"])

    def test_a_launch_is_annotated_and_compared_as_any_run(self):
        for name, settings in (("first", ""), ("second", "core.warps=8")):
            self.application("[three_launches]", GLINT_TIMING="dispatch 0", GLINT_OUT=name, GLINT_OBSERVE="profile sample=500",
                             GLINT_SET=settings)
        first, second = (f"{name}/launch-0-dispatch" for name in ("first", "second"))
        self.assertTrue((self.folder / first / "series.csv").exists())
        annotated = self.glint("annotate", first)
        self.assertEqual(annotated.returncode, 0, annotated.stderr)
        compared = self.glint("compare", first, second)
        self.assertEqual((compared.returncode, compared.stderr), (0, ""))
        self.assertIn("core.warps", compared.stdout)

    def test_a_folder_that_is_there_is_not_touched(self):
        (self.folder / "taken").mkdir()
        (self.folder / "taken/mine").write_text("mine")
        (self.folder / "empty").mkdir()
        for _ in range(2):
            self.application("[three_launches]", GLINT_OUT="taken")
            self.application("[three_launches]", GLINT_TIMING="dispatch 0")
        self.application("[three_launches]", GLINT_OUT="empty")
        self.assertEqual(sorted(path.name for path in (self.folder / "taken").iterdir()), ["mine"])
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["empty", "out", "taken", "taken.2", "taken.3"])
        self.assertEqual(sorted(path.name for path in (self.folder / "out").iterdir()), ["vulkan-test_vulkan", "vulkan-test_vulkan-2"])
        self.assertEqual([each["cycles"] for each in self.index("empty")["commands"]], [None] * 3)

    def test_without_choice_and_folder_nothing_is_left(self):
        self.application("[three_launches]")
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_a_folder_that_cannot_be_made_does_not_hinder_the_application(self):
        (self.folder / "file").write_text("")
        result = self.application("[three_launches]", GLINT_OUT="file/below", GLINT_TIMING="dispatch 0")
        self.assertEqual(result.stderr.count("nothing more is recorded of the launches"), 1, result.stderr)
        self.assertRegex(result.stdout, r"dispatch 0: shader 1, \d+ cycles")

    def test_a_launch_that_fails_leaves_its_error(self):
        self.application("[endless_launch]", GLINT_OUT="lost", GLINT_TIMING="all",
                         GLINT_SET="core.instruction_budget=100000")
        launch = self.index("lost")["commands"][-1]
        self.assertIn("instruction", launch["error"])
        self.assertIn("client.comp:4", launch["error"])
        self.assertEqual(launch["shader"], "shader 1")
        run = json.loads((self.folder / "lost" / launch["folder"] / "run.json").read_text())
        self.assertNotEqual(run["exit"], 0)
        self.assertEqual(self.index("lost")["refused"][0]["what"], "vkQueueSubmit")

    def test_what_a_killed_application_leaves_is_whole(self):
        environment = {**os.environ, "VK_DRIVER_FILES": str(MANIFEST), "VK_ICD_FILENAMES": str(MANIFEST), "GLINT_TIMING": "all",
                       "GLINT_OUT": "killed"}
        with subprocess.Popen([CLIENT, "[many_launches]"], cwd=self.folder, env=environment, stdout=subprocess.PIPE,
                              text=True) as process:
            for line in process.stdout:
                if line.strip() == "ended 5":
                    process.send_signal(signal.SIGKILL)
                    break
        index = self.index("killed")
        self.assertEqual(index["state"], "running")
        launches = [each for each in index["commands"] if each["kind"] == "dispatch"]
        self.assertGreaterEqual(len(launches), 5)
        for path in (self.folder / "killed").glob("launch-*"):
            self.assertEqual(json.loads((path / "run.json").read_text())["exit"], 0)
        for each in launches:
            self.assertIn(f"gpu.cycles,{each['cycles']},", (self.folder / "killed" / each["folder"] / "stats.csv").read_text())

    def test_an_application_may_leave_its_device_behind(self):
        self.application("[leaving]", GLINT_OUT="left")
        index = self.index("left")
        self.assertEqual(index["state"], "ended")
        self.assertEqual(len([each for each in index["commands"] if each["kind"] == "dispatch"]), 100)

    def test_two_applications_at_once_do_not_meet(self):
        environment = {**os.environ, "VK_DRIVER_FILES": str(MANIFEST), "VK_ICD_FILENAMES": str(MANIFEST), "GLINT_TIMING": "all",
                       "GLINT_OUT": "both"}
        both = [subprocess.Popen([CLIENT, "[three_launches]"], cwd=self.folder, env=environment, stdout=subprocess.DEVNULL)
                for _ in range(2)]
        self.assertEqual([process.wait(200) for process in both], [0, 0])
        one, other = self.index("both"), self.index("both.2")
        self.assertNotEqual(one["process"], other["process"])
        self.assertEqual(one["commands"], other["commands"])
        self.assertEqual(len(list(self.folder.glob("both*/launch-*/stats.json"))), 6)


vulkan_case.main()

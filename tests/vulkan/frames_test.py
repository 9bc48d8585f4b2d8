# Tests `glint export` and examples/rt_frames: another program draws the frame on the driver, and the picture is that of `glint run`.
# SPDX-License-Identifier: Apache-2.0
"""usage: frames_test.py MANIFEST SOURCE_DIR RT_FRAMES GLINT"""
import csv
import json
import pathlib
import subprocess
import sys

import vulkan_case
from vulkan_case import VulkanTest

RT_FRAMES, GLINT = (pathlib.Path(word).resolve() for word in sys.argv[3:5])
SMALL = ["--size", "24x16", "--spp", "1"]


class Frames(VulkanTest):
    def glint(self, *words, code=0):
        done = subprocess.run([GLINT, *map(str, words)], cwd=self.folder, capture_output=True, text=True, timeout=200)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def draw(self, *words, code=0, **environment):
        done = self.run_on_glint(RT_FRAMES, *words, **environment)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def check_picture(self, *what):
        self.glint("run", *what, *SMALL, "--mode", "functional", "--out", "run")
        self.glint("export", *what, *SMALL, "--out", "frame")
        self.draw("frame", "--runs", 1, "--warm-up", 0, "--picture", "drawn.pfm")
        self.assertEqual((self.folder / "drawn.pfm").read_bytes(), (self.folder / "run/image.pfm").read_bytes())

    def test_spheres_in_boxes_have_the_picture_of_glint_run(self):
        self.check_picture("WKND_PT")

    def test_textures_and_an_alpha_test_have_the_picture_of_glint_run(self):
        self.check_picture("CHSNT_PT")

    def test_instances_and_occlusion_rays_of_another_reach_have_the_picture_of_glint_run(self):
        self.check_picture("PARTY_AO", "--instancing", "--ao-reach", 5)

    def test_times_and_sizes_stand_in_the_table_which_grows(self):
        self.glint("export", "SHIP_SH", *SMALL, "--out", "frame")
        for _ in range(2):
            self.draw("frame", "--runs", 3, "--warm-up", 1, "--csv", "times.csv", GLINT_TIMING="trace 1-3", GLINT_STATS="compact")
        with open(self.folder / "times.csv") as file:
            first, second = csv.DictReader(file)
        self.assertEqual(first, second)
        self.assertEqual((first["frame"], first["width"], first["height"], first["runs"]), ("SHIP_SH", "24", "16", "3"))
        self.assertEqual(first["device"], "Glint mobile (simulated)")
        # The timed launches begin with cold caches, and their cycles are those of `glint run` over the same bytes of structures.
        self.assertEqual(first["least_ns"], first["most_ns"])
        self.assertGreater(int(first["median_ns"]), 1000)

    def test_a_capsule_of_a_frame_is_sampled_as_the_frame_is(self):
        frame, sample = ["SHIP_SH", "--size", "128x128", "--spp", "1"], ["--sample-pixels", "40%", "--set", "core.warps=8", "--stats", "compact"]
        self.glint("export", *frame, "--out", "frame")
        self.draw("frame", "--runs", 1, "--warm-up", 0, GLINT_VK_SAVE="trace 0", GLINT_OUT="app")
        capsule = next((self.folder / "app").glob("*.capsule"))
        self.glint("run", capsule, "--set", "core.warps=8", "--stats", "compact", "--out", "whole")
        self.glint("run", capsule, *sample, "--out", "sampled")
        self.glint("run", *frame, *sample, "--out", "scene")
        whole, sampled, scene = (self.statistics(folder) for folder in ("whole", "sampled", "scene"))
        self.assertLess(sampled["gpu.sample.cycles_low"], whole["gpu.cycles"])
        self.assertGreater(sampled["gpu.sample.cycles_high"], whole["gpu.cycles"])
        for name in ("instructions", "nodes"):  # The same blocks ran. Only addresses differ, and times with them.
            self.assertEqual(sampled[f"gpu.sample.{name}"], scene[f"gpu.sample.{name}"])
        run = json.loads((self.folder / "sampled/run.json").read_text())
        self.assertTrue(run["outputs"])
        self.assertEqual({about["incomplete"] for about in run["outputs"].values()}, {True})

    def statistics(self, folder):
        with open(self.folder / folder / "stats.csv") as file:
            return {row["path"]: float(row["value"]) for row in csv.DictReader(file)}

    def test_probes_on_the_driver_give_the_rows_of_glint_microbench(self):
        machine = ["--config", "mobile", "--set", "cores=1"]
        self.glint("microbench", *machine, "--frames", "probes")
        probes = json.loads((self.folder / "probes/probes.json").read_text())
        chosen = [probe for probe in probes if "one ray" in probe["name"] and probe["param"] in ("triangles=1", "triangles=256")]
        self.draw(*(f"probes/{probe[end]}" for probe in chosen for end in ("few", "many")), "--runs", 1, "--warm-up", 0, "--csv", "times.csv",
                  GLINT_TIMING="all", GLINT_STATS="compact", GLINT_SET="cores=1")
        (self.folder / "probes/probes.json").write_text(json.dumps(chosen))
        rows = subprocess.run([sys.executable, vulkan_case.ROOT / "examples/rt_microbench/rows.py", "probes", "times.csv", "1365"], cwd=self.folder,
                              capture_output=True, text=True, check=True, timeout=60).stdout
        (self.folder / "card.csv").write_text(rows)
        done = self.glint("microbench", *machine, "--only", "of one ray triangles", "--compare", "card.csv", "--format", "json")
        compared = [row for row in json.loads(done.stdout) if row.get("measured") is not None]
        self.assertEqual(len(compared), len(chosen))
        for row in compared:
            self.assertLess(abs(row["value"] / row["measured"] - 1), 0.05, row)

    def test_what_is_wrong_with_a_frame_is_said(self):
        self.glint("export", "SHIP_SH", *SMALL, "--out", "frame")
        whole = json.loads((self.folder / "frame/frame.json").read_text())
        wrong = {"version": (2, "this program reads version 1"), "format": ("other", 'the format is not "glint-frame"'),
                 "picture": (5, "no image is bound where the picture should be"),
                 "table": ({"raygen": 9, "miss": [], "hit": [], "callable": []}, "the table names a group that is not there")}
        for key, (value, message) in wrong.items():
            (self.folder / "frame/frame.json").write_text(json.dumps(whole | {key: value}))
            self.assertIn(message, self.draw("frame", "--runs", 1, "--warm-up", 0, code=2).stderr)
        (self.folder / "frame/frame.json").write_text("{")
        self.assertIn("frame.json", self.draw("frame", code=2).stderr)
        self.assertIn("cannot read nothing/frame.json", self.draw("nothing", code=2).stderr)

    def test_the_page_on_validation_has_the_tables_and_the_figure_of_the_measured_frames(self):
        tool = vulkan_case.ROOT / "tools/compare_rt_frames.py"
        table = subprocess.run([sys.executable, tool, "--figure", "figure.svg"], cwd=self.folder, capture_output=True, text=True, check=True).stdout
        page = (vulkan_case.ROOT / "docs/validation.md").read_text()
        for part in table.strip().split("\n\n"):
            self.assertIn(part, page)
        self.assertEqual((self.folder / "figure.svg").read_text(), (vulkan_case.ROOT / "docs/images/rt_frames.svg").read_text())

    def test_wrong_options_are_said(self):
        for words, message in ((["frame", "--runs"], "--runs is no option, or lacks its value"), (["--runs", "x", "frame"], "takes a number"),
                               (["--fast", "1", "frame"], "--fast is no option"), ([], "no folder is given")):
            self.assertIn(message, self.draw(*words, code=2).stderr)
        self.assertIn("usage: rt_frames", self.draw("--help").stdout)
        self.glint("export", "SHIP_SH", *SMALL, "--out", "frame")
        self.assertIn("the devices are:\n  Glint mobile (simulated)", self.draw("frame", "--device", "other", code=2).stderr)
        self.assertIn("a window of a frame cannot be exported", self.glint("export", "SHIP_SH", "--crop", "0,0,4,4", code=2).stderr)


vulkan_case.main()

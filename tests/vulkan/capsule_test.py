# Tests that a saved launch of an application runs again alone: with the same cycles, on other machines, and not when damaged.
# SPDX-License-Identifier: Apache-2.0
"""usage: capsule_test.py MANIFEST SOURCE_DIR CLIENT GLINT"""
import csv
import json
import pathlib
import struct
import subprocess
import sys

import vulkan_case
from vulkan_case import ROOT, VulkanTest

CLIENT, GLINT = (pathlib.Path(word).resolve() for word in sys.argv[3:5])


class Capsule(VulkanTest):
    def save(self, test, choice, **environment):
        """Returns the capsules and the cycles of the launches of a test of the client."""
        result = self.run_on_glint(CLIENT, test, GLINT_VK_SAVE=choice, GLINT_TIMING=choice, GLINT_OUT="app", **environment)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        commands = json.loads((self.folder / "app/index.json").read_text())["commands"]
        cycles = {each["number"]: each["cycles"] for each in commands if each.get("cycles")}
        return {int(path.stem.split("-")[1]): path for path in sorted((self.folder / "app").glob("*.capsule"))}, cycles

    def replay(self, capsule, *options, code=0):
        done = subprocess.run([GLINT, "run", capsule, *map(str, options)], cwd=self.folder, capture_output=True, text=True, timeout=250)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def cycles(self, folder):
        lines = (self.folder / folder / "stats.csv").read_text().splitlines()
        return next(int(line.split(",")[1]) for line in lines if line.startswith("gpu.cycles,"))

    def test_a_launch_has_the_cycles_that_it_had_in_the_application(self):
        for test, choice, numbers in (("[three_launches]", "dispatch 1-2", [1, 2]), ("[traces]", "trace 0-2", [0, 2])):
            with self.subTest(test):
                capsules, cycles = self.save(test, choice)
                self.assertEqual(sorted(capsules), numbers)
                for number, path in capsules.items():
                    self.replay(path, "--out", f"again-{path.stem}")
                    self.assertEqual(self.cycles(f"again-{path.stem}"), cycles[number])
                    run = json.loads((self.folder / f"again-{path.stem}/run.json").read_text())
                    inside = json.loads((self.folder / "app" / path.stem / "run.json").read_text())
                    for key in ("scene", "shader"):
                        self.assertEqual(run[key], inside[key])
                (self.folder / "app").rename(self.folder / f"app{numbers[0]}")

    def test_a_launch_that_was_not_timed_can_be_saved_and_timed_alone(self):
        _, timed = self.save("[traces]", "trace 2")
        (self.folder / "app").rename(self.folder / "first")
        result = self.run_on_glint(CLIENT, "[traces]", GLINT_VK_SAVE="trace 2", GLINT_OUT="app")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.replay("app/launch-2-trace.capsule", "--out", "again")
        self.assertEqual(self.cycles("again"), timed[2])

    def test_a_capsule_runs_on_every_preset_and_with_every_node_format(self):
        capsules, cycles = self.save("[traces]", "trace 2")
        presets = sorted(path.stem for path in (ROOT / "configs").glob("*.toml"))
        (self.folder / "sweep.toml").write_text(f'name = "presets"\nworkloads = ["{capsules[2]}"]\nconfigs = {presets}\nstore = "store"\n')
        for words in (("run", "sweep.toml"), ("collect", "sweep.toml", "--out", "results")):
            done = subprocess.run([GLINT, "sweep", *words], cwd=self.folder, capture_output=True, text=True, timeout=300)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        with (self.folder / "results/points.csv").open(newline="") as file:
            found = {row["config"]: int(float(row["cycles"])) for row in csv.DictReader(file)}
        self.assertEqual(sorted(found), presets)
        self.assertEqual(found["mobile"], cycles[2])
        self.assertGreater(len(set(found.values())), 3)
        for layout in ("bvh2", "bvh4", "bvh8"):
            self.replay(capsules[2], "--set", f"bvh.format={layout}", "--out", layout)
            self.assertTrue((self.folder / layout / "stats.csv").exists())
        self.assertIn("bvh.format", subprocess.run([GLINT, "compare", "bvh2", "bvh8"], cwd=self.folder, capture_output=True,
                                                   text=True, timeout=100).stdout)

    def test_a_capsule_keeps_anisotropic_samplers_and_images_with_blocks(self):
        for test, numbers in (("an anisotropic sampler takes the mean along the longer gradient", (0.5, 1, 1)),
                              ("an image with blocks is filled by copies and fetched texel by texel", (10,) * 4 + (20,) * 4 + (30,) * 2)):
            with self.subTest(test):
                capsules, _ = self.save(test, "dispatch 0")
                self.replay(capsules[0], "--out", "again")
                data = (self.folder / "again/set0-binding0.bin").read_bytes()
                self.assertEqual([round(x, 4) for x in struct.unpack(f"<{len(numbers)}f", data[:4 * len(numbers)])], list(numbers))
                (self.folder / "app").rename(self.folder / f"app{len(numbers)}")
                (self.folder / "again").rename(self.folder / f"again{len(numbers)}")

    def test_a_replay_leaves_the_buffers_that_it_changed(self):
        capsules, _ = self.save("[three_launches]", "dispatch 0-1")
        words = []
        for number, path in sorted(capsules.items()):
            self.replay(path, "--out", f"again-{number}")
            self.assertEqual([name.name for name in (self.folder / f"again-{number}").glob("*.bin")], ["set0-binding0.bin"])
            words.append(struct.unpack("<1024I", (self.folder / f"again-{number}/set0-binding0.bin").read_bytes()))
        self.assertEqual(words[1], tuple(each * each % 2**32 for each in words[0]))  # The second launch squares.

    def test_memory_that_is_reached_by_addresses_goes_along(self):
        capsules, cycles = self.save("[addresses]", "dispatch 0")
        self.assertLess(capsules[0].stat().st_size, 1 << 18)  # The buffer that no address names has four times as much.
        self.replay(capsules[0], "--out", "again")
        self.assertEqual(self.cycles("again"), cycles[0])
        changed = [path for path in (self.folder / "again").glob("*.bin")]
        self.assertEqual(len(changed), 1)
        self.assertRegex(changed[0].name, r"allocation-\d+\.bin")
        self.assertEqual(struct.unpack("<64I", changed[0].read_bytes()), tuple(i ^ 21 for i in range(64)))

    def test_a_capsule_keeps_micromaps_on_every_node_format_and_null_descriptors(self):
        capsules, cycles = self.save("[micromaps]", "dispatch 1")  # It asks the shader of unknown parts only.
        found = []
        for name, options in (("again", ()), ("bvh8", ("--set", "bvh.format=bvh8")), ("bvh2", ("--set", "bvh.format=bvh2"))):
            self.replay(capsules[1], "--out", name, *options)
            found.append((self.folder / name / "set0-binding1.bin").read_bytes())
        self.assertEqual(self.cycles("again"), cycles[1])
        words = struct.unpack("<1024I", found[0])
        asked = [word >> 4 & 15 for word in words]
        self.assertEqual(set(asked), {0, 1})
        self.assertEqual(found[1:], found[:1] * 2)
        said = self.replay(capsules[1], "--set", "rt.unit=software", code=2).stderr
        self.assertIn("the application uses opacity micromaps", said)
        (self.folder / "app").rename(self.folder / "maps")
        capsules, _ = self.save("[nulls]", "dispatch 0")
        self.replay(capsules[0], "--out", "nothing")
        data = (self.folder / "nothing/set0-binding0.bin").read_bytes()
        self.assertEqual(struct.unpack("<22I", data[:88]), (0,) * 20 + (77, 0xdead))

    def test_damaged_and_foreign_files_are_refused(self):
        capsules, _ = self.save("[three_launches]", "dispatch 1")
        good = capsules[1].read_bytes()
        bad = {"flipped": good[:len(good) // 2] + bytes([good[len(good) // 2] ^ 1]) + good[len(good) // 2 + 1:],
               "cut": good[:-1], "short": good[:20], "longer": good + b"x"}
        for name, data in bad.items():
            (self.folder / f"{name}.capsule").write_bytes(data)
            self.assertIn("the capsule is damaged", self.replay(f"{name}.capsule", code=2).stderr)
        for name, data, said in (("other", b"glint capsule 9\n" + good[16:], "another version"), ("foreign", b"PK\3\4", "it is no capsule")):
            (self.folder / f"{name}.capsule").write_bytes(data)
            self.assertIn(said, self.replay(f"{name}.capsule", code=2).stderr)
        self.assertIn("cannot read", self.replay("nowhere.capsule", code=2).stderr)
        self.assertIn("belongs to scenes", self.replay(capsules[1], "--exr", code=2).stderr)


vulkan_case.main()

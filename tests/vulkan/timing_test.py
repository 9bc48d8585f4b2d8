# Tests that the user chooses which launches are timed, and that a launch has the same cycles whatever else is timed.
# SPDX-License-Identifier: Apache-2.0
"""usage: timing_test.py MANIFEST SOURCE_DIR CLIENT"""
import pathlib
import re
import sys

import vulkan_case
from vulkan_case import VulkanTest

CLIENT = pathlib.Path(sys.argv[3]).resolve()


class Timing(VulkanTest):
    def cycles(self, **environment):
        """Returns the cycles of the launches that were timed, by number."""
        result = self.run_on_glint(CLIENT, "[three_launches]", **environment)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return {int(n): int(c) for n, c in re.findall(r"dispatch (\d+): shader \d+, (\d+) cycles", result.stdout)}

    def test_each_way_to_choose_takes_its_launches_with_the_same_cycles(self):
        every = self.cycles(GLINT_TIMING="all")
        self.assertEqual(sorted(every), [0, 1, 2])
        self.assertEqual(every[0], every[2], "the caches are cold at each launch")
        for choice, taken in (("none", []), ("dispatch 1-2", [1, 2]), ("first 1", [0, 1]), ("label:last", [2]),
                              ("shader:shader 2", [1]), ("dispatch 0; label:last", [0, 2]), ("launch 1-2", [1, 2]), ("trace 0-9", [])):
            with self.subTest(choice):
                self.assertEqual(self.cycles(GLINT_TIMING=choice), {number: every[number] for number in taken})

    def test_the_user_chooses_the_machine(self):
        mobile = self.cycles(GLINT_TIMING="all")
        self.assertEqual(self.cycles(GLINT_TIMING="all", GLINT_CONFIG="mobile"), mobile)
        desktop = self.cycles(GLINT_TIMING="all", GLINT_CONFIG="desktop")
        self.assertEqual(sorted(desktop), sorted(mobile))
        self.assertNotEqual(desktop, mobile)
        early = self.cycles(GLINT_TIMING="all", GLINT_SET="core.launch_latency=1000  core.ends_when_written=false")
        (self.folder / "late.toml").write_text('base = "mobile"\n[core]\nlaunch_latency = 6000\n')
        late = self.cycles(GLINT_TIMING="all", GLINT_CONFIG="late.toml")
        for number, cycles in mobile.items():  # Blocks begin at the end of a turn of 49 cycles.
            self.assertAlmostEqual(early[number], cycles - 4000, delta=49)
            self.assertAlmostEqual(late[number], cycles + 1000, delta=49)

    def test_traces_are_chosen_apart_from_dispatches(self):
        def cycles(choice):
            result = self.run_on_glint(CLIENT, "[traces]", GLINT_TIMING=choice)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            return {f"{kind} {number}": int(c) for kind, number, c in
                    re.findall(r"(trace|dispatch) (\d+): shader \d+, (\d+) cycles", result.stdout)}
        every = cycles("all")
        self.assertEqual(sorted(every), ["dispatch 1", "trace 0", "trace 2"])
        self.assertEqual(every["trace 0"], every["trace 2"], "the caches are cold at each launch")
        self.assertEqual(cycles("trace 1-2"), {"trace 2": every["trace 2"]})
        self.assertEqual(cycles("dispatch 0-9"), {"dispatch 1": every["dispatch 1"]})

    def test_a_machine_that_reorders_says_so_and_regroups_warps(self):
        for keys, batches in (("core.reorder=sort", 1), ("core.reorder=none", 0)):
            with self.subTest(keys):
                folder = keys.split("=")[1]
                result = self.run_on_glint(CLIENT, "[reordering]", GLINT_TIMING="all", GLINT_SET=keys, GLINT_OUT=folder)
                self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
                lines = (self.folder / folder / "launch-0-trace/stats.csv").read_text().splitlines()
                regrouped = sum(int(line.split(",")[1]) for line in lines if re.match(r"gpu\.core\[\d+\]\.reorder\.batches,", line))
                self.assertEqual(regrouped, batches)

    def test_micromaps_decide_the_same_in_the_timing_machine_and_cost_reads(self):
        result = self.run_on_glint(CLIENT, "[micromaps]", GLINT_TIMING="all", GLINT_OUT="maps")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        reads = []
        for run in sorted((self.folder / "maps").glob("launch-*"), key=lambda path: int(path.name.split("-")[1])):
            lines = (run / "stats.csv").read_text().splitlines()
            reads.append(sum(int(line.split(",")[1]) for line in lines if re.match(r"gpu\.rt_unit\[\d+\]\.rt\.micromaps\.reads,", line)))
        # The first launch has no maps. Of eight triangles four name one, under 512 of the 1,024 rays, and the last of each
        # nine launches disables them.
        self.assertEqual(reads, [0] + 2 * (8 * [512] + [0]))

    def test_threads_of_the_host_change_no_cycle(self):
        self.assertEqual(self.cycles(GLINT_TIMING="all", GLINT_THREADS="2"), self.cycles(GLINT_TIMING="all"))

    def test_a_choice_that_there_is_not_is_refused_by_name(self):
        for name, value in (("GLINT_TIMING", "sometimes"), ("GLINT_THREADS", "many"), ("GLINT_ON_FAULT", "cry")):
            result = self.run_on_glint(CLIENT, "[three_launches]", **{name: value})
            self.assertNotEqual(result.returncode, 0)
            self.assertRegex(result.stderr, f"{name}.*'{value}'")
        for name, value in (("GLINT_CONFIG", "mobil"), ("GLINT_SET", "core.warp=7")):
            result = self.run_on_glint(CLIENT, "[three_launches]", **{name: value})
            self.assertNotEqual(result.returncode, 0)
            self.assertIn("GLINT_CONFIG and GLINT_SET make no machine", result.stderr)
            self.assertIn("did you mean", result.stderr)


vulkan_case.main()

# Tests that paths of a warp which take turns change no picture, and what they change.
# SPDX-License-Identifier: Apache-2.0
"""usage: interleaving_test.py GLINT SOURCE_DIR"""
import glint_case
from glint_case import GlintTest

SMALL = ["--size", "48x48", "--spp", "1", "--config", "mobile", "--set", "cores=2"]
TURNS = [*SMALL, "--set", "core.interleaving=on_stall", "--set", "core.on_stall.waiting=0"]


class Interleaving(GlintTest):
    def count(self, statistics, name):
        return sum(value for key, value in statistics.items() if key.endswith(f".interleaving.{name}"))

    def test_the_picture_is_the_same_and_paths_take_turns(self):
        for what in ("WKND_PT", "CHSNT_PT", "PARTY_PT"):
            plain = self.run_statistics("plain", what, *SMALL)
            self.assertFalse([name for name in plain if ".interleaving." in name])
            for settings in ([], ["--set", "core.on_stall.yields=true"], ["--set", "core.subwarps.paths=32"]):
                turns = self.run_statistics("turns", what, *TURNS, *settings)
                self.assertEqual((self.folder / "turns/image.pfm").read_bytes(), (self.folder / "plain/image.pfm").read_bytes(), what)
                self.assertGreater(self.count(turns, "stalls") + self.count(turns, "yields"), 100, (what, settings))
                self.assertEqual(self.count(turns, "yields") > 0, "core.on_stall.yields=true" in settings)
                self.assertLessEqual(self.count(turns, "begun"), self.count(turns, "stalls") + self.count(turns, "yields"))
                for name in ("warps", "instructions", "lane_instructions"):
                    of = lambda statistics: sum(statistics[f"gpu.core[{core}].{name}"] for core in range(2))
                    self.assertEqual(of(turns), of(plain), (what, name))

    def test_a_change_costs_what_the_configuration_says(self):
        cheap = self.run_statistics("cheap", "WKND_PT", *TURNS)
        dear = self.run_statistics("dear", "WKND_PT", *TURNS, "--set", "core.subwarps.latency=1000")
        self.assertGreater(dear["gpu.cycles"], cheap["gpu.cycles"] + 1000)

    def test_stepping_skipping_and_threads_give_the_same_bytes(self):
        arguments = ["CHSNT_PT", *TURNS, "--set", "cores=4", "--set", "core.on_stall.yields=true"]
        self.check_same_statistics(*arguments)

    def test_what_does_not_go_together_is_refused(self):
        for setting, message in (
            ("core.reorder=by_shader_record", 'core.interleaving = "on_stall" does not go with core.reorder = "by_shader_record"'),
            ("core.parking=at_rays", 'core.interleaving = "on_stall" does not go with core.parking = "at_rays"'),
        ):
            done = self.glint("run", "WKND_SH", *TURNS, "--set", setting)
            self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
            self.assertIn(message, done.stdout + done.stderr)


if __name__ == "__main__":
    glint_case.main()

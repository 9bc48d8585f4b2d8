# Tests that warps which give up their places change no picture, and when they do so.
# SPDX-License-Identifier: Apache-2.0
"""usage: parking_test.py GLINT SOURCE_DIR"""
import glint_case
from glint_case import GlintTest

# One core with four places has more warps than it can hold.
SMALL = ["--size", "64x32", "--spp", "1", "--config", "mobile", "--set", "cores=1", "--set", "core.warps=4", "--set", "core.parking_lot.warps=12"]
PARKED = [*SMALL, "--set", "core.parking=at_rays"]
POOL = ["--set", "rt.pool=repack", "--set", "rt.pool_stacks=false", "--set", "rt.pool_warps=16"]


class Parking(GlintTest):
    def parked(self, statistics, name):
        return statistics[f"gpu.core[0].parking.{name}"]

    def test_more_rays_wait_than_warps_fit_and_the_picture_is_the_same(self):
        for what in ("WKND_PT", "CHSNT_AO"):  # CHSNT has any-hit shaders
            kept = self.run_statistics("kept", what, *SMALL, *POOL)
            gone = self.run_statistics("gone", what, *PARKED, *POOL)
            self.assertEqual((self.folder / "gone/image.pfm").read_bytes(), (self.folder / "kept/image.pfm").read_bytes(), what)
            self.assertFalse([name for name in kept if ".parking." in name])
            self.assertGreater(self.parked(gone, "left"), 20)
            self.assertLessEqual(self.parked(gone, "left"), self.parked(gone, "asked"))
            self.assertLessEqual(self.parked(gone, "wait_cycles"), self.parked(gone, "parked_cycles"))
            # More warps are in the unit at a time than the core has places.
            inside = self.parked(gone, "parked_cycles") / gone["gpu.cycles"]
            self.assertGreater(inside, 2, what)
            self.assertLessEqual(gone["gpu.core[0].occupancy"], 1)
            self.assertEqual(gone["gpu.core[0].warps"], kept["gpu.core[0].warps"])

    def test_a_return_costs_what_the_configuration_says(self):
        cheap = self.run_statistics("cheap", "WKND_PT", *PARKED, "--set", "core.parking_lot.latency=0")
        dear = self.run_statistics("dear", "WKND_PT", *PARKED, "--set", "core.parking_lot.latency=20000")
        self.assertGreater(dear["gpu.cycles"], cheap["gpu.cycles"] + 20000)

    def test_stepping_skipping_and_threads_give_the_same_bytes(self):
        arguments = ["CHSNT_PT", *PARKED, *POOL, "--set", "cores=4"]
        self.check_same_statistics(*arguments)

    def test_what_does_not_go_together_is_refused(self):
        for settings, message in (
            (["core.reorder=by_shader_record"], 'core.parking = "at_rays" does not go with core.reorder = "by_shader_record"'),
            (["core.schedulers=1", "core.parking_lot.warps=61"], "are 65 warps together, expected at most 64 (64 for each of 1 schedulers)"),
        ):
            done = self.glint("run", "WKND_SH", *PARKED, *(word for setting in settings for word in ("--set", setting)))
            self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
            self.assertIn(message, done.stdout + done.stderr)


if __name__ == "__main__":
    glint_case.main()

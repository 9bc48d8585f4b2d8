# Tests that regrouping threads changes no picture, print or cost of a thread, and that it makes warps diverge less.
# SPDX-License-Identifier: Apache-2.0
"""usage: reorder_test.py GLINT SOURCE_DIR"""
import re
import shutil

import glint_case
from glint_case import ROOT, GlintTest

POLICIES = ["none", "sort", "by_shader_record"]


class ReorderTest(GlintTest):
    def example(self, size=64):
        shutil.copytree(ROOT / "examples/reordering", self.folder / "example", dirs_exist_ok=True)
        text = (self.folder / "example/pipeline.toml").read_text()
        self.assertIn("size = [128, 128]", text)
        return self.write("example/pipeline.toml", text.replace("size = [128, 128]", f"size = [{size}, {size}]"))

    def run_glint(self, out, what, *arguments):
        done = self.glint("run", what, "--config", "mobile", "--out", out, *arguments)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def sums(self, out):
        """Returns each statistic of the run, added up over the parts of the machine."""
        total = {}
        for path, value in self.statistics(out).items():
            path = re.sub(r"\[\d+\]", "", path)
            total[path] = total.get(path, 0.0) + value
        return total


class Effect(ReorderTest):
    def test_sorted_warps_diverge_less_and_the_frame_takes_less_time_with_the_same_picture(self):
        what, total = self.example(), {}
        for policy in POLICIES:
            self.run_glint(policy, what, "--set", f"core.reorder={policy}")
            total[policy] = self.sums(policy)
            self.assertEqual((self.folder / policy / "picture.png").read_bytes(), (self.folder / "none/picture.png").read_bytes(), policy)
        self.assertFalse([path for path in total["none"] if "reorder" in path])
        efficiency = {policy: of["gpu.core.lane_instructions"] / of["gpu.core.lane_slots"] for policy, of in total.items()}
        for policy in POLICIES[1:]:
            of = {name.removeprefix("gpu.core.reorder."): value for name, value in total[policy].items() if ".reorder." in name}
            self.assertGreater(efficiency[policy], 1.3 * efficiency["none"], policy)
            self.assertLess(of["keys_after"] / of["warps_after"], 0.8 * of["keys_before"] / of["warps_before"], policy)
            self.assertLess(total[policy]["gpu.cycles"], total["none"]["gpu.cycles"], policy)
            self.assertGreater(of["threads_moved"], 0)
            self.assertLessEqual(of["timeouts"], of["batches"])
        # More is known of a thread that gives a hint.
        self.assertGreater(efficiency["sort"], efficiency["by_shader_record"])

    def test_moving_costs_what_the_configuration_says(self):
        what = self.example(48)
        arguments = [what, "--set", "core.reorder=sort"]
        self.run_glint("base", *arguments)
        self.run_glint("slow", *arguments, "--set", "core.reordering.bytes_per_cycle=1", "--set", "core.reordering.latency=5000")
        self.assertGreater(self.sums("slow")["gpu.cycles"], self.sums("base")["gpu.cycles"])
        self.run_glint("alone", *arguments, "--set", "core.reordering.batch=1")
        alone = self.sums("alone")
        self.assertEqual(alone["gpu.core.reorder.threads_moved"], 0)
        self.assertEqual(alone["gpu.core.reorder.batches"], alone["gpu.core.reorder.warps"])

    def test_without_compaction_each_warp_keeps_its_number_of_threads(self):
        self.run_glint("kept", self.example(48), "--set", "core.reorder=sort", "--set", "core.reordering.compact=false")
        kept = self.sums("kept")
        self.assertEqual(kept["gpu.core.reorder.warps_after"], kept["gpu.core.reorder.warps_before"])
        self.assertLess(kept["gpu.core.reorder.keys_after"], kept["gpu.core.reorder.keys_before"])


class Same(ReorderTest):
    def test_stepping_skipping_and_threads_give_the_same_bytes(self):
        what = self.example(40)
        for policy in POLICIES[1:]:
            self.check_same_statistics(what, "--config", "mobile", "--set", f"core.reorder={policy}", "--set", "cores=4")

    def test_each_pixel_pays_for_its_own_thread_wherever_that_runs(self):
        setting = ["--size", "24x24", "--spp", "1", "--set", "core.reorder=by_shader_record"]
        self.run_glint("timing", "WKND_PT", *setting, "--heat")
        self.run_glint("functional", "WKND_PT", *setting, "--heat", "--mode", "functional")
        self.assertGreater(self.sums("timing")["gpu.core.reorder.threads_moved"], 0)
        # Lanes that meet at a join execute it only when none waits there yet, so instructions depend on the company.
        for name in ("rays", "nodes", "triangle_tests", "intersection_calls"):
            maps = [(self.folder / run / "heat" / f"{name}.npy").read_bytes() for run in ("timing", "functional")]
            self.assertEqual(*maps, name)

    def test_candidates_that_wait_in_tables_go_with_their_threads(self):
        gathered = {}
        for policy in ("none", "by_shader_record"):
            self.run_glint(policy, "CHSNT_PT", "--size", "24x24", "--spp", "1", "--set", "rt.any_hit=deferred", "--set", "cores=2", "--set", f"core.reorder={policy}")
            self.assertEqual((self.folder / policy / "image.png").read_bytes(), (self.folder / "none/image.png").read_bytes())
            total = self.sums(policy)
            gathered[policy] = total["gpu.core.candidates_gathered"]
            self.assertEqual(gathered[policy], total["gpu.core.candidates_dropped"] + total["gpu.core.candidate_lanes"])
        # Which candidate is decided first depends on the company, and with it how many are still met.
        self.assertAlmostEqual(gathered["by_shader_record"], gathered["none"], delta=0.1 * gathered["none"])

    def test_prints_come_in_the_order_of_threads(self):
        what = self.example(16)
        shader = self.folder / "example/reordering.rgen"
        text = shader.read_text().replace("#include", "#extension GL_EXT_debug_printf : require\n#include", 1)
        shader.write_text(text.replace("    hitObjectExecuteShaderEXT", '    debugPrintfEXT("%u %u %d %u", gl_LaunchIDEXT.x, gl_LaunchIDEXT.y, bounce, path.random);\n    hitObjectExecuteShaderEXT'))
        printed = {}
        for policy in POLICIES:
            self.run_glint(policy, what, "--set", f"core.reorder={policy}", "--set", "cores=1", "--printf-limit", "5000")
            printed[policy] = (self.folder / policy / "printf.txt").read_text()
        self.assertGreater(printed["none"].count("\n"), 256)
        self.assertGreater(self.sums("sort")["gpu.core.reorder.threads_moved"], 0)
        for policy in POLICIES[1:]:
            self.assertEqual(printed[policy], printed["none"], policy)

    def test_the_interval_model_is_left_out_and_says_why(self):
        self.run_glint("run", "WKND_SH", "--size", "8x8", "--set", "core.reorder=by_shader_record")
        done = self.glint("model", "run")
        self.assertEqual(done.returncode, 0)
        self.assertIn('the interval model does not know core.reorder = "by_shader_record"', done.stdout + done.stderr)
        self.assertNotIn("interval", (self.folder / "run/models.csv").read_text())


if __name__ == "__main__":
    glint_case.main()

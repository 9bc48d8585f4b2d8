# Tests `glint run` with Amber scripts: the exit codes and the messages.
# SPDX-License-Identifier: Apache-2.0
"""usage: cli_test.py GLINT SOURCE_DIR"""
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
import glint_case
from glint_case import ROOT, GlintTest

BUFFER = "#!amber\nBUFFER b DATA_TYPE int32 DATA 1 2 END\n"
GOOD, BAD = BUFFER + "EXPECT b IDX 4 EQ 2\n", BUFFER + "EXPECT b IDX 4 EQ 3\n"
PAST = """#!amber
SHADER compute s GLSL
#version 450
layout(binding = 0) buffer B { uint v[]; };
void main() { v[2] = 9; }
END
BUFFER b DATA_TYPE uint32 DATA 1 2 END
PIPELINE compute p
  ATTACH s
  BIND BUFFER b AS storage DESCRIPTOR_SET 0 BINDING 0
END
RUN p 1 1 1
EXPECT b IDX 0 EQ 1 2
"""
# Doubles 4,096 numbers in each of three launches.
DOUBLE = """#!amber
SHADER compute s GLSL
#version 450
layout(local_size_x = 32) in;
layout(binding = 0) buffer B { uint v[]; };
void main() { v[gl_GlobalInvocationID.x] *= 2; }
END
BUFFER b DATA_TYPE uint32 SIZE 4096 FILL 1
PIPELINE compute p:1
  ATTACH s
  BIND BUFFER b AS storage DESCRIPTOR_SET 0 BINDING 0
END
RUN p:1 128 1 1
REPEAT 2
  RUN p:1 128 1 1
END
EXPECT b IDX 0 EQ 8 8
"""
GRAPHICS = "#!amber\nPIPELINE graphics p\nEND\n"


class Amber(GlintTest):
    def run_scripts(self, *texts, arguments=()):
        return self.glint("run", *(self.write(f"{i}.amber", text) for i, text in enumerate(texts)), *arguments)

    def check(self, done, code, out, err=""):
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        self.assertEqual(done.stdout, out + "\n")
        self.assertIn(err, done.stderr)

    def test_a_script_that_passes_exits_with_0_and_says_nothing_else(self):
        done = self.run_scripts(GOOD)
        self.check(done, 0, "1 passed, 0 failed, 0 unsupported")
        self.assertEqual(done.stderr, "")

    def test_an_expectation_that_fails_exits_with_1_and_names_the_line(self):
        self.check(self.run_scripts(BAD), 1, "0 passed, 1 failed, 0 unsupported", "0.amber:3: failed: buffer 'b' at byte 4 (value 0): expected == 3, found 2")

    def test_an_unsupported_script_exits_with_3(self):
        self.check(self.run_scripts(GRAPHICS), 3, "0 passed, 0 failed, 1 unsupported", "0.amber:2: unsupported: graphics pipelines")

    def test_a_script_that_is_wrong_exits_with_2(self):
        self.check(self.run_scripts("no script"), 2, "0 passed, 1 failed, 0 unsupported", "0.amber:1: error:")

    def test_several_scripts_all_run_and_are_counted(self):
        done = self.run_scripts(GRAPHICS, BAD, GOOD, GOOD)
        self.check(done, 1, "2 passed, 1 failed, 1 unsupported", "1.amber:3")
        self.check(self.run_scripts(GOOD, GRAPHICS), 3, "1 passed, 0 failed, 1 unsupported")

    def test_the_timing_machine_tells_cycles(self):
        done = self.glint("run", ROOT / "tests/amber/scripts/shared.amber", "--mode", "timing")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"shared.amber: [1-9][0-9]+ cycles")

    def test_accesses_outside_of_buffers_are_faults_with_strict(self):
        script = self.write("past.amber", PAST)
        self.check(self.glint("run", script), 0, "1 passed, 0 failed, 0 unsupported")
        self.check(self.glint("run", script, "--strict"), 4, "0 passed, 1 failed, 0 unsupported", "past.amber:12: ")
        self.expect(2, ["--strict belongs to Amber scripts"], "run", "WKND", "--strict")

    def cycles(self, folder):
        return int(self.statistics(folder)["gpu.cycles"])

    def test_out_leaves_a_run_directory_of_each_launch_and_their_sum(self):
        out = self.folder / "out"
        done = self.run_scripts(DOUBLE, arguments=["--mode", "timing", "--profile", "--out", out])
        self.assertEqual(done.returncode, 0, done.stderr)
        run = json.loads((out / "run.json").read_text())
        names = ["launch-0-p_1", "launch-1-p_1", "launch-2-p_1"]
        self.assertEqual((run["launches"], run["exit"], run["scene"]["form"]), (names, 0, "script"))
        cycles = [self.cycles(out / name) for name in names]
        self.assertEqual(sum(cycles), self.cycles(out))
        self.assertIn(f"0.amber: {sum(cycles)} cycles", done.stdout)
        self.assertEqual(cycles[1], cycles[0])
        self.assertTrue((out / names[2] / "profile.csv").exists())
        self.glint("report", out)
        self.assertIn(names[2], (out / "report.html").read_text())

    def test_warm_caches_make_later_launches_shorter(self):
        cold, warm = self.folder / "cold", self.folder / "warm"
        self.run_scripts(DOUBLE, arguments=["--mode", "timing", "--out", cold])
        self.run_scripts(DOUBLE, arguments=["--mode", "timing", "--out", warm, "--caches", "warm"])
        self.assertEqual(self.cycles(warm / "launch-0-p_1"), self.cycles(cold / "launch-0-p_1"))
        self.assertLess(self.cycles(warm / "launch-1-p_1"), self.cycles(cold / "launch-1-p_1"))
        self.expect(2, ["--caches warm needs the timing machine"], "run", self.folder / "0.amber", "--caches", "warm")
        self.expect(2, ["--caches belongs to Amber scripts"], "run", "WKND", "--caches", "warm")

    def test_a_script_that_fails_says_so_in_its_run_directory(self):
        bad = DOUBLE.replace("REPEAT", "EXPECT b IDX 0 EQ 3\nREPEAT")
        self.run_scripts(DOUBLE, bad, arguments=["--out", self.folder / "out"])
        good, failed = (json.loads((self.folder / "out" / name / "run.json").read_text()) for name in ("0", "1"))
        self.assertEqual(len(good["launches"]), 3)
        self.assertEqual((failed["launches"], failed["exit"]), (["launch-0-p_1"], 1))
        self.assertIn("expected == 3, found 2", failed["message"])

    def test_observations_need_a_run_directory(self):
        script = self.write("0.amber", DOUBLE)
        self.expect(2, ["need a run directory", "--out names it"], "run", script, "--profile")
        self.expect(2, ["--profile"], "run", script, "--profile", "--out", self.folder / "functional")

    def test_other_files_beside_scripts_are_refused(self):
        done = self.run_scripts(GOOD, arguments=["WKND"])
        self.assertEqual(done.returncode, 2)
        self.assertIn("'WKND' is not an Amber script", done.stderr)


if __name__ == "__main__":
    glint_case.main()

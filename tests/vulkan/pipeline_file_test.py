# Tests that a shader computes the same bits in an application as in a pipeline file, on either machine, with the same
# statistics.
# SPDX-License-Identifier: Apache-2.0
"""usage: pipeline_file_test.py MANIFEST SOURCE_DIR CLIENT GLINT"""
import pathlib
import subprocess
import sys

import vulkan_case
from vulkan_case import VulkanTest

CLIENT, GLINT = (pathlib.Path(word).resolve() for word in sys.argv[3:5])
SHADER = """#version 460
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer B { float v[]; };
shared float near[64];
void main() {
  uint i = gl_GlobalInvocationID.x;
  float x = sin(float(i) * 0.37) * exp2(float(i % 17u)) / (float(i) + 0.3);
  near[gl_LocalInvocationIndex] = x;
  barrier();
  v[i] = sqrt(abs(x)) + near[63u - gl_LocalInvocationIndex];
}
"""
FILE = """name = "same"
[compute]
shader = "same.comp"
[launch]
groups = [16]
[[buffer]]
set = 0
binding = 0
type = "f32"
count = 1024
init = "zero"
save = ["v.raw"]
"""


class PipelineFile(VulkanTest):
    def test_the_bits_are_the_same(self):
        (self.folder / "same.comp").write_text(SHADER)
        (self.folder / "same.toml").write_text(FILE)
        for mode, timing in (("functional", "none"), ("timing", "all")):
            result = self.run_on_glint(CLIENT, "[shader_of_file]", GLINT_TEST_SHADER="same.comp", GLINT_TEST_RESULT="ours.raw",
                                       GLINT_TIMING=timing, GLINT_OUT=f"application-{mode}")
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            subprocess.run([GLINT, "run", "same.toml", "--mode", mode, "--out", f"out-{mode}"], cwd=self.folder, check=True,
                           capture_output=True, timeout=200)
            ours, file = (self.folder / "ours.raw").read_bytes(), (self.folder / f"out-{mode}/v.raw").read_bytes()
            self.assertEqual(len(ours), 4096)
            self.assertGreater(len(set(ours)), 64)
            self.assertEqual(ours, file)
        for name in ("stats.json", "stats.csv", "stats.txt"):
            self.assertEqual((self.folder / "application-timing/launch-0-dispatch" / name).read_bytes(),
                             (self.folder / "out-timing" / name).read_bytes(), name)


vulkan_case.main()

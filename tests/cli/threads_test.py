# Tests with the real binary that `--threads N` gives the same bytes of every file for any N.
# SPDX-License-Identifier: Apache-2.0
"""usage: threads_test.py GLINT SOURCE_DIR"""
import json

import glint_case
from glint_case import GlintTest

ATOMICS = """#version 460
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer Out { uint word[]; } data;
void main() {
  uint mine = gl_GlobalInvocationID.x;
  if (mine >= 2048u) return;
  for (uint i = 0u; i < 6u; ++i) {
    const uint at = (mine * 7u + i) & 63u;
    const uint seen = data.word[at];
    mine += atomicAdd(data.word[at], seen + mine);
    mine ^= atomicExchange(data.word[64u + (mine & 15u)], mine);
    mine += atomicMax(data.word[80u], mine & 0xffffu);
  }
  data.word[128u + gl_GlobalInvocationID.x] = mine;
}
"""


class Threads(GlintTest):
    def same_files(self, arguments, files):
        for threads in (1, 2, 4, 8):
            done = self.glint("run", *arguments, "--threads", threads, "--out", f"t{threads}")
            self.assertEqual(done.returncode, 0, done.stderr)
        for name in files:
            expected = (self.folder / "t1" / name).read_bytes()
            self.assertGreater(len(expected), 0)
            for threads in (2, 4, 8):
                self.assertEqual((self.folder / f"t{threads}" / name).read_bytes(), expected, f"{name} with {threads} threads")

    def test_a_path_traced_frame_has_the_same_picture_statistics_series_and_profile(self):
        self.same_files(["WKND", "--shader", "pt", "--size", "24x16", "--spp", "1", "--profile", "--sample", "500"],
                        ["image.png", "image.pfm", "stats.json", "stats.txt", "stats.csv", "series.csv", "profile.csv", "profile.folded", "source.json", "config.toml"])

    def test_compute_full_of_racing_atomics_has_the_same_buffers_and_statistics(self):
        self.write("atomics.comp", ATOMICS)
        self.same_files(["atomics.comp", "--sample", "500"], ["data.npy", "stats.json", "series.csv"])
        self.assertGreater(json.loads((self.folder / "t8/stats.json").read_text())["gpu"]["core[3]"]["global_atomics"]["value"], 0)

    def test_a_number_that_is_none_is_refused(self):
        self.expect(2, ["--threads"], "run", "WKND", "--threads", "many")


if __name__ == "__main__":
    glint_case.main()

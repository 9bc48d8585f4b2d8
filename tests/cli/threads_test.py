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

HEAD = """#version 460
layout(local_size_x = 32) in;
layout(set = 0, binding = 0) buffer B { uint v[]; };
layout(set = 0, binding = 1, rgba32f) uniform image2D picture;
"""
RANDOM = """uint x = gl_GlobalInvocationID.x * 747796405u + 1;
  for (int i = 0; i < 12; ++i) {
    x = x * 1664525u + 1013904223u;
    uint at = PLACE;
    switch (x >> 4 & 3) {
      case 0: v[at] = x; break;
      case 1: x += v[at]; break;
      case 2: x ^= atomicAdd(v[at], x); break;
      default: atomicXor(v[at], x);
    }
  }"""
# Each of these depends on the order of blocks in another way.
FUNCTIONAL = {
    "apart": "v[gl_GlobalInvocationID.x] = gl_GlobalInvocationID.x * 3 + v[gl_GlobalInvocationID.x];",
    "chain": "if (gl_LocalInvocationID.x == 0) v[gl_WorkGroupID.x + 1] = v[gl_WorkGroupID.x] * 3 + 1;",
    "neighbours": "v[gl_GlobalInvocationID.x] += gl_GlobalInvocationID.x > 40 ? v[gl_GlobalInvocationID.x - 40] + 1 : 5;",
    "counter": "v[gl_GlobalInvocationID.x + 1] = atomicAdd(v[0], gl_LocalInvocationID.x) + 1;",
    # Each block waits for a flag that the block before it sets.
    "flags": "if (gl_LocalInvocationID.x > 0) return;\n  if (gl_WorkGroupID.x > 0 && gl_WorkGroupID.x < 40) while (atomicAdd(v[gl_WorkGroupID.x], 0) == 0);\n"
             "  atomicExchange(v[gl_WorkGroupID.x + 1], v[gl_WorkGroupID.x] + 7);",
    # A late block reads what is only then known to be written.
    "late": "if (gl_WorkGroupID.x < 70) v[gl_GlobalInvocationID.x + 1000] = 1;\n  else v[gl_GlobalInvocationID.x % 64] = v[gl_GlobalInvocationID.x % 300 + 1000] + v[gl_GlobalInvocationID.x % 64];",
    "image": "ivec2 at = ivec2(gl_GlobalInvocationID.x % 16, gl_GlobalInvocationID.x / 16 % 16);\n"
             "  imageStore(picture, at, imageLoad(picture, (at + 5) % 16) + vec4(gl_GlobalInvocationID.x % 7));",
    # Lanes load, store and modify words here and there, in the second case mostly words of their own block.
    "anywhere": RANDOM.replace("PLACE", "(x >> 8) % 9000"),
    "close": RANDOM.replace("PLACE", "(gl_WorkGroupID.x * 32 + (x >> 8) % 34) % 10900"),
    "stores": "imageStore(picture, ivec2(gl_GlobalInvocationID.x % 16, gl_GlobalInvocationID.x / 16 % 16), vec4(gl_WorkGroupID.x));",
}


class Threads(GlintTest):
    def same_files(self, arguments, files):
        said = {}
        for threads in (1, 2, 4, 8, 16):
            done = self.glint("run", *arguments, "--threads", threads, "--out", f"t{threads}")
            self.assertEqual(done.returncode, 0, done.stderr)
            said[threads] = done.stderr
        self.assertEqual(set(said.values()), {said[1]})
        for name in files:
            expected = (self.folder / "t1" / name).read_bytes()
            self.assertGreater(len(expected), 0)
            for threads in (2, 4, 8, 16):
                self.assertEqual((self.folder / f"t{threads}" / name).read_bytes(), expected, f"{name} with {threads} threads")

    def test_a_path_traced_frame_has_the_same_picture_statistics_series_and_profile(self):
        self.same_files(["WKND", "--shader", "pt", "--size", "24x16", "--spp", "1", "--profile", "--sample", "500"],
                        ["image.png", "image.pfm", "stats.json", "stats.txt", "stats.csv", "series.csv", "profile.csv", "profile.folded", "source.json", "config.toml"])

    def test_compute_full_of_racing_atomics_has_the_same_buffers_and_statistics(self):
        self.write("atomics.comp", ATOMICS)
        self.same_files(["atomics.comp", "--sample", "500"], ["data.npy", "stats.json", "series.csv"])
        self.assertGreater(json.loads((self.folder / "t8/stats.json").read_text())["gpu"]["core[3]"]["global_atomics"]["value"], 0)

    def test_the_functional_machine_has_the_picture_and_counts_of_one_thread(self):
        for scene in ("WKND_PT", "BATH_PT", "BUNNY_AO", "SHIP_SH"):
            self.same_files([scene, "--mode", "functional", "--size", "64x48", "--spp", "1"], ["image.pfm", "stats.csv"])

    def test_blocks_that_read_what_others_write_give_what_they_give_in_order(self):
        for name, body in FUNCTIONAL.items():
            with self.subTest(name):
                self.write(f"{name}.comp", HEAD + "void main() {\n  " + body + "\n}\n")
                self.write(f"{name}.toml", f'[compute]\nshader = "{name}.comp"\n[launch]\ngroups = [300, 1, 1]\n[[buffer]]\nname = "B"\nset = 0\nbinding = 0\ntype = "u32"\ncount = 11000\n'
                           'save = "B.npy"\n[[image]]\nname = "picture"\nset = 0\nbinding = 1\nsize = [16, 16]\nsave = "picture.pfm"\n')
                self.same_files([f"{name}.toml", "--mode", "functional"], ["B.npy", "picture.pfm", "stats.csv"])

    def test_the_first_fault_in_order_of_blocks_ends_a_launch_and_those_let_pass_are_listed_alike(self):
        self.write("f.comp", HEAD.replace("layout(set = 0, binding = 1, rgba32f) uniform image2D picture;\n", "") +
                   "void main() {\n  uint b = gl_WorkGroupID.x;\n  if (b > 61 && b % 2 == 0)\n    v[gl_GlobalInvocationID.x + 1000000 * b] = 1;\n"
                   "  while (b == 400 && v[5] != 77)\n    v[6] = 1;\n  v[gl_GlobalInvocationID.x] = b;\n}\n")
        for options, code in ((["--on-fault", "stop"], 4), (["--on-fault", "warn", "--max-instructions", "20000"], 4)):
            said = [self.expect(code, [], "run", "f.comp", "--mode", "functional", *options, "--threads", threads, "--out", "out").stderr for threads in (1, 2, 4)]
            self.assertEqual(len(set(said)), 1, said)
        self.assertIn("no end in sight", said[0])
        self.assertIn("the first of", said[0])

    def test_prints_come_in_order_from_the_functional_machine(self):
        self.write("p.comp", "#version 460\n#extension GL_EXT_debug_printf : require\nlayout(local_size_x = 32) in;\nvoid main() {\n"
                   '  if (gl_LocalInvocationID.x % 8 == 3) debugPrintfEXT("%u in %u", gl_LocalInvocationID.x, gl_WorkGroupID.x);\n}\n')
        self.same_files(["p.comp", "--mode", "functional"], ["printf.txt"])

    def test_a_number_that_is_none_is_refused(self):
        self.expect(2, ["--threads"], "run", "WKND", "--threads", "many")


if __name__ == "__main__":
    glint_case.main()

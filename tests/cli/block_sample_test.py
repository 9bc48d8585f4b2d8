# Tests samples of the blocks of one launch of a pipeline or a kernel: estimates, what is left, and what is refused.
# SPDX-License-Identifier: Apache-2.0
"""usage: block_sample_test.py GLINT SOURCE_DIR"""
import re
import struct

import glint_case
from glint_case import ROOT, GlintTest

COMMON = ["--config", "mobile", "--stats", "compact"]
SHARE = ["--sample-pixels", "10%"]
THREADS = 128 * 4096

SAXPY = f"""kernel = "{ROOT}/shaders/kernels/saxpy.ptx"
grid = 4096
block = 128
argument = [
  {{ buffer = "x", type = "f32", count = {THREADS}, init = "iota" }},
  {{ buffer = "y", type = "f32", count = {THREADS}, value = 1.0, save = true, show = 2 }},
  {{ f32 = 2.0 }},
  {{ u32 = {THREADS} }},
]
"""

# Block b waits for the flag of block b - 1 and sets its own, so that blocks end one after another.
CHAIN = """.version 7.0
.target sm_70
.address_size 64
.visible .entry chain(.param .u64 flags)
{
  .reg .pred %p<2>;
  .reg .b32 %r<4>;
  .reg .b64 %d<4>;
  ld.param.u64 %d1, [flags];
  mov.u32 %r1, %ctaid.x;
  mul.wide.u32 %d2, %r1, 4;
  add.u64 %d3, %d1, %d2;
WAIT:
  ld.volatile.global.u32 %r2, [%d3];
  setp.eq.u32 %p1, %r2, 0;
  @%p1 bra WAIT;
  mov.u32 %r3, 1;
  st.volatile.global.u32 [%d3+4], %r3;
  ret;
}
"""


class BlockSampling(GlintTest):
    def mandelbrot(self, groups):
        """Writes the example with so many groups each way, and its shader."""
        text = (ROOT / "examples/mandelbrot/pipeline.toml").read_text()
        self.write("mandelbrot.comp", (ROOT / "examples/mandelbrot/mandelbrot.comp").read_text())
        text = re.sub(r"groups = .*", f"groups = [{groups}, {groups}]", text)
        return self.write("mandelbrot.toml", re.sub(r"size = .*", f"size = [{8 * groups}, {8 * groups}]", text))

    def covers(self, whole, sampled):
        """Compares the estimates of a sampled run with what the whole run has counted."""
        truth, found = self.statistics(whole), self.statistics(sampled)
        low, high = (found[f"gpu.sample.cycles_{end}"] for end in ("low", "high"))
        self.assertTrue(low <= truth["gpu.cycles"] <= high, (low, truth["gpu.cycles"], high))
        self.assertLess(high / low, 1.6)
        # Only a share of the instructions was timed, and the estimate has all of them.
        timed, all_of_them = found["gpu.core[*].instructions"], truth["gpu.core[*].instructions"]
        self.assertLess(timed, 0.2 * all_of_them)
        self.assertTrue(found["gpu.sample.instructions_low"] <= all_of_them <= found["gpu.sample.instructions_high"])

    def test_the_interval_of_a_kernel_covers_the_whole_launch_and_its_buffers_are_marked(self):
        self.write("saxpy.toml", SAXPY)
        self.run_into("whole", "saxpy.toml", *COMMON)
        said = self.run_into("a", "saxpy.toml", *COMMON, *SHARE)
        self.covers("whole", "a")
        self.assertIn("a sample of 10 %, seed 1", said)
        self.assertIn("images and buffers have only what the blocks of the sample wrote", said)
        facts = self.facts("a")
        self.assertEqual(facts["outputs"], {"y.bin": {"name": "y", "kind": "buffer", "incomplete": True}})
        self.assertEqual((facts["sample"]["blocks"], facts["sample"]["by"]), (4096, "position"))
        self.assertEqual(self.facts("whole")["outputs"], {"y.bin": {"name": "y", "kind": "buffer"}})
        # A block that ran has written all of its numbers, and no other block has written any.
        values = struct.unpack(f"<{THREADS}f", (self.folder / "a/y.bin").read_bytes())
        blocks = [values[first:first + 128] for first in range(0, THREADS, 128)]
        ran = [block for block, found in enumerate(blocks) if found != (1.0,) * 128]
        self.assertTrue(all(blocks[block] == tuple(2.0 * (128 * block + i) + 1 for i in range(128)) for block in ran))
        self.assertEqual(len(ran), facts["sample"]["timed"] + facts["sample"]["warm"])

    def test_the_interval_of_a_pipeline_covers_the_whole_launch(self):
        self.run_into("whole", self.mandelbrot(32), *COMMON, "--set", "core.warps=8")
        self.run_into("a", "mandelbrot.toml", *COMMON, "--set", "core.warps=8", *SHARE)
        self.covers("whole", "a")
        self.assertTrue(self.facts("a")["outputs"]["picture.png"]["incomplete"])
        self.assertGreater(len(self.rows("a/sample.csv")), 3)

    def test_threads_of_the_host_change_no_byte_and_seeds_and_ways_do(self):
        self.write("saxpy.toml", SAXPY)
        for out, options in (("one", ["--threads", "1"]), ("two", ["--threads", "2"]), ("seed", ["--sample-seed", "2"]), ("way", ["--sample-by", "cost"])):
            self.run_into(out, "saxpy.toml", *COMMON, *SHARE, *options)
        bytes_of = lambda out: [(self.folder / out / name).read_bytes() for name in ("stats.csv", "sample.csv", "y.bin")]
        self.assertEqual(bytes_of("one"), bytes_of("two"))
        self.assertNotEqual(bytes_of("one"), bytes_of("seed"))
        self.assertNotEqual(bytes_of("one"), bytes_of("way"))
        self.assertIn("different blocks", self.glint("compare", "one", "seed").stdout)
        self.assertIn("Both runs have timed the same blocks", self.glint("compare", "one", "two").stdout)

    def test_what_cannot_be_sampled_is_refused(self):
        self.expect(2, ["a sample of 10 % has 13 of 128 blocks"], "run", self.write("small.toml", SAXPY.replace("grid = 4096", "grid = 128")), *COMMON, *SHARE)
        launch = '[[launch]]\nname = "{}"\n'
        self.expect(2, ["which has a list of launches", "--sample-launches"], "run", self.write("list.toml", SAXPY + launch.format("a") + launch.format("b")), *SHARE)
        text = (self.folder / self.mandelbrot(32)).read_text()
        self.expect(2, ["--sample-pixels needs the timing machine", "--mode timing"], "run",
                    self.write("functional.toml", text + '[machine]\nmode = "functional"\n'), *SHARE)
        self.write("test.amber", "#!amber\n")
        self.expect(2, ["--sample-pixels cannot be used with 'test.amber'"], "run", "test.amber", *SHARE)
        self.expect(2, ["--sample-pixels cannot be used with 'bfs'"], "run", "bfs", *SHARE)

    def test_blocks_that_wait_for_others_end_with_an_error_that_says_so(self):
        self.write("chain.ptx", CHAIN)
        self.write("first.bin", "")
        (self.folder / "first.bin").write_bytes(struct.pack("<I", 1))
        self.write("chain.toml", 'kernel = "chain.ptx"\ngrid = 1024\nblock = 32\nargument = [{ buffer = "flags", type = "u32", count = 1025, file = "first.bin" }]\n')
        limits = [*COMMON, "--set", "core.warps=4", "--set", "core.livelock_budget=20000", "--max-instructions", "20000"]
        self.assertEqual(self.glint("run", "chain.toml", *limits, "--out", "whole").returncode, 0)
        done = self.glint("run", "chain.toml", *limits, *SHARE, "--out", "a")
        self.assertIn(done.returncode, (4, 5), done.stderr)
        self.assertIn("a launch whose blocks wait for others needs all of them", done.stderr)


if __name__ == "__main__":
    glint_case.main()

# Tests with the real binary which exit code programs have that never end, and who is said to wait for whom.
# SPDX-License-Identifier: Apache-2.0
"""usage: stuck_test.py GLINT SOURCE_DIR"""
import json
import re

import glint_case
from glint_case import GlintTest

LAUNCH = """kernel = "%s.ptx"
grid = %d
block = %d
[[argument]]
buffer = "lock"
type = "u32"
count = 64
"""
PTX = """.version 8.0
.target sm_90
.address_size 64
.visible .entry k(.param .u64 at) {
  .reg .b64 %rd<4>;
  .reg .b32 %r<8>;
  .reg .pred %p<3>;
  ld.param.u64 %rd1, [at];
  mov.u32 %r1, %tid.x;
BODY
  ret;
}
"""
WAIT_AT_BARRIER = PTX.replace("BODY", """  setp.ge.u32 %p1, %r1, 64;
  @%p1 bra DONE;
  bar.sync 1, 128;
DONE:""")
# Nobody gives this lock back: whoever has it ends with it.
SPIN_LOCK = PTX.replace("BODY", """  setp.ne.u32 %p1, %r1, 0;
  @%p1 bra DONE;
TRY:
  atom.global.cas.b32 %r2, [%rd1], 0, 1;
  setp.ne.u32 %p2, %r2, 0;
  @%p2 bra TRY;
DONE:""")
# These two blocks wait for each other's flag, which is set too late.
EACH_OTHER = PTX.replace("BODY", """  mov.u32 %r2, %ctaid.x;
  xor.b32 %r3, %r2, 1;
  mul.wide.u32 %rd2, %r3, 4;
  add.u64 %rd2, %rd1, %rd2;
TRY:
  ld.volatile.global.u32 %r4, [%rd2];
  setp.eq.u32 %p1, %r4, 0;
  @%p1 bra TRY;
  mul.wide.u32 %rd3, %r2, 4;
  add.u64 %rd3, %rd1, %rd3;
  st.global.u32 [%rd3], 1;""")
SOON = ["--set", "core.livelock_budget=100000"]


class Stuck(GlintTest):
    def run_kernel(self, code, parts, text, grid, block, *options):
        self.write("k.ptx", text)
        self.write("k.toml", LAUNCH % ("k", grid, block))
        done = self.expect(code, parts, "run", "k.toml", "--out", "out", *options)
        self.assertEqual(json.loads((self.folder / "out/run.json").read_text())["exit"], code)
        return done.stderr

    def test_a_barrier_that_some_warps_never_reach_exits_with_5_and_names_those_that_wait_on_both_machines(self):
        said = []
        for mode in ("functional", "timing"):
            said.append(self.run_kernel(5, ["2 of 4 warps wait at bar.sync 1 (k.ptx:", "the others have ended"], WAIT_AT_BARRIER, 1, 128, "--mode", mode))
        self.assertEqual(said[0], said[1])

    def test_a_spin_lock_that_nobody_gives_back_exits_with_5_and_names_the_warps_and_the_word(self):
        for cores in (8, 1):
            said = self.run_kernel(5, ["the machine is stuck", "nothing in memory has changed", "k.ptx:", "byte 0 of 'lock'", "core.livelock_budget"],
                                   SPIN_LOCK, 3, 32, "--set", f"cores={cores}", *SOON)
            waiting = re.findall(r"(?m)^  warps? ([\d, ]+): .*last access: byte 0 of 'lock'", said)
            self.assertEqual(len(", ".join(waiting).split(", ")), 2, said)  # one of the three warps had the lock

    def test_two_blocks_that_wait_for_each_other_exit_with_5_and_each_names_the_others_word(self):
        said = self.run_kernel(5, ["warp 0: at k.ptx:", "warp 1: at k.ptx:"], EACH_OTHER, 2, 32, *SOON)
        self.assertIn("byte 4 of 'lock'", next(line for line in said.splitlines() if "warp 0:" in line))
        self.assertIn("byte 0 of 'lock'", next(line for line in said.splitlines() if "warp 1:" in line))

    def test_without_a_budget_for_livelocks_a_spinning_warp_ends_by_its_instructions(self):
        self.run_kernel(4, ["no end in sight"], EACH_OTHER, 2, 32, "--set", "core.livelock_budget=0", "--max-instructions", "20000")

    def test_a_launch_that_gets_something_done_is_not_taken_for_a_livelock(self):
        busy = PTX.replace("BODY", """  mov.u32 %r2, 0;
LOOP:
  st.global.u32 [%rd1], %r2;
  add.u32 %r2, %r2, 1;
  setp.lt.u32 %p1, %r2, 4000;
  @%p1 bra LOOP;""")
        self.run_kernel(0, [], busy, 1, 32, "--set", "core.livelock_budget=10000")


if __name__ == "__main__":
    glint_case.main()

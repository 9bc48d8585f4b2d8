# Tests with the real binary what becomes of launches that never end, or that are ended early.
# SPDX-License-Identifier: Apache-2.0
"""usage: endless_test.py GLINT SOURCE_DIR [SUITE]"""
import json
import os
import pty
import re
import signal
import subprocess
import time

import glint_case
from glint_case import GLINT, ROOT, GlintTest

HEAD = "#version 460\nlayout(local_size_x = 32) in;\nlayout(set = 0, binding = 0) buffer B { uint v[]; };\n"
NOTHING = HEAD + """void main() {
  while (true) {
  }
  v[gl_GlobalInvocationID.x] = 7;
}
"""
STORES = HEAD + """void main() {
  uint i = 0;
  while (true) {
    v[gl_GlobalInvocationID.x] = i++;
  }
}
"""
SOME_LANES = HEAD + """void main() {
  v[gl_GlobalInvocationID.x] = 1;
  if (gl_GlobalInvocationID.x % 5 == 3)
    for (;;)
      v[gl_GlobalInvocationID.x] += 2;
}
"""
IN_A_FUNCTION = HEAD + """uint f(uint x) {
  for (;;)
    x = x * 3 + 1;
  return x;
}
void main() {
  v[gl_GlobalInvocationID.x] = f(1);
}
"""
# This loop has a way out that is never taken.
NEVER_TAKEN = HEAD + """void main() {
  for (uint i = 0; i < 4; ++i) {
    while (v[gl_GlobalInvocationID.x] != 1) {
      v[gl_GlobalInvocationID.x] = 2;
    }
  }
}
"""
# This takes seconds on either machine.
LONG = HEAD + """void main() {
  for (uint i = 0; i < 2000000; ++i)
    v[gl_GlobalInvocationID.x] += i;
}
"""
LOOP_PTX = """.version 8.0
.target sm_90
.address_size 64
.visible .entry k(.param .u64 at) {
  .reg .b64 %rd<4>;
  .reg .b32 %r<4>;
  ld.param.u64 %rd1, [at];
  mov.u32 %r1, 0;
AGAIN:
  add.u32 %r1, %r1, 1;
  st.global.u32 [%rd1], %r1;
  bra AGAIN;
}
"""
LOOP_TOML = 'kernel = "k.ptx"\ngrid = 1\nblock = 32\n[[argument]]\nbuffer = "b"\ntype = "u32"\ncount = 64\n'


class Endless(GlintTest):
    def test_a_loop_that_nothing_leads_out_of_exits_with_4_and_names_file_and_lines_on_both_machines(self):
        for name, text, place, lines in (("nothing", NOTHING, "nothing.comp:[56] ", "lines? 5"), ("stores", STORES, "stores.comp:[67] ", "line 7|lines 6 to 7"),
                                         ("some", SOME_LANES, "some.comp:[78] ", "line 8|lines 7 to 8"), ("called", IN_A_FUNCTION, "called.comp:[56] ", "lines? [56]")):
            self.write(f"{name}.comp", text)
            for mode in ("functional", "timing"):
                with self.subTest(shader=name, mode=mode):
                    said = self.expect(4, ["fault: no end in sight: nothing leads out of the loop"], "run", f"{name}.comp", "--mode", mode, "--out", "out").stderr
                    self.assertRegex(said, place)
                    self.assertRegex(said, f"the loop of ({lines})")
                    record = json.loads((self.folder / "out/run.json").read_text())
                    self.assertEqual((record["exit"], record["message"].split("\n")[0] in said), (4, True))

    def test_an_endless_loop_of_a_kernel_is_named_by_its_line(self):
        self.write("k.ptx", LOOP_PTX)
        self.write("k.toml", LOOP_TOML)
        for mode in ("functional", "timing"):
            self.expect(4, ["k.ptx:10 ", "nothing leads out of the loop of lines 10 to 12"], "run", "k.toml", "--mode", mode)

    def test_a_loop_whose_way_out_is_never_taken_ends_by_the_budget_and_is_named_with_the_loop_around_it(self):
        self.write("never.comp", NEVER_TAKEN)
        for mode in ("functional", "timing"):
            said = self.expect(4, ["no end in sight: the warp has executed more than 5000 instructions, and --max-instructions allows more; the warp is in the loop of line"], "run", "never.comp", "--mode", mode,
                               "--max-instructions", "5000").stderr
            self.assertRegex(said, r"the warp is in the loop of lines? [67].*, which is in the loop of lines [56] to [78]")

    def test_a_launch_whose_warps_do_not_end_is_cut_by_the_budget_of_turnover_and_told_where_they_are(self):
        self.write("never.comp", NEVER_TAKEN)
        for threads in (1, 2):
            said = self.expect(4, ["no end in sight: for 30000 cycles no warp has begun or ended, and ", "--set core.turnover_budget=CYCLES allows more"], "run", "never.comp",
                               "--set", "core.turnover_budget=30000", "--threads", threads).stderr
            self.assertRegex(said, r"never\.comp:[67] .* of \d+ running warps are at .*never\.comp:[67], in the loop of lines 6 to 7, which is in the loop of lines 5 to 7")
        # The budget is on without being asked for.
        self.glint("run", "WKND_SH", "--size", "8x8", "--out", "whole")
        self.assertIn("turnover_budget = 20000000", (self.folder / "whole/config.toml").read_text())

    def test_a_launch_whose_warps_take_turns_may_take_longer_than_the_budget_of_turnover(self):
        self.write("turns.comp", HEAD + "void main() {\n  for (uint i = 0; i < 20; ++i)\n    v[gl_GlobalInvocationID.x] += i;\n}\n")
        done = self.glint("run", "turns.comp", "--set", "core.turnover_budget=9000", "--out", "turns")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertGreater(int(re.search(r"gpu.cycles,(\d+)", (self.folder / "turns/stats.csv").read_text())[1]), 20000)
        # The loops of built-in shaders count to numbers of rays.
        self.assertEqual(self.glint("run", "WKND_PT", "--size", "8x8", "--set", "core.turnover_budget=1000").returncode, 0)

    def test_the_error_is_the_same_at_any_number_of_threads(self):
        self.write("some.comp", SOME_LANES)
        said = [self.expect(4, [], "run", "some.comp", "--threads", threads).stderr for threads in (1, 2, 4)]
        self.assertEqual(len(set(said)), 1, said)

    def test_loops_that_something_leads_out_of_are_no_endless_loops(self):
        self.write("ends.comp", HEAD + """void main() {
  uint i = 0;
  if (gl_GlobalInvocationID.x < 64) while (true) {
    if (++i > 20000) {
      v[gl_GlobalInvocationID.x] = i;
      return;
    }
    if (i > 30000) break;
  }
}
""")
        for mode in ("functional", "timing"):
            done = self.glint("run", "ends.comp", "--mode", mode, "--out", "out")
            self.assertEqual(done.returncode, 0, done.stderr)
        # An endless loop that no lane comes to does no harm.
        self.write("unused.comp", NOTHING.replace("while (true)", "if (gl_GlobalInvocationID.x == 77777777) while (true)"))
        done = self.glint("run", "unused.comp", "--mode", "functional", "--out", "out")
        self.assertEqual(done.returncode, 0, done.stderr)


class Early(GlintTest):
    READERS = (["stats", "out", "--format", "metrics"], ["stats", "out"], ["compare", "out", "out"], ["report", "out"], ["model", "out", "--statistics-only"], ["annotate", "out"])

    def record(self, folder="out"):
        return json.loads((self.folder / folder / "run.json").read_text())

    def check_part(self, code, reason, said):
        record = self.record()
        self.assertEqual((record["exit"], record["partial"]["reason"]), (code, reason))
        self.assertLess(record["partial"]["ended_warps"], record["partial"]["num_warps"])
        self.assertIn("the launch was ended early", said)
        self.assertIn(record["message"], said)
        return record["partial"]

    def test_max_cycles_ends_a_launch_with_6_and_keeps_statistics_that_readers_name_partial(self):
        options = ["--size", "64x64", "--spp", "1", "--profile", "--sample", "1000", "--heat", "--trace"]
        said = self.expect(6, ["--max-cycles"], "run", "SHIP_SH", *options, "--max-cycles", "8000", "--out", "out").stderr
        part = self.check_part(6, "max_cycles", said)
        self.assertLessEqual(8000, part["cycles"])
        self.assertLess(part["cycles"], 8100)
        stats = (self.folder / "out/stats.csv").read_text()
        self.assertIn(f"gpu.cycles,{part['cycles']},", stats)
        self.assertGreater(int(re.search(r"gpu.core\[0\].instructions,(\d+)", stats)[1]), 0)
        for reader in self.READERS:
            with self.subTest(reader=reader):
                done = self.glint(*reader)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertIn(f"note: out is partial: the launch was ended early at cycle {part['cycles']}", done.stderr)
        page = (self.folder / "out/report.html").read_text()
        self.assertIn("<title>SHIP sh, partial", page)
        self.assertIn(f"out is partial</strong>: the launch was ended early at cycle {part['cycles']}", page)

    def test_a_launch_that_is_ended_early_names_the_line_and_the_loops_where_its_warps_were(self):
        (self.folder / "never.comp").write_text(NEVER_TAKEN)
        where = r"(\d+) of (\d+) running warps are at .*never\.comp:[67], in the loop of lines 6 to 7, which is in the loop of lines 5 to 7"
        done = self.glint("run", "never.comp", "--max-cycles", "20000", "--out", "out")
        self.assertEqual(done.returncode, 6, done.stderr)
        self.assertRegex(done.stderr, where)
        found = re.search(where, self.record()["partial"]["where"])
        self.assertGreater(int(found[1]), 0)
        self.assertLessEqual(int(found[1]), int(found[2]))

    def test_a_partial_run_is_the_same_at_any_number_of_threads_and_without_skipping(self):
        files = []
        for options in (["--threads", "1"], ["--threads", "2"], ["--threads", "4"], ["--no-skip"]):
            self.expect(6, [], "run", "SHIP_SH", "--size", "32x32", "--spp", "1", "--max-cycles", "7001", "--profile", "--out", "out", *options)
            files.append([(self.folder / "out" / name).read_bytes() for name in ("stats.csv", "image.pfm", "profile.csv")] + [self.record()["partial"]])
        self.assertEqual([files[0]] * 4, files)

    def test_a_launch_that_ends_before_the_limit_is_whole(self):
        self.write("short.comp", HEAD + "void main() { v[gl_GlobalInvocationID.x] = 1; }\n")
        for limit in ("100000000", None):
            done = self.glint("run", "short.comp", "--out", "out", *(["--max-cycles", limit] if limit else []))
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertNotIn("partial", self.record())

    def test_a_launch_without_an_end_runs_up_to_the_limit(self):
        self.write("k.ptx", LOOP_PTX)
        self.write("k.toml", LOOP_TOML + "save = true\n")
        self.expect(6, ["0 of 1 warps have ended"], "run", "k.toml", "--max-cycles", "20000", "--out", "out")
        self.assertGreater(int.from_bytes((self.folder / "out/b.bin").read_bytes()[:4], "little"), 10)

    def test_a_limit_of_cycles_is_refused_where_there_are_none(self):
        self.write("nothing.comp", NOTHING)
        self.expect(2, ["--max-cycles needs cycles", "--max-instructions"], "run", "nothing.comp", "--mode", "functional", "--max-cycles", "5")
        self.expect(2, ["--max-cycles"], "run", ROOT / "examples/amber/none.amber", "--max-cycles", "5")
        self.expect(2, ["--max-cycles"], "run", "nothing.comp", "--max-cycles", "0")

    def test_signals_end_a_launch_with_the_shells_code_and_keep_what_it_did(self):
        self.write("long.comp", LONG)
        for mode, number in (("timing", signal.SIGTERM), ("timing", signal.SIGINT), ("functional", signal.SIGINT)):
            with self.subTest(mode=mode, signal=number):
                process = subprocess.Popen([GLINT, "run", "long.comp", "--mode", mode, "--out", "out"], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
                self.addCleanup(lambda process=process: (process.kill(), process.communicate()))
                self.wait_for(lambda: handles(process.pid, number))
                process.send_signal(number)
                _, said = process.communicate(timeout=60)
                self.assertEqual(process.returncode, 128 + number, said)
                self.check_part(128 + number, number.name, said)
                self.assertTrue((self.folder / "out/stats.csv").exists())
                self.assertIn("is partial", self.glint("stats", "out").stderr)

    def wait_for(self, what):
        deadline = time.monotonic() + 60
        while not what():
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.02)

    def test_the_terminal_shows_what_runs_its_cycles_and_its_speed(self):
        self.write("k.ptx", LOOP_PTX)
        self.write("k.toml", LOOP_TOML)
        ours, theirs = pty.openpty()
        process = subprocess.Popen([GLINT, "run", "k.toml", "--max-cycles", "3000000", "--out", "out"], cwd=self.folder, stdout=theirs, stderr=subprocess.PIPE)
        os.close(theirs)
        shown = b""
        try:
            while part := os.read(ours, 4096):
                shown += part
        except OSError:  # the other end is closed
            pass
        process.communicate(timeout=60)
        self.assertRegex(shown.decode(), r"\r k \[[^\]]*\]   0 %  .*  \d[\d.]* [kM] cycles  \d[\d.]* [kM] instr/s")

    def test_the_terminal_names_the_line_of_a_launch_in_which_nothing_has_ended_for_some_seconds(self):
        self.write("k.ptx", LOOP_PTX)
        self.write("k.toml", LOOP_TOML)
        ours, theirs = pty.openpty()
        process = subprocess.Popen([GLINT, "run", "k.toml", "--max-cycles", "100000000000", "--out", "out"], cwd=self.folder, stdout=theirs, stderr=subprocess.PIPE)
        self.addCleanup(lambda: (process.kill(), process.communicate()))
        os.close(theirs)
        shown, deadline = "", time.monotonic() + 60
        while not re.search(r"\r k .*  0 %  .* cycles  .* instr/s  at k\.ptx:1[0-2]", shown):
            self.assertLess(time.monotonic(), deadline, shown)
            shown += os.read(ours, 4096).decode()


def handles(pid, number):
    """Returns whether a process has a handler for a signal (proc_pid_status(5))."""
    with open(f"/proc/{pid}/status", encoding="ascii") as status:
        caught = next(int(line.split()[1], 16) for line in status if line.startswith("SigCgt:"))
    return bool(caught >> (number - 1) & 1)


if __name__ == "__main__":
    glint_case.main()

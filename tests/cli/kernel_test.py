# Tests `glint run` of PTX kernels with the real binary: results on both machines, and what is said of mistakes.
# SPDX-License-Identifier: Apache-2.0
"""usage: kernel_test.py GLINT SOURCE_DIR"""
import json
import re
import struct

import glint_case
from glint_case import ROOT, GlintTest

KERNELS = ROOT / "shaders/kernels"


class Kernels(GlintTest):
    def test_the_examples_give_the_same_buffers_on_both_machines(self):
        for mode in ("functional", "timing"):
            done = self.glint("run", KERNELS / "saxpy.toml", "--mode", mode, "--out", mode)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("1 3 5 7 9 11 13 15", done.stdout)
            values = struct.unpack("<1000f", (self.folder / mode / "y.bin").read_bytes())
            self.assertEqual(values, tuple(2.0 * i + 1 for i in range(1000)))
        done = self.glint("run", KERNELS / "block_sums.ptx", "--launch", KERNELS / "block_sums.toml", "--out", "sums")
        self.assertIn("32640 98176 163712 229248", done.stdout)

    def test_init_writes_a_launch_file_that_runs_as_it_is(self):
        for name in ("saxpy", "block_sums"):
            with self.subTest(kernel=name):
                self.assertEqual(self.glint("init", f"{name}.toml", KERNELS / f"{name}.ptx").returncode, 0)
                done = self.glint("run", f"{name}.toml", "--out", name)
                self.assertEqual(done.returncode, 0, done.stderr)
        # y = a * x + y with a = 1 and both counting from 0
        self.assertEqual(struct.unpack("<4f", (self.folder / "saxpy/y.bin").read_bytes()[:16]), (0.0, 2.0, 4.0, 6.0))

    def test_init_writes_a_kernel_to_begin_with_where_there_is_none(self):
        (self.folder / "new").mkdir()
        done = self.glint("init", "new/first.toml", "new/first.ptx")
        self.assertEqual((done.returncode, done.stdout), (0, ""))
        self.assertIn("there was no 'new/first.ptx'", done.stderr)
        self.assertIn('kernel = "first.ptx"', (self.folder / "new/first.toml").read_text())
        for mode in ("functional", "timing"):
            done = self.glint("run", "new/first.toml", "--mode", mode, "--out", mode)
            self.assertEqual(done.returncode, 0, done.stderr)
            squares = struct.unpack("<65536f", (self.folder / mode / "squares.bin").read_bytes())
            self.assertEqual(squares[:1025], tuple(float(i * i) for i in range(1024)) + (1024.0,))
        mine = (self.folder / "new/first.ptx").read_text() + "// mine\n"
        self.write("new/first.ptx", mine)
        self.expect(2, ["exists already"], "init", "new/first.toml", "new/first.ptx")
        self.assertEqual(self.glint("init", "--force", "new/first.toml", "new/first.ptx").returncode, 0)
        self.assertEqual((self.folder / "new/first.ptx").read_text(), mine)

    def test_init_refuses_what_a_launch_file_cannot_give(self):
        self.write("a.ptx", ".version 7.0\n.target sm_70\n.address_size 64\n.visible .entry k(.param .align 4 .b8 block[12]) { ret; }\n")
        self.expect(2, ["parameter 'block' has 12 bytes"], "init", "a.toml", "a.ptx")
        self.write("none.toml", 'grid = 1\nkernel = "nowhere.ptx"\n')
        self.expect(2, ["none.toml:2:10: error: cannot read the kernel 'nowhere.ptx'"], "run", "none.toml", "--out", "out")
        self.expect(2, ["one PTX file"], "init", "a.toml", "a.ptx", "b.comp")
        self.write("none.ptx", ".version 7.0\n.target sm_70\n.address_size 64\n")
        self.expect(2, ["no kernel"], "init", "a.toml", "none.ptx")
        self.assertFalse((self.folder / "a.toml").exists())

    def write_list(self, more=""):
        """Writes two launches of saxpy over the same buffers, y = 2 * x + y, and a third one, x = y + x."""
        self.write("saxpy.ptx", (KERNELS / "saxpy.ptx").read_text())
        text = (KERNELS / "saxpy.toml").read_text()
        text += '\n[[launch]]\nname = "first"\n\n[[launch]]\nname = "again"\ncaches = "warm"\n\n[[launch]]\nname = "back"\n'
        text += "".join(f"[[launch.argument]]\n{each}\n" for each in ('buffer = "y"', 'buffer = "x"', "f32 = 1.0", "u32 = 1000"))
        self.write("list.toml", text.replace('init = "iota"', 'init = "iota"\nsave = true') + more)

    def cycles(self, folder):
        row = next(r for r in (self.folder / folder / "stats.csv").read_text().splitlines() if r.startswith("gpu.cycles,"))
        return int(row.split(",")[1])

    def test_launches_of_a_list_run_in_order_and_keep_memory(self):
        self.write_list()
        for mode in ("functional", "timing"):
            done = self.glint("run", "list.toml", "--mode", mode, "--out", mode)
            self.assertEqual(done.returncode, 0, done.stderr)
            values = {name: struct.unpack("<1000f", (self.folder / mode / f"{name}.bin").read_bytes()) for name in "xy"}
            self.assertEqual(values["y"], tuple(4.0 * i + 1 for i in range(1000)))
            self.assertEqual(values["x"], tuple(5.0 * i + 1 for i in range(1000)))
        folders = ["launch-0-first", "launch-1-again", "launch-2-back"]
        whole = json.loads((self.folder / "timing/run.json").read_text())
        self.assertEqual(whole["launches"], folders)
        cycles = [self.cycles(f"timing/{each}") for each in folders]
        self.assertEqual(self.cycles("timing"), sum(cycles))
        self.assertLess(cycles[1], cycles[0])  # The L2 has the buffers.
        self.assertEqual(self.glint("report", "timing", "--out", "page.html").returncode, 0)
        self.assertIn("again", (self.folder / "page.html").read_text())

    IMAGES = """.version 7.0
.target sm_70
.address_size 64
.extern .func (.param .b32 r) vprintf(.param .b64 f, .param .b64 a);
.global .u32 launches;
.global .align 1 .b8 text[8] = {108, 58, 32, 37, 117, 10, 0};
.visible .entry copy(.param .u64 from, .param .u64 to)
{
  .reg .b64 %rd<4>; .reg .b32 %r<4>; .reg .f32 %f<6>;
  ld.param.u64 %rd1, [from]; ld.param.u64 %rd2, [to]; mov.u32 %r1, %tid.x; mov.u32 %r2, %tid.y;
  cvt.rn.f32.u32 %f1, %r1; cvt.rn.f32.u32 %f2, %r2;
  tex.2d.v4.f32.f32 {%f1, %f2, %f3, %f4}, [%rd1, {%f1, %f2}];
  shl.b32 %r1, %r1, 2; cvt.rni.u32.f32 %r3, %f1; sust.b.2d.b32.trap [%rd2, {%r1, %r2}], {%r3};
  mov.u32 %r3, 1; red.global.add.u32 [launches], %r3; ret;
}
.visible .entry tell()
{
  .local .align 8 .b8 depot[8]; .reg .b64 %rd<4>; .reg .b32 %r<2>;
  ld.global.u32 %r1, [launches]; st.local.u32 [depot], %r1; mov.u64 %rd1, depot; cvta.local.u64 %rd2, %rd1; mov.u64 %rd3, text;
  { .param .b64 f; st.param.b64 [f], %rd3; .param .b64 a; st.param.b64 [a], %rd2; .param .b32 r; call (r), vprintf, (f, a); }
  ret;
}
"""
    LAUNCHES = """kernel = "images.ptx"
image = [{ name = "in", format = "r32_float", size = [2, 2], data = [5, 6, 7, 8] },
         { name = "out", format = "r32_uint", size = [2, 2], save = "out.csv" }]
[[launch]]
name = "copy"
entry = "copy"
block = [2, 2]
argument = [{ texture = "in" }, { surface = "out" }]
[[launch]]
name = "tell"
entry = "tell"
"""

    def test_images_are_handles_and_kernels_share_variables_and_print(self):
        self.write("images.ptx", self.IMAGES)
        self.write("images.toml", self.LAUNCHES)
        for mode in ("functional", "timing"):
            done = self.glint("run", "images.toml", "--mode", mode, "--out", mode)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("l: 4\n", done.stderr)
            self.assertEqual((self.folder / mode / "printf.txt").read_text(), "l: 4\n")
            red = [line.split(",")[2] for line in (self.folder / mode / "out.csv").read_text().split() if line[0].isdigit()]
            self.assertEqual(red, ["5", "6", "7", "8"])
        self.write("wrong.toml", self.LAUNCHES.replace('texture = "in"', 'texture = "no"').replace("r32_uint", "r32_unit"))
        self.expect(2, ["'r32_unit' is not a format of texels", "did you mean 'r32_uint'?"], "run", "wrong.toml", "--out", "w")
        self.write("wrong.toml", self.LAUNCHES.replace('texture = "in"', 'texture = "no"'))
        self.expect(2, ["wrong.toml:8:", "there is no [[image]] with the name 'no'"], "run", "wrong.toml", "--out", "w")

    def test_a_cold_launch_of_a_list_has_the_cycles_that_it_has_alone(self):
        self.write_list()
        self.write("list.toml", (self.folder / "list.toml").read_text().replace('caches = "warm"\n', ""))
        self.assertEqual(self.glint("run", "list.toml", "--out", "list").returncode, 0)
        self.assertEqual(self.glint("run", KERNELS / "saxpy.toml", "--out", "alone").returncode, 0)
        self.assertEqual({self.cycles(each) for each in ("list/launch-0-first", "list/launch-1-again")}, {self.cycles("alone")})

    def test_mistakes_of_a_list_are_told(self):
        self.write_list('[[launch]]\ncaches = "hot"\n[[launch.argument]]\nbuffer = "y"\ncount = 3\n')
        self.expect(2, ["a launch needs a 'name'", "'caches' must be", "buffer 'y' is there already"], "run", "list.toml")
        self.write_list()
        self.expect(2, ["list of launches"], "run", "saxpy.ptx", "--launch", "list.toml")

    def test_a_kernel_without_a_launch_file_is_refused(self):
        self.expect(2, ["needs a launch file"], "run", KERNELS / "saxpy.ptx")

    def test_mistakes_of_a_launch_file_are_told_with_their_lines_all_at_once(self):
        self.write("bad.toml", 'kernel = "k.ptx"\ngird = 4\n[[argument]]\nu33 = 1\n[[argument]]\nbuffer = "b"\ninit = "iota"\n')
        self.expect(2, ["bad.toml:2:1: error: 'gird' is not a key", "did you mean 'grid'?", "bad.toml:4:1: error: 'u33'",
                        "needs 'count'"], "run", "bad.toml")

    def test_a_grid_that_is_too_large_is_refused_with_the_limit(self):
        text = (KERNELS / "saxpy.toml").read_text()
        self.write("saxpy.ptx", (KERNELS / "saxpy.ptx").read_text())
        for grid in ("4000000000", "[1, 2147483648]", "0", "[]"):
            changed = re.sub(r"(?m)^grid = .*$", f"grid = {grid}", text)
            self.assertNotEqual(changed, text)
            self.write("saxpy.toml", changed)
            self.expect(2, ["saxpy.toml:", "'grid' must be a whole number, or a list of up to three, each from 1 to 2147483647"], "run", "saxpy.toml")

    def test_an_unknown_op_exits_with_3_and_names_its_place(self):
        text = (KERNELS / "saxpy.ptx").read_text().replace("fma.rn.f32", "fna.rn.f32")
        self.write("saxpy.ptx", text)
        line = text[: text.index("fna.rn")].count("\n") + 1
        self.expect(3, [f"saxpy.ptx:{line}:", "no op 'fna.rn.f32'; did you mean 'fma.rn.f32'?"],
                    "run", "saxpy.ptx", "--launch", KERNELS / "saxpy.toml")

    def test_a_wrong_argument_is_refused_at_its_line(self):
        text = (KERNELS / "saxpy.toml").read_text().replace("u32 = 1000", "u64 = 1000")
        self.write("saxpy.ptx", (KERNELS / "saxpy.ptx").read_text())
        self.write("saxpy.toml", text)
        line = text[: text.index("[[argument]]\nu64")].count("\n") + 1
        self.expect(2, [f"saxpy.toml:{line}:", "parameter 'n' has 4 bytes, and this argument has 8"], "run", "saxpy.toml")

    def test_an_access_out_of_bounds_ends_with_4_and_names_file_and_line_in_both_modes(self):
        self.write("saxpy.ptx", (KERNELS / "saxpy.ptx").read_text())
        self.write("saxpy.toml", (KERNELS / "saxpy.toml").read_text().replace("u32 = 1000", "u32 = 1001"))
        for mode in ("functional", "timing"):
            self.expect(4, ["saxpy.ptx:", "past the end of 'x'"], "run", "saxpy.toml", "--mode", mode)


if __name__ == "__main__":
    glint_case.main()

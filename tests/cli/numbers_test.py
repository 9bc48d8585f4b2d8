# Tests the numbers of a pipeline file: specialisation constants of every type, generators, and numbers that do not fit.
# SPDX-License-Identifier: Apache-2.0
"""usage: numbers_test.py GLINT SOURCE_DIR"""
import struct

import glint_case
from glint_case import GlintTest

# Constants 0 and 1 are a block's size, which glslang declares as two constants each.
CONSTANTS = """#version 460
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(constant_id = 2) const int8_t BYTE = int8_t(-2);
layout(constant_id = 3) const int16_t SHORT = int16_t(-4);
layout(constant_id = 4) const uint8_t COUNT = uint8_t(9);
layout(constant_id = 5) const float16_t HALF = 1.5hf;
layout(constant_id = 6) const double WIDE = 0.1;
layout(constant_id = 7) const int64_t LONG = 5l;
layout(constant_id = 8) const bool ON = false;
layout(set = 0, binding = 0) buffer Out { double wide; int64_t far; int byte; int small; uint count; float half_; uint on, threads; };
void main() {
  wide = WIDE, far = LONG, byte = BYTE, small = SHORT, count = COUNT, half_ = HALF, on = uint(ON);
  threads = gl_WorkGroupSize.x * 100 + gl_WorkGroupSize.y;
}
"""
ROW = "<dqiiIfII"
BUFFER = '[compute]\nshader = "a.comp"\n[launch]\ngroups = 1\n[[buffer]]\nset = 0\nbinding = 0\n'
STORE = "#version 460\nlayout(set = 0, binding = 0) buffer Out { uint o[]; };\nvoid main() { o[0] += 0u; }\n"


class NumbersTest(GlintTest):
    def bytes_of(self, text, mode="functional"):
        done = self.glint("run", self.write("p.toml", text), "--mode", mode, "--out", "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        return (self.folder / "out/o.raw").read_bytes()

    def refuse(self, parts, text):
        self.expect(2, parts, "run", self.write("p.toml", text), "--out", "out")

    def constants(self, values):
        self.write("a.comp", CONSTANTS)
        return BUFFER + f'bytes = 40\nsave = "o.raw"\n[specialization]\n{values}\n'

    def test_constants_of_every_type_reach_the_shader(self):
        given = "0 = 4\n1 = 2\nBYTE = -100\nSHORT = -300\nCOUNT = 255\nHALF = -2.5\nWIDE = 0.3\nLONG = -9000000000\nON = true"
        for mode in ("functional", "timing"):
            self.assertEqual(struct.unpack(ROW, self.bytes_of(self.constants(given), mode)), (0.3, -9000000000, -100, -300, 255, -2.5, 1, 402))

    def test_init_writes_the_defaults_of_constants_as_values_that_mean_the_same(self):
        self.write("a.comp", CONSTANTS)
        self.expect(0, [], "init", "a.toml", "a.comp")
        lines = [line[2:] for line in (self.folder / "a.toml").read_text().splitlines() if "# constant_id" in line]
        self.assertEqual([line.split("  #")[0] for line in lines],
                         ["0 = 1", "1 = 1", "BYTE = -2", "SHORT = -4", "COUNT = 9", "HALF = 1.5", "WIDE = 0.1", "LONG = 5", "ON = false"])
        defaults = struct.unpack(ROW, self.bytes_of(self.constants("")))
        self.assertEqual(defaults, (0.1, 5, -2, -4, 9, 1.5, 0, 101))
        self.assertEqual(struct.unpack(ROW, self.bytes_of(self.constants("\n".join(lines)))), defaults)

    def test_a_number_that_needs_more_bits_than_its_type_has_is_refused_at_its_line(self):
        self.refuse(["p.toml:11:1: error: the specialisation constant is of type u8"], self.constants("COUNT = 256"))
        self.refuse(["p.toml:11:1: error: the specialisation constant is of type s16"], self.constants("SHORT = -32769"))
        self.write("a.comp", STORE)
        for number in ("256", "-129"):
            self.refuse(["p.toml:9:", f"{number} is not a u8"], BUFFER + f'type = "u8"\ndata = [1, 2, 3, {number}]\n')
        self.assertEqual(self.bytes_of(BUFFER + 'type = "u8"\ndata = [255, -1, 128, -128]\nsave = "o.raw"\n'), bytes([255, 255, 128, 128]))

    def test_a_number_of_another_kind_is_named_with_what_to_write(self):
        self.write("a.comp", STORE)
        self.refuse(["p.toml:8:12: error: 0.5 is not a u32", "numbers with a fraction need a type of floats"], BUFFER + "data = [1, 0.5]\n")
        self.refuse(["'x' is not a u32", "the name of a buffer"], BUFFER + 'data = ["x"]\n')
        self.refuse(["'set' is a date or a time, expected a whole number"], BUFFER.replace("set = 0", "set = 1979-05-27") + "data = [1]\n")

    def test_generators_draw_numbers_of_the_buffers_type(self):
        self.write("a.comp", STORE)
        drawn = self.bytes_of(BUFFER + 'type = "double"\ncount = 64\ninit = "random"\nsave = "o.raw"\n')
        self.assertLessEqual(max(struct.unpack("<64d", drawn)), 1)
        counted = self.bytes_of(BUFFER + 'type = "u8"\ncount = 300\ninit = "iota"\nsave = "o.raw"\n')
        self.assertEqual(counted, bytes(i % 256 for i in range(300)))
        for line, message in (("value = 300", "'value' is 300, which is not a u8"),
                              ("value = 1.5", "'value' is 1.5, which is not a u8"),
                              ('init = "random"\nhigh = 256', "'high' is 256, which is not a u8"),
                              ('init = "random"\nlow = 9\nhigh = 3', "'low' is 9, which is above 'high', 3")):
            self.refuse(["p.toml:5:", message], BUFFER + f'type = "u8"\ncount = 4\n{line}\n')


if __name__ == "__main__":
    glint_case.main()

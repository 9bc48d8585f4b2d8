# Tests images whose texels are in the pipeline file itself: every shape, any binding, and mistakes.
# SPDX-License-Identifier: Apache-2.0
"""usage: texel_test.py GLINT SOURCE_DIR"""
import shutil
import struct

import glint_case
from glint_case import GlintTest

LOOK = """#version 460
layout(local_size_x = 1) in;
layout(set = 3, binding = 200) uniform sampler2D plane;
layout(set = 3, binding = 201) uniform samplerCube cube;
layout(set = 3, binding = 202) uniform sampler3D deep;
layout(set = 3, binding = 203) uniform usampler2D numbers;
layout(set = 3, binding = 204) uniform texture2D several[2];
layout(set = 3, binding = 205) uniform sampler pick;
layout(set = 15, binding = 1023) buffer Out { float o[]; };
void main() {
  o[0] = texelFetch(plane, ivec2(1, 1), 0).y;
  o[1] = textureLod(plane, vec2(0.5), 1.0).x;
  o[2] = texture(cube, vec3(0, 0, -1)).x;
  o[3] = texelFetch(deep, ivec3(0, 1, 1), 0).x;
  o[4] = float(texelFetch(numbers, ivec2(1, 0), 0).z);
  o[5] = textureLod(sampler2D(several[1], pick), vec2(0.9, 0.1), 0.0).x;
  o[6] = float(o.length()) + float(textureQueryLevels(plane));
}
"""

LOOK_FILE = """[compute]
shader = "look.comp"
[launch]
groups = 1
[[image]]
set = 3
binding = 200
size = [2, 2]
format = "rg32_float"
data = [[1, 10], [2, 20], [3, 30], [6, 40]]
mipmaps = true
filter = "nearest"
[[image]]
set = 3
binding = 201
size = [1, 1]
layers = 6
format = "r32_float"
data = [1, 2, 3, 4, 5, 6]
[[image]]
set = 3
binding = 202
size = [1, 2, 2]
format = "r32_float"
data = [1, 2, 3, 4.5]
[[image]]
set = 3
binding = 203
size = [2, 1]
format = "rgba8_uint"
data = [1, 2, 3, 4, 5, 6, 7, 8]
[[image]]
set = 3
binding = 204
size = [1, 1]
data = [8, 0, 0, 1]
[[image]]
set = 3
binding = 204
element = 1
size = [2, 1]
data = [9, 0, 0, 1, 10, 0, 0, 1]
[[sampler]]
set = 3
binding = 205
filter = "nearest"
[[buffer]]
set = 15
binding = 1023
type = "f32"
count = 7
save = "out.csv"
"""


SAMPLES = """#version 460
layout(local_size_x = 2, local_size_y = 2) in;
layout(set = 0, binding = 0, r32f) uniform image2DMS many;
layout(set = 0, binding = 1) buffer Out { float o[]; };
void main() {
  const ivec2 at = ivec2(gl_LocalInvocationID.xy);
  o[gl_LocalInvocationIndex] = imageLoad(many, at, 1).x + float(imageSamples(many)) * 100.0;
}
"""
SAMPLES_FILE = """[compute]
shader = "samples.comp"
[launch]
groups = 1
[[image]]
binding = 0
size = [2, 2]
samples = 2
data = [1, 2, 3, 4, 5, 6, 7, 8]
format = "r32_float"
[[buffer]]
binding = 1
type = "f32"
count = 4
save = "out.csv"
"""


INTEGERS = """#version 460
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) uniform usampler2D counts;
layout(set = 0, binding = 1) uniform isampler2D depths;
layout(set = 0, binding = 2) buffer Out { uvec4 o[4]; };
void main() {
  o[0] = textureLod(counts, vec2(1.5), 0.0), o[1] = uvec4(textureLod(depths, vec2(-0.5), 0.0));
  o[2] = textureLod(counts, vec2(0.6, 0.5), 0.0), o[3] = uvec4(textureLod(depths, vec2(0.4, 0.5), 0.0));
}
"""
INTEGERS_FILE = """[compute]
shader = "integers.comp"
[launch]
groups = 1
[[image]]
binding = 0
size = [2, 1]
format = "rgba32_uint"
data = [1, 2, 3, 4, 5, 6, 7, 8]
wrap = "clamp_to_border"
border = [7, 4294967295, 16777217, 10]
[[image]]
binding = 1
size = [2, 1]
format = "rg16_sint"
data = [-1, 2, 3, -4]
wrap = "clamp_to_border"
border = [-7, -8, 9, 10]
[[buffer]]
binding = 2
bytes = 64
save = "out.csv"
"""


class Texels(GlintTest):
    def setUp(self):
        super().setUp()
        self.write("look.comp", LOOK)

    def run_text(self, code, parts, text):
        return self.expect(code, parts, "run", self.write("p.toml", text), "--mode", "functional", "--out", "out")

    def refused(self, old, new, *parts):
        self.assertIn(old, LOOK_FILE)
        self.run_text(2, parts, LOOK_FILE.replace(old, new, 1))

    def test_images_of_every_shape_hold_the_texels_of_the_file_far_up_in_their_sets(self):
        self.run_text(0, [], LOOK_FILE)
        self.assertEqual(self.saved_numbers(), [40, 3, 6, 4.5, 7, 10, 9])

    def test_samples_of_a_texel_are_layers_and_only_where_the_shader_has_them(self):
        self.write("samples.comp", SAMPLES)
        self.run_text(0, [], SAMPLES_FILE)
        self.assertEqual(self.saved_numbers(), [205, 206, 207, 208])
        self.refused("size = [1, 1]\nlayers = 6", "size = [1, 1]\nlayers = 6\nsamples = 2", "image 'image_3_201'", "samples per texel, and the shader's has one")

    def test_images_of_integers_take_the_nearest_texel_and_borders_of_integers(self):
        self.write("integers.comp", INTEGERS)
        self.run_text(0, [], INTEGERS_FILE)
        rows = [7, 2**32 - 1, 2**24 + 1, 10, -7, -8, 0, 1, 5, 6, 7, 8, -1, 2, 0, 1]
        self.assertEqual(self.saved_numbers(number=int), [v % 2**32 for v in rows])
        self.run_text(2, ["p.toml:11:1: error: 'border' has 5 numbers, expected up to four"], INTEGERS_FILE.replace("16777217, 10]", "16777217, 10, 11]"))
        self.assertEqual(self.glint("init", "new.toml", "integers.comp").returncode, 0)
        self.assertEqual((self.folder / "new.toml").read_text().count('filter = "nearest"'), 2)
        self.expect(0, [], "run", "new.toml", "--mode", "functional", "--out", "new")

    def test_a_sampler_is_anisotropic_where_its_file_says_so(self):
        self.write("stretch.comp", """#version 460
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) uniform sampler2D picture;
layout(set = 0, binding = 1) buffer Out { float o[]; };
void main() { o[0] = textureGrad(picture, vec2(8.5 / 16.0, 0.5), vec2(0.5, 0), vec2(0, 2 / 16.0)).r; }
""")
        row = [0] * 8 + [1] * 8
        text = f"""[compute]
shader = "stretch.comp"
[launch]
groups = 1
[[image]]
binding = 0
size = [16, 16]
format = "r32_float"
data = {row * 16}
filter = "nearest"
max_anisotropy = 16
[[buffer]]
binding = 1
type = "f32"
bytes = 4
save = "out.csv"
"""
        # Two of the four samples lie to the left of texel 8.
        self.run_text(0, [], text)
        self.assertEqual(self.saved_numbers(), [0.5])
        self.run_text(0, [], text.replace("max_anisotropy = 16\n", ""))
        self.assertEqual(self.saved_numbers(), [1])
        self.run_text(2, ["p.toml:11:1: error: 'max_anisotropy' is 17, expected a number from 1 to 16"], text.replace("anisotropy = 16", "anisotropy = 17"))

    def test_images_of_integers_are_saved_as_integers_with_all_their_bits(self):
        self.write("integers.comp", INTEGERS)
        text = INTEGERS_FILE.replace("[1, 2, 3, 4, 5, 6, 7, 8]", '[4294967295, 16777217, 3, 4, 5, 6, 7, 8]\nsave = ["u.csv", "u.npy"]').replace(
            "data = [-1, 2, 3, -4]", 'data = [-1, 2, 3, -4]\nsave = ["s.csv", "s.npy"]')
        self.run_text(0, [], text)
        self.assertEqual((self.folder / "out/u.csv").read_text(), "x,y,red,green,blue,alpha\n0,0,4294967295,16777217,3,4\n1,0,5,6,7,8\n")
        self.assertEqual((self.folder / "out/s.csv").read_text(), "x,y,red,green,blue,alpha\n0,0,-1,2,0,1\n1,0,3,-4,0,1\n")
        for name, kind, numbers in (("u", "<u4", (2**32 - 1, 2**24 + 1, 3, 4, 5, 6, 7, 8)), ("s", "<i4", (-1, 2, 0, 1, 3, -4, 0, 1))):
            data = (self.folder / f"out/{name}.npy").read_bytes()
            self.assertIn(f"'descr': '{kind}', 'fortran_order': False, 'shape': (1, 2, 4)".encode(), data)
            self.assertEqual(struct.unpack("<8I" if kind == "<u4" else "<8i", data[-32:]), numbers)

    def test_files_of_bytes_keep_them_and_their_smaller_levels_are_means_of_linear_values(self):
        grey = [255 * (x % 2) if y < 2 else 16 * y + x for y in range(16) for x in range(16)]
        (self.folder / "grey.png").write_bytes(glint_case.png_bytes(16, 16, bytes(part for value in grey for part in (value, value // 2, 255 - value))))
        self.write("copy.comp", """#version 460
layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0) uniform sampler2DArray encoded;
layout(set = 0, binding = 1) uniform sampler2D plain;
layout(set = 0, binding = 2) buffer Out { vec4 o[]; };
void main() {
  const uint at = gl_LocalInvocationIndex;
  o[2 * at] = texelFetch(encoded, ivec3(gl_LocalInvocationID.xy, 1), 0);
  o[2 * at + 1] = texelFetch(plain, ivec2(gl_LocalInvocationID.xy), 0);
  if (at == 0 && textureQueryLevels(plain) > 1) o[512] = texelFetch(encoded, ivec3(0, 0, 1), 1), o[513] = texelFetch(plain, ivec2(0), 1);
}
""")
        image = '[[image]]\nbinding = %d\nfile = %s\nformat = "%s"\nmipmaps = %s\n'
        text = '[compute]\nshader = "copy.comp"\n[launch]\ngroups = 1\n[[buffer]]\nbinding = 2\ntype = "f32"\ncount = 2056\nsave = "out.csv"\n'
        files = '["grey.png", "grey.png"]'
        for mipmaps in ("true", "false"):
            self.run_text(0, [], text + image % (0, files, "rgba8_srgb", mipmaps) + image % (1, '"grey.png"', "rgba8_unorm", mipmaps))
            saved = self.saved_numbers()
            for i, value in enumerate(grey):
                for c, byte in enumerate((value, value // 2, 255 - value)):
                    share = byte / 255
                    linear = share / 12.92 if share <= 0.04045 else ((share + 0.055) / 1.055) ** 2.4
                    self.assertAlmostEqual(saved[8 * i + c], linear, places=6)
                    self.assertAlmostEqual(saved[8 * i + 4 + c], share, places=6)
                self.assertEqual((saved[8 * i + 3], saved[8 * i + 7]), (1, 1))
            if mipmaps == "true":  # The means of two black and two white texels are one half; 188 of 255 is its code.
                self.assertAlmostEqual(saved[4 * 512], ((188 / 255 + 0.055) / 1.055) ** 2.4, places=5)
                self.assertAlmostEqual(saved[4 * 513], 128 / 255, places=5)
        self.expect(2, ["p.toml:10:", "image 'image_0_0' names 2 files and has 3 layers of 1 samples; each sample of a layer takes a file"],
                    "run", self.write("p.toml", text + (image % (0, files, "rgba8_srgb", "false")).replace("[[image]]", "[[image]]\nlayers = 3") + image % (1, '"grey.png"', "rgba8_unorm", "false")), "--out", "out")

    def test_integers_are_the_bytes_of_a_png_when_read_and_when_saved(self):
        self.write("count.comp", """#version 460
layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0, rgba8ui) uniform writeonly uimage2D made;
layout(set = 0, binding = 1, r32i) uniform writeonly iimage2D wide;
void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  imageStore(made, at, uvec4(at.x + 16 * at.y, 255 - at.x, at.y, 255));
  imageStore(wide, at, ivec4(100 * at.x - 300));
}
""")
        image = '[[image]]\nbinding = {}\nsize = [16, 16]\nformat = "{}"\nsave = "{}"\n'
        made, wide = image.format(0, "rgba8_uint", "made.png"), image.format(1, "r32_sint", "wide.png")
        self.run_text(0, [], f'[compute]\nshader = "count.comp"\n[launch]\ngroups = 1\n{made}{wide}')
        width, height, data = glint_case.read_png(self.folder / "out/made.png")
        expected = bytes(v for y in range(16) for x in range(16) for v in (x + 16 * y, 255 - x, y))
        self.assertEqual((width, height, bytes(data)), (16, 16, expected))
        _, _, data = glint_case.read_png(self.folder / "out/wide.png")
        self.assertEqual(list(data[:30:3]), [0, 0, 0, 0, 100, 200, 255, 255, 255, 255])
        self.write("copy.comp", """#version 460
layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0, rgba8ui) uniform uimage2D read;
void main() { imageStore(read, ivec2(gl_GlobalInvocationID.xy), imageLoad(read, ivec2(gl_GlobalInvocationID.xy))); }
""")
        shutil.copy(self.folder / "out/made.png", self.folder / "made.png")
        self.run_text(0, [], '[compute]\nshader = "copy.comp"\n[launch]\ngroups = 1\n[[image]]\nbinding = 0\nfile = "made.png"\nformat = "rgba8_uint"\nsave = "again.png"\n')
        self.assertEqual(bytes(glint_case.read_png(self.folder / "out/again.png")[2]), expected)

    def test_files_that_the_run_writes_itself_or_that_are_saved_twice_are_refused(self):
        self.refused('"out.csv"', '"stats.csv"', "p.toml:", "the run itself writes 'stats.csv'")
        self.refused('"out.csv"', '["a.csv", "a.csv"]', "p.toml:", "'a.csv' is saved twice")

    def test_texels_that_do_not_fill_their_image_are_refused_with_both_numbers(self):
        self.refused("[1, 2, 3, 4.5]", "[1, 2, 3]", "image 'image_3_202' has 3 numbers", "want 4")

    def test_an_image_of_a_file_and_of_data_is_refused(self):
        self.refused("data = [8, 0, 0, 1]", "data = [8, 0, 0, 1]\nfile = 'a.png'", "both a file and data")

    def test_a_binding_beyond_the_last_is_refused_at_its_line(self):
        self.refused("binding = 1023", "binding = 1024", "p.toml:", "1024")

    def test_an_image_that_no_binding_of_the_file_gives_is_named_by_the_shaders_line(self):
        self.refused("binding = 201", "binding = 300", "look.comp:4", "cube")


if __name__ == "__main__":
    glint_case.main()

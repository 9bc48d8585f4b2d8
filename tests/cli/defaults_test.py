# Tests `glint run SHADER` and `glint init`: a shader alone runs, and a new file runs as it is.
# SPDX-License-Identifier: Apache-2.0
"""usage: defaults_test.py GLINT SOURCE_DIR"""
import glint_case
from glint_case import ROOT, read_png
from pipeline_case import ADD, PICTURES, PipelineTest

LISTS = ["denoise", "temporal"]  # examples with several launches, whose file `glint init` does not write


def shaders_of(example):
    """Returns the shaders of an example. Files that shaders include have no stage in their names."""
    return [p for p in sorted((ROOT / "examples" / example).iterdir()) if p.suffix not in (".toml", ".obj", ".glsl")]


class Defaults(PipelineTest):
    def test_a_shader_alone_runs_with_defaults(self):
        self.write("add.comp", ADD)
        self.run_file("add.comp")
        self.run_file(ROOT / "examples/reduction/reduction.comp")
        self.run_file(ROOT / "examples/hello_triangle/hello.rgen")
        width, height, pixels = glint_case.read_png(self.folder / "out/picture.png")
        self.assertEqual((width, height), (256, 256))
        self.assertGreater(len(set(pixels)), 50)  # the pyramid's faces mix colours

    def test_an_image_without_a_format_has_the_one_that_the_shader_declares(self):
        self.write("count.comp", """#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, r32ui) uniform uimage2D counts;
layout(set = 0, binding = 1) buffer Words { uint words[]; };
void main() { words[gl_LocalInvocationIndex % 2u] = imageAtomicAdd(counts, ivec2(1, 5), 1u) * 0u + 9u; }
""")
        self.assertRegex(self.run_file("count.comp").stdout, r"(?i)words.* 9 9 0")

    def test_init_writes_a_file_that_runs_as_it_is(self):
        for name in {*PICTURES, "reduction"} - {*LISTS}:
            with self.subTest(example=name):
                shaders = shaders_of(name)
                done = self.glint("init", f"{name}.toml", *shaders)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.run_file(f"{name}.toml")

    def test_the_picture_of_a_new_file_shows_something(self):
        self.write("cam.rgen", """#version 460
#extension GL_EXT_ray_tracing : require
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(set = 0, binding = 1, rgba8) uniform writeonly image2D picture;
layout(set = 0, binding = 2) uniform Camera { mat4 viewInverse; mat4 projInverse; vec3 lightDirection; float intensity; } cam;
layout(location = 0) rayPayloadEXT vec3 color;
void main() {
  const vec2 at = (vec2(gl_LaunchIDEXT.xy) + 0.5) / vec2(gl_LaunchSizeEXT.xy) * 2.0 - 1.0;
  const vec3 along = mat3(cam.viewInverse) * normalize((cam.projInverse * vec4(at, 1.0, 1.0)).xyz);
  traceRayEXT(scene, gl_RayFlagsOpaqueEXT, 0xff, 0, 0, 0, (cam.viewInverse * vec4(0, 0, 0, 1)).xyz, 0.001, along, 100.0, 0);
  imageStore(picture, ivec2(gl_LaunchIDEXT.xy), vec4(color * cam.intensity * max(0.0, dot(cam.lightDirection, vec3(0, 1, 0))), 1.0));
}
""")
        head = "#version 460\n#extension GL_EXT_ray_tracing : require\nlayout(location = 0) rayPayloadInEXT vec3 color;\n"
        self.write("cam.rmiss", head + "void main() { color = vec3(0.0); }\n")
        self.write("cam.rchit", head + "void main() { color = vec3(gl_PrimitiveID < 2 ? 0.3 : 1.0); }\n")  # the floor, the pyramid
        projects = {name: shaders_of(name) for name in PICTURES if name not in LISTS}
        for name, shaders in {**projects, "cam": [f"cam.{stage}" for stage in ("rgen", "rmiss", "rchit")]}.items():
            with self.subTest(project=name):
                self.assertEqual(self.glint("init", f"{name}.toml", *shaders).returncode, 0)
                done = self.glint("run", f"{name}.toml", "--mode", "functional", "--out", name)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertNotIn("not finite", done.stderr)
                width, height, data = read_png(self.folder / name / "picture.png")
                lit = sum(any(data[i:i + 3]) for i in range(0, len(data), 3))
                self.assertGreater(lit, width * height / 10)
                self.assertGreater(len({data[i:i + 3] for i in range(0, len(data), 3)}), 2)
        # The camera sees the pyramid before the floor, the right way up: the floor is in the lower half, the top row is empty.
        self.assertFalse(any(data[:3 * width]))
        self.assertGreater(data[3 * (width * height // 2 + width // 2)], 190)
        self.assertGreater(sum(any(data[i:i + 3]) for i in range(len(data) // 2, len(data), 3)), lit / 2)

    def test_init_keeps_include_folders_and_macros_of_the_command_line(self):
        (self.folder / "parts").mkdir()
        self.write("parts/scale.glsl", "const uint kScale = SCALE;\n")
        self.write("scaled.comp", """#version 460
#extension GL_GOOGLE_include_directive : require
#include "scale.glsl"
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) buffer Words { uint words[]; };
void main() { words[0] = kScale; }
""")
        done = self.glint("init", "scaled.toml", "scaled.comp", "-I", "parts", "-D", "SCALE=7u")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(self.run_file("scaled.toml").stdout, r"Words +7 0 0")

    def test_addresses_of_a_new_file_lead_to_buffers(self):
        self.write("walk.comp", """#version 460
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
layout(local_size_x = 4) in;
layout(buffer_reference, scalar) buffer Numbers { float v[]; };
layout(buffer_reference) buffer Node;
layout(buffer_reference, scalar) buffer Node { uint step; Node next; };
struct Mesh { Numbers corners; uint count; };
layout(set = 0, binding = 0, scalar) buffer Meshes { Mesh meshes[]; };
layout(set = 0, binding = 1) buffer Out { uint o[]; };
layout(push_constant, scalar) uniform Push { Node head; Numbers o; } push;
void main() {
  const uint lane = gl_GlobalInvocationID.x;
  push.o.v[lane] = lane;
  Node behind = push.head + 1000;  // the sum of an address and a number of structures
  o[lane] = uint(push.o.v[lane] + meshes[0].corners.v[9]) + behind.step + uint(uint64_t(push.head.next)) + uint(uint64_t(meshes[1].corners));
}
""")
        done = self.glint("init", "walk.toml", "walk.comp")
        self.assertEqual(done.returncode, 0, done.stderr)
        text = (self.folder / "walk.toml").read_text()
        for line in ('head = "head"', 'o = "o"', 'data = { meshes = [{ corners = "corners", count = 4 }] }', 'name = "corners"'):
            self.assertIn(line + "\n", text)
        self.assertRegex(self.run_file("walk.toml").stdout, r"Out +0 1 2 3 4 5")
        self.assertRegex(self.run_file("walk.comp").stdout, r"Out +0 1 2 3 4 5")

    def test_numbers_whose_names_say_that_they_are_addresses_lead_to_buffers(self):
        self.write("objects.comp", """#version 460
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
layout(local_size_x = 4) in;
struct Object { int first; uint64_t vertexAddress, indexAddress, hash; };
layout(buffer_reference, scalar) buffer Vertices { vec3 v[]; };
layout(buffer_reference, scalar) buffer Indices { ivec3 i[]; };
layout(set = 0, binding = 0, scalar) buffer Objects { Object objects[]; };
layout(set = 0, binding = 1) buffer Out { uint o[]; };
void main() {
  const Object object = objects[0];
  const uint lane = gl_GlobalInvocationID.x;
  o[lane] = 5 + uint(Vertices(object.vertexAddress).v[lane % 100].y) + Indices(object.indexAddress).i[lane % 100].z + uint(object.hash);
}
""")
        done = self.glint("init", "objects.toml", "objects.comp")
        self.assertEqual(done.returncode, 0, done.stderr)
        line = 'data = { objects = [{ first = 0, vertexAddress = "vertexAddress", indexAddress = "indexAddress", hash = 0 }] }\n'
        text = (self.folder / "objects.toml").read_text()
        self.assertIn(line, text)
        self.assertIn('name = "indexAddress"\n# values[]: u32 x 1 at 0\n', text)
        self.assertRegex(self.run_file("objects.toml").stdout, r"Out +5 5 5 5")

    def test_init_does_not_write_over_a_file(self):
        self.write("there.toml", "x")
        self.expect(2, ["exists already", "--force"], "init", "there.toml", ROOT / "examples/reduction/reduction.comp")

    def test_init_wants_one_shader_to_start_with(self):
        self.expect(2, ["0 ray generation or compute shaders"], "init", "x.toml", ROOT / "examples/hello_triangle/hello.rmiss")


if __name__ == "__main__":
    glint_case.main()

# Tests shaders through the command: what they print, the cache, contraction, and the forms that `compile` emits.
# SPDX-License-Identifier: Apache-2.0
"""usage: shader_test.py GLINT SOURCE_DIR [SUITE...]"""
import json
import time

import glint_case
from glint_case import GlintTest

RAYGEN = """#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_debug_printf : require
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(set = 0, binding = 1, rgba32f) uniform image2D picture;
layout(location = 0) rayPayloadEXT vec3 colour;
void main() {
  vec2 at = (vec2(gl_LaunchIDEXT.xy) + 0.5) / vec2(gl_LaunchSizeEXT.xy) * 2.0 - 1.0;
  traceRayEXT(scene, 0, 0xff, 0, 0, 0, vec3(0, 1, 4), 0.0, normalize(vec3(at, -2)), 100.0, 0);
  if (gl_LaunchIDEXT.x == 7 && gl_LaunchIDEXT.y % 100 == 3) debugPrintfEXT("raygen %v2u", gl_LaunchIDEXT.xy);
  imageStore(picture, ivec2(gl_LaunchIDEXT.xy), vec4(colour, 1));
}
"""
MISS = """#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_debug_printf : require
layout(location = 0) rayPayloadInEXT vec3 colour;
void main() {
  if (gl_LaunchIDEXT.x == 7 && gl_LaunchIDEXT.y % 100 == 3) debugPrintfEXT("miss %u", gl_LaunchIDEXT.y);
  colour = vec3(0);
}
"""
HIT = """#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_debug_printf : require
layout(location = 0) rayPayloadInEXT vec3 colour;
hitAttributeEXT vec2 weights;
void main() {
  if (gl_LaunchIDEXT.x == 7 && gl_LaunchIDEXT.y % 100 == 3) debugPrintfEXT("hit %u at %.1f", gl_LaunchIDEXT.y, gl_HitTEXT);
  colour = vec3(weights, 1);
}
"""
COMPUTE = """#version 460
#extension GL_EXT_debug_printf : require
#include "part.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer W { float w[]; };
void main() {
  uint id = gl_GlobalInvocationID.x;
  float x = float(id) * 0.1;
  w[id] = x * x + part() * SCALE;
  if (id < LINES) debugPrintfEXT("line %u", id);
}
"""


class ShaderTest(GlintTest):
    def setUp(self):
        super().setUp()
        self.write("include/part.glsl", "float part() { return 3.0; }\n")
        self.write("a.comp", COMPUTE)

    def glint(self, *arguments, code=0):
        done = super().glint(*arguments, text=False, GLINT_CACHE=str(self.folder / "cache"))
        self.assertEqual(done.returncode, code, done.stdout.decode(errors="replace") + done.stderr.decode(errors="replace"))
        return done

    def compute(self, *arguments, **keys):
        return self.glint("run", "a.comp", "-I", "include", "-DSCALE=2.0", *arguments, **keys)

    def cached(self):
        return sorted((self.folder / "cache/shaders").glob("*")) if (self.folder / "cache/shaders").exists() else []


class Printing(ShaderTest):
    def test_every_stage_prints_in_order_of_launch_on_both_machines(self):
        for name, text in (("scene.rgen", RAYGEN), ("scene.rmiss", MISS), ("scene.rchit", HIT)):
            self.write(name, text)
        printed = []
        for mode in ("functional", "timing"):
            done = self.glint("run", "scene.rgen", "--mode", mode, "--out", "out")
            text = (self.folder / "out/printf.txt").read_text()
            self.assertIn(text, done.stderr.decode())
            printed.append(text)
        self.assertEqual(printed[0], printed[1])
        lines = printed[0].splitlines()
        self.assertEqual([line for line in lines if line.startswith("raygen")], ["raygen 7, 3", "raygen 7, 103", "raygen 7, 203"])
        self.assertEqual(len(lines), 6)
        for launch in range(3):  # a shader that the ray calls prints before the ray generation shader goes on
            self.assertRegex(lines[2 * launch], r"^(miss \d+|hit \d+ at \d+\.\d)$")

    def test_the_limit_bounds_the_lines_and_says_how_many_are_left_out(self):
        done = self.compute("-DLINES=100", "--printf-limit", 5, "--mode", "functional", "--out", "out")
        wanted = "".join(f"line {i}\n" for i in range(5)) + "(95 more messages not shown; the limit is 5)\n"
        self.assertEqual((self.folder / "out/printf.txt").read_text(), wanted)
        self.assertIn(wanted, done.stderr.decode())

    def test_a_shader_that_prints_nothing_leaves_no_file(self):
        self.compute("-DLINES=0", "--mode", "functional", "--out", "out")
        self.assertFalse((self.folder / "out/printf.txt").exists())

    def test_lines_before_a_fault_are_shown(self):
        self.write("fault.comp", COMPUTE.replace("w[id] =", 'if (id == 3) debugPrintfEXT("before"); w[id + 0x3fffff0] ='))
        done = self.glint("run", "fault.comp", "-Iinclude", "-DSCALE=1", "-DLINES=0", "--mode", "functional", "--out", "out", code=4)
        self.assertIn("before\n", done.stderr.decode())
        self.assertEqual((self.folder / "out/printf.txt").read_text(), "before\n")

    def test_scripts_print_launch_by_launch(self):
        self.write("two.amber", """#!amber
SHADER compute printer GLSL
#version 460
#extension GL_EXT_debug_printf : require
layout(local_size_x = 2) in;
layout(set = 0, binding = 0) buffer W { uint w[]; };
void main() { w[gl_GlobalInvocationID.x] += 1; debugPrintfEXT("thread %u has %u", gl_GlobalInvocationID.x, w[gl_GlobalInvocationID.x]); }
END
BUFFER words DATA_TYPE uint32 SIZE 2 FILL 0
PIPELINE compute p
  ATTACH printer
  BIND BUFFER words AS storage DESCRIPTOR_SET 0 BINDING 0
END
RUN p 1 1 1
RUN p 1 1 1
EXPECT words IDX 0 EQ 2 2
""")
        done = self.glint("run", "two.amber")
        self.assertEqual(done.stderr.decode(), "thread 0 has 1\nthread 1 has 1\nthread 0 has 2\nthread 1 has 2\n")

    def test_a_wrong_format_is_an_error_with_its_line(self):
        self.write("bad.comp", COMPUTE.replace('"line %u"', '"line %q"'))
        done = self.glint("run", "bad.comp", "-Iinclude", "-DSCALE=1", "-DLINES=0", code=2)
        self.assertIn("bad.comp:10: error: debugPrintfEXT(\"line %q\"): '%q' is not a conversion", done.stderr.decode())


class Cache(ShaderTest):
    def run_twice(self, *change):
        return [self.compute("-DLINES=0", "--mode", "functional", "--json", *change).stdout for _ in range(2)]

    def test_the_second_run_finds_what_the_first_has_compiled_and_gives_the_same(self):
        cold, warm = self.run_twice()
        self.assertEqual(cold, warm)
        files = self.cached()
        self.assertGreaterEqual(len(files), 2)
        self.run_twice()
        self.assertEqual(self.cached(), files)

    def test_damaged_files_are_written_again(self):
        cold, _ = self.run_twice()
        for path in self.cached():
            path.write_bytes(path.read_bytes()[:-7] + b"garbage")
        before = [path.read_bytes() for path in self.cached()]
        again, _ = self.run_twice()
        self.assertEqual(cold, again)
        self.assertNotEqual([path.read_bytes() for path in self.cached()], before)

    def test_no_cache_leaves_no_files(self):
        self.run_twice("--no-cache")
        self.assertEqual(self.cached(), [])

    def test_an_include_that_changes_is_compiled_again(self):
        first = self.glint("compile", "a.comp", "-Iinclude", "-DSCALE=1", "-DLINES=0").stdout
        self.write("include/part.glsl", "float part() { return 4.0; }\n")
        self.assertNotEqual(self.glint("compile", "a.comp", "-Iinclude", "-DSCALE=1", "-DLINES=0").stdout, first)


class Contraction(ShaderTest):
    def test_the_switch_fuses_and_is_recorded(self):
        plain = self.glint("compile", "a.comp", "-Iinclude", "-DSCALE=1", "-DLINES=0").stdout
        fused = self.glint("compile", "a.comp", "-Iinclude", "-DSCALE=1", "-DLINES=0", "--contract").stdout
        self.assertNotIn(b"fma.rn.f32", plain)
        self.assertIn(b"fma.rn.f32", fused)
        hashes = []
        for arguments in ([], ["--contract"]):
            self.compute("-DLINES=0", "--mode", "functional", "--out", "out", *arguments)
            run = json.loads((self.folder / "out/run.json").read_text())
            hashes.append(run["config"]["hash"])
            self.assertEqual("--contract" in run["command"], bool(arguments))
            self.assertRegex((self.folder / "out/config.toml").read_text(), "contract *= *" + ("true" if arguments else "false"))
        self.assertNotEqual(*hashes)

    def test_precise_stays_apart(self):
        self.write("a.comp", COMPUTE.replace("w[id] = x * x", "precise float y = x * x + 1.0; w[id] = y; y = 0.0 * x").replace("+ part() * SCALE", ""))
        self.assertNotIn(b"fma.rn.f32", self.glint("compile", "a.comp", "-Iinclude", "-DSCALE=1", "-DLINES=0", "--contract").stdout)


class Emission(ShaderTest):
    ARGUMENTS = ["-Iinclude", "-D", "SCALE=1", "-DLINES=0"]

    def test_times_have_a_row_for_every_stage_and_pass_in_their_order(self):
        text = self.glint("compile", "a.comp", *self.ARGUMENTS, "--time").stdout.decode()
        lines = text.splitlines()
        self.assertEqual((lines[0], lines[1].split()), ("a.comp", ["stage", "pass", "seconds"]))
        rows = [line.split() for line in lines[2:]]
        for row in rows:
            self.assertRegex(row[-1], r"^\d+\.\d{3}$")
        stages = [row[0] for row in rows]
        # What glslang makes is validated in its stage, and what the optimiser makes has a row of its own.
        self.assertEqual(list(dict.fromkeys(stages)), ["glslang", "optimiser", "validation", "lowering", "backend"])
        self.assertEqual([row[1] for row in rows if row[0] == "validation"], ["after"])
        self.assertEqual(self.glint("compile", "a.comp", *self.ARGUMENTS, "--emit", "spv", "-o", "a.spv").returncode, 0)
        rows = [line.split() for line in self.glint("compile", "a.spv", "--time").stdout.decode().splitlines()[2:]]
        self.assertEqual(rows[0][0], "reading")
        self.assertEqual([row[1] for row in rows if row[0] == "backend"],
                         ["simplify-code", "convert-selections", "keep-predicates", "schedule", "allocate", "expand-calls", "emit"])
        passes = [row[1] for row in rows if row[0] == "optimiser" and len(row) == 3]
        self.assertLess(passes.index("inline-entry-points-exhaustive"), passes.index("merge-blocks"))

    def test_every_form_of_a_shader_compiles_to_the_same_program(self):
        self.glint("compile", "a.comp", *self.ARGUMENTS, "--emit", "spv", "-o", "a.spv")
        text = self.glint("compile", "a.comp", *self.ARGUMENTS, "--emit", "spvasm").stdout
        self.assertEqual(self.glint("compile", "a.spv", "--emit", "spirv").stdout, text)
        self.write("a.spvasm", text.decode())
        code = lambda text: [line for line in text.splitlines() if not line.startswith(b";")]  # without the generator's name
        self.assertEqual(code(self.glint("compile", "a.spvasm", "--emit", "spirv").stdout), code(text))
        self.glint("compile", "a.spvasm", "--emit", "spv", "-o", "b.spv")
        programs = [self.glint("compile", name, *more).stdout.decode().split("\n", 1)
                    for name, more in (("a.comp", self.ARGUMENTS), ("a.spv", []), ("a.spvasm", []), ("b.spv", []))]
        for name, program in zip(("a.comp", "a.spv", "a.spvasm", "b.spv"), programs):
            self.assertEqual(program[0], f'.program "{name}"')
            self.assertEqual(program[1], programs[0][1])

    def test_the_simplified_module_has_no_calls_and_keeps_its_prints(self):
        text = self.glint("compile", "a.comp", *self.ARGUMENTS, "--emit", "simplified").stdout.decode()
        self.assertNotIn("OpFunctionCall", text)
        text = self.glint("compile", "a.comp", "-Iinclude", "-DSCALE=1", "-DLINES=1", "--emit", "simplified").stdout.decode()
        self.assertIn("NonSemantic.DebugPrintf", text)

    def test_a_missing_include_or_macro_is_an_error_with_file_and_line(self):
        done = self.glint("compile", "a.comp", "-DSCALE=1", "-DLINES=0", code=2)
        self.assertIn("a.comp:3: error:", done.stderr.decode())
        done = self.glint("compile", "a.comp", "-Iinclude", "-DLINES=0", code=2)
        self.assertIn("a.comp:9: error:", done.stderr.decode())

    def test_an_include_that_is_not_found_names_the_folders_searched(self):
        done = self.glint("compile", "a.comp", "-Iother", "-Ithird", "-DSCALE=1", "-DLINES=0", code=2)
        self.assertEqual(done.stderr.decode(), "a.comp:3: error: '#include' : cannot find part.glsl; searched in ., other, third\n")

    def test_a_shader_that_includes_itself_is_refused_within_two_seconds(self):
        self.write("again.comp", "#version 460\n" + "// a line\n" * 5000 + '#include "again.comp"\n' * 3 + "void main() {}\n")
        begin = time.monotonic()
        done = self.glint("compile", "again.comp", code=2)
        self.assertLess(time.monotonic() - begin, 2)
        self.assertIn("again.comp:5002: error:", done.stderr.decode())
        self.assertIn("more than 100 deep: again.comp includes again.comp", done.stderr.decode())

    def test_folders_are_searched_in_order_and_the_includer_s_first(self):
        self.write("other/part.glsl", "float part() { return other; }\n")
        self.glint("compile", "a.comp", *self.ARGUMENTS, "-Iother")
        self.glint("compile", "a.comp", "-Iother", *self.ARGUMENTS, code=2)
        self.write("part.glsl", "float part() { return 1.0; }\n")
        self.glint("compile", "a.comp", "-Iother", *self.ARGUMENTS)

    def test_several_modules_in_one_file_are_refused(self):
        self.glint("compile", "a.comp", "a.comp", *self.ARGUMENTS, "--emit", "spv", code=2)


if __name__ == "__main__":
    glint_case.main()

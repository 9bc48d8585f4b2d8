# Tests what the command says about command lines and shaders that it cannot take.
# SPDX-License-Identifier: Apache-2.0
"""usage: messages_test.py GLINT SOURCE_DIR [SUITE...]"""
from glint_case import GlintTest, main

COMPUTE = "layout(local_size_x = 1) in;\nvoid main() {}\n"


class CommandLines(GlintTest):
    def test_each_mistake_is_named_in_one_sentence(self):
        for arguments, *parts in [
                ("frobnicate", "there is no command 'frobnicate'"),
                ("rnu WKND", "there is no command 'rnu'", "did you mean 'run'?"),
                ("run WKND --spp -1", "--spp: '-1' is not a whole number from 1 to 65536"),
                ("run WKND --spp 99999999999999999999", "--spp: '99999999999999999999' is not a whole number"),
                ("run WKND --seed -5", "--seed: '-5' is not a whole number from 0 on"),
                ("report a --timeline-sm x", "--timeline-sm: 'x' is not a whole number from 0 on"),
                ("run empty.spv", "empty.spv: error: this is not a SPIR-V module: it has 0 bytes, and a module has at least 20"),
                ("run WKND --sample 0", "--sample: '0' is not a number above 0"),
                ("run WKND --max-instructions inf", "--max-instructions: 'inf' is not a whole number from 1 to 1000000000000000000"),
                ("run WKND --printf-limit 99999999999999999999", "--printf-limit: '99999999999999999999' is not a whole number"),
                ("run WKND --set core.warps=99999999999999999999", "'99999999999999999999' is not representable in 64 bits"),
                ("run a.xyz", "a.xyz: error: Glint does not run files that end in .xyz", ".amber"),
                ("run a.vkscript", "end in .vkscript"),
                ("run b/a.shader_test", "end in .shader_test"),
                ("run b/nothing", "this file has no ending that says what it is"),
                ("run ..", "this is a folder"),
                ("run nosuch.toml", "nosuch.toml: error: cannot read the file", "name a TOML file that exists and that you may read"),
                ("run WKNDD", "unknown scene 'WKNDD'", "did you mean 'WKND'?"),
                ("compile -D =3 a.comp", "--define has no macro's name in ''"),
                ("compile -D 1x a.comp", "--define has no macro's name in '1x'")]:
            with self.subTest(arguments):
                self.write("empty.spv", "")
                self.expect(2, parts, *arguments.split())

    def test_an_empty_value_is_refused_wherever_a_text_is_expected(self):
        for arguments in (["run", ""], ["run", "WKND", "--out", ""], ["run", "WKND", "--config", ""], ["compile", "-D", "", "a.comp"]):
            with self.subTest(arguments):
                self.expect(2, ["its value is empty"], *arguments)

    def test_help_and_version_are_understood_as_words(self):
        for word, option in ((["help"], ["--help"]), (["help", "run"], ["run", "--help"]), (["version"], ["--version"])):
            with self.subTest(word):
                said, expected = self.glint(*word), self.glint(*option)
                self.assertEqual((said.returncode, said.stdout), (0, expected.stdout))
                self.assertTrue(said.stdout)


class Shaders(GlintTest):
    def test_what_glslang_cannot_read_has_its_file_and_line(self):
        for code, text, *parts in [
                (3, "#version 460\n#extension GL_FOO_bar : require\n", "a.comp:2: error:", "not supported: GL_FOO_bar"),
                (2, "// nothing\n#version 999\n", "a.comp:2: error: this GLSL version is not supported"),
                (2, "\n\n#version 300 es\n", "a.comp:3: error: compute shaders require"),
                (2, "  # version 110\n", "a.comp:1: error: GLSL version 110 is too old")]:
            with self.subTest(text):
                self.write("a.comp", text + COMPUTE)
                said = self.expect(code, parts, "compile", "a.comp")
                self.assertEqual(said.stdout, "")
                self.assertNotIn("extra tokens", said.stderr)
                self.assertNotIn("built-ins", said.stderr)

    def test_a_name_that_the_assembler_does_not_know_may_be_too_young_for_it(self):
        self.write("a.spvasm", "OpCapability Shader\nOpCapability FromTheFuture\n")
        self.expect(2, ["a.spvasm:2:14: error: Invalid capability 'FromTheFuture'", "misspelled, or younger than they are"], "compile", "a.spvasm")

    def test_an_unknown_extension_that_is_only_enabled_is_no_error(self):
        self.write("a.comp", "#version 460\n#extension GL_FOO_bar : enable\n" + COMPUTE)
        self.assertEqual(self.glint("compile", "a.comp").returncode, 0)
        self.write("a.comp", "#version 460\n#extension GL_FOO_bar : enable\nlayout(local_size_x = 1) in;\nvoid main() { x = 1; }\n")
        self.expect(2, ["a.comp:4: error: 'x' : undeclared identifier"], "compile", "a.comp")

    def test_the_stage_may_stand_before_the_ending_glsl(self):
        self.write("main.comp.glsl", "#version 460\n" + COMPUTE)
        said = self.glint("compile", "main.comp.glsl")
        self.assertIn(".stage compute", said.stdout)
        self.expect(2, ["unknown shader stage"], "compile", self.write("main.glsl", COMPUTE))

    def test_ptx_is_run_and_not_compiled(self):
        self.expect(2, ["k.ptx: error: unknown shader stage", "`glint init FILE.toml KERNEL.ptx`"], "compile", self.write("k.ptx", ".version 8.0\n"))

    def test_companions_of_a_ray_generation_shader_have_the_same_ending(self):
        head = "#version 460\n#extension GL_EXT_ray_tracing : require\n"
        self.write("a.rgen.glsl", head + "layout(set = 0, binding = 0) uniform accelerationStructureEXT top;\n"
                   "layout(set = 0, binding = 1, rgba32f) uniform image2D picture;\nlayout(location = 0) rayPayloadEXT vec4 colour;\n"
                   "void main() {\n  traceRayEXT(top, 0, 0xff, 0, 0, 0, vec3(0, 0, 3), 0, vec3(0, 0, 1), 100, 0);\n"
                   "  imageStore(picture, ivec2(gl_LaunchIDEXT.xy), colour);\n}\n")
        self.write("a.rmiss.glsl", head + "layout(location = 0) rayPayloadInEXT vec4 colour;\nvoid main() { colour = vec4(1, 0, 0, 1); }\n")
        alone = self.glint("run", "a.rgen.glsl", "--mode", "functional", "--out", "out")
        self.assertEqual(alone.returncode, 0, alone.stderr)
        self.assertIn("a.rmiss.glsl", (self.folder / "out/run.json").read_text())

    def test_a_capability_that_the_installed_tools_do_not_know_is_named(self):
        words = [0x07230203, 0x00010600, 0, 8, 0, 2 << 16 | 17, 1, 2 << 16 | 17, 5437]
        (self.folder / "a.spv").write_bytes(b"".join(word.to_bytes(4, "little") for word in words))
        self.expect(3, ["a.spv: capability RayTracingClusterAccelerationStructureNV"], "compile", "a.spv")


if __name__ == "__main__":
    main()

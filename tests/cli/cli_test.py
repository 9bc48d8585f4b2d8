# Tests what `glint` answers to good and bad input with the real binary: exit codes, messages, files.
# SPDX-License-Identifier: Apache-2.0
"""usage: cli_test.py GLINT SOURCE_DIR [SUITE...]"""
import json
import os
import re
import shutil
import subprocess
import sys

import glint_case
from glint_case import GLINT, ROOT, GlintTest

SMALL = ["--size", "16x16", "--spp", "1"]


class ShadersTest(GlintTest):
    def shaders_with(self, name, text):
        """Makes a copy of the path tracer in which one file is replaced. The copied includes lie beside it."""
        shutil.copytree(ROOT / "shaders", self.folder / "shaders", dirs_exist_ok=True)
        folder = self.folder / "shaders/path_tracing"
        (folder / name).write_text(text)
        return folder


class Usage(GlintTest):
    def test_an_unknown_subcommand_is_refused_with_the_nearest(self):
        self.expect(2, ["did you mean 'compile'?"], "compil")

    def test_an_unknown_option_is_refused_with_the_nearest(self):
        self.expect(2, ["did you mean '--shader'?"], "run", "WKND", "--shadre", "pt")

    def test_no_subcommand_is_refused(self):
        self.expect(2, ["error:"])

    def test_help_names_every_subcommand(self):
        done = self.glint("--help")
        self.assertEqual(done.returncode, 0)
        for word in ("run", "compile", "asm", "isa", "list", "describe"):
            self.assertIn(word, done.stdout)

    def test_an_unknown_scene_is_refused_with_the_nearest(self):
        self.expect(2, ["did you mean", "WKND"], "run", "WKNDD")

    def test_an_unknown_shader_set_is_refused(self):
        self.expect(2, ["pt, sh or ao"], "run", "WKND", "--shader", "ptx")

    def test_sizes_that_are_none_are_refused(self):
        for size in ("0x16", "16", "16x", "x16", "16x16x16", "-1x4", "99999x1", "axb"):
            with self.subTest(size=size):
                self.expect(2, ["--size"], "run", "WKND", "--size=" + size)

    def test_every_list_prints_something(self):
        for what in ("scenes", "shaders", "configs", "policies", "ops", "stats"):
            with self.subTest(what=what):
                done = self.glint("list", what)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertGreaterEqual(len(done.stdout.splitlines()), 2)

    def test_list_ops_names_the_test_of_each_op(self):
        ops = [line.split()[0] for line in self.glint("list", "ops").stdout.splitlines()]
        tests = {line.split()[0]: line.split()[1:] for line in self.glint("list", "ops", "--tests").stdout.splitlines()}
        self.assertTrue(list(tests) == ops)
        self.assertEqual(tests["st.shared.v2.b64"], ["tests/ops/access.cpp"])
        self.assertEqual(tests["add.s32"], ["tests/isa/rows_test.cpp", "3", "examples"])
        self.expect(2, ["--tests goes with ops", "scenes"], "list", "scenes", "--tests")

    def test_isa_explains_an_op_and_refuses_an_unknown_one(self):
        done = self.glint("isa", "fma.rn.f32")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("fma.rn.f32", done.stdout)
        self.expect(2, ["did you mean", "fma.rn.f32"], "isa", "fma.rn.f31")


class Compile(GlintTest):
    SHADER = "#version 460\nlayout(local_size_x = 32) in;\nlayout(set = 0, binding = 0) buffer Out { uint x[]; } o;\n%s\n"

    def test_a_syntax_error_is_reported_with_file_and_line(self):
        name = self.write("bad.comp", self.SHADER % "void main() {\n  o.x[0] = ;\n}")
        self.expect(2, ["bad.comp:5"], "compile", name)

    def test_a_missing_file_is_refused(self):
        self.expect(2, ["nothing.comp"], "compile", "nothing.comp")

    def test_a_file_without_a_stage_is_refused(self):
        self.expect(2, ["bad.txt"], "compile", self.write("bad.txt", "void main() {}"))

    def test_an_unsupported_feature_exits_with_3_and_names_the_line(self):
        body = ("layout(set = 0, binding = 1) uniform sampler2D image;\nvoid main() {\n  vec4 texel;\n"
                "  o.x[0] = sparseTextureLodARB(image, vec2(0.5), 0.0, texel);\n}")
        sparse = (self.SHADER % body).replace("460\n", "460\n#extension GL_ARB_sparse_texture2 : require\n")
        self.expect(3, ["sparse.comp:8"], "compile", self.write("sparse.comp", sparse))

    def test_a_good_shader_compiles_to_text_that_asm_reads_and_prints_again_unchanged(self):
        name = self.write("good.comp", self.SHADER % "void main() { o.x[gl_GlobalInvocationID.x] = 7u * gl_GlobalInvocationID.x; }")
        text = self.glint("compile", name)
        self.assertEqual(text.returncode, 0, text.stderr)
        again = self.glint("asm", self.write("good.isa", text.stdout))
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(again.stdout, text.stdout)

    def test_a_define_reaches_the_shader(self):
        name = self.write("define.comp", self.SHADER % "void main() { o.x[0] = VALUE; }")
        self.expect(2, ["VALUE"], "compile", name)
        self.assertEqual(self.glint("compile", "-D", "VALUE=41u", name).returncode, 0)

    def test_spirv_is_printed_on_demand(self):
        name = self.write("good.comp", self.SHADER % "void main() { o.x[0] = 1u; }")
        self.assertIn("OpEntryPoint GLCompute", self.glint("compile", "--emit", "spirv", name).stdout)

    def test_an_unknown_op_in_text_is_refused_with_its_line(self):
        self.expect(2, ["bad.isa:"], "asm", self.write("bad.isa", "\n    frobnicate %r1;\n"))

    def test_the_built_in_shaders_compile(self):
        for shader in sorted((ROOT / "shaders").glob("*/*.r*")):
            with self.subTest(shader=shader.name):
                done = self.glint("compile", "-I", ROOT / "shaders/include", "-o", "out.isa", shader)
                self.assertEqual(done.returncode, 0, done.stderr)


class Configuration(GlintTest):
    def test_an_unknown_key_is_refused_at_its_line_with_the_nearest(self):
        self.write("gpu.toml", "cores = 2\n[core]\nwraps = 8\n")
        self.expect(2, ["gpu.toml:3:1", "core.wraps", "did you mean 'warps'?"], "run", "WKND", "--config", "gpu.toml")

    def test_a_wrong_type_is_refused_at_its_line(self):
        self.write("gpu.toml", "[core]\nwarps = \"many\"\n")
        self.expect(2, ["gpu.toml:2:1", "expected an integer"], "describe", "--config", "gpu.toml")

    def test_every_error_of_a_file_is_reported_at_once(self):
        self.write("gpu.toml", "croes = 2\n[core]\nwarps = 10000\n")
        self.expect(2, ["croes", "core.warps"], "describe", "--config", "gpu.toml")

    def test_text_that_is_not_toml_is_refused(self):
        self.write("gpu.toml", "[core\n")
        self.expect(2, ["gpu.toml:1"], "describe", "--config", "gpu.toml")

    def test_presets_of_cards_have_the_published_rates_and_reach_their_published_bandwidths(self):
        # boxes and triangles a cycle and unit, cores, GB/s of the memory, cycles of a load that hits in the L2 (None: a guess)
        cards = {"turing": (8, 0.5, 68, 616, 226), "ada": (8, 2, 128, 1008, 273), "rdna2": (4, 1, 80, 512, None),
                 "rdna4": (8, 2, 64, 640, None), "alchemist": (12, 1, 32, 560, None)}
        children = {"cwbvh": 8, "bvh4": 4, "bvh8_12bit": 8, "bvh6": 6}
        for card, (boxes, triangles, cores, bandwidth, l2) in cards.items():
            text = self.glint("describe", "--config", card).stdout
            value = lambda key: re.search(rf'^{re.escape(key)} = "?([^"\n]*)"?$', text, re.M)[1]
            rate = lambda test: float(value(f"rt.{test}.units")) / float(value(f"rt.{test}.interval"))
            self.assertEqual((children[value("bvh.format")] * rate("box"), rate("triangle"), int(value("cores"))), (boxes, triangles, cores), card)
            peak = float(value("memory.dram.clock_mhz")) * 1e6 * 8 * 2 * int(value("memory.dram.channels"))
            self.assertEqual(peak, bandwidth * 1e9, card)
            if l2:
                self.assertIn(f",{l2},", self.glint("microbench", "--config", card, "--only", "bytes=1048576;", "--format", "csv").stdout)

    def test_a_missing_configuration_is_refused_with_the_nearest(self):
        self.expect(2, ["did you mean 'mobile'?"], "describe", "--config", "moblie")

    def test_a_wrong_setting_is_refused(self):
        self.expect(2, ["core.wraps"], "run", "WKND", "--set", "core.wraps=8")
        self.expect(2, ["expected key=value"], "run", "WKND", "--set", "core.warps")

    def test_an_impossible_cache_is_refused_before_anything_runs(self):
        self.expect(2, ["l1.size"], "run", "WKND", *SMALL, "--set", "memory.l1.size=100")

    def test_an_unknown_policy_is_refused_with_the_nearest(self):
        self.expect(2, ["did you mean \"gto\"?"], "describe", "--set", "core.issue=gtoo")

    def test_every_preset_loads_and_defaults_are_shown_with_unit_and_range(self):
        for preset in sorted((ROOT / "configs").glob("*.toml")):
            done = self.glint("describe", "core.warps", "--config", preset.stem)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertRegex(done.stdout, r"core\.warps = (16|32|48|64)\n")
            self.assertIn("range  1 to", done.stdout)

    def test_a_file_stands_on_its_base_and_wins_over_it(self):
        value = lambda key, config: self.glint("describe", key, "--config", config).stdout.split("\n")[0].split(" = ")[1]
        self.write("low.toml", 'base = "vulkan-sim-desktop"\n[rt]\nwarps = 7\nrequests_per_cycle = 2\n')
        self.write("sub/high.toml", 'base = "../low.toml"\n[rt]\nwarps = 9\n')
        self.assertEqual([value(key, "sub/high.toml") for key in ("cores", "rt.warps", "rt.requests_per_cycle")], ["30", "9", "2"])
        self.write("mobile", "this is no TOML")  # the name of a preset wins over a file
        self.write("named.toml", 'base = "mobile"\n')
        self.assertEqual(self.glint("describe", "--config", "named.toml").stdout, self.glint("describe", "--config", "mobile").stdout)

    def test_a_wrong_base_is_refused_at_its_line(self):
        self.write("a.toml", 'cores = 2\nbase = "b.toml"\n')
        self.write("b.toml", '# this file\n\nbase = "a.toml"\n')
        self.expect(2, ["b.toml:3:1", "the bases go in a circle", "a.toml -> b.toml -> a.toml"], "describe", "--config", "a.toml")
        self.write("self.toml", 'base = "self.toml"\n')
        self.expect(2, ["self.toml:1:1", "in a circle"], "describe", "--config", "self.toml")
        self.write("c.toml", 'base = "ttp62"\n')
        self.expect(2, ["c.toml:1:1", "the base 'ttp62'", "did you mean 'ttp26'?"], "run", "WKND", "--config", "c.toml")
        self.expect(2, ["d.toml:1:1", "'base' is an integer"], "describe", "--config", self.write("d.toml", "base = 3\n"))
        self.expect(2, ["e.toml:1:1", "'base' is empty"], "describe", "--config", self.write("e.toml", 'base = ""\n'))
        self.write("bad.toml", "[core]\nwraps = 8\n")
        self.expect(2, ["bad.toml:2:1", "core.wraps"], "describe", "--config", self.write("f.toml", 'base = "bad.toml"\n'))
        self.expect(2, ["--set base=mobile", "a base stands in a file"], "describe", "--set", "base=mobile")

    def test_a_preset_of_a_paper_has_the_numbers_of_the_paper(self):
        said = lambda config: dict(line.split(" = ") for line in self.glint("describe", "--config", config).stdout.splitlines() if " = " in line)
        papers = {"ttp26": ("8", "32768", "4", 512), "coop25": ("30", "65536", "4", 3072), "pred21": ("2", "65536", "16", 256),
                  "treelet23": ("8", "65536", "16", 512), "vtq25": ("16", "16384", "1", 128)}
        for name, (cores, l1, warps, l2) in papers.items():
            keys = said(name)
            self.assertEqual((keys["cores"], keys["memory.l1.size"], keys["rt.warps"]), (cores, l1, warps), name)
            self.assertEqual(int(keys["memory.dram.channels"]) * int(keys["memory.l2.slices"]) * int(keys["memory.l2.slice_size"]), l2 << 10, name)
        for name, base in (("ttp26", "vulkan-sim-mobile"), ("coop25", "vulkan-sim-desktop")):
            # Their published figures were measured before the base had memory of a thread's own.
            self.assertEqual(said(name), said(base) | {"core.local_by_thread": "false"})

    def test_an_unknown_key_to_describe_is_refused_with_the_nearest(self):
        self.expect(2, ["did you mean 'core.warps'?"], "describe", "core.warp")


ENDLESS = """#version 460
#extension GL_EXT_ray_tracing : require
layout(set = 0, binding = 1, rgba32f) uniform image2D accumulation;
void main() {
  uint i = 0;
  while (imageLoad(accumulation, ivec2(0)).x > -1.0) ++i;
  imageStore(accumulation, ivec2(0), vec4(i));
}
"""
OUT_OF_BOUNDS = """#version 460
#extension GL_EXT_ray_tracing : require
layout(set = 0, binding = 5, std430) buffer Indices { uint indices[]; };
void main() {
  indices[1u << 28] = 1;
}
"""


WRONG_COMPUTE = """#version 460
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer Out { uint result[]; } outcome;
layout(set = 0, binding = 1) buffer In { uint few[4]; } data;
void main() {
  const uint read = data.few[gl_GlobalInvocationID.x + 100000u];
  outcome.result[gl_GlobalInvocationID.x + (read == 0u ? 100000u : 0u)] = 1u;
}
"""


class Faults(ShadersTest):
    def test_an_endless_loop_ends_with_4_and_names_the_shader_in_both_modes(self):
        folder = self.shaders_with("raygen.rgen", ENDLESS)
        for mode in ("functional", "timing"):
            with self.subTest(mode=mode):
                self.expect(4, ["raygen.rgen"], "run", "WKND", *SMALL, "--mode", mode, "--shader-dir", folder,
                            "--max-instructions", 10000, "--out", "out")
                self.assertEqual(json.loads((self.folder / "out/run.json").read_text())["exit"], 4)

    def test_an_access_out_of_bounds_ends_with_4_and_names_file_and_line_in_both_modes(self):
        folder = self.shaders_with("raygen.rgen", OUT_OF_BOUNDS)
        for mode in ("functional", "timing"):
            with self.subTest(mode=mode):
                self.expect(4, ["raygen.rgen:5"], "run", "WKND", *SMALL, "--mode", mode, "--shader-dir", folder)

    def test_on_fault_warn_goes_on_lists_each_fault_once_and_counts_it_alike_in_both_modes(self):
        self.write("wrong.comp", WRONG_COMPUTE)
        told, pictures = [], []
        for mode in ("functional", "timing"):
            with self.subTest(mode=mode):
                self.expect(4, ["wrong.comp:6 (instruction ", "past the end of", "launch id ("], "run", "wrong.comp", "--mode", mode, "--out", "stop")
                self.assertEqual(json.loads((self.folder / "stop/run.json").read_text())["on_fault"], "stop")
                done = self.expect(0, ["wrong.comp:6 (instruction ", "wrong.comp:7 (instruction ", "(0, 0, 0), the first of 65536 times",
                                       "faults let pass: 131072, at 2 places"], "run", "wrong.comp", "--mode", mode, "--on-fault", "warn", "--out", mode)
                told.append(done.stderr)
                run = json.loads((self.folder / mode / "run.json").read_text())
                self.assertEqual((run["exit"], run["on_fault"]), (0, "warn"))
                self.assertEqual([(f["kind"], f["launch_id"], f["count"]) for f in run["faults"]], [("out_of_bounds", [0, 0, 0], 65536)] * 2)
                self.assertIn("wrong.comp:6", run["faults"][0]["place"])
                stats = json.loads((self.folder / mode / "stats.json").read_text())
                self.assertEqual(stats["gpu"]["faults"]["value"]["out_of_bounds"], 131072)
                pictures.append((self.folder / mode / "outcome.npy").read_bytes())
        self.assertEqual(told[0], told[1])
        self.assertEqual(pictures[0], pictures[1])

    def test_on_fault_warn_serves_scenes_and_kernels_and_refuses_other_words(self):
        folder = self.shaders_with("raygen.rgen", OUT_OF_BOUNDS)
        for mode in ("functional", "timing"):
            self.expect(0, ["raygen.rgen:5", "faults let pass: "], "run", "WKND", *SMALL, "--mode", mode, "--on-fault", "warn", "--shader-dir", folder)
        kernels = ROOT / "shaders/kernels"
        shutil.copy(kernels / "saxpy.ptx", self.folder)
        self.write("saxpy.toml", (kernels / "saxpy.toml").read_text().replace("u32 = 1000", "u32 = 1001"))
        self.expect(0, ["saxpy.ptx:", "past the end of 'x'", "past the end of 'y'", "launch id (1000, 0, 0)", "faults let pass: 3, at 3 places"],
                    "run", "saxpy.toml", "--on-fault", "warn")
        self.expect(2, ["--on-fault"], "run", "WKND", "--on-fault", "ignore")

    def test_a_broken_shader_of_a_workload_ends_with_2(self):
        folder = self.shaders_with("raygen.rgen", "#version 460\nvoid main() { x = 1; }\n")
        self.expect(2, ["raygen.rgen:2"], "run", "WKND", *SMALL, "--shader-dir", folder)


class RunDirectory(GlintTest):
    FILES = ["config.toml", "image.pfm", "image.png", "run.json", "stats.csv", "stats.json", "stats.txt"]

    def test_a_run_leaves_a_complete_directory_with_valid_json(self):
        done = self.glint("run", "WKND", *SMALL, "--out", "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(sorted(p.name for p in (self.folder / "out").iterdir()), self.FILES)
        run = json.loads((self.folder / "out/run.json").read_text())
        self.assertEqual((run["exit"], run["scene"]["name"], run["width"], run["samples"]), (0, "WKND", 16, 1))
        stats = json.loads((self.folder / "out/stats.json").read_text())
        self.assertGreater(stats["gpu"]["cycles"]["value"], 5000)  # more than the launch alone
        self.assertIn("out/image.png", done.stdout)

    def test_the_picture_is_kept_as_exr_on_request_and_equals_the_pfm(self):
        done = self.glint("run", "WKND", *SMALL, "--mode", "functional", "--exr", "--out", "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(sorted(p.name for p in (self.folder / "out").iterdir()), sorted([*self.FILES, "image.exr"]))
        done = self.glint("imgdiff", "out/image.exr", "out/image.pfm", "--min-psnr", "inf")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(self.glint("run", "WKND", *SMALL, "--mode", "functional", "--out", "out").returncode, 0)
        self.assertFalse((self.folder / "out/image.exr").exists())
        self.expect(2, ["--exr belongs to scenes", "save"], "run", ROOT / "examples/mandelbrot/pipeline.toml", "--exr")

    def test_the_same_command_gives_the_same_statistics_and_image_bytes(self):
        for out in ("a", "b"):
            done = self.glint("run", "WKND", *SMALL, "--out", out)
            self.assertEqual(done.returncode, 0, done.stderr)
        for name in self.FILES:
            if name != "run.json":
                self.assertEqual((self.folder / "a" / name).read_bytes(), (self.folder / "b" / name).read_bytes(), name)

    def test_the_resolved_configuration_loads_back_to_the_same_run(self):
        self.assertEqual(self.glint("run", "WKND", *SMALL, "--set", "core.warps=8", "--out", "a").returncode, 0)
        self.assertEqual(self.glint("run", "WKND", *SMALL, "--config", "a/config.toml", "--out", "b").returncode, 0)
        self.assertEqual((self.folder / "a/stats.json").read_bytes(), (self.folder / "b/stats.json").read_bytes())
        hashes = [json.loads((self.folder / out / "run.json").read_text())["config"]["hash"] for out in ("a", "b")]
        self.assertEqual(hashes[0], hashes[1])

    def test_functional_and_timing_runs_give_the_same_picture(self):
        for mode in ("functional", "timing"):
            self.assertEqual(self.glint("run", "WKND", *SMALL, "--mode", mode, "--out", mode).returncode, 0)
        self.assertEqual((self.folder / "functional/image.pfm").read_bytes(), (self.folder / "timing/image.pfm").read_bytes())

    def test_another_seed_gives_another_picture(self):
        for seed in (1, 2):
            done = self.glint("run", "WKND", *SMALL, "--mode", "functional", "--seed", seed, "--out", f"s{seed}")
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotEqual((self.folder / "s1/image.pfm").read_bytes(), (self.folder / "s2/image.pfm").read_bytes())

    def test_json_prints_the_statistics_and_nothing_else(self):
        done = self.glint("run", "WKND", *SMALL, "--mode", "functional", "--json", "--out", "out")
        self.assertEqual(json.loads(done.stdout), json.loads((self.folder / "out/stats.json").read_text()))

    def test_a_pipe_gets_plain_text(self):
        done = self.glint("run", "WKND", *SMALL, "--mode", "functional", "--out", "out")
        self.assertNotIn("\x1b", done.stdout)
        self.assertNotIn("\r", done.stdout)

    def test_an_output_folder_that_cannot_be_made_is_refused(self):
        self.write("file", "x")
        self.expect(2, ["file"], "run", "WKND", *SMALL, "--mode", "functional", "--out", "file")


class Docs(GlintTest):
    def test_the_generated_docs_are_fresh(self):
        script = ROOT / "tools/update_golden.py"
        done = subprocess.run([sys.executable, script, "--check", GLINT], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    os.environ.pop("NO_COLOR", None)
    glint_case.main()

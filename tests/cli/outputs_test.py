# Tests with the real binary that a failed run or write leaves nothing old and nothing half, and never exits with 0.
# SPDX-License-Identifier: Apache-2.0
"""usage: outputs_test.py GLINT SOURCE_DIR"""
import json
import os
import resource
import shutil
import subprocess

import glint_case
from glint_case import GLINT, ROOT, GlintTest

RUN = ["run", "WKND", "--size", "8x8", "--spp", "1"]
KERNEL = {
    "k.ptx": ".version 7.0\n.target sm_70\n.address_size 64\n.visible .entry k(.param .u64 p)\n{\n.reg .u64 %rd<2>;\n"
             "ld.param.u64 %rd1, [p];\nst.global.u32 [%rd1+OFFSET], 7;\nret;\n}\n",
    "k.toml": 'kernel = "k.ptx"\ngrid = [1]\nblock = [1]\n[[argument]]\nbuffer = "kept"\ntype = "u32"\ncount = 4\nsave = true\n'}


class Outputs(GlintTest):
    def ok(self, *arguments):
        done = self.glint(*arguments)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done

    def left(self, folder):
        return sorted(path.name for path in (self.folder / folder).iterdir())

    def limited(self, most, *arguments):
        """Runs glint where no file can grow beyond `most` bytes. By default the system ends a process that tries to."""
        return subprocess.run([GLINT, *arguments], capture_output=True, text=True, cwd=self.folder, timeout=300,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most)))

    def test_a_run_that_fails_leaves_nothing_of_an_earlier_one_and_every_reader_refuses_it(self):
        self.ok(*RUN, "--profile", "--heat", "--sample", "1000", "--trace", "--out", "run")
        shutil.copytree(self.folder / "run", self.folder / "base")
        self.expect(4, ["no end in sight"], *RUN, "--max-instructions", "50", "--out", "run")
        self.assertEqual(self.left("run"), ["config.toml", "run.json"])
        readers = [["compare", "base", "run", "--fail-on", "cycles>1%"], ["imgdiff", "base", "run"], ["annotate", "run"], ["model", "run"], ["report", "run"],
                   *(["stats", "run", "--format", form] for form in ("txt", "csv", "json", "metrics", "vulkan-sim"))]
        shutil.copytree(self.folder / "base", self.folder / "run", dirs_exist_ok=True, ignore=lambda *_: ["run.json"])  # as older versions left the folder
        for reader in readers:
            with self.subTest(reader=reader):
                self.expect(2, ["run.json", "the run failed", "no end in sight"], *reader)

    def test_files_that_a_kernel_saved_are_gone_when_the_next_one_fails(self):
        for name, text in KERNEL.items():
            self.write(name, text.replace("OFFSET", "0"))
        self.ok("run", "k.toml", "--out", "run")
        self.assertEqual(json.loads((self.folder / "run/run.json").read_text())["saved"], ["kept.bin"])
        self.ok("run", "k.toml", "--out", "run")
        self.assertIn("kept.bin", self.left("run"))
        self.write("k.ptx", KERNEL["k.ptx"].replace("OFFSET", "1048576"))
        self.expect(4, ["k.ptx"], "run", "k.toml", "--out", "run")
        self.assertEqual(self.left("run"), ["config.toml", "run.json"])

    def test_a_full_disk_leaves_run_json_with_the_error_and_no_result_old_or_half(self):
        self.ok(*RUN, "--out", "run")
        config, stats = ((self.folder / "run" / name).stat().st_size for name in ("config.toml", "stats.csv"))
        self.assertLess(config + 5000, stats)
        done = self.limited(stats - 1000, *RUN, "--out", "run")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(self.left("run"), ["config.toml", "run.json"])
        facts = json.loads((self.folder / "run/run.json").read_text())
        self.assertEqual(facts["exit"], 2)
        self.assertIn("cannot write the file: File too large", facts["message"])

    def test_a_file_that_cannot_be_written_keeps_what_it_was_and_leaves_no_temporary_one(self):
        self.ok(*RUN, "--out", "run")
        self.write("page/page.html", "before")
        done = self.limited(20000, "report", "run", "-o", "page/page.html")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual((self.folder / "page/page.html").read_text(), "before")
        self.assertIn("page/page.html: error: cannot write the file: File too large", done.stderr)
        self.assertEqual(self.left("page"), ["page.html"])

    def test_a_full_device_is_named_with_the_systems_reason(self):
        self.ok(*RUN, "--out", "run")
        self.expect(2, ["/dev/full: error: cannot write the file: No space left on device"], "report", "run", "-o", "/dev/full")
        with open("/dev/full", "w") as full:
            done = subprocess.run([GLINT, "stats", "run"], stdout=full, stderr=subprocess.PIPE, text=True, cwd=self.folder, timeout=300)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("error: ", done.stderr)

    def test_pixels_that_are_not_finite_are_counted_and_the_first_is_named(self):
        self.write("p/picture.comp", "#version 460\nlayout(local_size_x = 8, local_size_y = 4) in;\nlayout(set = 0, binding = 0, rgba32f) uniform image2D picture;\n"
                   "void main() {\n  ivec2 at = ivec2(gl_GlobalInvocationID.xy);\n  vec4 colour = vec4(1e38, 1e38, 1e38, 1);\n"
                   "  if (at.y == 2 && at.x >= 5) colour.g = intBitsToFloat(at.x == 6 ? 0x7fc00000 : 0x7f800000);\n"
                   "  if (at == ivec2(1, 3)) colour.b = -intBitsToFloat(0x7f800000);\n  imageStore(picture, at, colour);\n}\n")
        self.write("p/p.toml", '[compute]\nshader = "picture.comp"\n[launch]\ngroups = [1, 1]\n[[image]]\nname = "picture"\nset = 0\nbinding = 0\n'
                   'size = [8, 4]\nsave = "picture.pfm"\n')
        for mode in ("functional", "timing"):
            said = self.ok("run", "p/p.toml", "--mode", mode, "--out", "out").stderr
            self.assertIn("warning: picture.pfm: 4 of 32 pixels are not finite; the first at x 5, y 2 from the top left: 1e+38 inf 1e+38, stored at picture.comp:9\n", said)
            record = json.loads((self.folder / "out/run.json").read_text())
            self.assertEqual(record["not_finite"], {"picture.pfm": {"pixels": 4, "x": 5, "y": 2, "stored_at": "picture.comp:9"}})
        self.ok(*RUN, "--out", "run")
        self.assertNotIn("not_finite", json.loads((self.folder / "run/run.json").read_text()))
        # Of several lines that store, the one that stored the pixel last is named.
        twice = (self.folder / "p/picture.comp").read_text().replace("  imageStore(picture, at, colour);", "  if (at.x > 4)\n    imageStore(picture, at, colour);\n  else\n    imageStore(picture, at, colour * 0.5);\n"
                                                                     "  if (at.x > 90) imageStore(picture, at, vec4(0));")
        self.write("p/picture.comp", twice)
        for cores in ("functional", "timing", "one core"):
            options = ["--set", "cores=1"] if cores == "one core" else ["--mode", cores]
            self.assertIn(", stored at picture.comp:10\n", self.ok("run", "p/p.toml", *options, "--out", "out").stderr)
        # A store that is finite leaves an earlier one that is not without effect.
        self.write("p/picture.comp", twice.replace("  if (at.x > 4)", "  imageStore(picture, at, colour / 0.0);\n  if (at.x > 4)"))
        self.assertIn("the first at x 5, y 2 from the top left: 1e+38 inf 1e+38, stored at picture.comp:11\n", self.ok("run", "p/p.toml", "--out", "out").stderr)

    def test_the_store_that_left_a_pixel_not_finite_is_named_in_windows_layers_and_halves(self):
        shutil.copytree(ROOT / "shaders/path_tracing", self.folder / "shaders/path_tracing")
        shutil.copytree(ROOT / "shaders/include", self.folder / "shaders/include")
        self.write("shaders/path_tracing/raygen.rgen", "#version 460\n#extension GL_EXT_ray_tracing : require\nlayout(set = 0, binding = 2, rgba32f) uniform image2D picture;\n"
                   "void main() {\n  ivec2 at = ivec2(gl_LaunchIDEXT.xy);\n  if (at == ivec2(9, 6))\n    imageStore(picture, at, vec4(1.0 / float(at.x - 9)));\n  else\n    imageStore(picture, at, vec4(0.5));\n}\n")
        said = self.ok("run", "WKND", "--shader-dir", "shaders/path_tracing", "--size", "16x16", "--crop", "8,5,4,4", "--out", "out").stderr
        self.assertIn("1 of 16 pixels are not finite; the first at x 1, y 1 from the top left: inf inf inf, stored at raygen.rgen:7\n", said)
        self.write("p/layers.comp", "#version 460\nlayout(local_size_x = 8, local_size_y = 4) in;\nlayout(set = 0, binding = 0, rgba16f) uniform image2DArray picture;\n"
                   "void main() {\n  ivec2 at = ivec2(gl_GlobalInvocationID.xy);\n  imageStore(picture, ivec3(at, 0), vec4(1));\n"
                   "  imageStore(picture, ivec3(at, 1), vec4(at.x == 3 ? 65520.0 : 1.0));\n}\n")
        self.write("p/layers.toml", '[compute]\nshader = "layers.comp"\n[launch]\ngroups = [1, 1]\n[[image]]\nname = "picture"\nset = 0\nbinding = 0\n'
                   'size = [8, 4]\nlayers = 2\nsave = "picture.pfm"\n')
        self.assertIn("4 of 64 pixels are not finite; the first at x 3, y 4 from the top left: inf inf inf, stored at layers.comp:7\n", self.ok("run", "p/layers.toml", "--out", "out").stderr)

    def test_compact_statistics_are_totals_from_which_all_metrics_follow_in_at_most_60_kb(self):
        for what in (["SHIP_PT", "--config", "mobile"], ["WKND_SH", "--config", "desktop"], ["WKND_AO", "--config", "h200"], ["WKND_PT", "--mode", "functional"]):
            with self.subTest(what=what):
                self.ok("run", *what, "--size", "16x16", "--spp", "1", "--out", "full")
                done = self.ok("run", *what, "--size", "16x16", "--spp", "1", "--stats", "compact", "--out", "compact")
                self.assertIn("compact/stats.csv", done.stdout)
                sizes = {name: self.size("compact", name) for name in self.left("compact") if not name.startswith("image.")}
                self.assertLessEqual(sum(sizes.values()), 60_000, sizes)
                self.assertEqual([name for name in self.left("compact") if name.startswith("stats")], ["stats.csv"])
                self.assertEqual(*(self.metrics(folder) for folder in ("full", "compact")))
                if "--mode" not in what:
                    self.assertRegex(self.ok("compare", "full", "compact").stdout, r"\Aall \d+ metrics are equal\n\Z")
                    self.expect(2, ["compact statistics, and a report needs those of every unit", "--stats compact"], "report", "compact")
                self.expect(2, ["compact statistics, and the format txt needs"], "stats", "compact")

    def size(self, *names):
        return self.folder.joinpath(*names).stat().st_size

    def metrics(self, folder):
        """Returns the metrics of a run as they are printed, without the speed of the host."""
        return [" ".join(line.split()) for line in self.ok("stats", folder, "--format", "metrics").stdout.splitlines() if not line.startswith("sim_rate")]

    def test_output_goes_through_a_link_to_the_file_that_it_names(self):
        self.write("there/isa.txt", "before")
        (self.folder / "link").symlink_to("there/isa.txt")
        shader = next((ROOT / "shaders/path_tracing").glob("*.rmiss"))
        self.ok("compile", shader, "-o", "link")
        self.assertTrue((self.folder / "link").is_symlink())
        self.assertNotEqual((self.folder / "there/isa.txt").read_text(), "before")

    def test_stdout_that_takes_no_more_ends_every_command_with_1(self):
        self.ok(*RUN, "--profile", "--out", "run")
        shader = next((ROOT / "shaders/path_tracing").glob("*.rmiss"))
        (self.folder / "run.isa").write_text(self.ok("compile", shader).stdout)
        commands = [[*RUN, "--out", "other"], [*RUN, "--json", "--out", "other"], ["describe"], ["describe", "--markdown"], ["describe", "rt"], ["describe", "gpu.cycles"],
                    ["describe", "thread_ipc"], *(["stats", "run", "--format", form] for form in ("txt", "csv", "json", "metrics", "vulkan-sim")),
                    *(["list", what] for what in ("scenes", "shaders", "workloads", "configs", "policies", "ops", "stats", "metrics")), ["list", "stats", "--markdown"],
                    ["annotate", "run"], ["isa"], ["isa", "fma"], ["isa", "--table", "mobile"], ["isa", "--index"], ["compile", shader], ["asm", "run.isa"],
                    ["report", "run"], ["report", "run", "-o", "-"], ["compare", "run", "run"], ["imgdiff", "run", "run"], ["model", "run", "--statistics-only"],
                    ["model", "run", "--statistics-only", "-o", "-"], ["bench", "WKND_SH", "--size", "8x8", "--out", "bench"], ["--help"], ["run", "--help"], ["--version"]]
        for command in commands:
            for redirection in (">/dev/full", ">&-"):
                with self.subTest(command=command, redirection=redirection):
                    done = subprocess.run(["sh", "-c", f'exec "$0" "$@" {redirection}', str(GLINT), *map(str, command)], stderr=subprocess.PIPE, text=True, cwd=self.folder, timeout=300)
                    self.assertEqual(done.returncode, 1, done.stderr)
                    self.assertIn("error: cannot write to standard output", done.stderr)

    def test_stderr_that_takes_no_more_never_ends_in_an_abort(self):
        for redirection, code in (("2>/dev/full", (1, 2)), ("2>&-", (2,))):
            done = subprocess.run(["sh", "-c", f'exec "$0" "$@" {redirection}', str(GLINT), "run", "WKNDD"], cwd=self.folder, timeout=300)
            self.assertIn(done.returncode, code)

    def test_of_an_option_given_twice_the_last_one_counts(self):
        """Runs the command of ./demo with further options."""
        line = next(line for line in (ROOT / "demo").read_text().splitlines() if "/glint run " in line and not line.startswith("step"))
        arguments = line.split()[1:-1]
        self.assertIn("--size", arguments)
        self.ok(*arguments, "--size", "8x8", "--spp", "1", "--shader", "sh", "--config", "desktop", "--set", "rt.warps=2", "--set", "core.warps=4", "--out", "mine")
        facts = json.loads((self.folder / "mine/run.json").read_text())
        self.assertEqual([facts[key] for key in ("width", "height", "samples", "shader")] + [facts["config"]["name"]], [8, 8, 1, "sh", "desktop"])
        config = (self.folder / "mine/config.toml").read_text().split("[rt")[0]
        self.assertRegex(config, r"(?m)^warps = 4\b")
        self.assertFalse((self.folder / "out").exists())

    def test_one_broken_preset_costs_isa_its_column_only(self):
        root = self.folder / "installed"
        (root / "bin").mkdir(parents=True)
        (root / "share/glint").mkdir(parents=True)
        shutil.copytree(ROOT / "configs", root / "share/glint/configs")
        (root / "share/glint/shaders").symlink_to(ROOT / "shaders")
        try:
            os.link(GLINT, root / "bin/glint")
        except OSError:  # another file system, or another mount of the same one
            shutil.copy(GLINT, root / "bin/glint")
        (root / "share/glint/configs/broken.toml").write_text("core.warpz = 3\n")
        done = subprocess.run([root / "bin/glint", "isa", "fma.rn.f32"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout, self.ok("isa", "fma.rn.f32").stdout)
        self.assertIn("preset 'broken' is left out", done.stderr)
        self.assertIn("core.warpz", done.stderr)

    def test_describe_explains_a_metric(self):
        out = self.ok("describe", "simt_efficiency").stdout
        self.assertRegex(out, r"simt_efficiency \(a metric")
        self.assertRegex(out, r"formula +\S*\w+")
        self.expect(2, ["did you mean 'simt_efficiency'?"], "describe", "simt_eficiency")


if __name__ == "__main__":
    glint_case.main()

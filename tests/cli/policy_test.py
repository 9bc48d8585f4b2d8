# Tests that no policy changes the picture, that each costs the cycles that policies.csv records, and that a policy can live outside of the tree.
# SPDX-License-Identifier: Apache-2.0
"""usage: policy_test.py GLINT SOURCE_DIR [Table|Frames|Plugin|NewPolicy]

policies.csv has one row for each policy: its key, its name, and the cycles of one small frame with it. An empty number means
"not recorded yet": tools/new_policy.py writes such a row, and tools/update_golden.py fills it in."""
import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import glint_case
from glint_case import GLINT, ROOT, GlintTest

sys.path.insert(0, str(ROOT / "tools"))
import frame_table  # noqa: E402
import policy_table  # noqa: E402

YOUNGEST = (ROOT / "docs/howto/policy.md").read_text().split("```cpp\n")[1].split("```")[0]


class Table(GlintTest):
    def test_every_policy_has_a_row_and_costs_its_cycles_with_the_same_picture(self):
        recorded = {(row["key"], row["name"]): row["cycles"] for row in csv.DictReader((ROOT / policy_table.PATH).read_text().splitlines())}
        self.assertEqual(sorted(recorded), sorted(policy_table.policies(GLINT)), "tools/update_golden.py writes the rows anew")
        pictures = {}
        for key, name in recorded:
            with self.subTest(key=key, policy=name):
                cycles, picture = policy_table.measure(GLINT, key, name, self.folder / "out")
                self.assertEqual(str(cycles), recorded[key, name], "tools/update_golden.py records a number anew")
                pictures.setdefault(picture, f"{key}={name}")
        self.assertEqual(len(pictures), 1, f"these give pictures of their own: {list(pictures.values())}")

    def test_the_order_by_octant_asks_for_a_node_format_with_slots_by_octant(self):
        done = self.glint("run", "SHIP_SH", "--size", "8x8", "--set", "rt.child_order=octant", "--out", "out")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn('bvh.format = "bvh6" does not place them so; choose bvh.format = "cwbvh"', done.stderr)


class Frames(GlintTest):
    def test_occlusion_rays_end_at_their_first_hit_in_every_preset_and_visit_fewer_nodes(self):
        nodes = {}
        for preset in sorted(path.stem for path in (ROOT / "configs").glob("*.toml")):
            done = self.glint("describe", "rt.nearest_first_hit", "--config", preset)
            self.assertRegex(done.stdout, r"\bfalse\b", preset)
        for key in ("true", "false"):
            done = self.glint("run", "SHIP_SH", "--mode", "functional", "--size", "16x16", "--spp", "1", "--set", f"rt.nearest_first_hit={key}", "--out", key)
            self.assertEqual(done.returncode, 0, done.stderr)
            stats = json.loads((self.folder / key / "stats.json").read_text())
            nodes[key] = stats["gpu"]["nodes"]["value"]
        self.assertLess(nodes["false"], nodes["true"])
        self.assertEqual(*((self.folder / key / "image.pfm").read_bytes() for key in nodes))

    def test_ccws_spares_misses_and_cycles_where_warps_take_each_others_lines(self):
        # Each of 32 warps of a core reads 8 lines of its own again and again; the L1 has room for half of them.
        (self.folder / "lines.comp").write_text("""#version 460
            layout(local_size_x = 256) in;
            layout(set = 0, binding = 0) buffer In { float data[]; };
            layout(set = 0, binding = 1) buffer Out { float sums[]; };
            void main() {
              const uint warp = gl_GlobalInvocationID.x / 32u, lane = gl_GlobalInvocationID.x % 32u;
              float sum = 0.0;
              for (uint round = 0u; round < 64u; ++round)
                for (uint line = 0u; line < 8u; ++line) sum += data[(warp * 8u + line) * 32u + lane] * float(round);
              sums[gl_GlobalInvocationID.x] = sum;
            }""")
        (self.folder / "lines.toml").write_text("""compute.shader = "lines.comp"
            launch.groups = 32
            buffer = [{ name = "data", set = 0, binding = 0, type = "f32", count = 65536, init = "iota" },
                      { name = "sums", set = 0, binding = 1, type = "f32", count = 8192, save = ["sums.csv"] }]""")
        cycles, fills, sums = {}, {}, {}
        for policy in ("gto", "ccws"):
            done = self.glint("run", "lines.toml", "--set", "memory.l1.size=16384", "--set", "memory.l2.slice_size=16384",
                              "--set", f"core.issue={policy}", "--out", policy)
            self.assertEqual(done.returncode, 0, done.stderr)
            rows = list(csv.DictReader((self.folder / policy / "stats.csv").read_text().splitlines()))
            cycles[policy] = int(next(row["value"] for row in rows if row["path"] == "gpu.cycles"))
            fills[policy] = sum(int(row["value"]) for row in rows if row["path"].endswith(".l1.fills"))
            sums[policy] = (self.folder / policy / "sums.csv").read_bytes()
        self.assertEqual(sums["ccws"], sums["gto"])
        self.assertEqual(fills["gto"], 256 * 8 * 64 * 4, "every read misses, and its four sectors come one by one")
        self.assertLess(2 * fills["ccws"], fills["gto"])
        self.assertLess(cycles["ccws"], cycles["gto"])

    def test_statistics_and_pictures_are_the_bytes_that_every_distribution_gives(self):
        for row in csv.DictReader((ROOT / frame_table.PATH).read_text().splitlines()):
            for threads in ("1", "3"):
                with self.subTest(workload=row["workload"], threads=threads):
                    self.assertEqual(frame_table.measure(GLINT, row["workload"], self.folder / "out", "--threads", threads), [row["statistics"], row["picture"]],
                                     "a change of the model moves them: tools/update_golden.py records them anew")


class Plugin(GlintTest):
    """Tests an issue scheduler that knows only an installed Glint."""
    @classmethod
    def setUpClass(cls):
        build = GLINT.parents[2]
        if not (build / "cmake_install.cmake").exists() or not shutil.which("cmake"):
            raise unittest.SkipTest("the command does not lie in a build folder")
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.prefix = pathlib.Path(folder.name)
        for component in ("glint", "dev"):
            subprocess.run(["cmake", "--install", build, "--prefix", cls.prefix, "--component", component], check=True, capture_output=True)

    def build(self, name, source=None):
        """Begins a plugin as a user does, builds it against the installed headers, and returns its file."""
        folder = self.folder / name
        subprocess.run([sys.executable, ROOT / "tools/new_policy.py", "core.issue", name, "--plugin", folder], check=True, capture_output=True)
        if source:
            (folder / f"{name}.cpp").write_text(source)
        return self.configure_and_build(folder) / f"{name}.so"

    def configure_and_build(self, folder):
        build = folder / "build"
        for command in (["cmake", "-G", "Ninja", "-S", folder, "-B", build, "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS_RELEASE=-O0",
                         f"-DCMAKE_PREFIX_PATH={self.prefix}"], ["cmake", "--build", build]):
            done = subprocess.run(command, capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return build

    def installed(self, *words, **environment):
        return subprocess.run([self.prefix / "bin/glint", *words], capture_output=True, text=True, cwd=self.folder, env=os.environ | environment)

    def test_a_scheduler_from_outside_runs_and_is_written_down(self):
        plugin = self.build("youngest", YOUNGEST)
        run = ["run", "SHIP_SH", "--size", "16x16", "--spp", "1", "--set", "core.issue=youngest", "--out", "out"]
        self.assertEqual(self.installed(*run).returncode, 2)  # nobody knows the name without the plugin
        for words, environment in ((["--plugin", plugin, *run], {}), ([*run, "--plugin", plugin], {}), (run, {"GLINT_PLUGINS": str(plugin)})):
            done = self.installed(*words, **environment)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(list(json.loads((self.folder / "out/run.json").read_text())["plugins"]), [str(plugin)])
        self.assertIn('issue = "youngest"', (self.folder / "out/config.toml").read_text())
        self.assertRegex(self.installed("list", "policies", "--plugin", plugin).stdout, r"core\.issue +youngest +A scheduler issues from")
        suite = ["bench", "SHIP_SH", "--size", "16x16", "--spp", "1", "--set", "core.issue=youngest", "--out", "suite", "--plugin", plugin]
        self.assertEqual(self.installed(*suite).returncode, 0)
        self.assertIn("1 of them complete", self.installed(*suite, "--resume").stdout + self.installed(*suite, "--resume").stderr)

    def test_the_examples_of_rt_policies_work_from_outside(self):
        folder = ROOT / "examples/policies"
        text = (ROOT / "docs/howto/policy.md").read_text()
        self.assertIn(f"```cpp\n{(folder / 'next_line.cpp').read_text()}```", text, "the page shows the file whole")
        shutil.copytree(folder, self.folder / "policies")
        build = self.configure_and_build(self.folder / "policies")
        base = ["run", "SHIP_SH", "--size", "16x16", "--spp", "1"]
        self.assertEqual(self.installed(*base, "--out", "base").returncode, 0)
        for key, name, statistic in (("rt.prefetch", "next_line", r"rt\.next_line\.nodes,[1-9]"), ("rt.entry", "last_hit", r"rt\.entry\.verified,[1-9]"),
                                     ("rt.scheduler", "same_region", r"rt\.same_region\.followed,[1-9]"), ("bvh.format", "box32", r"rt\.internal_nodes,[1-9]")):
            with self.subTest(policy=name):
                self.assertLess(len((folder / f"{name}.cpp").read_text().splitlines()), 150)
                done = self.installed(*base, "--set", f"{key}={name}", "--plugin", build / f"{name}.so", "--out", name)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertRegex((self.folder / name / "stats.csv").read_text(), statistic)
                self.assertEqual(*((self.folder / out / "image.pfm").read_bytes() for out in (name, "base")))

        # The format has the boxes of bvh4 at other places of the node, so the machine does the same in each cycle.
        self.assertEqual(self.installed(*base, "--set", "bvh.format=bvh4", "--out", "bvh4").returncode, 0)
        self.assertEqual(*((self.folder / out / "stats.csv").read_bytes() for out in ("box32", "bvh4")))
        self.assertNotEqual(*((self.folder / out / "stats.csv").read_bytes() for out in ("base", "bvh4")))
        unknown = self.installed(*base, "--set", "bvh.format=box32", "--out", "none")
        self.assertEqual(unknown.returncode, 2, unknown.stderr)
        self.assertIn("box32", unknown.stderr)

    def test_a_program_can_embed_the_libraries(self):
        folder = self.folder / "embed"
        folder.mkdir()
        (folder / "CMakeLists.txt").write_text("cmake_minimum_required(VERSION 3.25)\nproject(embed LANGUAGES CXX)\nfind_package(glint REQUIRED)\n"
                                               "add_executable(embed main.cpp)\ntarget_link_libraries(embed PRIVATE glint::pipeline)\n")
        (folder / "main.cpp").write_text('#include <cstdio>\n#include "base/registry.h"\n#include "pipeline/render.h"\nint main() {\n'
                                         '  std::printf("%d %zu", int(glint::scenes::load_scene("CORNELL", {}).triangles()), glint::all_policies().size());\n}\n')
        triangles, policies = subprocess.run([self.configure_and_build(folder) / "embed"], capture_output=True, text=True, check=True).stdout.split()
        self.assertEqual(triangles, "12")
        self.assertGreater(int(policies), 30)

    def test_a_copied_policy_costs_the_same_as_its_original(self):
        plugin = self.build("mine")
        cycles = {}
        for name in ("oldest", "mine"):
            done = self.installed("run", "SHIP_SH", "--size", "16x16", "--spp", "1", "--set", f"core.issue={name}", "--out", f"{name}_run", "--plugin", plugin)
            self.assertEqual(done.returncode, 0, done.stderr)
            cycles[name] = next(line for line in (self.folder / f"{name}_run" / "stats.csv").read_text().splitlines() if line.startswith("gpu.cycles,"))
        self.assertEqual(cycles["oldest"], cycles["mine"])

    def test_a_plugin_that_takes_a_name_or_brings_nothing_or_is_of_another_glint_is_refused(self):
        taken = self.build("taken", YOUNGEST.replace('"youngest"', '"gto"'))
        empty = self.build("empty", "int nothing = 0;\n")
        other = self.folder / "other.so"
        other.write_bytes(empty.read_bytes().replace(b"glint-plugin-stamp:0", b"glint-plugin-stamp:9"))
        text = self.folder / "text.so"
        text.write_text("no library")
        for file, message in ((taken, "name is taken (core/schedulers: gto)"), (empty, "registers no policy"), (other, "built against other headers"), (text, "not a plugin of Glint"),
                              (self.folder / "absent.so", "cannot read the file")):
            with self.subTest(file=file.name):
                done = self.installed("list", "policies", "--plugin", file)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn(message, done.stderr)


class NewPolicy(GlintTest):
    """tools/new_policy.py in a copy of what it reads and writes."""

    def setUp(self):
        super().setUp()
        for path in (*ROOT.glob("core/*.h"), *ROOT.glob("core/schedulers/*.cpp"), ROOT / "tools/new_policy.py", ROOT / policy_table.PATH, ROOT / "CHANGELOG.md"):
            copy = self.folder / path.relative_to(ROOT)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, copy)

    def begin(self, *words):
        return subprocess.run([sys.executable, self.folder / "tools/new_policy.py", *words], capture_output=True, text=True)

    def test_it_writes_a_file_a_row_and_a_line(self):
        done = self.begin("IssueScheduler", "youngest_first", "--like", "gto")
        self.assertEqual(done.returncode, 0, done.stderr)
        text = (self.folder / "core/schedulers/youngest_first.cpp").read_text()
        for part in ('kName = "youngest_first"', "class YoungestFirst final", "const Register<IssueScheduler, YoungestFirst> registered;", "// SPDX-License-Identifier"):
            self.assertIn(part, text)
        self.assertIn("core.issue,youngest_first,\n", (self.folder / policy_table.PATH).read_text())
        self.assertRegex((self.folder / "CHANGELOG.md").read_text(), r"### Added\n\n\w.*\n- `core.issue = \"youngest_first\"` is a new policy.\n- ")

    def test_every_key_of_the_page_begins_a_plugin_and_the_hints_can_be_followed(self):
        rows = (ROOT / "docs/howto/policy.md").read_text().split("## What there is to change")[1].splitlines()
        keys = [key for row in rows for key in re.findall(r"`([\w.]+)`", row.rsplit("|", 2)[-2] if row.startswith("|") else "")]
        self.assertGreater(len(keys), 20)
        for key in [*keys, "SampleWay", "StatWriter", "Replacement"]:
            with self.subTest(key=key):
                folder = self.folder / key
                done = subprocess.run([sys.executable, ROOT / "tools/new_policy.py", key, "mine", "--plugin", folder], capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertIn("-DCMAKE_PREFIX_PATH=PREFIX", done.stdout)
                how = {"SampleWay": "--sample-by mine", "StatWriter": "", "Replacement": "--set memory.l1.replacement=mine"}.get(key, f"--set {key}=mine")
                self.assertTrue(done.stdout.rstrip().endswith(f"run WKND_PT {how}".rstrip()), done.stdout)

    def test_statistics_of_a_copy_have_its_own_name(self):
        done = subprocess.run([sys.executable, ROOT / "tools/new_policy.py", "rt.prefetch", "mine", "--like", "next_line", "--plugin", self.folder / "mine"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        text = (self.folder / "mine/mine.cpp").read_text()
        self.assertIn('group(parent, "mine")', text)
        self.assertNotIn('"next_line"', text)

    def test_it_refuses_what_there_is_and_what_there_is_not(self):
        for words, message in ((("IssueScheduler", "gto"), "has a policy 'gto' already"), (("core.issue", "Gto"), "not a name of lower-case"), (("core.nothing", "x"), "no kind of policy"),
                               (("core.issue", "x", "--like", "y"), "has no policy 'y'")):
            with self.subTest(words=words):
                done = self.begin(*words)
                self.assertEqual(done.returncode, 1)
                self.assertIn(message, done.stderr)


if __name__ == "__main__":
    glint_case.main()

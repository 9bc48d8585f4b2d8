# Tests `glint model`: predictions beside simulated cycles, with their inputs, and what it refuses.
# SPDX-License-Identifier: Apache-2.0
"""usage: model_test.py GLINT SOURCE_DIR"""
import csv
import json
import shutil

import glint_case
from glint_case import ROOT, GlintTest

SMALL = ["--size", "16x16", "--spp", "1"]


class Model(GlintTest):
    def simulate(self, workload, out, *arguments):
        done = self.glint("run", workload, *SMALL, "--out", out, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads((self.folder / out / "stats.json").read_text())

    def table(self, name):
        with open(self.folder / name, newline="") as file:
            return list(csv.DictReader(file))

    def test_a_folder_of_runs_is_compared_workload_by_workload(self):
        cycles = {name: self.simulate(name, f"suite/{name}")["gpu"]["cycles"]["value"] for name in ("WKND_SH", "SHIP_AO")}
        done = self.glint("model", "suite", "--inputs")
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = self.table("suite/models.csv")
        self.assertEqual({row["workload"]: float(row["cycles"]) for row in rows}, cycles)
        for row in rows:
            self.assertAlmostEqual(float(row["model:interval model"]) / float(row["cycles"]), 1, delta=0.3)
            self.assertIn(row["equation"], ("22", "23", "24"))
            self.assertIn(row["workload"], done.stdout)
        for name in ("mwp", "cwp", "memory_latency", "bound: DRAM bus", "R2"):
            self.assertIn(name, done.stdout)

    def test_runs_of_scene_files_are_modelled_where_their_file_is(self):
        self.write("t.obj", "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n")
        cycles = self.simulate("t.obj", "t")["gpu"]["cycles"]["value"]
        done = self.glint("model", "t")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(float(self.table("t/models.csv")[0]["cycles"]), cycles)
        self.write("t.obj", "v -1 -1 0\nv 1 -1 0\nv 0 1.5 0\nf 1 2 3\n")
        self.expect(2, ["t/run.json", "the file has changed since"], "model", "t")
        (self.folder / "t.obj").unlink()
        self.expect(2, ["the file of the run's scene, 't.obj', is not here", "from the folder that the run was called from"], "model", "t")

    def test_totals_alone_and_many_launches_have_the_cores_and_launches_of_the_run(self):
        rows = {}
        for name, words in {"full": ["SHIP_SH", "--size", "32x32"], "compact": ["SHIP_SH", "--size", "32x32", "--stats", "compact"], "bfs": ["bfs", "--small", "--stats", "compact"]}.items():
            done = self.glint("run", *words, "--out", name)
            self.assertEqual(done.returncode, 0, done.stderr)
            done = self.glint("model", name, "--statistics-only")
            self.assertEqual(done.returncode, 0, done.stderr)
            [rows[name]] = self.table(f"{name}/models.csv")
        self.assertEqual(rows["full"] | {"workload": ""}, rows["compact"] | {"workload": ""})
        self.assertEqual((float(rows["full"]["cores"]), float(rows["full"]["launches"])), (8, 1))
        self.assertEqual(float(rows["bfs"]["launches"]), len(self.table("bfs/launches.csv")))

    def test_statistics_alone_need_no_scene(self):
        self.simulate("WKND_SH", "one")
        done = self.glint("model", "one", "--statistics-only", "-o", "-")
        self.assertEqual(done.returncode, 0, done.stderr)
        header, row = done.stdout.splitlines()
        self.assertIn("model:Hong and Kim", header)
        self.assertNotIn("interval", header)
        self.assertTrue(row.startswith("one,"))

    def test_what_the_models_cannot_take_is_refused_with_the_reason(self):
        self.expect(2, ["nowhere"], "model", "nowhere")
        (self.folder / "empty").mkdir()
        self.expect(2, ["no finished run"], "model", "empty")
        self.simulate("WKND_SH", "functional", "--mode", "functional")
        self.expect(2, ["functional", "timing machine"], "model", "functional")

    def near(self, name, delta, *words):
        done = self.glint("model", name, *words)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        [row] = self.table(f"{name}/models.csv")
        self.assertAlmostEqual(float(row["model:interval model"]) / float(row["cycles"]), 1, delta=delta, msg=name)

    def test_the_interval_model_takes_programs_with_all_their_launches(self):
        for name in ("bfs", "backprop", "streamcluster"):
            self.assertEqual(self.glint("run", name, "--small", "--out", name, "--stats", "compact").returncode, 0)
            self.near(name, 0.2)

    def test_the_interval_model_takes_kernels_pipelines_and_their_lists(self):
        self.write("t.comp", "#version 460\nlayout(local_size_x = 64) in;\nlayout(set = 0, binding = 0) buffer B { float v[]; };\n"
                             "void main() { v[gl_GlobalInvocationID.x] *= 2.0; }\n")
        runs = {"kernel": ROOT / "shaders/kernels/block_sums.toml", "shader": "t.comp", "list": ROOT / "examples/denoise/pipeline.toml"}
        for name, what in runs.items():
            done = self.glint("run", what, "--out", name)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.near(name, 0.2)
        for name in ("shadow", "include"):
            shutil.copytree(ROOT / "shaders" / name, self.folder / "own" / name)
        self.simulate("WKND_SH", "folder", "--shader-dir", "own/shadow")
        self.near("folder", 0.3, "--shader-dir", "own/shadow")

    def test_what_the_interval_model_does_not_know_is_said_and_the_other_model_stays(self):
        kernel = ROOT / "shaders/kernels/saxpy.toml"
        for name, words, said in (("fetching", [kernel, "--set", "core.fetch.perfect=false"], "core.fetch.perfect"), ("unnamed", [kernel.with_suffix(".ptx"), "--launch", kernel], "does not name the file")):
            self.assertEqual(self.glint("run", *words, "--out", name).returncode, 0)
            done = self.glint("model", name)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(said, done.stderr)
            self.assertIn("left out", done.stderr)
            self.assertNotIn("interval", (self.folder / name / "models.csv").read_text())

    def test_kernels_without_reads_are_modelled(self):
        self.write("idle.ptx", ".version 7.0\n.target sm_70\n.address_size 64\n.visible .entry idle()\n{\n  ret;\n}\n")
        self.write("idle.toml", 'kernel = "idle.ptx"\ngrid = 1\nblock = 32\n')
        done = self.glint("run", "idle.toml", "--out", "idle")
        self.assertEqual(done.returncode, 0, done.stderr)
        done = self.glint("model", "idle", "--statistics-only", "--inputs")
        self.assertEqual(done.returncode, 0, done.stderr)
        row = self.table("idle/models.csv")[0]
        self.assertEqual(float(row["memory_instructions_per_warp"]), 0)
        self.assertGreater(float(row["model:Hong and Kim"]), float(row["launch_latency"]))

    def test_the_table_of_several_runs_lies_beside_them_and_never_in_the_working_directory(self):
        for name in ("a", "b", "runs/a", "runs/b"):
            done = self.glint("run", ROOT / "shaders/kernels/saxpy.toml", "--out", name)
            self.assertEqual(done.returncode, 0, done.stderr)
        done = self.glint("model", "runs/a", "runs/b/")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("runs/models.csv", done.stdout)
        self.assertEqual([row["workload"] for row in self.table("runs/models.csv")], ["a", "b"])
        self.expect(2, ["--out"], "model", "a", "b")
        self.expect(2, ["--out"], "model", "runs/a", "b")
        self.assertFalse((self.folder / "models.csv").exists())
        self.assertEqual(self.glint("model", "a", "b", "-o", "here.csv").returncode, 0)
        self.assertEqual(len(self.table("here.csv")), 2)

    def test_a_run_that_is_not_the_launch_of_its_run_json_is_refused(self):
        self.simulate("WKND_SH", "one")
        shutil.copytree(self.folder / "one", self.folder / "other")
        facts = json.loads((self.folder / "one/run.json").read_text())
        self.write("one/run.json", json.dumps({**facts, "samples": 2}))
        self.expect(2, ["warp instructions", "run it again"], "model", "one")
        facts["scene"]["hash"] = "0000000000000000"
        self.write("other/run.json", json.dumps(facts))
        self.expect(2, ["--assets"], "model", "other")


if __name__ == "__main__":
    glint_case.main()

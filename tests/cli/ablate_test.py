# Tests `glint ablate`: the plan, the machines between two configurations, and what it says of them.
# SPDX-License-Identifier: Apache-2.0
"""usage: ablate_test.py GLINT SOURCE_DIR"""
import csv
import shlex
import subprocess
import sys

from glint_case import ROOT, GlintTest, main

CONFIG = 'base = "mobile"\n'
CHANGED = CONFIG + """[core]
warps = 16
[memory.l1]
size = 32768
hit_latency = 30
[rt]
child_order = "first_internal"
"""


class Ablate(GlintTest):
    def ablate(self, *arguments, code=0):
        self.write("a.toml", CONFIG)
        self.write("b.toml", CHANGED)
        done = self.glint("ablate", "a.toml", "b.toml", *arguments)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def test_the_plan_groups_the_keys_and_counts_each_machine_once(self):
        text = self.ablate("--plan").stdout
        # from, to, three alone, three without; of the steps the first is alone, the second is without the third, the third is `to`
        self.assertIn("3 groups of keys, 8 machines", text)
        self.assertRegex(text, r"core\.warps +core\.warps=16\n")
        self.assertRegex(text, r"memory\.l1 +memory\.l1\.size=32768 memory\.l1\.hit_latency=30\n")
        self.assertRegex(text, r"rt\.child_order +rt\.child_order=first_internal\n")
        self.assertIn("4 groups of keys", self.ablate("--plan", "--keys").stdout)
        self.assertIn("1 groups of keys, 2 machines", self.ablate("--plan", "--only", "rt").stdout)
        self.assertFalse((self.folder / "out").exists())

    def test_the_commands_run_elsewhere_leave_nothing_to_run(self):
        given = ("--only", "rt", "--workloads", "WKND_SH", "--size", "16x16", "--spp", "1")
        lines = self.ablate(*given, "--commands").stdout.splitlines()
        self.assertEqual([shlex.split(line)[-1] for line in lines], ["out/ablate-a-b/from", "out/ablate-a-b/to"])
        self.assertFalse((self.folder / "out").exists())
        for line in lines:
            done = self.glint(*shlex.split(line)[1:])
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.ablate(*given).stdout.count("1 workloads, 1 of them complete"), 2)

    def test_steps_add_up_and_every_machine_has_its_keys(self):
        done = self.ablate("--workloads", "WKND_SH", "--size", "16x16", "--spp", "1", "--order", "rt.child_order", "--metrics", "cycles", "-j", "2")
        folder = self.folder / "out/ablate-a-b"
        with (folder / "ablation.csv").open(newline="") as file:
            rows = [row for row in csv.DictReader(file) if row["metric"] == "cycles"]
        cycles = {(row["kind"], row["group"]): float(row["mean"]) for row in rows}
        for (kind, _), mean in cycles.items():
            self.assertGreater(mean, 0, kind)
        self.assertAlmostEqual(cycles["step", "memory.l1"], cycles["to", ""])
        self.assertAlmostEqual(cycles["step", "rt.child_order"], cycles["alone", "rt.child_order"])
        arms = {(row["kind"], row["group"]): row["arm"] for row in rows}
        self.assertEqual(arms["back", "memory.l1"], "step-02-core.warps")  # the same machine, so it has run once
        config = (folder / arms["back", "memory.l1"] / "WKND_SH/config.toml").read_text()
        self.assertIn("size = 65536", config)
        self.assertIn("warps = 16", config)
        statistics = self.statistics("out/ablate-a-b/alone-core.warps/WKND_SH")
        self.assertAlmostEqual(cycles["alone", "core.warps"], statistics["gpu.cycles"])
        self.assertIn("cycles: ", done.stdout)
        page = (folder / "ablation.html").read_text()
        self.assertEqual(page.count("<rect"), 5)  # both machines and three steps
        said = subprocess.run([sys.executable, ROOT / "tools/check_paper.py", "--ablation", folder], capture_output=True, text=True, check=True).stdout
        self.assertRegex(said, r"(?m)^(holds|does not hold) +half of traceRay's L1D reads miss on average")
        self.assertIn("1 of them complete", self.ablate("--workloads", "WKND_SH", "--size", "16x16", "--spp", "1", "--order", "rt.child_order").stdout)

    def test_mistakes_are_told_before_anything_runs(self):
        self.write("a.toml", CONFIG)
        self.write("b.toml", CHANGED)
        self.expect(2, ["do not differ in a group 'memory.l2'", "did you mean 'memory.l1'?"], "ablate", "a.toml", "b.toml", "--order", "memory.l2")
        self.expect(2, ["do not differ in a group 'bvh'", "core.warps, memory.l1, rt.child_order"], "ablate", "a.toml", "b.toml", "--order", "bvh")
        self.expect(2, ["'a.toml' and 'a.toml' do not differ"], "ablate", "a.toml", "a.toml")
        self.expect(2, ["do not differ in what --only names"], "ablate", "a.toml", "b.toml", "--only", "bvh")
        self.expect(2, ["mobil"], "ablate", "mobil", "b.toml")
        self.assertFalse((self.folder / "out").exists())


if __name__ == "__main__":
    main()

# Tests a sweep of many tiny points: each is there once, the index can be made again, and nothing is run twice.
# SPDX-License-Identifier: Apache-2.0
"""usage: many_test.py GLINT SOURCE_DIR

A stand-in takes the simulator's place, so that what is tested is the sweep: its store, its locks, its index and its tables. GLINT_SWEEP_POINTS is the
number of points, a multiple of 100. 20000 take some 25 minutes on two cores that do other work, too, and the default half a minute."""
import collections
import os
import subprocess
import sys

from sweeps_case import SweepTest, main, points_in

COUNT, LARGE = int(os.environ.get("GLINT_SWEEP_POINTS", "400")), 20000
RUN = "import sys, glint.sweeps as s; sys.exit(s.run('sweep.toml', engine=s.Engine(workers=1), glint=sys.argv[1]).left)"


class Many(SweepTest):
    def setUp(self):
        super().setUp()
        self.runs, self.store = self.folder / "runs", self.folder / "store"
        self.program = self.stand_in(f"echo >> {self.runs}")
        latencies, budgets = list(range(1000, 1000 + COUNT // 100)), list(range(1_000_000, 1_000_100))
        self.write(f"""workloads = ["WKND_SH"]
store = "store"
[run]
size = "8x8"
spp = 1
[[design]]
keys = {{ core.launch_latency = {latencies}, core.instruction_budget = {budgets} }}
""")
        self.wanted = {(str(latency), str(budget)) for latency in latencies for budget in budgets}

    def run_with(self, submitters):
        """Runs the sweep with so many processes at once, and returns how many runs they have started."""
        before = len(self.runs.read_text().splitlines()) if self.runs.exists() else 0
        all_of_them = [subprocess.Popen([sys.executable, "-c", RUN, self.program], cwd=self.folder) for _ in range(submitters)]
        self.assertEqual([child.wait() for child in all_of_them], [0] * submitters)
        return len(self.runs.read_text().splitlines()) - before

    def collected(self):
        """Returns the rows of the sweep, which has to be complete."""
        found = self.sweeps.collect("sweep", self.store)
        self.assertEqual((found.missing, found.failures, found.damaged), (0, [], []))
        return found.rows

    def test_two_processes_at_once_run_each_point_once_and_the_tables_have_all(self):
        self.assertEqual(self.run_with(submitters=2), COUNT)
        ids = points_in(self.store)
        self.assertEqual((len(ids), len(set(ids))), (COUNT, COUNT))

        rows = self.collected()
        self.assertEqual([int(row["index"]) for row in rows], list(range(COUNT)))
        self.assertEqual({row["id"] for row in rows}, set(ids))
        keys = collections.Counter((str(row["core.launch_latency"]), str(row["core.instruction_budget"])) for row in rows)
        self.assertEqual((set(keys), max(keys.values())), (self.wanted, 1))

        index = self.store / "index.sqlite"
        index.unlink()
        self.assertEqual(self.collected(), rows)
        self.assertTrue(index.exists())

        self.assertEqual(self.run_with(submitters=1), 0)
        self.assertIn(f"{COUNT} points, {COUNT} different: {COUNT} done, 0 failed, 0 left", self.glint("status", "sweep", "--store", "store").stdout)
        if COUNT < LARGE:
            print(f"SKIPPED: a sweep of {LARGE} points; GLINT_SWEEP_POINTS={LARGE} runs it, and {COUNT} points ran")


if __name__ == "__main__":
    main()

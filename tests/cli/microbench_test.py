# Tests that `glint microbench` measures configurations other than the reference, and says what does not fit.
# SPDX-License-Identifier: Apache-2.0
"""usage: microbench_test.py GLINT SOURCE_DIR"""
import json

import glint_case
from glint_case import GlintTest


class Microbench(GlintTest):
    def measure(self, *arguments):
        """Returns the values by name and parameter, with None for '-', and the text of stderr."""
        done = self.glint("microbench", *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = done.stdout.splitlines()
        value, unit = lines[0].index("parameter") + len("parameter"), len(lines[0].rstrip()) - len("unit")
        return {" ".join(line[:value].split()): None if line[value:unit].strip() == "-" else float(line[value:unit]) for line in lines[1:]}, done.stderr

    def test_writes_are_not_faster_than_the_memory_they_go_to(self):
        channel = ["--config", "mobile", "--set", "memory.dram.model=simple", "--set", "cores=2", "--set", "memory.dram.channels=1", "--set", "memory.l2.slice_size=65536"]
        values, _ = self.measure(*channel, "--only", "DRAM write")
        self.assertLess(values["bw DRAM write 8GiB"], 14.0)  # 16 bits at 7 GT/s
        self.assertGreater(values["bw DRAM write 8GiB"], 0.5 * 14.0)

    def test_a_back_edge_costs_what_its_instructions_do_however_slow_the_loop_s_own_are(self):
        for latency in (2, 10, 30):
            values, _ = self.measure("--config", "mobile", "--set", f"core.units.branch.latency={latency}", "--set", "core.units.fp32.interval=1", "--only", "back edge")
            fast = values["branch back edge of a loop"]
            values, _ = self.measure("--config", "mobile", "--set", f"core.units.branch.latency={latency}", "--set", "core.units.fp32.interval=2", "--only", "back edge")
            self.assertLessEqual(abs(values["branch back edge of a loop"] - fast), 4)
            self.assertGreaterEqual(fast, latency)

    def rays(self, text, *settings):
        """Returns the values of the rows of rays with this text, by name and parameter, on one core of `mobile`."""
        rows = json.loads(self.glint("microbench", "--config", "mobile", "--set", "cores=1", *settings, "--only", text, "--format", "json").stdout)
        return {(row["name"], row["param"]): row["value"] for row in rows}

    def test_triangles_are_tested_at_the_rate_of_the_unit(self):
        for interval in (1, 4):
            found, = self.rays("triangles in one ray", "--set", f"rt.triangle.interval={interval}").values()
            self.assertLessEqual(found, 1 / interval)
            self.assertGreater(found, 0.6 / interval)

    def test_a_hit_takes_longer_in_a_deeper_tree_and_a_miss_takes_least(self):
        values = self.rays("of one ray triangles")
        hits = [values["hit of one ray", f"triangles={4 ** i}"] for i in (0, 2, 4, 6, 8)]
        self.assertEqual(hits, sorted(hits))
        self.assertGreater(hits[4], 1.5 * hits[0])
        self.assertLess(values["miss of one ray", "triangles=1"], hits[0])

    def test_a_core_of_sixteen_warps_is_measured_but_for_what_needs_more(self):
        values, said = self.measure("--config", "mobile", "--set", "core.warps=16", "--only", "fma.rn.f32", "--only", "bar.sync")
        self.assertEqual(values["latency fma.rn.f32"], 4)
        self.assertGreater(values["throughput fma.rn.f32"], 60)
        self.assertGreater(values["bar bar.sync 0 warps=16"], values["bar bar.sync 0 warps=8"])
        self.assertIsNone(values["bar bar.sync 0 warps=32"])
        for part in ("1 benchmarks", "bar.sync 0 warps=32", "32 warps, and 16 fit"):
            self.assertIn(part, said)

    def test_reads_of_the_l2_are_slower_than_l1s_and_faster_than_dram_on_any_machine(self):
        for more in ([], ["--set", "cores=4"], ["--set", "memory.l1.size=131072"]):
            done = self.glint("microbench", "--config", "mobile", *more, "--only", "bw L2", "--only", "bw DRAM read", "--only", "L1 .ca v4", "--format", "json")
            values = {row["name"]: row["value"] for row in json.loads(done.stdout)}
            cores = 4 if "cores=4" in more else 8
            with self.subTest(more):
                self.assertLess(values["L2 read 8MiB x128"], 0.7 * cores * values["L1 .ca v4"] * 1.365)
                self.assertGreater(values["L2 read 8MiB x128"], 1.5 * values["DRAM read 8GiB"])

    def test_an_l2_that_is_no_larger_than_the_l1s_is_not_measured_and_the_row_says_why(self):
        self.expect(2, ["has no room for a buffer that L1s of 1048576 bytes cannot keep"],
                    "microbench", "--config", "mobile", "--set", "memory.l1.size=1048576", "--only", "bw L2")

    def test_a_result_as_csv_is_a_comparison_file_with_no_errors(self):
        only = ["--config", "mobile", "--only", "shared chase", "--only", "L1 .ca v4"]
        text = self.glint("microbench", *only, "--format", "csv").stdout
        rows = [line.split(",")[:4] for line in text.splitlines()]
        self.assertEqual(rows[0], ["group", "name", "param", "value"])
        self.write("four.csv", "".join(",".join(row) + "\n" for row in rows))
        self.write("more.csv", text)
        for name in ("four.csv", "more.csv"):
            listed = json.loads(self.glint("microbench", *only, "--compare", name, "--format", "json").stdout)
            self.assertEqual([(row["measured"], row["error"]) for row in listed], [(float(row[3]), 0) for row in rows[1:]])
        self.expect(2, ["short.csv:2: error: this row has 2 of 4 columns"], "microbench", *only, "--compare",
                    self.write("short.csv", "group,name,param,value\na,b\n"))
        other = self.expect(0, ["no row of --compare"], "microbench", *only, "--compare", self.write("other.csv", "group,name,param,value\na,b,c,1\n"))
        self.assertIn("shared", other.stdout)

    def test_measuring_nothing_is_an_error(self):
        self.expect(2, ["the groups are latency, throughput"], "microbench", "--only", "no such")
        self.expect(2, ["no benchmark"], "microbench", "--only", "no such")
        self.expect(2, ["shared memory, and a core has 0", "core.shared_bytes"], "microbench", "--config", "mobile", "--set", "core.shared_bytes=0", "--only", "shared chase")


if __name__ == "__main__":
    glint_case.main()

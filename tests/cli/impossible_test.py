# Tests with the real binary that impossible configurations are refused at the line of a key that causes it, before anything runs.
# SPDX-License-Identifier: Apache-2.0
"""usage: impossible_test.py GLINT SOURCE_DIR"""
import glint_case
from glint_case import GlintTest

# Each entry has the text of a configuration, the line that must be named, and what must be said.
WRONG = [
    ("cores = 0", 1, "'cores' is 0, expected 1 to 256 core"),
    ("clock_mhz = -5.0", 1, "'clock_mhz' is -5, expected 1 to 10000 MHz"),
    ("[core]\nwarps = 65", 2, "'core.warps' is 65, expected 1 to 64 warp"),
    ("[core]\nissue = \"gtoo\"", 2, "did you mean \"gto\"?"),
    ("[core.units]\nfp32 = { latency = 0 }", 2, "'core.units.fp32.latency' is 0"),
    ("[core.fetch]\nperfect = false\nsize = 1000\nways = 3", 3, "'core.fetch.size' is 1000 bytes, expected a multiple of 384 bytes (3 ways x 128 bytes)"),
    ("[core.fetch]\nperfect = false\nways = 7", 1, "'core.fetch.size' is 16384 bytes, expected a multiple of 896 bytes"),
    ("[core.constant]\nperfect = false\nline = 48", 3, "'core.constant.line' is 48 bytes, expected a power of two"),
    ("[core.constant]\nperfect = false\nsize = 1000", 3, "'core.constant.size' is 1000 bytes, expected a multiple of 256 bytes"),
    ("[core.constant]\nperfect = false\n[core.code_cache]\nsize = 5000", 4, "'core.code_cache.size'"),
    ("[memory]\nline = 96", 2, "'memory.line' is 96 bytes, expected a power of two"),
    ("[memory]\ninterleave = 64", 2, "'memory.interleave' is 64 bytes"),
    ("[memory.l1]\nsize = 100", 2, "expected at least one line of 128 bytes"),
    ("[memory.l1]\n\nsize = 32768\nways = 7", 3, "expected a multiple of 896 bytes (7 ways x 128 bytes)"),
    ("[memory.l1]\nports = 0", 2, "no access would ever be taken"),
    ("[memory.l1]\nmshr_entries = 0", 2, "no miss could ever leave the cache"),
    ("[memory.l1]\nallocate = \"on_miss\"\nmiss_queue = 1", 3, "a miss and the write-back of its victim"),
    ("[memory.noc]\ncore_reply_bytes = 0", 2, "packets must move"),
    ("[memory.noc]\nsides = 9", 2, "expected at most the 4 slices"),
    ("[memory.noc]\nfar_latency = 10", 2, "nothing lies far"),
    ("[memory.l2]\ndram_queue = 7", 2, "the sectors of a line and of its victim"),
    ("[memory.dram]\nchannels = 0", 2, "at least one memory partition"),
    ("[memory.dram]\nbanks = 10", 2, "expected a multiple of 'memory.dram.bank_groups'"),
    ("[memory.dram]\nkind = \"gddr5\"", 2, "expected one of: gddr6_7000"),
    ("[memory.dram]\nrc = 1.0", 2, "expected at least 'memory.dram.ras'"),
    ("[memory.dram]\nrefresh = \"all_bank\"\nrefi = 100.0", 3, "nothing but refreshes would ever happen"),
    ("[rt]\nrequest_bytes = 48", 2, "'rt.request_bytes' is 48, expected a multiple of the sector of 32 bytes"),
    ("[rt]\nstack = \"sort_stack\"", 2, "did you mean \"short_stack\"?"),
    ("[bvh]\nformat = \"bvh3\"", 2, "expected one of: bvh2, bvh4, bvh6, bvh8"),
]


class Impossible(GlintTest):
    def test_each_is_refused_at_its_line(self):
        for text, line, said in WRONG:
            with self.subTest(text=text):
                self.write("gpu.toml", text + "\n")
                done = self.expect(2, [f"gpu.toml:{line}:", said], "describe", "--config", "gpu.toml")
                self.assertEqual(done.stdout, "")

    def test_a_run_refuses_it_too_and_leaves_no_directory(self):
        self.write("gpu.toml", "[memory.l1]\nsize = 100\n")
        for mode in ("timing", "functional"):
            self.expect(2, ["gpu.toml:2:"], "run", "WKND", "--config", "gpu.toml", "--mode", mode, "--out", "out")
        self.assertFalse((self.folder / "out").exists())

    def test_several_are_told_at_once_each_at_its_place_and_settings_by_their_text(self):
        self.write("gpu.toml", "[core.constant]\nperfect = false\nsize = 1000\n")
        self.expect(2, ["gpu.toml:3:", "--set memory.l1.ports=0"], "describe", "--config", "gpu.toml", "--set", "memory.l1.ports=0")


class Statistics(GlintTest):
    def test_describe_explains_statistics_with_or_without_an_instance_and_a_part(self):
        for name in ("gpu.core[*].issue_slots", "gpu.core[12].issue_slots", "gpu.core[0].issue_slots::raw_fixed"):
            done = self.expect(0, [], "describe", name)
            self.assertEqual(done.stdout.splitlines(), ["gpu.core[*].issue_slots", "  Cycles of all schedulers, by what each was spent on.", "  unit   cycle"])

    def test_describe_explains_every_statistic_that_is_listed(self):
        names = [line.split()[0] for line in self.glint("list", "stats").stdout.splitlines()]
        self.assertGreater(len(names), 200)
        shown = self.glint("describe", "gpu").stdout
        for name in names:
            self.assertIn(name + "\n", shown)

    def test_a_statistic_that_is_none_is_refused_with_the_nearest(self):
        self.expect(2, ["did you mean 'gpu.memory.load_latency.p50'?"], "describe", "gpu.memory.load_latency.p51")


if __name__ == "__main__":
    glint_case.main()

# Tests `glint lab`: experiments, their arms, and the table beside the published effects.
# SPDX-License-Identifier: Apache-2.0
"""usage: lab_test.py GLINT SOURCE_DIR [SUITE...]"""
import csv
import json
import math
import re

from glint_case import ROOT, GlintTest, main

SMALL = '''title = "{title}"
source = "a test"
config = "vulkan-sim-mobile"
workloads = ["SHIP_SH", "WKND_SH"]
size = "16x16"

[[arm]]
name = "base"

[[arm]]
name = "other"
against = "base"
set = ["{setting}"]
published = {published}
expected = [0.2, 5]
figure = [{{ name = "nodes a ray", formula = "sum(rt.nodes) / sum(rt.rays)" }},
          {{ name = "rays, ratio", formula = "sum(rt.rays)", ratio = true, expected = [1, 1] }}]
'''


class LabTest(GlintTest):
    def lab(self, code, *arguments):
        done = self.glint("lab", *arguments)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def rows(self, folder):
        with open(self.folder / folder / "lab.csv", newline="") as file:
            return list(csv.DictReader(file))

    def stat(self, run, name):
        with open(self.folder / run / "stats.csv", newline="") as file:
            return next(float(row[1]) for row in csv.reader(file) if row[0] == name)

    def experiment(self, setting="memory.l2.latency=300", published=0.5):
        return self.write("mine.toml", SMALL.format(title="Fewer warps", setting=setting, published=published))


class Files(LabTest):
    def test_the_list_has_every_experiment_and_each_can_be_read(self):
        listed = {line.split()[0] for line in self.lab(0).stdout.splitlines()}
        self.assertEqual(listed, {path.stem for path in (ROOT / "labs").glob("*.toml")})

    def test_mistakes_are_told_with_their_lines(self):
        self.write("bad.toml", 'title = "x"\nsource = "y"\nconfig = "mobile"\n[[arm]]\nname = "A b"\npublished = 2\n'
                               '[[arm]]\nname = "c"\nagainst = "zz"\nexpected = [2, 1]\nlest = 3\n')
        self.expect(2, ["bad.toml:4", "small letters", "no 'against'", "bad.toml:10", "the smaller first", "did you mean 'least'?",
                        "'zz', which is no arm before it"], "lab", "bad.toml")
        self.write("bad.toml", 'title = "x"\nsource = "y"\nconfig = "mobile"\nsize = "8"\nworkloads = ["SHIPP_SH"]\n[[arm]]\nname = "a"\nworkloads = ["nosuch"]\n')
        self.expect(2, ["bad.toml:4:1: error: --size is '8'", "bad.toml:5:1: error: there is no workload or suite 'SHIPP_SH'", "did you mean 'SHIP_SH'?",
                        "bad.toml:8:1: error: there is no workload or suite 'nosuch'"], "lab", "bad.toml")
        self.expect(2, ["c.toml:3:1: error: there is no configuration 'mobil'"], "lab",
                    self.write("c.toml", 'title = "x"\nsource = "y"\nconfig = "mobil"\n[[arm]]\nname = "a"\n'))
        self.expect(2, ["at least one [[arm]]"], "lab", self.write("none.toml", 'title = "x"\nsource = "y"\nconfig = "mobile"\n'))
        self.expect(2, ["mine.toml:16:11: error: 'sum(rt.nodes) /' is not a formula"], "lab", self.write("mine.toml", SMALL.format(title="x", setting="rt.warps=1", published=1)
                                                                   .replace("/ sum(rt.rays)", "/")))
        self.expect(2, ["no experiment 'ttp62'", "did you mean 'ttp26'?"], "lab", "ttp62")
        self.expect(2, ["has no arm 'turbo'", "stack_trend"], "lab", "ttp26", "--arms", "turbo")
        self.expect(2, ["none of these workloads: SHIP_AO"], "lab", self.experiment(), "--workloads", "SHIP_AO")
        self.expect(2, ["'other' runs WKND_AO", "'base' does not"], "lab", self.write("more.toml", SMALL.format(
            title="x", setting="rt.warps=1", published=1).replace('against = "base"', 'against = "base"\nworkloads = ["WKND_AO"]')))
        self.expect(2, ["rt.wraps"], "lab", self.experiment("rt.wraps=1"))
        self.assertFalse((self.folder / "out/lab-ttp26").exists())


class Runs(LabTest):
    def test_speedups_are_quotients_of_cycles_and_their_mean_is_geometric(self):
        text = self.lab(0, self.experiment()).stdout
        rows = [row for row in self.rows("out/lab-mine") if not row["figure"]]
        self.assertEqual([(row["arm"], row["workload"]) for row in rows],
                         [("base", "SHIP_SH"), ("base", "WKND_SH"), ("other", "SHIP_SH"), ("other", "WKND_SH")])
        speedups = []
        for row in rows:
            cycles = self.stat(f"out/lab-mine/{row['arm']}/{row['workload']}", "gpu.cycles")
            self.assertEqual(float(row["cycles"]), cycles)
            if row["arm"] == "other":
                speedups.append(self.stat(f"out/lab-mine/base/{row['workload']}", "gpu.cycles") / cycles)
                self.assertAlmostEqual(float(row["speedup"]), speedups[-1])
        self.assertTrue(all(speedup != 1 for speedup in speedups))
        self.assertIn(f"{math.exp(sum(map(math.log, speedups)) / 2):.3f}", text)
        self.assertEqual(text.count(" as expected"), 2)
        figures = {(row["workload"], row["figure"]): float(row["value"]) for row in self.rows("out/lab-mine") if row["figure"]}
        self.assertEqual(figures["SHIP_SH", "rays, ratio"], 1)
        self.assertGreater(figures["SHIP_SH", "nodes a ray"], 5)

    def test_another_machine_has_a_folder_of_its_own(self):
        text = self.lab(0, self.experiment(), "--config", "mobile", "--workloads", "SHIP_SH").stdout
        self.assertIn("machine: mobile", text)
        self.assertTrue((self.folder / "out/lab-mine-mobile/base/SHIP_SH/run.json").exists())

    def test_an_arm_has_the_reach_of_the_experiment_or_its_own(self):
        text = SMALL.format(title="x", setting="rt.warps=1", published=1).replace("_SH", "_AO").replace('size =', 'ao_reach = 30\nsize =')
        self.lab(0, self.write("mine.toml", text.replace('against = "base"', 'against = "base"\nao_reach = 0')), "--workloads", "SHIP_AO")
        reach = lambda arm: json.loads((self.folder / f"out/lab-mine/{arm}/SHIP_AO/run.json").read_text())["rays"].get("ao_reach")
        self.assertEqual((reach("base"), reach("other")), (30, None))
        self.expect(2, ["bad.toml:", "'ao_reach'", "0 to 100"], "lab", self.write("bad.toml", text.replace("30", "300")))

    def test_what_is_complete_is_not_run_again(self):
        name = self.experiment()
        self.lab(0, name, "--arms", "base")
        before = (self.folder / "out/lab-mine/base/SHIP_SH/run.json").stat().st_mtime_ns
        self.assertIn("2 of them complete", self.lab(0, name).stdout)
        self.assertEqual((self.folder / "out/lab-mine/base/SHIP_SH/run.json").stat().st_mtime_ns, before)

    def test_a_flipped_sign_fails_the_check_and_only_the_check(self):
        self.assertIn("NOT as expected", self.lab(0, self.write("no.toml", SMALL.format(title="x", setting="memory.l2.latency=300", published=2)
                                                                .replace("[0.2, 5]", "[4, 5]")), "--workloads", "SHIP_SH").stdout)
        done = self.lab(1, self.experiment(published=2), "--check", "--workloads", "SHIP_SH")
        self.assertIn("has not the published sign: other", done.stderr)


class Pairs(LabTest):
    TEXT = """title = "Pairs"
source = "a test"
config = "vulkan-sim-mobile"
workloads = ["SHIP_SH"]
size = "16x16"
pairs = true
""" + "".join(f"""
[[arm]]
name = "{name}"
{against}set = [{keys}]
""" for name, against, keys in (("base", "", ""), ("prefetch", 'against = "base"\n', '"rt.prefetch=stack_trend", "rt.warps=4"'), ("helpers", 'against = "base"\n', '"rt.mapping=cooperative"'),
                                ("trail", 'against = "base"\n', '"rt.stack=restart_trail", "rt.warps=4"'), ("other", 'against = "base"\n', '"rt.prefetch=none"')))

    def test_each_two_arms_run_together_and_refused_pairs_say_why(self):
        text = self.lab(0, self.write("mine.toml", self.TEXT)).stdout
        speedups = {row["arm"]: row["speedup"] for row in self.rows("out/lab-mine")}
        self.assertEqual(set(speedups), {"base", "prefetch", "helpers", "trail", "other", "prefetch+helpers", "prefetch+trail", "helpers+other", "trail+other"})
        config = (self.folder / "out/lab-mine/prefetch+helpers/SHIP_SH/config.toml").read_text()
        self.assertIn('prefetch = "stack_trend"', config)
        self.assertIn('mapping = "cooperative"', config)
        self.assertIn('prefetch and other: both change rt.prefetch\n', text)
        self.assertRegex(text, r'helpers and trail: rt\.mapping = "cooperative" does not go with rt\.stack = "restart_trail": that stack')
        row = re.search(r"^prefetch +(\S+) +(\S+) +(\S+) +(\S+)", text[text.index("\npairs "):], re.M).groups()
        self.assertEqual(row, (*(f"{float(speedups[name]):.3f}" for name in ("prefetch", "prefetch+helpers", "prefetch+trail")), "refused"))

    def test_an_impossible_arm_is_refused_before_anything_runs(self):
        self.expect(2, ["the arm 'trail' of 'mine' is refused", "short_stack"], "lab", self.write("mine.toml", self.TEXT.replace("restart_trail", "short_stak")))
        self.assertFalse((self.folder / "out").exists())


class Page(LabTest):
    def test_the_page_has_the_tables_and_can_be_made_again(self):
        self.assertIn("out/lab-mine/report.html", self.lab(0, self.experiment()).stdout)
        page = (self.folder / "out/lab-mine/report.html").read_bytes()
        text = page.decode()
        document = json.loads((self.folder / "out/lab-mine/lab.json").read_text())
        other = document["arms"][1]
        for part in ('id="lab"', 'data-table="lab-arms"', 'data-table="lab-workloads"', f"{other['here']:.3f}", "0.500", "0.2 to 5", "nodes a ray", "SHIP_SH"):
            self.assertIn(part, text)
        self.assertEqual(document["size"], "16x16")
        self.assertEqual([one["workload"] for one in other["workloads"]], ["SHIP_SH", "WKND_SH"])
        (self.folder / "out/lab-mine/report.html").unlink()
        self.assertEqual(self.glint("report", "out/lab-mine").returncode, 0)
        self.assertEqual((self.folder / "out/lab-mine/report.html").read_bytes(), page)

    def test_the_page_shows_pairs_and_escapes_names(self):
        self.lab(0, self.write("mine.toml", Pairs.TEXT.replace('"Pairs"', '"Pairs <b>"')), "--arms", "prefetch+helpers", "helpers", "prefetch")
        text = (self.folder / "out/lab-mine/report.html").read_text()
        self.assertIn("Pairs &lt;b&gt;", text)
        self.assertIn('data-table="lab-pairs"', text)
        self.assertNotIn("<b>", text.split("<script")[0])

    def test_a_damaged_document_is_refused(self):
        self.lab(0, self.experiment(), "--workloads", "SHIP_SH")
        path = self.folder / "out/lab-mine/lab.json"
        good = path.read_text()
        for damage, parts in ((good[:100], ["lab.json", "no result of an experiment"]), (good.replace('"schema": 1', '"schema": 7'), ["schema 7, expected 1"]),
                              (good.replace('"arms"', '"arm"'), ["cannot be shown", "run `glint lab` again"])):
            path.write_text(damage)
            self.expect(2, parts, "report", "out/lab-mine")


class Oracles(LabTest):
    def cycles(self, workload, config, *options):
        """Returns cycles and picture of a run on one core, so that its unit has more warps than it holds."""
        done = self.glint("run", workload, "--size", "32x32", "--spp", "1", "--config", config, "--set", "cores=1", "--out", "run", *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        return self.stat("run", "gpu.cycles"), (self.folder / "run/image.png").read_bytes()

    def names(self):
        return [line.split()[0] for line in self.glint("list", "oracles").stdout.splitlines()]

    def test_every_oracle_bounds_and_changes_no_picture(self):
        gains = dict.fromkeys(self.names(), 0)
        for workload, config in (("SHIP_PT", "mobile"), ("SHIP_SH", "vulkan-sim-mobile"), ("CHSNT_PT", "mobile")):
            base, picture = self.cycles(workload, config)
            for name in gains:
                cycles, same = self.cycles(workload, config, "--oracle", name)
                with self.subTest(workload=workload, name=name):
                    self.assertEqual(same, picture)
                    self.assertLessEqual(cycles, base)
                gains[name] += cycles < 0.97 * base
        self.assertTrue(all(gains.values()), gains)

    def test_skipping_to_events_changes_no_count_under_an_oracle(self):
        for name in ("no_divergence", "perfect_prediction"):
            stats = []
            for options in ([], ["--no-skip"]):
                self.cycles("CHSNT_PT" if name == "no_divergence" else "SHIP_SH", "mobile", "--oracle", name, "--set", "rt.warps=2", *options)
                stats.append((self.folder / "run/stats.csv").read_bytes())
            self.assertEqual(*stats)

    def test_a_setting_wins_over_an_oracle_and_benches_and_experiments_take_oracles(self):
        config = lambda: (self.folder / "run/config.toml").read_text()
        self.cycles("SHIP_SH", "mobile", "--oracle", "infinite_tests", "--set", "rt.box.latency=7")
        self.assertRegex(config(), r"(?s)\[rt\.box\].*?latency = 7\b.*?units = 4096\b")
        self.cycles("SHIP_SH", "desktop", "--oracle", "ideal_memory")
        own, like = ([line for line in self.glint("describe", "memory", "--config", one).stdout.splitlines() if " = " in line] for one in ("run/config.toml", "ideal-memory"))
        self.assertEqual(own, like)
        self.assertEqual(self.glint("bench", "SHIP_SH", "--size", "8x8", "--spp", "1", "--oracle", "perfect_prefetch", "--out", "bench").returncode, 0)
        self.assertIn("fetch_hits = true", (self.folder / "bench/SHIP_SH/config.toml").read_text())
        text = SMALL.format(title="x", setting="rt.warps=4", published=1).replace('against = "base"', 'against = "base"\noracle = ["perfect_prefetch"]')
        self.lab(0, self.write("mine.toml", text), "--workloads", "SHIP_SH", "--oracle", "infinite_tests")
        for arm, hits in (("base", "false"), ("other", "true")):
            text = (self.folder / f"out/lab-mine/{arm}/SHIP_SH/config.toml").read_text()
            self.assertIn(f"fetch_hits = {hits}", text)
            self.assertIn("units = 4096", text)

    def test_an_unknown_oracle_is_refused(self):
        self.expect(2, ["perfect_prefetch"], "run", "SHIP_SH", "--oracle", "perfect_cache")
        self.expect(2, ["there is no oracle 'ideal_memroy'", "did you mean 'ideal_memory'?"], "describe", "--set", "oracle=ideal_memroy")


class Effects(LabTest):
    """The published effects keep their sign on a small set."""

    def speedups(self, name, arms, *workloads):
        """Returns the speed-ups by arm and workload, after the check that no sign is flipped."""
        self.lab(0, name, "--arms", *arms, "--workloads", *workloads, "--size", "32x32", "--check")
        return {(row["arm"], row["workload"]): float(row["speedup"]) for row in self.rows(f"out/lab-{name}") if row["speedup"] and not row["figure"]}

    def test_the_prefetcher_speeds_up_a_ship_and_no_scene_is_slower(self):
        got = self.speedups("ttp26", ["stack_trend", "perfect-prefetch", "stack_trend-ao", "stack_trend-sh"], "SHIP_PT", "BUNNY_PT", "WKND_PT", "SHIP_AO", "SHIP_SH")
        self.assertGreater(got["stack_trend", "SHIP_PT"], 1.2)
        self.assertGreater(got["stack_trend", "SHIP_PT"], got["stack_trend-ao", "SHIP_AO"])
        for workload in ("SHIP_PT", "BUNNY_PT", "WKND_PT"):
            self.assertGreaterEqual(got["stack_trend", workload], 0.98)
            self.assertGreaterEqual(got["perfect-prefetch", workload], got["stack_trend", workload])
        figures = {row["figure"]: float(row["value"]) for row in self.rows("out/lab-ttp26") if row["figure"] and row["workload"] == "SHIP_PT"}
        self.assertGreater(figures["accuracy in the L1"], 0.9)
        self.assertAlmostEqual(figures["DRAM sectors read, ratio"], 1, delta=0.05)

    def test_helpers_speed_up_paths_most_and_more_with_wider_groups(self):
        got = self.speedups("coop25", ["cooperative", "subwarps-of-8", "subwarps-of-4", "cooperative-ao", "cooperative-sh"], "SHIP_PT", "WKND_PT", "SHIP_AO", "SHIP_SH")
        self.assertGreater(got["cooperative", "SHIP_PT"], 1.3)
        self.assertGreaterEqual(got["cooperative", "SHIP_PT"], got["subwarps-of-8", "SHIP_PT"])
        self.assertGreater(got["subwarps-of-8", "SHIP_PT"], got["subwarps-of-4", "SHIP_PT"])
        self.assertLess(got["cooperative", "WKND_PT"], got["cooperative", "SHIP_PT"])
        for arm, workload in (("cooperative-ao", "SHIP_AO"), ("cooperative-sh", "SHIP_SH")):
            self.assertLess(got[arm, workload], got["cooperative", "SHIP_PT"])

    def test_perfect_prediction_has_room(self):
        got = self.speedups("pred21", ["perfect-prediction"], "SHIP_AO", "SPNZA_AO")
        self.assertGreater(got["perfect-prediction", "SPNZA_AO"], 1.3)
        self.assertGreater(got["perfect-prediction", "SHIP_AO"], 1)

    def test_treelets_read_ahead_speed_up_a_ship_and_more_with_16_warps_than_with_4(self):
        got = self.speedups("treelet23", ["treelet", "two-stacks", "treelet-4-warps"], "SHIP_PT", "BUNNY_PT")
        self.assertGreater(got["treelet", "SHIP_PT"], 1.05)
        self.assertGreater(got["treelet", "SHIP_PT"], got["two-stacks", "SHIP_PT"])
        self.assertGreater(got["treelet", "SHIP_PT"], got["treelet-4-warps", "SHIP_PT"])


if __name__ == "__main__":
    main()

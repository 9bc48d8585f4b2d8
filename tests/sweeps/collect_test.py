# Tests what a sweep's results become: tables, the index, effects of keys, the front, and the page in a browser.
# SPDX-License-Identifier: Apache-2.0
"""usage: collect_test.py GLINT SOURCE_DIR [Tables|Effects|Page]. The page opens in Chromium, and its test skips where there is none."""
import csv
import importlib.util
import random
import os
import re
import shutil
import subprocess
import sys
import time

from sweeps_case import SKIPPED, TINY, SweepTest, main, points_in

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
SWEEP = """
name = "small"
workloads = ["WKND_SH", "SHIP_SH"]
store = "store"
objectives = ["cycles", "thread_ipc:max"]
[run]
size = "8x8"
spp = 1
[[design]]
keys = { rt.warps = [2, 4], core.warps = [0, 8] }
"""


class Tables(SweepTest):
    def collected(self):
        self.glint("collect", "sweep.toml", "--out", "tables")
        return {path.name: path.read_bytes() for path in (self.folder / "tables").iterdir() if path.name != "costs.csv"}

    def test_tables_have_a_row_for_each_point_and_the_same_bytes_each_time(self):
        self.write(SWEEP.replace("[0, 8]", "[4, 8]"))
        self.glint("run", "sweep.toml")
        first = self.collected()
        rows = list(csv.DictReader(first["points.csv"].decode().splitlines()))
        self.assertEqual([(row["workload"], row["rt.warps"], row["core.warps"]) for row in rows], [(w, r, c) for w in ("WKND_SH", "SHIP_SH") for r in "24" for c in "48"])
        self.assertTrue(all(float(row["cycles"]) > 0 for row in rows))
        self.assertNotIn("sim_rate", rows[0])
        self.assertEqual(len(list(csv.DictReader((self.folder / "tables/costs.csv").read_text().splitlines()))), 8)
        self.assertEqual(self.collected(), first)
        for damage in (lambda path: path.unlink(), lambda path: path.write_bytes(b"damaged" * 1000)):
            damage(self.folder / "store/index.sqlite")
            self.assertEqual(self.collected(), first)

    def test_failures_and_points_to_come_are_told(self):
        program = self.stand_in('case "$*" in *rt.warps=2*) exit 3 ;; esac')
        found = self.sweeps.run({**TINY, "design": [{"keys": {"rt.warps": [2, 4]}}], "retry": {"crash": 0}}, self.folder / "store", glint=program)
        self.assertEqual(len(found.failures), 1)
        collected = self.sweeps.collect("sweep", self.folder / "store")
        self.assertEqual((len(collected.rows), [record["kind"] for record in collected.failures], collected.missing), (1, ["unsupported"], 0))
        shutil.rmtree(self.folder / "store/points")
        (self.folder / "store/index.sqlite").unlink()
        self.assertEqual(self.sweeps.collect("sweep", self.folder / "store").missing, 1)

    def test_parquet_has_the_rows_of_the_csv(self):
        if not importlib.util.find_spec("pyarrow"):
            print("SKIPPED: collect_test.py Tables: no pyarrow, so Parquet was not tried")
            self.write('workloads = ["WKND_SH"]\n[run]\nsize = "8x8"\nspp = 1\n')
            self.glint("run", "sweep.toml")
            self.assertIn("points.parquet was left out", self.glint("collect", "sweep.toml").stderr)
            return
        import pyarrow.parquet
        self.write(SWEEP.replace("[0, 8]", "[4, 8]"))
        self.glint("run", "sweep.toml")
        rows = list(csv.DictReader(self.collected()["points.csv"].decode().splitlines()))
        self.assertEqual([str(value) for value in pyarrow.parquet.read_table(self.folder / "tables/points.parquet")["id"].to_pylist()], [row["id"] for row in rows])

    def test_an_objective_that_is_no_metric_is_refused(self):
        self.write(SWEEP.replace("[0, 8]", "[4, 8]").replace('"cycles"', '"cycle"'))
        self.assertIn("did you mean", self.glint("run", "sweep.toml", code=2).stderr)


class Effects(SweepTest):
    def test_a_share_is_the_variance_between_the_means(self):
        from glint.sweeps.sensitivity import effects
        rows = [{"a": a, "b": b, "c": c, "y": 10 * a + b} for a in (0, 1) for b in (0, 1) for c in range(5)]
        found = {effect.key: effect for effect in effects(rows, ["a", "b", "c"], "y")}
        self.assertAlmostEqual(found["a"].share, 100 / 101, places=2)
        self.assertEqual(found["c"].share, 0.0)
        self.assertEqual((found["a"].span, found["b"].span, found["c"].span), (10, 1, 0))
        self.assertEqual(found["a"].levels, [("0", 0.5, 10), ("1", 10.5, 10)])
        self.assertLess(found["a"].interval[0], found["a"].share + 0.001)

    def test_first_order_indices_of_a_random_sample_are_near_the_exact_ones(self):
        from glint.sweeps.sensitivity import effects
        source = random.Random(3)
        rows = [{"a": source.random(), "b": source.random()} for _ in range(4000)]
        rows = [{**row, "y": row["a"] + 2 * row["b"]} for row in rows]
        found = {effect.key: effect.share for effect in effects(rows, ["a", "b"], "y")}
        self.assertAlmostEqual(found["a"], 0.2, delta=0.03)
        self.assertAlmostEqual(found["b"], 0.8, delta=0.03)

    def test_keys_whose_values_come_once_do_not_explain_everything(self):
        from glint.sweeps.sensitivity import effects
        rows = [{"a": a, "b": (7 * a) % 16, "y": a} for a in range(16)]  # as in a small sample of wide ranges
        found = {effect.key: effect.share for effect in effects(rows, ["a", "b"], "y")}
        self.assertGreater(found["a"], 0.8)
        self.assertLess(found["b"], 0.5)
        self.assertEqual([effect.share for effect in effects(rows, ["a"], "y")], [1.0])

    def test_total_indices_hold_the_interactions(self):
        from glint.sweeps.sensitivity import sobol
        source, values = random.Random(5), []
        y = lambda a, b, c: (a - 0.5) * (b - 0.5) + 0.2 * c  # noqa: E731
        for _ in range(8000):
            a, b = [source.random() for _ in range(3)], [source.random() for _ in range(3)]
            values += [y(*a), y(*b), *(y(*[b[k] if k == i else a[k] for k in range(3)]) for i in range(3))]
        found = sobol(values, ["a", "b", "c"])
        product, line = 1 / 144, 0.04 / 12  # variances of the two terms
        for key, first, total in (("a", 0, product), ("b", 0, product), ("c", line, line)):
            self.assertAlmostEqual(found[key][0], first / (product + line), delta=0.05)
            self.assertAlmostEqual(found[key][1], total / (product + line), delta=0.05)

    def test_a_sweep_by_saltelli_has_total_indices_of_its_own_keys(self):
        if not importlib.util.find_spec("scipy"):
            print("SKIPPED: collect_test.py Effects: no scipy, so no sweep was sampled by sobol or saltelli")
            return
        keys = {"memory.l2.latency": {"low": 50, "high": 400, "scale": "log"}, "rt.warps": {"low": 1, "high": 8}}
        definition = {**TINY, "design": [{"method": "saltelli", "points": 4, "keys": keys}]}
        found = self.sweeps.run(definition, self.folder / "store")
        self.assertEqual((found.points, found.left), (16, 0))
        effects = self.sweeps.collect("sweep", self.folder / "store").effects("cycles")
        self.assertEqual(effects[0].key, "memory.l2.latency")
        self.assertGreater(effects[0].total, 0.5)
        self.assertTrue(all(effect.total is not None and effect.interval is None for effect in effects))

    def test_the_front_is_what_no_point_beats(self):
        from glint.sweeps.sensitivity import pareto
        source = random.Random(7)
        rows = [{"a": source.randint(0, 30), "b": source.randint(0, 30), "c": source.randint(0, 30)} for _ in range(300)]
        for objectives in ([("a", False), ("b", True)], [("a", False), ("b", False), ("c", True)]):
            signs = [(name, -1 if more else 1) for name, more in objectives]
            beats = lambda p, q: all(s * p[n] <= s * q[n] for n, s in signs) and any(s * p[n] < s * q[n] for n, s in signs)  # noqa: E731
            self.assertEqual(pareto(rows, objectives), [i for i, row in enumerate(rows) if not any(beats(other, row) for other in rows)])


class Page(SweepTest):
    def opened(self, page):
        words = [CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={self.folder}/profile", "--window-size=1280,900", "--enable-logging=stderr", "--dump-dom", page.as_uri()]
        start = time.monotonic()
        done = subprocess.run(words, capture_output=True, text=True, timeout=200)
        return done.stdout, done.stderr, time.monotonic() - start

    def setUp(self):
        super().setUp()
        if not CHROMIUM:
            print("SKIPPED: collect_test.py Page: no Chromium (Debian: chromium)")
            sys.stdout.flush()
            os._exit(SKIPPED)  # unittest would count an exit from here as an error

    def test_the_page_of_a_sweep_shows_its_points_and_what_moves_them(self):
        self.write(SWEEP.replace("[0, 8]", "[4, 8]").replace("[run]", 'stats = "full"\nreport = true\n[run]'))
        self.glint("run", "sweep.toml")
        self.glint("report", "sweep.toml", "--out", "page")
        dom, log, _ = self.opened(self.folder / "page/report.html")
        self.assertNotRegex(log, r"CONSOLE.*(rror|refused)")
        for text in ("8 of 8 points pass the filters", "What moves cycles", "What moves thread_ipc", "on the Pareto front of cycles and thread_ipc"):
            self.assertIn(text, dom)
        self.assertEqual(len(re.findall("<tr data-row", dom)), 8)
        prefix = re.search(r'"prefix":"([^"]+)","file":"report.html"', (self.folder / "page/report.html").read_text())[1]
        for id in points_in(self.folder / "store"):
            self.assertTrue((self.folder / "page" / prefix / id[:3] / id / "report.html").is_file())

    def test_ten_thousand_points_open(self):
        from glint.derived import metrics
        from glint.sweeps.collecting import Collection
        from glint.sweeps.page import page_of
        source, names = random.Random(1), list(metrics())
        keys = ["rt.warps", "core.warps", "memory.l1.size", "memory.l2.latency"]
        rows = []
        for i in range(10000):
            chosen = {"rt.warps": source.randint(1, 16), "core.warps": source.choice([8, 16, 32]), "memory.l1.size": 2 ** source.randint(12, 18), "memory.l2.latency": source.uniform(50, 400)}
            rows.append({"index": i, "id": f"{i:032x}", "workload": source.choice(["WKND_SH", "SHIP_PT"]), "config": "mobile", "seed": 1, **chosen,
                         **{name: source.random() * 1e6 for name in names}, "cycles": 1e6 / chosen["rt.warps"] + 10 * chosen["memory.l2.latency"] * source.random()})
        definition = self.sweeps.Definition("large", ["WKND_SH", "SHIP_PT"], objectives=["cycles", "thread_ipc"])
        path = self.folder / "large.html"
        path.write_text(page_of(Collection(definition, str(self.folder), rows, keys, [], [], 0), self.folder))
        dom, log, seconds = self.opened(path)
        self.assertNotRegex(log, r"CONSOLE.*(rror|refused)")
        self.assertIn("10000 of 10000 points pass the filters", dom)
        self.assertIn('data-ready="yes"', dom)
        drawn = int(re.search(r'data-milliseconds="(\d+)"', dom)[1])
        print(f"a page of 10,000 points has {path.stat().st_size / 1e6:.1f} MB and is drawn after {drawn / 1000:.1f} s; the browser took {seconds:.1f} s from its start to its end")


if __name__ == "__main__":
    main()

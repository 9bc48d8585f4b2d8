# Tests what a sweep says of mistakes in its file, of wrong engines, of a store that cannot be made, and of a check that was killed.
# SPDX-License-Identifier: Apache-2.0
"""usage: mistakes_test.py GLINT SOURCE_DIR [Files|Ranges|Places]"""
import sys
import unittest.mock

from sweeps_case import GLINT, TINY, SweepTest, main

LINES = ['workloads = ["WKND_SH"]', 'store = "store"', "[run]", 'size = "8x8"', "spp = 1", "[[design]]", "keys = { rt.warps = [2, 4] }"]
WHOLE, RANGE = "\n".join(LINES), "rt.warps = { low = %s }"


class Files(SweepTest):
    def refused(self, text, line, words):
        from glint.sweeps.planning import plan
        from glint.sweeps.program import Program
        with self.assertRaises((self.sweeps.SweepError, self.missing)) as caught:
            plan(self.sweeps.read(self.write(text)), Program(str(GLINT)))
        self.assertIn(f"sweep.toml:{line}: ", str(caught.exception))
        self.assertIn(words, str(caught.exception))

    def setUp(self):
        super().setUp()
        from glint.errors import MissingPackage
        self.missing = MissingPackage

    def test_values_of_the_wrong_kind_are_told_with_their_lines(self):
        for line, old, new, words in (
                (2, '"store"', "5", "the path of a folder is needed"), (1, WHOLE, "design = 5\n" + "\n".join(LINES[:5]), "a table [[design]] is needed"),
                (7, LINES[6], LINES[6] + "\n[dask]\nscheduler = 5", "tcp://host:8786"), (7, "[2, 4]", "[1979-05-27]", "a number, a text, true or false"), (7, "[2, 4]", "[[2], [4]]", "integer"),
                (1, "WKND_SH", "WKND\\u0000", "a zero byte"), (7, "keys", "points = 9\nkeys", "takes no `points`"), (7, "keys", "method = 5\nkeys", "`method` is 5: it is one of grid"),
                (1, "WKND_SH", "x" * 300 + ".toml", "xxx.toml"), (2, "store =", "threads = 100000\nstore =", "--threads"),
                (2, "store =", "seeds = [1.5]\nstore =", "a whole number"), (2, "store =", "objectives = []\nstore =", "one metric at least"),
                (7, LINES[6], LINES[6] + "\n[limits]\ntimeout = -5", "no time"), (2, "store =", "constraints = [' ']\nstore =", "an empty text"), (2, "store =", f"constraints = [{'(' * 5000 + '1' + ')' * 5000!r}]\nstore =", "cannot be"),
                (2, "store =", "constraints = ['1 // 0 > rt.warps']\nstore =", "cannot be computed"), (2, "store =", "constraints = ['min(1)()']\nstore =", "may have keys")):
            with self.subTest(new[:60]):
                self.assertIn(old, WHOLE)
                self.refused(WHOLE.replace(old, new), line + 2 * ("[dask]" in new or "[limits]" in new), words)

    def test_ranges_without_meaning_are_told_with_their_lines(self):
        for given, words in (("5, high = 7, scale = 'power2'", "no power of two"), ("1, high = 8, scale = 'power2', step = 1", "no step"), ("1, high = 8, integer = 1", "true or false"),
                             ("0.5, high = 8, step = 1, integer = true", "no whole number"), ("nan, high = 8, step = 1", "not a number"), ("8, high = 8, step = 1", "not below"),
                             ("1, high = 8, step = 0", "not above 0"), ("0, high = 8, scale = 'log', step = 1", "begins above 0"), ("1, hihg = 8", "low and high")):
            with self.subTest(given):
                self.refused(WHOLE.replace("rt.warps = [2, 4]", RANGE % given), 7, words)

    def test_options_that_no_run_takes_are_told_before_anything_runs(self):
        for new, words in (('frames = "5:1"', "expected the first and the last frame"), ("sample-launches = 3", "needs --frames"), ("fps = 3", "belongs to a sequence"),
                           ('sample = 500\nmode = "functional"', "need cycles"), ('frames = "0:3"\nsample-pixels = "5%"', "cannot be used with --frames"),
                           ('frames = "0:1"\nanimation = "walk"', "belongs to glTF files"), ('sample-pixels = "5%"\nsample-seed = -1', "is not a whole number from 0")):
            with self.subTest(new):
                self.refused(WHOLE.replace("spp = 1", new), 5 + (new.startswith("frames") and "animation" in new) + ("seed" in new), words)
        self.refused(WHOLE.replace("WKND_SH", "gaussian").replace("spp = 1", "profile = true"), 5, "cannot be used with compute programs")

    def test_sweeps_of_too_many_points_are_refused_at_once(self):
        self.refused("replicas = 10_000_000\n" + WHOLE, 1, "a sweep may have 4,000,000 points")
        self.refused(WHOLE.replace("store =", "replicas = 3_000_000\nstore ="), 7, "3,000,000 seeds = 6,000,000 points")

    def test_a_sweep_whose_file_has_no_name_for_a_folder_needs_one(self):
        (self.folder / "my sweep.toml").write_text(WHOLE)
        self.assertIn("give it a `name`", self.glint("run", "my sweep.toml", code=2).stderr)

    def test_a_file_that_is_no_text_is_told_with_its_line(self):
        (self.folder / "latin.toml").write_bytes(WHOLE.replace("8x8", "8x8\xe9").encode("latin-1"))
        self.assertIn("latin.toml:4: the file is no TOML: byte 0xe9", self.glint("run", "latin.toml", code=2).stderr)

    def test_samples_without_scipy_say_what_to_install(self):
        for method in ("sobol", "saltelli"):
            with unittest.mock.patch.dict(sys.modules, {"scipy": None, "scipy.stats": None}):
                self.refused(WHOLE.replace("keys", f'method = "{method}"\npoints = 4\nkeys'), 7, "install python3-scipy")


class Ranges(SweepTest):
    def test_a_range_of_many_steps_is_sampled_without_listing_them(self):
        from glint.sweeps.design import points_of
        for scale in ("linear", "log"):
            values = [point["a"] for point in points_of("random", {"a": {"low": 3, "high": 10**15, "step": 7, "scale": scale}}, 50, 1, [])]
            self.assertEqual({(value - 3) % 7 for value in values}, {0})
            self.assertTrue(all(3 <= value <= 10**15 for value in values))
        low = [point["a"] for point in points_of("random", {"a": {"low": 1, "high": 9, "step": 4}}, 50, 1, [])]
        self.assertEqual(set(low), {1, 5, 9})


class Places(SweepTest):
    def test_engines_that_mean_nothing_are_refused(self):
        for words, engine in (("one of local, slurm, dask", {"name": "slrum"}), ("whole number from 0", {"workers": -1}), ("whole number from 0", {"chunk": 1.5}), ("a number from 0", {"memory": float("nan")})):
            self.assertRaisesRegex(self.sweeps.SweepError, words, self.sweeps.run, TINY, self.folder / "store", engine=self.sweeps.Engine(**engine))
        self.assertFalse((self.folder / "store").exists())

    def test_a_store_that_cannot_be_made_is_told(self):
        self.write(WHOLE.replace('"store"', '"/proc/glint-store"'))
        self.assertIn("/proc/glint-store: no store can be made here: ", self.glint("run", "sweep.toml", code=2).stderr)

    def test_a_check_that_was_killed_says_what_happened_and_what_to_do(self):
        from glint.errors import CommandFailed
        program = self.folder / "killed"
        program.write_text('#!/bin/sh\nkill -9 $$\n')
        program.chmod(0o755)
        with self.assertRaises(CommandFailed) as caught:
            self.sweeps.run(TINY, self.folder / "store", glint=program)
        for words in ("was ended, as the system does when memory ends, by SIGKILL", "give the same command again", "nothing was run"):
            self.assertIn(words, str(caught.exception))
        self.assertFalse((self.folder / "store").exists())

    def test_a_report_that_cannot_be_made_is_a_failure_of_its_point(self):
        program = self.stand_in()
        program.write_text(program.read_text().replace("[ \"$1\" = run ]", "[ \"$1\" = report ] && { echo 'error: no page' >&2; exit 2; }\n[ \"$1\" = run ]"))
        found = self.sweeps.run({**TINY, "stats": "full", "report": True, "retry": {"crash": 0}}, self.folder / "store", glint=program)
        self.assertEqual([(one["kind"], "exit code 2: error: no page" in one["message"]) for one in found.failures], [("crash", True)])


if __name__ == "__main__":
    main()

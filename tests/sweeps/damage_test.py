# Tests what a sweep says and does when files of its store are damaged, when a disk is full, and when the store can only be read.
# SPDX-License-Identifier: Apache-2.0
"""usage: damage_test.py GLINT SOURCE_DIR [Damaged|Full|ReadOnly]"""
import errno
import os
import shutil
import sqlite3
import subprocess
import sys
import unittest.mock

from sweeps_case import GLINT, TINY, SweepTest, contents, main, points_in

SWEEP = {**TINY, "name": "three", "design": [{"keys": {"rt.warps": [2, 4, 8]}}]}


class DamageTest(SweepTest):
    def setUp(self):
        super().setUp()
        self.store = self.folder / "store"
        self.program = self.stand_in()

    def run_it(self):
        return self.sweeps.run(SWEEP, self.store, glint=self.program)

    def place(self, number=0):
        id = points_in(self.store)[number]
        return self.store / "points" / id[:3] / id

    def is_whole_again(self):
        self.assertEqual((self.run_it().done, len(contents(self.store))), (3, 3))
        self.assertEqual(list((self.store / "tmp").iterdir()), [])


class Damaged(DamageTest):
    def test_a_record_of_another_form_is_told_and_is_no_point_of_the_tables(self):
        self.run_it()
        for text in ("{}", "[]", '{"metrics": null, "cost": 5, "files": []}', ""):
            with self.subTest(text):
                place = self.place()
                (place / "point.json").write_text(text)
                collected = self.sweeps.collect("three", self.store)
                self.assertEqual((len(collected.rows), collected.damaged), (2, [place.name]))
                self.assertIn("the point is damaged", self.glint("open", "--store", self.store, "--point", place.name, "--out", "opened", code=2).stderr)
                self.assertFalse((self.folder / "opened").exists())
                self.glint("gc", "--store", self.store, "--yes")
                self.is_whole_again()

    def test_what_lies_in_the_place_of_a_point_makes_way_for_it(self):
        for damage in (lambda place: (place / "point.json").unlink(), lambda place: (shutil.rmtree(place), place.mkdir()), lambda place: (shutil.rmtree(place), place.write_text("x"))):
            self.run_it()
            damage(self.place())
            self.assertEqual(self.sweeps.status("three", self.store).done, 2)
            self.is_whole_again()

    def test_a_list_of_points_that_is_cut_is_told_and_gc_removes_nothing(self):
        self.run_it()
        listed = self.store / "sweeps/three/points.jsonl"
        whole = listed.read_text()
        lines = whole.splitlines(keepends=True)
        for text in ("", "[]", whole[:70], "".join(lines[:-1]), "".join(lines[1:])):
            with self.subTest(text):
                listed.write_text(text)
                for action in (("status", "three"), ("collect", "three"), ("gc", "--yes")):
                    self.assertIn("points.jsonl: the list of points is missing, was cut short, or is damaged", self.glint(*action, "--store", self.store, code=2).stderr)
                self.assertEqual(len(points_in(self.store)), 3)
        listed.unlink()
        self.glint("gc", "--yes", "--store", self.store, code=2)
        self.is_whole_again()
        self.assertEqual(listed.read_text(), whole)
        (listed.parent / "sweep.json").unlink()
        self.glint("gc", "--yes", "--store", self.store)
        self.is_whole_again()

    def test_a_damaged_failure_hides_no_point(self):
        self.run_it()
        place = self.place()
        record = self.store / "failures" / place.name[:3] / f"{place.name}.json"
        shutil.rmtree(place)
        record.parent.mkdir(exist_ok=True)
        record.write_text("{}")
        self.is_whole_again()
        self.assertFalse(record.exists())

    def test_records_that_are_damaged_within_the_index_are_read_from_their_folders(self):
        self.run_it()
        first = self.sweeps.collect("three", self.store).rows
        index = sqlite3.connect(self.store / "index.sqlite")
        index.execute("update points set record = '{'")
        index.commit()
        index.close()
        (self.store / "index.sqlite-journal").write_bytes(b"of another index")
        self.assertEqual(self.sweeps.collect("three", self.store).rows, first)
        self.assertFalse((self.store / "index.sqlite-journal").exists())

    def test_the_mark_of_a_store_can_be_made_again(self):
        self.run_it()
        self.sweeps.collect("three", self.store)
        mark = self.store / "glint-store.json"
        mark.write_text("")
        self.assertIn("when the file is removed", self.glint("status", "three", "--store", self.store, code=2).stderr)
        mark.unlink()
        self.is_whole_again()

    def test_gc_keeps_points_that_a_sweep_names_while_it_looks(self):
        from glint.sweeps.cleaning import clean
        self.run_it()
        shutil.move(self.store / "sweeps/three", self.folder / "away")
        self.sweeps.run({**TINY, "name": "one"}, self.store, glint=self.program)
        store = self.sweeps.Store(self.store)
        look = store.damage

        def meanwhile(id):
            if (self.folder / "away").exists():
                shutil.move(self.folder / "away", self.store / "sweeps/three")
            return look(id)

        with unittest.mock.patch.object(store, "damage", meanwhile):
            self.assertIn("removed 0 points", clean(store, True))
        self.assertEqual(len(points_in(self.store)), 3)

    def test_a_sweep_begins_when_gc_has_ended(self):
        store = self.sweeps.Store(self.store)
        code = "import sys, glint.sweeps as s; from glint.sweeps.folder import SweepFolder as f; s.Store(sys.argv[1]).plans_kept_still().__enter__(); print('in')"
        with store.plans_kept_still():
            child = subprocess.Popen([sys.executable, "-c", code, self.store], stdout=subprocess.PIPE, text=True)
            with self.assertRaises(subprocess.TimeoutExpired):
                child.wait(2)
        self.assertEqual(child.communicate(timeout=60)[0], "in\n")


class Full(DamageTest):
    def test_a_store_without_space_ends_the_sweep_and_no_point_fails(self):
        def full(source, target):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(target))

        with unittest.mock.patch("shutil.copyfile", full), self.assertRaisesRegex(self.sweeps.SweepError, "the store takes no further point: .*No space left on device"):
            self.run_it()
        self.assertEqual(list((self.store / "tmp").iterdir()), [])
        status = self.sweeps.status("three", self.store)
        self.assertEqual((status.done, status.failures, status.left), (0, [], 3))
        self.is_whole_again()

    def test_runs_without_space_end_the_sweep_and_no_point_fails(self):
        program = self.stand_in("echo 'stats.csv: error: cannot write the file: No space left on device'; exit 2", "full")
        with self.assertRaisesRegex(self.sweeps.SweepError, "no space is left for the files of a run: stats.csv"):
            self.sweeps.run(SWEEP, self.store, glint=program)
        self.assertEqual(self.sweeps.status("three", self.store).failures, [])

    def test_a_file_that_cannot_be_written_leaves_no_scratch(self):
        from glint.sweeps.store import write_whole
        (self.folder / "taken").mkdir()
        with self.assertRaisesRegex(OSError, "taken'$"):
            write_whole(self.folder / "taken", "text")
        self.assertEqual([path.name for path in self.folder.iterdir() if path.name.startswith(".")], [])


class ReadOnly(DamageTest):
    def read_only(self, *words):
        """Runs `glint sweep` where the store can only be read: by a mount of its own, because root may write everywhere."""
        script = 'mount --bind "$1" "$1" && mount -o remount,ro,bind "$1" && shift && exec "$@"'
        return subprocess.run(["unshare", "-m", "sh", "-c", script, "sh", self.store, GLINT, "sweep", *map(str, words), "--store", self.store], capture_output=True, text=True, cwd=self.folder)

    def test_a_store_that_can_only_be_read_is_read(self):
        self.run_it()
        if os.geteuid() or self.read_only("status").returncode:
            print("SKIPPED: damage_test.py ReadOnly: no mount could be made, so no store was only read")
            return
        self.assertIn("3 done", self.read_only("status", "three").stdout)
        self.assertIn("three: 3 points", self.read_only("collect", "three", "--out", self.folder / "tables").stdout)
        self.assertEqual(self.read_only("open", "--point", points_in(self.store)[0], "--out", self.folder / "opened").returncode, 0)
        self.assertIn("0 points with damaged files", self.read_only("gc").stdout)
        for words in (("gc", "--yes"), ("cancel", "three"), ("resume", "three")):
            done = self.read_only(*words)
            self.assertEqual((done.returncode, "the store can only be read here" in done.stderr), (2, True), done.stderr)


if __name__ == "__main__":
    main()

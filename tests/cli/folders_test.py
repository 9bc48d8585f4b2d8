# Tests with the real binary that a command writes only into folders of its own, one process at a time, and keeps what others left there.
# SPDX-License-Identifier: Apache-2.0
"""usage: folders_test.py GLINT SOURCE_DIR"""
import csv
import json
import os
import signal
import subprocess
import time

import glint_case
from glint_case import GLINT, GlintTest
from outputs_test import KERNEL

TINY = ["--size", "8x8", "--spp", "1"]
RUN = ["run", "WKND", *TINY]
LONG = ["run", "PARTY_PT", "--size", "256x256", "--spp", "64"]
RUN_FILES = ["config.toml", "image.pfm", "image.png", "run.json", "stats.csv", "stats.json", "stats.txt"]
ADVICE = "give --out a new or empty folder"


class Folders(GlintTest):
    def ok(self, *arguments):
        done = self.glint(*arguments)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done

    def files(self, folder="."):
        """Returns the bytes of every file of a folder by name, with empty folders as None."""
        top = self.folder / folder
        return {str(path.relative_to(top)): path.read_bytes() if path.is_file() else None for path in top.rglob("*")}

    def refused(self, folder, parts, *arguments):
        """Runs a command that must be refused and must leave the folder as it is."""
        before = self.files(folder)
        self.expect(2, parts, *arguments)
        self.assertEqual(self.files(folder), before)

    def begin(self, folder, *arguments):
        """Starts a command and waits until its run has marked the folder."""
        process = subprocess.Popen([GLINT, *arguments], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(lambda: (process.kill(), process.communicate()))
        deadline = time.monotonic() + 100
        while not (self.folder / folder / "config.toml").exists() and time.monotonic() < deadline:
            time.sleep(0.02)
        self.assertIsNone(process.poll(), "the run was faster than the test")
        return process


class RunFolders(Folders):
    def test_a_folder_with_files_of_others_is_refused_and_nothing_in_it_changes(self):
        self.ok("run", "WKND", *TINY, "--out", "first")
        self.write("mine/config.toml", (self.folder / "first/config.toml").read_text())
        for name in ("stats.txt", "image.png", "printf.txt", "heat/notes.txt"):
            self.write(f"mine/{name}", "mine")
        for content in (None, "{}", '{"schema": 1}', "no json"):
            if content:
                self.write("mine/run.json", content)
            with self.subTest(run_json=content):
                self.refused("mine", ["mine", ADVICE], *RUN, "--config", "mine/config.toml", "--out", "mine")
        (self.folder / "mine/run.json").unlink()
        os.mkfifo(self.folder / "mine/run.json")
        self.expect(2, [ADVICE], *RUN, "--out", "mine")

    def test_the_working_directory_is_a_folder_like_any_other(self):
        self.write("config.toml", "core.warps = 8\n")
        self.refused(".", [ADVICE], *RUN, "--config", "config.toml", "--out", ".")
        (self.folder / "config.toml").unlink()
        self.ok(*RUN, "--out", ".")
        self.ok(*RUN, "--out", ".")
        self.assertEqual(sorted(self.files()), RUN_FILES)

    def test_a_run_removes_the_files_of_an_earlier_one_and_no_others(self):
        self.ok(*RUN, "--heat", "--sample", "1000", "--out", "run")
        heat = self.files("run/heat")
        self.assertGreater(len(heat), 4)
        self.write("run/notes.txt", "mine")
        self.write("run/heat/notes.txt", "mine")
        self.ok(*RUN, "--out", "run")
        self.assertEqual(sorted(self.files("run")), sorted([*RUN_FILES, "heat", "heat/notes.txt", "notes.txt"]))
        (self.folder / "run/heat/notes.txt").unlink()
        self.ok(*RUN, "--heat", "--out", "run")
        self.assertEqual(self.files("run/heat"), heat)
        self.ok(*RUN, "--out", "run")
        self.assertEqual(sorted(self.files("run")), sorted([*RUN_FILES, "notes.txt"]))

    def test_a_file_of_others_with_the_name_of_one_to_save_is_refused(self):
        for name, text in KERNEL.items():
            self.write(name, text.replace("OFFSET", "0"))
        self.ok(*RUN, "--out", "run")
        self.write("run/kept.bin", "mine")
        self.refused("run", ["kept.bin", "not of an earlier run"], "run", "k.toml", "--out", "run")
        (self.folder / "run/kept.bin").unlink()
        self.ok("run", "k.toml", "--out", "run")
        self.ok("run", "k.toml", "--out", "run")
        self.ok(*RUN, "--out", "run")
        self.assertNotIn("kept.bin", self.files("run"))

    def test_a_killed_run_leaves_a_folder_that_readers_refuse_and_the_next_run_takes(self):
        killed = self.begin("run", *LONG, "--out", "run")
        killed.kill()
        killed.wait()  # Its lock is gone only then.
        for reader in (["stats", "run", "--format", "metrics"], ["compare", "run", "run"], ["report", "run"], ["annotate", "run"]):
            self.expect(2, ["run.json", "the run has not ended"], *reader)
        self.ok(*RUN, "--out", "run")
        self.assertEqual(sorted(self.files("run")), RUN_FILES)

    def test_the_next_run_removes_half_files_of_killed_writes_and_nothing_else(self):
        self.ok(*RUN, "--heat", "--out", "run")
        gone = subprocess.Popen(["true"])
        gone.wait()
        halves = [f"run/{name}.{gone.pid}.tmp" for name in ("stats.csv", "run.json", "config.toml", "image.png")]
        kept = [f"run/notes.{gone.pid}.tmp", f"run/stats.csv.{os.getpid()}.tmp", "run/stats.csv.tmp", f"run/heat/notes.txt.{gone.pid}.tmp"]
        for name in [*halves, *kept, f"run/heat/rays.npy.{gone.pid}.tmp"]:
            self.write(name, "half")
        self.ok(*RUN, "--out", "run")
        self.assertEqual(sorted(self.files("run")), sorted([*RUN_FILES, "heat", *(name[4:] for name in kept)]))

    def test_of_two_runs_into_one_folder_the_second_is_refused_until_the_first_is_gone(self):
        first = self.begin("run", *LONG, "--out", "run")
        self.expect(2, ["another process writes its results into this folder", ADVICE], *RUN, "--out", "run")
        self.assertIsNone(first.poll())
        first.kill()
        first.wait()
        self.ok(*RUN, "--out", "run")

    def test_runs_that_begin_together_never_lose_a_result(self):
        processes = [subprocess.Popen([GLINT, "run", "WKND", "--size", "32x32", "--spp", "1", "--set", f"core.warps={warps}", "--out", "run"], cwd=self.folder,
                                      stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) for warps in (8, 16, 32)]
        ends = [(process.communicate()[1], process.returncode) for process in processes]
        for err, code in ends:
            self.assertIn(code, (0, 2))
            self.assertEqual("another process" in err, code == 2, err)
        self.assertIn(0, [code for _, code in ends])
        self.ok("stats", "run", "--format", "metrics")
        self.assertNotIn("glint.lock", self.files("run"))


class BenchFolders(Folders):
    def bench(self, *names, out="b"):
        return self.ok("bench", *names, *TINY, "--out", out)

    def rows(self, folder="b"):
        with open(self.folder / folder / "metrics.csv", newline="") as file:
            return {row["workload"]: row for row in csv.DictReader(file)}

    def test_rows_of_other_workloads_stay_in_the_table(self):
        self.bench("WKND_SH", "SHIP_SH")
        before = self.rows()
        self.ok("bench", "BUNNY_SH", "SHIP_SH", "--size", "16x16", "--spp", "1", "--out", "b")
        after = self.rows()
        order = [line.split()[0] for line in self.ok("list", "workloads").stdout.splitlines()]
        self.assertEqual(list(after), sorted(("WKND_SH", "BUNNY_SH", "SHIP_SH"), key=order.index))
        self.assertEqual(after["WKND_SH"], before["WKND_SH"])
        self.assertNotEqual(after["SHIP_SH"], before["SHIP_SH"])
        self.assertEqual(self.glint("model", "b", "--statistics-only").stderr, "")
        self.ok("bench", "BUNNY_SH", "--size", "16x16", "--spp", "1", "--out", "b", "--resume")
        self.assertEqual(self.rows(), after)

    def test_a_table_with_other_columns_is_not_cut(self):
        self.bench("WKND_SH")
        self.write("b/metrics.csv", "workload,old\nWKND_SH,1\n")
        (self.folder / "b/bench.json").unlink()  # that version's own, if it had one
        self.refused("b", ["metrics.csv", "another version", "WKND_SH", ADVICE], "bench", "SHIP_SH", *TINY, "--out", "b")
        self.bench("WKND_SH")
        self.assertIn("cycles", self.rows()["WKND_SH"])

    def test_folders_with_files_of_others_are_refused_before_anything_runs(self):
        for name, text in (("summary.txt", "mine"), ("metrics.csv", "mine"), ("metrics.csv", "name,value\na,1\n")):
            with self.subTest(name=name):
                self.write(f"mine/{name}", text)
                self.refused("mine", ["mine", ADVICE], "bench", "WKND_SH", *TINY, "--out", "mine")
                (self.folder / "mine" / name).unlink()
        (self.folder / "mine/SHIP_SH").mkdir()
        self.write("mine/SHIP_SH/log.txt", "mine")
        self.refused("mine", ["mine/SHIP_SH", ADVICE], "bench", "WKND_SH", "SHIP_SH", *TINY, "--out", "mine")
        self.bench("WKND_SH", out="mine")  # It does not touch the folder SHIP_SH.

    def test_a_bench_may_stand_in_a_bench(self):
        self.bench("WKND_SH")
        self.bench("SHIP_SH", out="b/inner")
        self.bench("WKND_SH")
        self.assertEqual((list(self.rows()), list(self.rows("b/inner"))), (["WKND_SH"], ["SHIP_SH"]))

    def test_a_killed_bench_is_gone_on_with_and_a_second_one_is_refused(self):
        first = self.begin("b/PARTY_PT", "bench", "WKND_SH", "PARTY_PT", "--size", "128x128", "--spp", "64", "-j", "2", "--out", "b")
        self.expect(2, ["another process"], "bench", "SHIP_SH", *TINY, "--out", "b")
        first.send_signal(signal.SIGKILL)
        first.wait()
        deadline = time.monotonic() + 60  # The kernel ends the children of a killed bench.
        while self.glint("bench", "PARTY_SH", "WKND_SH", *TINY, "--out", "b").returncode and time.monotonic() < deadline:
            time.sleep(0.1)
        self.bench("PARTY_PT")
        self.assertEqual(set(self.rows()), {"PARTY_SH", "PARTY_PT", "WKND_SH"})
        self.assertNotIn("glint.lock", self.files("b"))

    def test_a_characterisation_overwrites_no_files_of_others(self):
        table = "workload,a,b,c\n" + "".join(f"w{i},{i},{i * i},{7 % (i + 1)}\n" for i in range(6))
        self.write("t.csv", table)
        self.write("mine/subset.csv", "mine")
        self.refused("mine", ["mine", ADVICE], "characterize", "t.csv", "--clusters", "2", "-o", "mine")
        self.ok("characterize", "t.csv", "--clusters", "2", "--metrics", "2", "-o", "new")
        self.ok("characterize", "t.csv", "--clusters", "2", "--metrics", "2", "-o", "new")


class Facts(Folders):
    READERS = [["report", "run"], ["stats", "run", "--format", "metrics"], ["compare", "run", "run"], ["model", "run", "--statistics-only"], ["annotate", "run"],
               ["imgdiff", "run", "run"]]

    def test_a_value_of_another_type_in_run_json_is_refused_and_named(self):
        self.ok(*RUN, "--profile", "--out", "run")
        facts = json.loads((self.folder / "run/run.json").read_text())
        places = [(facts, key) for key in facts] + [(facts[table], key) for table in ("scene", "config", "structures", "residency", "rays", "memory_peaks") for key in facts[table]]
        for table, key in places:
            for other in (7, "x", [], None):
                if type(other) is type(table[key]) or {type(other), type(table[key])} == {int, float}:
                    continue
                right, table[key] = table[key], other
                self.write("run/run.json", json.dumps(facts))
                table[key] = right
                done = self.glint("report", "run", "-o", "page.html")
                with self.subTest(key=key, other=other):
                    self.assertIn(done.returncode, (0, 2), done.stderr)
                    if key in ("mode", "scene", "config", "exit", "schema", "name", "hash", "shader", "command"):
                        self.assertEqual(done.returncode, 2)
                        self.assertRegex(done.stderr, f"run.json: .*{key}' is ")
        self.write("run/run.json", json.dumps({**facts, "mode": 7}))
        for reader in self.READERS:
            with self.subTest(reader=reader):
                self.expect(2, ["run.json", "'mode' is number, expected string"], *reader)

    def test_a_pipe_in_the_place_of_run_json_is_refused_at_once(self):
        self.ok(*RUN, "--profile", "--out", "run")
        (self.folder / "run/run.json").unlink()
        os.mkfifo(self.folder / "run/run.json")
        for reader in self.READERS:
            with self.subTest(reader=reader):
                done = subprocess.run([GLINT, *reader], capture_output=True, text=True, cwd=self.folder, timeout=20)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn("run.json", done.stderr)


if __name__ == "__main__":
    glint_case.main()

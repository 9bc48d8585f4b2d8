# Tests with the real binary that readers of runs and benches notice every file that is not as it was written.
# SPDX-License-Identifier: Apache-2.0
"""usage: whole_test.py GLINT SOURCE_DIR"""
import json
import shutil
import zlib

import glint_case
from glint_case import GlintTest

TINY = ["--size", "8x8", "--spp", "1"]
# The readers of each file of a run.
READERS = {
    "stats.csv": [["compare", "d", "ok"], ["compare", "ok", "d"], ["report", "d"], ["stats", "d", "--format", "metrics"], ["stats", "d", "--format", "vulkan-sim"],
                  ["stats", "d", "--format", "csv"], ["model", "d", "--statistics-only"]],
    "stats.json": [["report", "d"], ["stats", "d", "--format", "json"]],
    "stats.txt": [["stats", "d"]],
    "config.toml": [["compare", "d", "ok"], ["report", "d"], ["stats", "d", "--format", "metrics"], ["model", "d", "--statistics-only"]],
    "profile.csv": [["annotate", "d"], ["annotate", "d/profile.csv"], ["report", "d"]],
    "source.json": [["annotate", "d"], ["report", "d"]],
    "series.csv": [["report", "d"]],
    "trace.json.gz": [["report", "d"]],
    "heat/maps.json": [["report", "d"]],
    "heat/cycles.npy": [["report", "d"]],
    "image.png": [["report", "d"]],
    "image.pfm": [["imgdiff", "d", "ok"], ["imgdiff", "ok", "d"]],
}


def cut(data):
    """Returns the data without its last line, or half of it when it has no lines."""
    at = data.rfind(b"\n", 0, -1) + 1
    return data[:at] if at else data[:len(data) // 2]


def flipped(data):
    """Returns data of the same length with one digit or byte changed in the middle."""
    at = len(data) // 2
    return data[:at] + bytes([data[at] ^ 1]) + data[at + 1:]


class Whole(GlintTest):
    def ok(self, *arguments):
        done = self.glint(*arguments)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done

    def record(self, folder="ok"):
        return json.loads((self.folder / folder / "run.json").read_text())

    def damaged(self, name, change):
        """Makes the folder d, a copy of ok in which one file was changed."""
        shutil.rmtree(self.folder / "d", ignore_errors=True)
        shutil.copytree(self.folder / "ok", self.folder / "d")
        path = self.folder / "d" / name
        path.write_bytes(change(path.read_bytes()))


class Runs(Whole):
    def setUp(self):
        super().setUp()
        self.ok("run", "WKND_SH", *TINY, "--profile", "--sample", "500", "--heat", "--trace", "--out", "ok")

    def test_run_json_lists_every_file_of_the_run_with_its_length_and_sum(self):
        listed = self.record()["files"]
        files = {str(path.relative_to(self.folder / "ok")): path.read_bytes() for path in (self.folder / "ok").rglob("*") if path.is_file()}
        files.pop("run.json")
        self.assertEqual(listed, {name: {"bytes": len(data), "crc32": f"{zlib.crc32(data):08x}"} for name, data in files.items()})
        self.assertLessEqual(set(READERS), set(listed))

    def test_every_reader_refuses_a_file_that_was_cut_or_changed_and_says_what_differs(self):
        for name, readers in READERS.items():
            for change, parts in ((cut, ["bytes, and run.json says", "it was cut short"]), (flipped, ["CRC-32", "it was changed"]),
                                  (lambda data: data + b"\n", ["something was added to it"])):
                self.damaged(name, change)
                for reader in readers:
                    with self.subTest(file=name, reader=reader):
                        done = self.expect(2, [f"d/{name}: error: ", *parts, "run it again"], *reader)
                        self.assertEqual(done.stdout, "")

    def test_a_run_of_an_earlier_version_is_read_with_one_note(self):
        record = self.record()
        del record["files"]
        self.damaged("run.json", lambda data: json.dumps(record).encode())
        for reader in (["compare", "d", "d"], ["report", "d"], ["stats", "d"], ["annotate", "d"], ["imgdiff", "d", "ok"], ["model", "d", "--statistics-only"]):
            with self.subTest(reader=reader):
                self.assertEqual(self.ok(*reader).stderr.count("without the lengths and sums of its files"), 1)
        self.assertEqual(self.ok("compare", "ok", "ok").stderr, "")

    def test_files_that_are_gone_are_named_and_left_out(self):
        for name in ("profile.csv", "trace.json.gz"):
            (self.folder / "ok" / name).unlink()
        said = self.ok("report", "ok").stderr
        self.assertIn("ok: these files of the run are gone: profile.csv, trace.json.gz", said)

    def test_a_list_that_is_none_is_refused(self):
        for wrong in (7, {"stats.csv": 7}, {"stats.csv": {"bytes": 1}}):
            record = {**self.record(), "files": wrong}
            self.damaged("run.json", lambda data, record=record: json.dumps(record).encode())
            self.expect(2, ["d/run.json", "files"], "compare", "d", "ok")

    def test_a_run_that_failed_lists_what_it_left(self):
        self.glint("run", "WKND_SH", *TINY, "--max-instructions", "1", "--out", "ok")
        self.assertEqual(sorted(self.record()["files"]), ["config.toml"])


class Benches(Whole):
    def setUp(self):
        super().setUp()
        self.ok("bench", "WKND_SH", "SHIP_SH", "BUNNY_SH", *TINY, "--out", "ok")

    def test_a_table_that_was_cut_is_refused_and_a_resumed_bench_makes_it_again(self):
        whole = (self.folder / "ok/metrics.csv").read_bytes()
        self.damaged("metrics.csv", cut)
        for reader in (["characterize", "d", "--clusters", "2"], ["characterize", "d/metrics.csv", "--clusters", "2"], ["report", "d"], ["model", "d", "--statistics-only"],
                       ["bench", "WKND_PT", *TINY, "--out", "d"]):
            with self.subTest(reader=reader):
                self.expect(2, ["d/metrics.csv: error: ", "bench.json says", "it was cut short", "remove metrics.csv and run the bench again with --resume"], *reader)
        (self.folder / "d/metrics.csv").unlink()
        done = self.ok("bench", "WKND_SH", "SHIP_SH", "BUNNY_SH", *TINY, "--out", "d", "--resume")
        self.assertIn("3 of them complete", done.stdout)
        self.assertEqual((self.folder / "d/metrics.csv").read_bytes(), whole)

    def test_a_damaged_run_is_run_again_by_a_resumed_bench(self):
        whole = (self.folder / "ok/SHIP_SH/stats.csv").read_bytes()
        self.damaged("SHIP_SH/stats.csv", cut)
        self.expect(2, ["d/SHIP_SH/stats.csv", "it was cut short"], "report", "d")
        done = self.ok("bench", "WKND_SH", "SHIP_SH", "BUNNY_SH", *TINY, "--out", "d", "--resume")
        self.assertIn("2 of them complete", done.stdout)
        self.assertEqual((self.folder / "d/SHIP_SH/stats.csv").read_bytes(), whole)


if __name__ == "__main__":
    glint_case.main()

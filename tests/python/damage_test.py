# Tests damaged runs, pictures and folders: each is refused with a GlintError that names the file, and affects no other run.
# SPDX-License-Identifier: Apache-2.0
"""usage: damage_test.py GLINT SOURCE_DIR. Without numpy and matplotlib, some tests are left out with a message."""
import importlib.util
import json
import re
import shutil
import struct
import subprocess
import warnings
import zlib

import python_case
from python_case import PythonTest

ARRAYS = all(importlib.util.find_spec(name) for name in ("numpy", "matplotlib"))


def half(data):
    return data[:len(data) // 2]


def with_cycles(word):
    return lambda data: re.sub(rb'("cycles": \{\s*"value": )\d+', rb"\g<1>" + word, data, count=1)


def png(path, width, height, colour, rows):
    """Returns a PNG with 8 bits per channel: colour 0 is grey, 4 is grey with transparency, 6 is RGBA."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    data = b"".join(b"\0" + bytes(row) for row in rows)
    header = struct.pack(">IIBBBBB", width, height, 8, colour, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(data)) + chunk(b"IEND", b""))
    return path


class Damaged(PythonTest):
    def refused(self, file, change, read, words=None, listed=False):
        """Checks that reading a run whose file was changed raises a SchemaError with the file's name. Without `listed`, only the file's form can tell."""
        there = self.folder / "damaged"
        shutil.rmtree(there, ignore_errors=True)
        shutil.copytree(self.ship.directory, there)
        record = json.loads((there / "run.json").read_text())
        if not listed:
            del record["files"]
            (there / "run.json").write_text(json.dumps(record))
        (there / file).parent.mkdir(exist_ok=True)
        (there / file).write_bytes(change((there / file).read_bytes() if (there / file).exists() else b""))
        with self.subTest(file=file, words=words), warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of a run without a list
            self.assertRaisesRegex(self.glint.SchemaError, words or re.escape(file), lambda: read(self.glint.Run(there)))

    def test_a_file_that_is_not_as_run_json_lists_it_is_refused(self):
        cut = lambda data: data[:data.rindex(b"\n", 0, -1) + 1]
        changed = lambda data: data.replace(b"1", b"2", 1)
        for file, read in (("config.toml", lambda run: run.config), ("stats.json", lambda run: run.cycles), ("series.csv", lambda run: run.series),
                           ("profile.csv", lambda run: run.profile), ("profile.folded", lambda run: run.folded)):
            self.refused(file, cut, read, rf"{file}: the file has \d+ bytes, and run.json says \d+: it was cut short: run it again", listed=True)
            self.refused(file, changed, read, rf"{file}: the contents .* it was changed: run it again", listed=True)
            self.refused(file, lambda data: data + b"\n", read, rf"{file}: .* something was added to it", listed=True)

    def test_tables_of_a_bench_and_of_a_characterisation_that_were_cut_are_refused(self):
        table = self.folder / "metrics.csv"
        table.write_text("workload,config,cycles,a,b\n" + "".join(f"w{i},c,{i},{i * i},{7 % (i + 1)}\n" for i in range(1, 7)))
        there = self.folder / "suite"
        self.command("characterize", table, "--clusters", "2", "--metrics", "2", "-o", there)
        for name in ("scores", "leaves", "linkage", "subset", "kiviat", "eigenvalues"):
            path = there / f"{name}.csv"
            whole = path.read_bytes()
            self.assertGreater(len(self.glint.Characterization(there).table(name)), 0)
            path.write_bytes(whole[:whole.rindex(b"\n", 0, -1) + 1])
            self.assertRaisesRegex(self.glint.SchemaError, f"{name}.csv.*characterization.json says .* cut short: run `glint characterize` again",
                                   self.glint.Characterization(there).table, name)
            path.write_bytes(whole)
        bench = self.folder / "bench"
        subprocess.run([python_case.GLINT, "bench", "WKND_SH", "WKND_AO", "--size", "8x8", "--spp", "1", "--out", bench], check=True, capture_output=True)
        self.assertEqual(len(self.glint.Bench(bench).table), 2)
        whole = (bench / "metrics.csv").read_bytes()
        (bench / "metrics.csv").write_bytes(whole[:whole.rindex(b"\n", 0, -1) + 1])
        self.assertRaisesRegex(self.glint.SchemaError, "metrics.csv.*bench.json says .* cut short: remove metrics.csv", self.glint.Bench, bench)

    def test_a_list_of_files_that_is_none_is_refused(self):
        for wrong in (7, [], {"stats.json": 7}, {"stats.json": {"bytes": 1}}):
            self.refused("run.json", lambda data, wrong=wrong: json.dumps({**json.loads(data), "files": wrong}).encode(), lambda run: run, "'files' is no list", listed=True)

    def test_a_run_of_an_earlier_version_is_read_with_a_warning(self):
        there = self.folder / "early"
        shutil.copytree(self.ship.directory, there)
        record = json.loads((there / "run.json").read_text())
        del record["files"]
        (there / "run.json").write_text(json.dumps(record))
        with self.assertWarnsRegex(UserWarning, "without the lengths and sums"):
            self.assertEqual(self.glint.Run(there).cycles, self.ship.cycles)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertEqual(self.glint.Run(self.ship.directory).cycles, self.ship.cycles)

    def test_statistics_that_are_no_numbers_are_refused(self):
        for word in (b'"x"', b"null", b"true", b"NaN", b"Infinity", b"1e999"):
            self.refused("stats.json", with_cycles(word), lambda run: run.cycles)

    def test_texts_that_are_not_utf_8_are_refused(self):
        for file, read in (("config.toml", lambda run: run.config), ("series.csv", lambda run: run.series), ("profile.folded", lambda run: run.folded),
                           ("stats.json", lambda run: run.stats), ("run.json", lambda run: run)):
            self.refused(file, lambda data: b"\xff\xfe" + data, read)

    def test_a_configuration_that_was_cut_between_two_lines_is_refused(self):
        self.refused("config.toml", lambda data: data[:data.index(b"[memory]")], lambda run: run.seconds, "cut short")
        self.refused("config.toml", lambda data: b"", lambda run: run.seconds, "cut short")

    def test_stacks_and_series_that_were_cut_are_refused(self):
        self.refused("profile.folded", lambda data: data[:data.rindex(b" ")], lambda run: run.folded)
        self.refused("profile.folded", lambda data: data + b"garbage\n", lambda run: run.folded)
        # The last number that is left is still a number.
        self.refused("series.csv", lambda data: data[:-2], lambda run: run.series, "series.csv.*cut short")
        self.refused("series.csv", lambda data: data[:data.rindex(b"\n", 0, -1) + 1], lambda run: run.series, "ends at cycle .* cut short")
        self.refused("run.json", lambda data: b'{"schema": 1}', lambda run: run)
        self.refused("run.json", lambda data: b'{"schema": "1"}', lambda run: run, "schema is '1'")

    def test_lists_of_maps_that_are_none_are_refused(self):
        for text in (b'{"maps": 3}', b'{"maps": [3]}', b'{"maps": [{"name": "nodes", "unit": "node"}]}', b"{"):
            self.refused("heat/maps.json", lambda data, text=text: text, lambda run: run.map_info("nodes"))

    def test_a_run_without_statistics_is_no_run(self):
        there = self.folder / "bare"
        shutil.copytree(self.ship.directory, there)
        (there / "stats.json").unlink()
        self.assertRaisesRegex(self.glint.MissingFile, "no stats.json", self.glint.Run, there)
        self.assertEqual(self.glint.Run(there, partial=True).workload, "SHIP_SH")

    def test_a_damaged_run_is_named_and_spoils_no_other(self):
        there = self.folder / "many"
        for name in ("good", "cut", "gone", "keys"):
            shutil.copytree(self.ship.directory, there / name)
        (there / "cut/stats.json").write_bytes(half((there / "cut/stats.json").read_bytes()))
        (there / "gone/stats.json").unlink()
        (there / "keys/config.toml").write_bytes(half((there / "keys/config.toml").read_bytes()))
        runs = self.glint.Runs(there)
        self.assertEqual((list(runs), sorted(runs.failed)), (["good"], ["cut", "gone", "keys"]))
        self.assertEqual([row["cycles"] for row in runs.rows(["cycles"])], [self.ship.cycles])
        self.assertRaisesRegex(self.glint.UnknownName, "'cut' cannot be read: .*stats.json", lambda: runs["cut"])
        self.assertRaisesRegex(self.glint.UnknownName, "did you mean 'good'", lambda: runs["god"])

    def test_a_plan_of_a_sweep_that_is_damaged_is_refused(self):
        there = self.folder / "plan"
        shutil.copytree(self.ship.directory, there / "a")
        for text in ("{", "{}", '{"axes": 3}', '{"axes": {"rt.warps": 4}}', '{"axes": {}, "runs": 3}', "[]"):
            (there / "sweep.json").write_text(text)
            self.assertRaisesRegex(self.glint.SchemaError, "sweep.json", self.glint.Sweep, there)

    def test_conditions_on_columns_that_are_not_there_are_answered_with_near_ones(self):
        self.assertRaisesRegex(self.glint.UnknownName, "did you mean 'stage'", lambda: self.ship.profile.where(stag="raygen"))


class Pictures(PythonTest):
    def setUp(self):
        if not ARRAYS:
            print("SKIPPED: pictures: no numpy or matplotlib")
            self.skipTest("no numpy or matplotlib")

    def test_damaged_pictures_are_refused(self):
        whole = (self.ship.directory / "image.png").read_bytes()
        for name, data in (("cut.png", half(whole)), ("empty.png", b""), ("text.png", b"text"), ("negative.pfm", b"PF\n-4 -4\n-1\n" + bytes(192)),
                           ("none.pfm", b"PF\n0 0\n-1\n"), ("scale.pfm", b"PF\n1 1\nnan\n" + bytes(12)), ("cut.npy", b"\x93NUMPY")):
            (self.folder / name).write_bytes(data)
            with self.subTest(picture=name):
                self.assertRaisesRegex(self.glint.SchemaError, name, self.glint.read_image, self.folder / name)

    def test_grey_pictures_keep_all_their_columns(self):
        grey = self.glint.read_image(png(self.folder / "grey.png", 8, 2, 0, [range(8), range(8, 16)]))
        self.assertEqual((grey.shape, round(float(grey[1, 7]) * 255)), ((2, 8), 15))
        clear = self.glint.read_image(png(self.folder / "clear.png", 2, 1, 4, [[10, 255, 20, 0]]))
        self.assertEqual((clear.shape[:2], round(float(clear[0, 0].max()) * 255)), ((1, 2), 10))
        self.assertEqual(self.glint.read_image(png(self.folder / "rgba.png", 1, 1, 6, [[1, 2, 3, 4]])).shape, (1, 1, 3))


if __name__ == "__main__":
    python_case.main()

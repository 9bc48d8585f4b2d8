# Shares with all tests of the command: the binary, a folder to run it in, and checks of what it says.
# SPDX-License-Identifier: Apache-2.0
"""Scripts that use this module are called with GLINT SOURCE_DIR [SUITE...]."""
import base64
import csv
import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

GLINT, ROOT = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


class GlintTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, text):
        """Writes a file into the test's folder and returns its name."""
        path = self.folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
        return name

    def glint(self, *arguments, text=True, **environment):
        """Runs glint in the test's folder. Its output is bytes with text=False."""
        return subprocess.run([GLINT, *map(str, arguments)], capture_output=True, text=text, cwd=self.folder, timeout=300,
                              env={**os.environ, **environment})

    def run_into(self, out, *arguments):
        """Runs something well into a folder, and returns what it printed."""
        done = self.glint("run", *arguments, "--out", out)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def collect(self, sweep):
        """Runs a sweep well, and returns the rows of its points."""
        for words in (["run", sweep], ["collect", sweep, "--out", "found"]):
            done = self.glint("sweep", *words)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return self.rows("found/points.csv")

    def rows(self, name):
        """Returns the rows of a table as dictionaries."""
        with (self.folder / name).open(newline="") as file:
            return list(csv.DictReader(file))

    def saved_numbers(self, name="out.csv", number=float):
        """Returns the numbers of a buffer that a run into the folder `out` saved as CSV."""
        return [number(v) for v in (self.folder / "out" / name).read_text().split()[1:]]

    def facts(self, out):
        """Returns what run.json of a folder says."""
        return json.loads((self.folder / out / "run.json").read_text())

    def expect(self, code, parts, *arguments):
        """Runs glint, which must exit with `code` and say every one of `parts` on stderr."""
        done = self.glint(*arguments)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        for part in parts:
            self.assertIn(part, done.stderr)
        return done

    def run_statistics(self, folder, *arguments):
        """Runs `arguments` into `folder` and returns the statistics."""
        done = self.glint("run", "--out", folder, *arguments)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return self.statistics(folder)

    def check_same_statistics(self, *arguments):
        """Checks that a run has the same bytes when no cycle is skipped, and with several threads."""
        self.run_statistics("one", *arguments, "--threads", "1")
        wanted = (self.folder / "one/stats.csv").read_bytes()
        for other in (["--no-skip"], ["--threads", "2"], ["--threads", "4"]):
            self.run_statistics("other", *arguments, *other)
            self.assertEqual((self.folder / "other/stats.csv").read_bytes(), wanted, (arguments, other))

    def statistics(self, folder):
        """Returns the value of each statistic of the run in `folder`, by path."""
        with (self.folder / folder / "stats.csv").open(newline="") as file:
            return {row["path"]: float(row["value"]) for row in csv.DictReader(file)}


def png_bytes(width, height, pixels):
    """Returns a PNG of 8-bit pixels whose channels, three or four, follow from their number."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    stride = len(pixels) // height
    rows = b"".join(b"\0" + pixels[y * stride:(y + 1) * stride] for y in range(height))
    header = struct.pack(">IIBBBBB", width, height, 8, {3: 2, 4: 6}[stride // width], 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def read_png(path):
    """Returns width, height and the bytes of an 8-bit RGB image (PNG specification: chunks and filters)."""
    data, at, packed, width, height = path.read_bytes(), 8, b"", 0, 0
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        at += 12 + length
        if kind == b"IHDR":
            width, height = struct.unpack(">II", body[:8])
        if kind == b"IDAT":
            packed += body
    raw, stride, out, above = zlib.decompress(packed), width * 3, b"", bytes(width * 3)
    for y in range(height):
        method, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            a, b, c = (row[i - 3] if i >= 3 else 0), above[i], (above[i - 3] if i >= 3 else 0)
            pa, pb, pc = abs(b - c), abs(a - c), abs(a + b - 2 * c)
            nearest = a if pa <= pb and pa <= pc else b if pb <= pc else c
            row[i] = (row[i] + [0, a, b, (a + b) // 2, nearest][method]) & 255
        out, above = out + bytes(row), bytes(row)
    return width, height, out


def page_document(page):
    """Returns what a report holds, as its script reads it: statistics, metrics, configuration and pictures run by run (docs/report.md)."""
    data = json.loads(zlib.decompress(base64.b64decode(re.search(r'<script type="text/plain" id="data">([^<]*)</script>', page).group(1))))
    at = lambda column, i: column[0 if len(column) == 1 else i]
    for i, run in enumerate(data["runs"]):
        for name in ("stats", "metrics", "config"):
            run[name] = {key: at(column, i) for key, column in data[name].items()}
        stats = run["stats"] = {path: value for path, value in run["stats"].items() if value is not None}
        for path, parts in data["quotients"].items():
            if all(part in stats for part in parts):
                stats[path] = quotient(*(stats[part] for part in parts))
        if "timeline" in run:
            run["timeline"]["slices"] = slices(run["timeline"]["slices"])
        if "source" in run:
            run["source"].update(data["listings"][run["source"]["listing"]])
    for run, name, source in re.findall(r'<img alt="" data-run="(\d+)" data-map="([^"]*)" src="([^"]*)">', page):
        owner = data["runs"][int(run)]
        (next(one for one in owner["heat"] if one["name"] == name) if name else owner)["picture"] = source
    return data


def slices(columns):
    """Returns the rows of a timeline, in which begins are counted from the end of the row before of the same kind and thread."""
    rows, ends = [], {}
    for thread, kind, gap, length, *rest in zip(*columns):
        begin = ends.get((kind, thread), 0) + gap
        ends[kind, thread] = begin + length
        rows.append([thread, kind, begin, length, *(value for value in rest if value is not None)])
    return rows


def quotient(over, under):
    """Returns the quotients instance by instance, with 0 where the second is 0. The number 0 stands for 0 in all instances."""
    if 0 in (over, under):
        return 0
    count = max(len(over), len(under))
    pairs = zip(over * (count // len(over)), under * (count // len(under)))
    out = [a / b if b else 0 for a, b in pairs]
    return out if any(out) else 0


def reader():
    """Returns the page's own reader of its document as a script, which has the function readDocument()."""
    parts = [(ROOT / "web/src" / name).read_text() for name in ("packed.js", "document.js")]
    return "".join(parts).replace("export ", "").replace('import { unpacked } from "./packed.js";', "")


def when_ready(page, script):
    """Returns the report with a script of a test in it, which runs after the page's own."""
    wait = f'const go = () => {{ {script} }}; const wait = () => (document.documentElement.dataset.ready === "yes" ? go() : setTimeout(wait, 20)); wait();'
    return page.replace("</body>", f"<script>(() => {{ {wait} }})();</script></body>")


def opened(page):
    """Returns what Chromium prints of a page's file: the document after its scripts as stdout, and the console in stderr. All frames are drawn
    before the document is printed, because a figure is drawn in the frame after its place is known."""
    command = [CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={page.parent}/profile", "--enable-logging=stderr", "--window-size=1280,900",
               "--run-all-compositor-stages-before-draw", "--virtual-time-budget=20000", "--dump-dom", page.as_uri()]
    return subprocess.run(command, capture_output=True, text=True, timeout=280)


def main():
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])

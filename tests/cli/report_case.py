# Shares with the tests of `glint report`: two runs, the page of them, and its elements.
# SPDX-License-Identifier: Apache-2.0
import html.parser
import json
import pathlib
import re
import subprocess
import tempfile

import glint_case
from glint_case import GLINT, GlintTest

SMALL = ["--size", "16x16", "--spp", "1"]


def leaves(tree, path=""):
    """Yields (pattern, instance, value) of every number of stats.json. A histogram is one value."""
    for name, child in tree.items():
        here = f"{path}.{name}" if path else name
        if not isinstance(child, dict):
            continue
        if "value" in child and "unit" in child:
            found = re.findall(r"\[(\d+)\]", here)
            pattern, instance = re.sub(r"\[\d+\]", "[*]", here), int(found[0]) if found else 0
            parts = child["value"].items() if isinstance(child["value"], dict) else [("", child["value"])]
            for part, value in parts:
                yield f"{pattern}::{part}" if part else pattern, instance, value
        else:
            yield from leaves(child, here)


def trimmed(bins):
    while bins and bins[-1] == 0:
        bins = bins[:-1]
    return bins


class Elements(html.parser.HTMLParser):
    """Collects attributes and text of elements, in order."""

    def __init__(self, text):
        super().__init__()
        self.found, self.open = [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.found.append([tag, dict(attributes), ""])
        if tag not in ("meta", "img", "br", "link", "input"):
            self.open.append(self.found[-1])

    def handle_endtag(self, tag):
        while self.open and self.open.pop()[0] != tag:
            pass

    def handle_data(self, data):
        for element in self.open:
            element[2] += data

    def having(self, attribute):
        return [(tag, attributes, text) for tag, attributes, text in self.found if attribute in attributes]


class ReportTest(GlintTest):
    @classmethod
    def setUpClass(cls):
        cls.shared = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.shared.cleanup)

        def run(out, *options):
            subprocess.run([GLINT, "run", *options, *SMALL, "--out", out], cwd=cls.shared.name, check=True, capture_output=True)

        run("wknd", "WKND", "--shader", "pt", "--profile", "--sample", "1000")
        run("slow", "WKND", "--shader", "pt", "--set", "rt.box.latency=40")

    def setUp(self):
        super().setUp()
        self.runs = {name: f"{self.shared.name}/{name}" for name in ("wknd", "slow")}

    def report(self, *names):
        done = self.glint("report", *[self.runs[name] for name in names], "-o", "report.html")
        self.assertEqual(done.returncode, 0, done.stderr)
        return (self.folder / "report.html").read_text()

    def document(self, page):
        return glint_case.page_document(page)

    def stats(self, name):
        return json.loads(pathlib.Path(self.runs[name], "stats.json").read_text())

    def equal_to_stats_json(self, stats, name):
        """Returns how many numbers there are. `stats` are those of the page, path by path."""
        count = 0
        for path, instance, value in leaves(self.stats(name)):
            there = stats[path] if stats[path] == 0 else stats[path][instance]
            self.assertEqual(trimmed(value) if isinstance(value, list) else value, there if there != 0 or not isinstance(value, list) else [], path)
            count += 1
        return count

    def total(self, name, pattern):
        return sum(value for path, _, value in leaves(self.stats(name)) if path == pattern)

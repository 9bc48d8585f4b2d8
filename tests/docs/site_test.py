# Checks that the documentation site is built offline, without a warning or a broken link, and opens in a browser from disk.
# SPDX-License-Identifier: Apache-2.0
"""usage: site_test.py GLINT SOURCE_DIR; the exit status is 77, with a message, where Sphinx, MyST and furo are not installed."""
import html
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
import python_case  # noqa: E402
from python_case import GLINT, ROOT  # noqa: E402

python_case.need("sphinx", "myst_parser", "furo", "matplotlib")


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.html = pathlib.Path(folder.name) / "html"
        command = [sys.executable, ROOT / "docs/build", "--glint", GLINT, "--out", folder.name, "--links"]
        cls.done = subprocess.run(command, capture_output=True, text=True, check=False)

    def test_the_site_builds_without_a_warning_and_without_a_broken_link(self):
        self.assertEqual(self.done.returncode, 0, self.done.stdout + self.done.stderr)
        pages = {path.stem for path in self.html.glob("*.html")}
        self.assertLessEqual({path.stem for path in (ROOT / "docs").glob("*.md")} - {"README"}, pages)

    def test_every_command_option_policy_and_preset_stands_in_the_reference(self):
        shown = {name: html.unescape(re.sub(r"<[^>]+>", "", (self.html / f"reference/{name}.html").read_text(encoding="utf-8"))) for name in ("commands", "policies", "presets")}
        listed = {what: [re.split(r" {2,}", line) for line in self.glint("list", what).splitlines()] for what in ("policies", "configs")}
        self.assertEqual([row[2] for row in listed["policies"] if row[2] not in shown["policies"]], [])
        self.assertEqual([row[0] for row in listed["configs"] if row[0] not in shown["presets"]], [])
        commands = re.findall(r"^  (\w+) {2,}\S", self.glint("--help").split("Subcommands:")[1], re.M)
        self.assertGreater(len(commands), 12)
        for command in commands:
            options = re.findall(r"^  (?:-\w,)?(--[\w-]+)", self.glint(command, "--help"), re.M)
            self.assertEqual([option for option in options if option not in shown["commands"]], [], command)

    def test_the_python_reference_has_every_public_name_as_users_write_it(self):
        import glint
        shown = set(re.findall(r'id="(glint\.[\w.]+)"', (self.html / "reference/python.html").read_text(encoding="utf-8")))
        public = {f"glint.{name}" for name in glint.__all__ if name != "plot"} | {f"glint.plot.{name}" for name in glint.plot.__all__ if not name.isupper()}
        self.assertEqual(public - shown, set())
        self.assertEqual({name for name in shown - public if name.rpartition(".")[0] not in public}, set())  # only members of public names are left

    def glint(self, *words):
        return subprocess.run([GLINT, *words], capture_output=True, text=True, check=True).stdout

    def test_a_broken_link_would_be_noticed(self):
        sys.path.insert(0, str(ROOT / "docs/site"))
        import links
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "a.html").write_text('<h1 id="top"></h1><a href="b.html"></a><a href="#top"></a><a href="#gone"></a><img src="a.png"><a href="https://x.org/y">')
            self.assertEqual([line.split(": ")[1] for line in links.broken(pathlib.Path(folder))], ["b.html", "#gone", "a.png"])

    def test_nothing_is_asked_of_a_network(self):
        for path in [*self.html.rglob("*.html"), *self.html.rglob("*.css")]:
            text = path.read_text(encoding="utf-8")
            loaded = re.findall(r"<(?:script|img|link)[^>]*(?:src|href)=\"(https?:[^\"]*)", text) + re.findall(r"url\(['\"]?((?:https?:)?//?[^)'\"]*)", text)
            self.assertEqual([link for link in loaded if not link.startswith("https://schema")], [], path.name)

    def opened(self, address, *options):
        """Returns the page's document after its scripts have run. The console must not show an error. The test is skipped where Chromium is not installed."""
        chromium = shutil.which("chromium")
        if not chromium:
            self.skipTest("chromium is not installed, so no page was opened")
        with tempfile.TemporaryDirectory() as profile:
            done = subprocess.run([chromium, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={profile}", "--enable-logging=stderr", *options, "--dump-dom", address],
                                  capture_output=True, text=True, timeout=120, check=False)
        self.assertNotRegex(done.stderr, r"CONSOLE.*(Error|error)")
        return done.stdout

    def probe(self, page, script):
        """Writes a copy of the page with a script at its end, and returns the copy's address."""
        path = self.html / page
        copy = path.with_name(f"probe_{path.name}")
        copy.write_text(path.read_text(encoding="utf-8").replace("</body>", f"<script>{script}</script></body>"), encoding="utf-8")
        return copy.as_uri()

    def test_a_browser_opens_pages_from_disk_without_an_error_light_and_dark(self):
        backgrounds = set()
        probe = self.probe("concepts.html", "addEventListener('load',()=>{document.body.dataset.ground=getComputedStyle(document.body).backgroundColor;document.querySelector('.theme-toggle').click();document.body.dataset.toggled=document.body.dataset.theme})")
        for scheme in ("0", "1"):  # Blink's numbers for dark and light
            text = self.opened(probe, f"--blink-settings=preferredColorScheme={scheme}")
            backgrounds.add(re.search(r'data-ground="([^"]+)"', text)[1])
            self.assertRegex(text, r'data-toggled="(light|dark)"')
        self.assertEqual(len(backgrounds), 2)

    def test_the_search_works_from_disk_without_an_error(self):
        text = self.opened((self.html / "search.html").as_uri() + "?q=scoreboard", "--virtual-time-budget=10000")
        self.assertGreater(len(re.findall(r"<li[^>]*><a href=", text.split('id="search-results"')[1])), 1)

    def test_the_table_of_presets_shows_all_its_columns(self):
        script = "addEventListener('load',()=>{document.body.dataset.wide=JSON.stringify([...document.querySelectorAll('.table-wrapper')].map((one)=>[one.scrollWidth,one.clientWidth]))})"
        text = self.opened(self.probe("reference/presets.html", script), "--window-size=1300,1000")
        widths = re.findall(r"\[(\d+),(\d+)\]", re.search(r'data-wide="([^"]+)"', text)[1])
        self.assertEqual(len(widths), 3)
        for needed, given in widths:
            self.assertLessEqual(int(needed), int(given))


if __name__ == "__main__":
    os.environ.pop("GLINT_DOCS_PYTHON", None)
    python_case.main()

# Tests what presented frames leave: pictures, frames in the index, and launches that are chosen by frame.
# SPDX-License-Identifier: Apache-2.0
"""usage: window_test.py MANIFEST SOURCE_DIR CLIENT GLINT"""
import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import unittest
import zlib

import vulkan_case
from vulkan_case import VulkanTest

CLIENT, GLINT = (pathlib.Path(word).resolve() for word in sys.argv[3:5])
COLOURS = [(255, 0, 0), (0, 255, 0), (0, 0, 255)]


def pixels(path):
    """Returns (width, height, set of colours) of a PNG whose rows have one colour."""
    data = path.read_bytes()
    width, height, bits, kind = struct.unpack(">IIBB", data[16:26])
    assert (bits, kind) == (8, 2), "it has three channels of 8 bits"
    at, packed = 8, b""
    while at < len(data):
        size, name = struct.unpack(">I4s", data[at:at + 8])
        packed += data[at + 8:at + 8 + size] if name == b"IDAT" else b""
        at += 12 + size
    rows, before, colours = zlib.decompress(packed), bytes(3 * width), set()
    for y in range(height):
        line = bytearray(rows[y * (3 * width + 1):(y + 1) * (3 * width + 1)])
        how, line = line[0], line[1:]
        for i, value in enumerate(line):
            left, above = line[i - 3] if i >= 3 else 0, before[i]
            corner = before[i - 3] if i >= 3 else 0
            nearest = min((left, above, corner), key=lambda one: abs(left + above - corner - one))
            line[i] = (value + (0, left, above, (left + above) // 2, nearest)[how]) & 255
        colours |= {tuple(line[i:i + 3]) for i in range(0, len(line), 3)}
        before = bytes(line)
    return width, height, colours


class Window(VulkanTest):
    def frames(self, **environment):
        result = self.run_on_glint(CLIENT, "[three_frames]", **environment)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return result

    def names(self, folder):
        return sorted(path.name for path in (self.folder / folder).iterdir())

    def test_each_frame_is_a_picture_when_all_are_wanted(self):
        self.frames(GLINT_VK_PRESENT="all", GLINT_OUT="all")
        self.assertEqual(self.names("all"), ["index.json"] + [f"present-000{i}.png" for i in range(3)])
        for i, colour in enumerate(COLOURS):
            self.assertEqual(pixels(self.folder / f"all/present-000{i}.png"), (40, 24, {colour}))

    def test_the_last_frame_alone_is_kept_unless_something_else_is_asked(self):
        self.frames(GLINT_OUT="last")
        self.assertEqual(self.names("last"), ["index.json", "present-last.png"])
        self.assertEqual(pixels(self.folder / "last/present-last.png"), (40, 24, {COLOURS[2]}))
        self.frames(GLINT_OUT="none", GLINT_VK_PRESENT="none")
        self.assertEqual(self.names("none"), ["index.json"])
        self.frames(GLINT_VK_PRESENT="frame 1")
        self.assertEqual(self.names("out/vulkan-test_vulkan"), ["index.json", "present-0001.png"])
        self.assertEqual(pixels(self.folder / "out/vulkan-test_vulkan/present-0001.png"), (40, 24, {COLOURS[1]}))

    def test_without_a_choice_nothing_is_left(self):
        self.frames()
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_launches_are_chosen_by_frame_and_the_index_has_the_frames(self):
        for choice, taken in (("frame 1", [1]), ("frame 1-2", [1, 2]), ("frame 0; launch 2", [0, 2]), ("frame 7", [])):
            with self.subTest(choice):
                out = self.frames(GLINT_TIMING=choice).stdout
                self.assertEqual([int(n) for n in re.findall(r"dispatch (\d+): shader \d+, \d+ cycles", out)], taken)
        self.frames(GLINT_OUT="index", GLINT_VK_PRESENT="frame 2")
        commands = json.loads((self.folder / "index/index.json").read_text())["commands"]
        self.assertEqual([(each["kind"], each["frame"]) for each in commands if each["kind"] != "transfer"],
                         [(kind, frame) for frame in range(3) for kind in ("dispatch", "present")])
        presents = [each for each in commands if each["kind"] == "present"]
        self.assertEqual([each["size"] for each in presents], [[40, 24]] * 3)
        self.assertEqual([each.get("file") for each in presents], [None, None, "present-0002.png"])

    def test_the_report_has_the_frames(self):
        done = subprocess.run([GLINT, "vulkan", "--present", "all", "--timing", "frame 1", "--out", "here", "--", CLIENT, "[three_frames]"],
                              cwd=self.folder, capture_output=True, text=True, timeout=200)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("3 frames were presented\n", done.stderr)
        page = (self.folder / "here/report.html").read_text()
        for part in ('id="frames"', "frame 1 ends at cycle", '<a href="present-0001.png">'):
            self.assertIn(part, page)

    def test_draws_are_dropped_with_a_word_and_their_pictures_are_marked(self):
        result = self.run_on_glint(CLIENT, "[dropped_draws]", GLINT_VK_QUEUE="universal", GLINT_OUT="drawn")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertEqual(result.stderr.count("draws with graphics pipeline 1 are dropped"), 1, result.stderr)
        self.assertEqual(pixels(self.folder / "drawn/present-last.png"), (40, 24, {COLOURS[1], COLOURS[2]}))
        index = json.loads((self.folder / "drawn/index.json").read_text())
        self.assertEqual([(each["what"], each["count"]) for each in index["dropped"]], [("draws with graphics pipeline 1", 2)])
        self.assertEqual(index["commands"][-1]["dropped"], 2)
        cleared = 40 * 24 * 4 + 40 * 4 * 4  # The pass clears all of the image, and then four of its rows.
        transfers = [(each["count"], each["bytes"]) for each in index["commands"] if each["kind"] == "transfer"]
        self.assertEqual(transfers, [(2, cleared)])

    def test_a_universal_device_has_three_families_of_queues(self):
        result = self.run_on_glint(CLIENT, "[families]", GLINT_VK_QUEUE="universal")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_a_universal_queue_has_formats_of_vertices(self):
        result = self.run_on_glint(CLIENT, "[vertex_formats]", GLINT_VK_QUEUE="universal")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertNotEqual(self.run_on_glint(CLIENT, "[vertex_formats]").returncode, 0)

    def run_on_x(self, *command, **environment):
        """Runs a program on Glint with an X server of its own."""
        read, write = os.pipe()
        with subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "640x480x24"], pass_fds=[write],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as server:
            os.close(write)
            try:
                with os.fdopen(read) as lines:
                    display = lines.readline().strip()  # The server writes it when it is ready.
                return self.run_on_glint(*command, DISPLAY=f":{display}", **environment)
            finally:
                server.terminate()

    @unittest.skipUnless(shutil.which("Xvfb"), "SKIPPED: Xvfb is not installed (package xvfb)")
    def test_a_window_of_xlib_gives_its_size_and_is_lost_when_it_is_destroyed(self):
        result = self.run_on_x(CLIENT, "[xlib]", GLINT_OUT="xlib")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertEqual(pixels(self.folder / "xlib/present-last.png"), (200, 120, {COLOURS[1]}))

    @unittest.skipUnless(shutil.which("Xvfb") and shutil.which("vkcube"), "SKIPPED: Xvfb or vkcube is not installed (packages xvfb, vulkan-tools)")
    def test_a_window_of_x_gives_its_size(self):
        result = self.run_on_x("vkcube", "--c", "3", "--suppress_popups", GLINT_OUT="cube", GLINT_VK_QUEUE="universal")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        index = json.loads((self.folder / "cube/index.json").read_text())
        presents = [each for each in index["commands"] if each["kind"] == "present"]
        self.assertEqual([(each["size"], each["dropped"]) for each in presents], [([500, 500], 1)] * 3)
        self.assertEqual(pixels(self.folder / "cube/present-last.png"), (500, 500, {(51, 51, 51)}))  # It clears to grey.

    def test_a_wrong_choice_is_refused_by_name(self):
        for name, value in (("GLINT_VK_PRESENT", "some"), ("GLINT_VK_PRESENT", "frame x"), ("GLINT_TIMING", "frame 3-1")):
            result = self.run_on_glint(CLIENT, "[three_frames]", **{name: value})
            self.assertNotEqual(result.returncode, 0)
            self.assertIn(f"{name}: ", result.stderr)


vulkan_case.main()

# Tests ffmpeg's Vulkan filters, which nobody wrote for Glint: their pictures are those of lavapipe within 1/255.
# SPDX-License-Identifier: Apache-2.0
"""usage: ffmpeg_test.py MANIFEST SOURCE_DIR"""
import pathlib
import sys

import vulkan_case
from vulkan_case import MANIFEST, VulkanTest

LAVAPIPE = next(pathlib.Path("/usr/share/vulkan/icd.d").glob("lvp_icd*.json"), None)
SOURCE = ["-f", "lavfi", "-i", "testsrc2=size=64x48:rate=1"]
ONE = {
    "hflip": "hflip_vulkan", "vflip": "vflip_vulkan", "transpose": "transpose_vulkan=dir=clock",
    "scale": "scale_vulkan=w=32:h=24", "chromaber": "chromaber_vulkan=dist_x=0.02:dist_y=0.01",
}


class Ffmpeg(VulkanTest):
    def picture(self, manifest, *filters):
        """Returns the bytes of a filtered picture."""
        out = self.folder / "out.raw"
        result = self.run_on_glint("ffmpeg", "-hide_banner", "-loglevel", "error", "-init_hw_device", "vulkan=v:0", "-filter_hw_device", "v",
                                   *filters, "-frames:v", "1", "-f", "rawvideo", "-y", out,
                                   VK_DRIVER_FILES=str(manifest), VK_ICD_FILENAMES=str(manifest))
        self.assertEqual(result.returncode, 0, result.stderr)
        return out.read_bytes()

    def compare(self, *filters):
        ours, theirs = self.picture(MANIFEST, *filters), self.picture(LAVAPIPE, *filters)
        self.assertEqual(len(ours), len(theirs))
        self.assertGreater(len(set(ours)), 16, "the picture is not one colour")
        self.assertLessEqual(max(abs(a - b) for a, b in zip(ours, theirs)), 1)

    def test_filters_of_one_picture(self):
        for name, filters in ONE.items():
            with self.subTest(name):
                self.compare(*SOURCE, "-vf", f"format=rgba,hwupload,{filters},hwdownload,format=rgba")

    def test_the_average_blur_is_its_definition(self):
        size, radius = 32, 2  # sizeX=3 has two neighbours on either side; samples lie at the corners of texels
        source = ["-f", "lavfi", "-i", f"testsrc2=size={size}x{size}:rate=1"]
        before = self.picture(MANIFEST, *source, "-vf", "format=rgba")
        after = self.picture(MANIFEST, *source, "-vf", "format=rgba,hwupload,avgblur_vulkan=sizeX=3:sizeY=3,hwdownload,format=rgba")

        def texel(picture, x, y, channel):
            return picture[(min(max(y, 0), size - 1) * size + min(max(x, 0), size - 1)) * 4 + channel]

        def blurred(picture, dx, dy):
            out = bytearray(len(picture))
            for i in range(len(picture)):
                x, y, channel = i // 4 % size, i // 4 // size, i % 4
                total = sum(texel(picture, x + dx * p - a, y + dy * p - b, channel)
                            for p in range(-radius, radius + 1) for a in (0, 1) for b in (0, 1))
                parts = 4 * (2 * radius + 1)
                out[i] = (2 * total + parts) // (2 * parts)
            return bytes(out)

        wanted = blurred(blurred(before, 1, 0), 0, 1)
        self.assertGreater(len(set(wanted)), 16)
        self.assertLessEqual(max(abs(a - b) for a, b in zip(after, wanted)), 1)

    def test_filters_of_two_pictures(self):
        for filters in ("overlay_vulkan=x=5:y=7", "blend_vulkan=all_mode=multiply"):
            with self.subTest(filters):
                size = "64x48" if filters.startswith("blend") else "16x16"
                self.compare(*SOURCE, "-f", "lavfi", "-i", f"testsrc=size={size}:rate=1", "-filter_complex",
                             f"[0]format=rgba,hwupload[a];[1]format=rgba,hwupload[b];[a][b]{filters},hwdownload,format=rgba")


vulkan_case.need("ffmpeg", "ffmpeg")
if not LAVAPIPE:
    print("SKIPPED: lavapipe is not installed (package mesa-vulkan-drivers)")
    sys.exit(vulkan_case.SKIPPED)
vulkan_case.main()

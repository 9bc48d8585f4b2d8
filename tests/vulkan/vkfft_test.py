# Tests VkFFT, which nobody wrote for Glint: its transforms are those of the definition.
# SPDX-License-Identifier: Apache-2.0
"""usage: vkfft_test.py MANIFEST SOURCE_DIR TEST_PROGRAM

The program vkfft_client is built beside TEST_PROGRAM where libvkfft-dev is installed.
"""
import pathlib
import sys

import vulkan_case
from vulkan_case import VulkanTest

CLIENT = pathlib.Path(sys.argv[3]).resolve().parent / "vkfft_client"


class VkFft(VulkanTest):
    def test_transforms_are_those_of_the_definition(self):
        result = self.run_on_glint(CLIENT)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr.count("fault"), 0, result.stderr)
        errors = {int(size): (float(there), float(back)) for size, there, back in map(str.split, result.stdout.splitlines())}
        self.assertEqual(sorted(errors), [8, 64, 100, 243, 1001, 1024])
        for size, (there, back) in errors.items():
            with self.subTest(size):
                # Results grow with the square root of the size, and errors with its logarithm besides.
                self.assertLess(there, 1e-5 * size**0.5)
                self.assertLess(back, 1e-5)


if not CLIENT.exists():
    print("SKIPPED: the tests were built without VkFFT (package libvkfft-dev)")
    sys.exit(vulkan_case.SKIPPED)
vulkan_case.main()

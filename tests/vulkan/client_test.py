# Runs the tests of the client program on another driver, under the validation layer, which has to stay silent, and with
# little memory.
# SPDX-License-Identifier: Apache-2.0
"""usage: client_test.py MANIFEST SOURCE_DIR CLIENT"""
import pathlib
import sys

import vulkan_case
from vulkan_case import VulkanTest

CLIENT = pathlib.Path(sys.argv[3]).resolve()
LAYER = pathlib.Path("/usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json")
LAVAPIPE = next(pathlib.Path("/usr/share/vulkan/icd.d").glob("lvp_icd*.json"), None)


class Client(VulkanTest):
    def test_lavapipe_computes_the_same(self):
        if not LAVAPIPE:
            self.skipTest("lavapipe is not installed (package mesa-vulkan-drivers)")
        result = self.run_on_glint(CLIENT, "[portable]", VK_DRIVER_FILES=str(LAVAPIPE), VK_ICD_FILENAMES=str(LAVAPIPE))
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_the_validation_layer_stays_silent(self):
        if not LAYER.exists():
            self.skipTest("the validation layer is not installed (package vulkan-validationlayers)")
        result = self.run_on_glint(CLIENT, "[portable]~[graphics]", VK_INSTANCE_LAYERS="VK_LAYER_KHRONOS_validation",
                                   VK_LAYER_ENABLES="VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertNotIn("heard:", result.stderr)

    def test_memory_that_the_host_does_not_have_is_refused(self):
        result = self.run_on_glint("sh", "-c", f"ulimit -v 3000000 && exec {CLIENT} '[little_memory]'")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn("the host has no memory for 4294967296 bytes", result.stderr)


vulkan_case.main()

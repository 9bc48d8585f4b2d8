# Tests that the program vulkaninfo finds the device and hears an answer to all that it asks.
# SPDX-License-Identifier: Apache-2.0
"""usage: vulkaninfo_test.py MANIFEST SOURCE_DIR"""
import json
import sys

import vulkan_case
from vulkan_case import MANIFEST, VulkanTest


class VulkanInfo(VulkanTest):
    def test_it_ends_well_and_names_no_command_that_is_missing(self):
        result = self.run_on_glint("vulkaninfo")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("is not there", result.stderr)
        self.assertIn("deviceName        = Glint mobile (simulated)", result.stdout)
        self.assertIn("QUEUE_COMPUTE | QUEUE_TRANSFER", result.stdout)

    def test_a_universal_queue_has_graphics_and_says_that_it_pretends(self):
        result = self.run_on_glint("vulkaninfo", GLINT_VK_QUEUE="universal")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("QUEUE_GRAPHICS", result.stdout)
        self.assertRegex(result.stdout, r"independentBlend\s+= true")
        self.assertRegex(result.stdout, r"conformanceVersion:\s+major\s+= 1\s+minor\s+= 3\s")
        self.assertIn("the device announces graphics and has none of it, and a conformance that nobody certified", result.stderr)
        without = self.run_on_glint("vulkaninfo").stdout
        self.assertNotIn("QUEUE_GRAPHICS", without)
        self.assertRegex(without, r"independentBlend\s+= false")
        self.assertRegex(without, r"conformanceVersion:\s+major\s+= 0\s+minor\s+= 0\s")

    def test_an_unknown_queue_is_refused(self):
        result = self.run_on_glint("vulkaninfo", GLINT_VK_QUEUE="all")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("GLINT_VK_QUEUE is 'all': it has to be 'compute' or 'universal'", result.stderr)

    def test_a_variable_of_a_wrong_name_is_refused(self):
        for name, meant in (("GLINT_VK_TIMING", "did you mean GLINT_TIMING?"), ("GLINT_VK_PRESENTS", "did you mean GLINT_VK_PRESENT?"),
                            ("GLINT_VK_THIRTY_TWO", "it has GLINT_CONFIG, ")):
            with self.subTest(name):
                result = self.run_on_glint("vulkaninfo", **{name: "all"})
                self.assertNotEqual(result.returncode, 0)
                self.assertIn(f"{name} is no variable of the driver; {meant}", result.stderr)

    def test_the_library_shows_the_loader_s_functions_and_no_others(self):
        library = json.loads(MANIFEST.read_text())["ICD"]["library_path"]
        listed = self.run_on_glint("nm", "-D", "--defined-only", library)
        names = [line.split()[-1] for line in listed.stdout.splitlines()]
        self.assertEqual(sorted(names), ["vk_icdGetInstanceProcAddr", "vk_icdGetPhysicalDeviceProcAddr",
                                         "vk_icdNegotiateLoaderICDInterfaceVersion"])

    def test_the_library_stays_where_it_is_when_it_is_closed_and_can_be_opened_again(self):
        library = json.loads(MANIFEST.read_text())["ICD"]["library_path"]
        script = f"""
import _ctypes, ctypes
for _ in range(5):
    library = ctypes.CDLL({library!r})
    version = ctypes.c_uint32(99)
    assert library.vk_icdNegotiateLoaderICDInterfaceVersion(ctypes.byref(version)) == 0 and version.value == 5
    _ctypes.dlclose(library._handle)
    assert "libglint_vulkan" in open("/proc/self/maps").read()
"""
        result = self.run_on_glint(sys.executable, "-c", script)
        self.assertEqual(result.returncode, 0, result.stderr)


vulkan_case.need("vulkaninfo", "vulkan-tools")
vulkan_case.main()

# Tests two makers of WebGPU, which nobody wrote for Glint: a shader in WGSL computes what it says.
# SPDX-License-Identifier: Apache-2.0
"""usage: webgpu_test.py MANIFEST SOURCE_DIR

GLINT_NODE_MODULES names the folder in which npm installed webgpu, which is Dawn, or @deno/linux-x64-glibc, which has wgpu.
"""
import json
import unittest

import vulkan_case
from vulkan_case import ROOT, VulkanTest

COUNT, GROUP = 1000, 64  # of webgpu_client.mjs
CLIENT = ROOT / "tests/vulkan/webgpu_client.mjs"

vulkan_case.need("node", "nodejs")
DAWN, DENO = vulkan_case.need_module("webgpu", "@deno/linux-x64-glibc")


class WebGpu(VulkanTest):
    def expect_numbers(self, result, adapter):
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("is not there", result.stderr)
        self.assertIn("the device announces graphics and has none of it", result.stderr)
        found = json.loads(result.stdout.splitlines()[-1])
        self.assertIn(adapter, found["adapter"])
        self.assertEqual(found["numbers"], [2 * i + 0.5 for i in range(COUNT)])
        groups = [sum(range(first, min(first + GROUP, COUNT))) for first in range(0, COUNT, GROUP)]
        self.assertEqual(found["sums"], [sum(groups), max(groups)])

    def expect_no_adapter(self, result):
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("there is no adapter", result.stderr)

    @unittest.skipUnless(DAWN, "there is no module webgpu")
    def test_dawn_computes_with_a_universal_queue_and_without_it_passes_over_the_device(self):
        command = ["node", CLIENT, DAWN]
        self.expect_numbers(self.run_on_glint(*command, GLINT_VK_QUEUE="universal"), "Glint: preset mobile")
        self.expect_no_adapter(self.run_on_glint(*command))

    @unittest.skipUnless(DENO, "there is no module @deno/linux-x64-glibc")
    def test_wgpu_computes_with_a_universal_queue_and_without_it_passes_over_the_device(self):
        command = [DENO / "deno", "run", "--allow-all", "--unstable-webgpu", "--no-config", CLIENT]
        only = {"DENO_WEBGPU_BACKEND": "vulkan", "DENO_DIR": str(self.folder), "NO_COLOR": "1"}
        self.expect_numbers(self.run_on_glint(*command, GLINT_VK_QUEUE="universal", **only), "Glint mobile (simulated)")
        self.expect_no_adapter(self.run_on_glint(*command, **only))


vulkan_case.main()

# Tests Dawn, the WebGPU of npm's module webgpu, which nobody wrote for Glint: a shader in WGSL computes what it says.
# SPDX-License-Identifier: Apache-2.0
"""usage: webgpu_test.py MANIFEST SOURCE_DIR

GLINT_NODE_MODULES names the folder in which npm installed webgpu.
"""
import json

import vulkan_case
from vulkan_case import ROOT, VulkanTest

COUNT, GROUP = 1000, 64  # of webgpu_client.mjs


class WebGpu(VulkanTest):
    def run_client(self, **environment):
        return self.run_on_glint("node", ROOT / "tests/vulkan/webgpu_client.mjs", MODULE, **environment)

    def test_a_shader_computes_with_a_universal_queue(self):
        result = self.run_client(GLINT_VK_QUEUE="universal")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("is not there", result.stderr)
        self.assertIn("the device announces graphics and has none of it", result.stderr)
        found = json.loads(result.stdout.splitlines()[-1])
        self.assertIn("Glint: preset mobile", found["adapter"])
        self.assertEqual(found["numbers"], [2 * i + 0.5 for i in range(COUNT)])
        groups = [sum(range(first, min(first + GROUP, COUNT))) for first in range(0, COUNT, GROUP)]
        self.assertEqual(found["sums"], [sum(groups), max(groups)])

    def test_without_it_dawn_passes_over_the_device(self):
        result = self.run_client()
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("there is no adapter", result.stderr)


vulkan_case.need("node", "nodejs")
MODULE = vulkan_case.need_module("webgpu")
vulkan_case.main()

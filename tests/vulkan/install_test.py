# Tests that the manifest which is installed finds the library, also below a prefix that was moved.
# SPDX-License-Identifier: Apache-2.0
"""usage: install_test.py MANIFEST SOURCE_DIR CLIENT GLINT"""
import os
import pathlib
import shutil
import subprocess
import sys

import vulkan_case
from vulkan_case import MANIFEST, VulkanTest

GLINT = pathlib.Path(sys.argv[4]).resolve()


class Install(VulkanTest):
    def install(self, prefix, **environment):
        """Installs the driver alone, from the build folder of its room."""
        result = subprocess.run(["cmake", "--install", MANIFEST.parent / "vulkan", "--component", "glint", "--prefix", prefix],
                                env=os.environ | environment, capture_output=True, text=True, timeout=120)
        self.assertEqual(result.returncode, 0, result.stderr)

    def expect_device(self, prefix):
        manifests = list(prefix.glob("share/vulkan/icd.d/*.json"))
        self.assertEqual([path.name for path in manifests], ["glint_icd.json"])
        result = self.run_on_glint("vulkaninfo", "--summary", VK_DRIVER_FILES=str(manifests[0]), VK_ICD_FILENAMES=str(manifests[0]))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("deviceName         = Glint mobile (simulated)", result.stdout)

    def test_a_prefix_may_be_moved(self):
        self.install(self.folder / "first")
        self.expect_device(self.folder / "first")
        (self.folder / "first").rename(self.folder / "second")
        self.expect_device(self.folder / "second")

    def test_an_installed_command_takes_the_installed_driver(self):
        self.install(self.folder / "prefix")
        (self.folder / "prefix/bin").mkdir()
        shutil.copy(GLINT, self.folder / "prefix/bin/glint")
        result = subprocess.run([self.folder / "prefix/bin/glint", "vulkan", "--", "sh", "-c", "echo $VK_DRIVER_FILES"], cwd=self.folder,
                                capture_output=True, text=True, timeout=60)
        self.assertEqual(result.stdout.strip(), str((self.folder / "prefix/share/vulkan/icd.d/glint_icd.json").resolve()), result.stderr)

    def test_the_tree_of_a_package_is_whole(self):
        self.install("/usr", DESTDIR=str(self.folder))
        self.expect_device(self.folder / "usr")


vulkan_case.need("vulkaninfo", "vulkan-tools")
vulkan_case.need("cmake", "cmake")
vulkan_case.main()

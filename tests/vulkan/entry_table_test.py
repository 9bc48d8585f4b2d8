# Tests what tools/vulkan_entry.py makes of a small registry, and what it refuses.
# SPDX-License-Identifier: Apache-2.0
"""usage: entry_table_test.py SOURCE_DIR"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(sys.argv[1]).resolve()
REGISTRY = """<registry>
<commands>
  <command><proto><type>VkResult</type> <name>vkCreateThing</name></proto>
    <param><type>VkDevice</type> <name>device</name></param>
    <param>const <type>VkAllocationCallbacks</type>* <name>pAllocator</name></param>
    <param><type>uint32_t</type>* <name>out</name></param></command>
  <command><proto><type>void</type> <name>vkDoNothing</name></proto>
    <param><type>VkCommandBuffer</type> <name>commandBuffer</name></param></command>
  <command name="vkCreateThingKHR" alias="vkCreateThing"/>
</commands>
<types>
  <type category="struct" name="VkPhysicalDeviceFeatures"><member><type>VkBool32</type> <name>old</name></member></type>
  <type category="struct" name="VkNewFeatures" structextends="VkPhysicalDeviceFeatures2,VkDeviceCreateInfo">
    <member values="VK_NEW"><type>VkStructureType</type> <name>sType</name></member>
    <member><type>void</type>* <name>pNext</name></member><member><type>VkBool32</type> <name>fresh</name></member></type>
</types>
<feature api="vulkan" name="VK_VERSION_1_0" number="1.0"><require><command name="vkCreateThing"/>
  <command name="vkDoNothing"/></require></feature>
<extensions>
  <extension name="VK_KHR_thing" type="device" requires="VK_KHR_base" supported="vulkan"><require>
    <enum value="7" name="VK_KHR_THING_SPEC_VERSION"/><command name="vkCreateThingKHR"/><type name="VkNewFeatures"/></require></extension>
  <extension name="VK_KHR_base" type="device" supported="vulkan"><require><enum value="1" name="VK_KHR_BASE_SPEC_VERSION"/><command name="vkCreateThingKHR"/>
    </require></extension>
</extensions>
</registry>"""
BOTH = 'instance_extensions = []\ndevice_extensions = ["VK_KHR_thing", "VK_KHR_base"]\nfeatures = ["fresh"]\nuniversal_features = []\n'


class EntryTable(unittest.TestCase):
    def generate(self, announced, source="VkResult CreateThing(Device& device, uint32_t* out) {\n", newer="<registry/>"):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = pathlib.Path(folder.name)
        for name, text in (("vk.xml", REGISTRY), ("announced.toml", announced), ("thing.cpp", source),
                           ("newer_extensions.xml", newer)):
            (path / name).write_text(text)
        result = subprocess.run([sys.executable, ROOT / "tools/vulkan_entry.py", path / "vk.xml", path / "announced.toml", path,
                                 path / "out"], capture_output=True, text=True)
        texts = {p.name: p.read_text() for p in path.glob("out/*.cpp")}
        return result, texts

    def test_names_are_sorted_and_an_alias_leads_to_its_command(self):
        result, texts = self.generate(BOTH)
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = [line.split(", ")[:2] for line in texts["entry_table.cpp"].splitlines() if line.startswith('    {"vk')]
        self.assertEqual(rows, [['    {"vkCreateThing"', "PFN_vkVoidFunction(&call_CreateThing)"],
                                ['    {"vkCreateThingKHR"', "PFN_vkVoidFunction(&call_CreateThing)"],
                                ['    {"vkDoNothing"', "PFN_vkVoidFunction(&call_DoNothing)"]])

    def test_a_command_knows_every_extension_that_brings_it(self):
        _, texts = self.generate(BOTH)
        self.assertIn('{"vkCreateThing", PFN_vkVoidFunction(&call_CreateThing), Level::OfDevice, ""}', texts["entry_table.cpp"])
        self.assertIn('{"vkCreateThingKHR", PFN_vkVoidFunction(&call_CreateThing), Level::OfDevice, "VK_KHR_base VK_KHR_thing"}',
                      texts["entry_table.cpp"])

    def test_newer_extensions_count_where_the_registry_lacks_them(self):
        newer = """<registry><types>
          <type category="struct" name="VkNewFeatures" structextends="VkPhysicalDeviceFeatures2">
            <member values="7"><type>VkStructureType</type> <name>sType</name></member></type>
          <type category="struct" name="VkNewestFeatures" structextends="VkPhysicalDeviceFeatures2">
            <member values="VkStructureType(9)"><type>VkStructureType</type> <name>sType</name></member>
            <member><type>VkBool32</type> <name>freshest</name></member></type></types>
          <extensions><extension name="VK_KHR_newest" type="device" supported="vulkan"><require>
            <enum value="1" name="VK_KHR_NEWEST_SPEC_VERSION"/><type name="VkNewestFeatures"/></require></extension></extensions>
          </registry>"""
        announced = BOTH.replace('"VK_KHR_base"', '"VK_KHR_base", "VK_KHR_newest"').replace('"fresh"', '"fresh", "freshest"')
        result, texts = self.generate(announced, newer=newer)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn('{"VK_KHR_newest", 1}', texts["announced.cpp"])
        self.assertIn("{VkStructureType(9), kVkNewestFeatures}", texts["announced.cpp"])
        self.assertIn("{VK_NEW, kVkNewFeatures}", texts["announced.cpp"])

    def test_a_written_command_is_guarded_and_another_says_that_it_is_not_there(self):
        _, texts = self.generate(BOTH)
        self.assertIn('guarded<VkResult>("vkCreateThing", device, [&] { return CreateThing(*device, out); })',
                      texts["entry_table.cpp"])
        self.assertIn('not_written<void>("vkDoNothing", said)', texts["entry_table.cpp"])

    def test_features_know_whether_they_are_announced(self):
        _, texts = self.generate(BOTH)
        self.assertIn('{"fresh", true, true}', texts["announced.cpp"])
        self.assertIn('{"old", false, false}', texts["announced.cpp"])
        self.assertIn('{"VK_KHR_thing", 7}', texts["announced.cpp"])

    def test_a_feature_of_graphics_is_announced_by_a_universal_queue_alone(self):
        _, texts = self.generate(BOTH.replace("universal_features = []", 'universal_features = ["old"]'))
        self.assertIn('{"old", false, true}', texts["announced.cpp"])

    def test_an_extension_without_the_one_that_it_needs_is_refused(self):
        result, _ = self.generate(BOTH.replace(', "VK_KHR_base"', ""))
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("VK_KHR_thing needs VK_KHR_base, which is not announced", result.stderr)

    def test_an_extension_whose_command_is_not_written_is_refused(self):
        result, _ = self.generate(BOTH, source="")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("not written: vkCreateThingKHR", result.stderr)

    def test_a_feature_that_nothing_announced_has_is_refused(self):
        result, _ = self.generate(BOTH.replace('"fresh"', '"stale"'))
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("stale", result.stderr)


if __name__ == "__main__":
    del sys.argv[1:]
    unittest.main(verbosity=2)

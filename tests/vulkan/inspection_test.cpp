// Tests what applications learn of a pipeline, of the time and of the memory, over the Vulkan loader.
// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <map>

#include "tests/support/catch.h"
#include "tests/vulkan/client.h"

namespace glint::test {
namespace {

const char* const kShader =
    "#version 460\nlayout(local_size_x = 64) in;\n"
    "layout(set = 0, binding = 0) buffer A { uint a[]; };\n"
    "shared uint s[64];\n"
    "void main() {\n"
    "  s[gl_LocalInvocationIndex] = a[gl_GlobalInvocationID.x];\n"
    "  barrier();\n"
    "  a[gl_GlobalInvocationID.x] = s[63 - gl_LocalInvocationIndex];\n"
    "}\n";

Client::Options with(std::vector<const char*> extensions, const void* features = nullptr) {
  Client::Options options;
  options.extensions = std::move(extensions), options.more_features = features;
  return options;
}

TEST_CASE("a pipeline says what its shader needs and shows its code") {
  const VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR features{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR, nullptr, VK_TRUE};
  Client client(with({VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME}, &features));
  const ComputePipeline made = client.pipeline(kShader, {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}});
  const auto properties =
      client.load<PFN_vkGetPipelineExecutablePropertiesKHR>("vkGetPipelineExecutablePropertiesKHR");
  const auto statistics =
      client.load<PFN_vkGetPipelineExecutableStatisticsKHR>("vkGetPipelineExecutableStatisticsKHR");
  const auto texts = client.load<PFN_vkGetPipelineExecutableInternalRepresentationsKHR>(
      "vkGetPipelineExecutableInternalRepresentationsKHR");
  const VkPipelineInfoKHR pipeline{VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR, nullptr, made.pipeline};
  VkPipelineExecutableInfoKHR info{VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, nullptr, made.pipeline, 0};

  uint32_t count = 9;
  VkPipelineExecutablePropertiesKHR shader{};
  shader.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR;
  REQUIRE(properties(client.device, &pipeline, &count, &shader) == VK_SUCCESS);
  CHECK(count == 1);
  CHECK(shader.stages == VK_SHADER_STAGE_COMPUTE_BIT);
  CHECK(shader.subgroupSize == 32);

  REQUIRE(statistics(client.device, &info, &count, nullptr) == VK_SUCCESS);
  std::vector<VkPipelineExecutableStatisticKHR> all(count);
  REQUIRE(statistics(client.device, &info, &count, all.data()) == VK_SUCCESS);
  std::map<std::string, uint64_t> values;
  for (const auto& each : all) values[each.name] = each.value.u64;
  CHECK(values.at("Shared bytes") == 256);
  CHECK(values.at("Stack instructions") == 0);
  CHECK(values.at("Resident warps") == 2 * values.at("Resident workgroups"));

  VkPipelineExecutableInternalRepresentationKHR text{};
  text.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INTERNAL_REPRESENTATION_KHR;
  count = 1;
  REQUIRE(texts(client.device, &info, &count, &text) == VK_SUCCESS);
  std::string code(text.dataSize, '?');
  text.pData = code.data();
  REQUIRE(texts(client.device, &info, &count, &text) == VK_SUCCESS);
  CHECK(code.size() == std::strlen(code.c_str()) + 1);
  CHECK_THAT(code, Catch::Contains("ld.shared"));
  text.dataSize = 10;
  CHECK(texts(client.device, &info, &count, &text) == VK_INCOMPLETE);
  CHECK(std::strlen(code.c_str()) == 9);

  info.executableIndex = 1;
  CHECK(statistics(client.device, &info, &count, nullptr) == VK_ERROR_VALIDATION_FAILED_EXT);
}

TEST_CASE("calibrated timestamps read the device's clock and the host's") {
  Client client(with({VK_EXT_CALIBRATED_TIMESTAMPS_EXTENSION_NAME}));
  const MappedBuffer out = client.buffer(1 << 20);
  const auto read = client.load<PFN_vkGetCalibratedTimestampsEXT>("vkGetCalibratedTimestampsEXT");
  const VkCalibratedTimestampInfoEXT domains[] = {
      {VK_STRUCTURE_TYPE_CALIBRATED_TIMESTAMP_INFO_EXT, nullptr, VK_TIME_DOMAIN_DEVICE_EXT},
      {VK_STRUCTURE_TYPE_CALIBRATED_TIMESTAMP_INFO_EXT, nullptr, VK_TIME_DOMAIN_CLOCK_MONOTONIC_EXT}};
  std::array<uint64_t, 2> before{}, after{};
  uint64_t deviation = 0;
  REQUIRE(read(client.device, 2, domains, before.data(), &deviation) == VK_SUCCESS);
  CHECK(deviation > 0);

  REQUIRE(client.run([&](VkCommandBuffer to) { vkCmdFillBuffer(to, out.buffer, 0, VK_WHOLE_SIZE, 5); }) ==
          VK_SUCCESS);

  REQUIRE(read(client.device, 2, domains, after.data(), &deviation) == VK_SUCCESS);
  CHECK(after[0] - before[0] == 25560);  // as timestamps say in queue_test.cpp
  CHECK(after[1] > before[1]);
}

TEST_CASE("the budget of the heap says what the process has, on whatever instance") {
  Client client(with({VK_EXT_MEMORY_BUDGET_EXTENSION_NAME})), other;
  const auto used = [](const Client& of) {
    VkPhysicalDeviceMemoryBudgetPropertiesEXT budget{};
    budget.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_BUDGET_PROPERTIES_EXT;
    VkPhysicalDeviceMemoryProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_PROPERTIES_2, properties.pNext = &budget;
    vkGetPhysicalDeviceMemoryProperties2(of.physical, &properties);
    CHECK(budget.heapBudget[0] == properties.memoryProperties.memoryHeaps[0].size);
    return budget.heapUsage[0];
  };
  const VkDeviceSize before = used(client);
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, 4096, 0};
  VkDeviceMemory memory = nullptr;

  REQUIRE(vkAllocateMemory(client.device, &info, nullptr, &memory) == VK_SUCCESS);

  CHECK(used(client) == before + 4096);
  CHECK(used(other) == before + 4096);
  vkFreeMemory(client.device, memory, nullptr);
  CHECK(used(other) == before);
}

// An untimed launch runs as if on one core with one warp.
TEST_CASE("a shader reads on which core and in which place its warp runs, within what the device says") {
  VkPhysicalDeviceShaderSMBuiltinsFeaturesNV wanted{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_SM_BUILTINS_FEATURES_NV, nullptr, VK_TRUE};
  Client::Options options;
  options.extensions = {VK_NV_SHADER_SM_BUILTINS_EXTENSION_NAME}, options.more_features = &wanted;
  Client client(options);
  VkPhysicalDeviceShaderSMBuiltinsPropertiesNV cores{};
  cores.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_SM_BUILTINS_PROPERTIES_NV;
  VkPhysicalDeviceProperties2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &cores, {}};
  vkGetPhysicalDeviceProperties2(client.physical, &all);
  const MappedBuffer out = client.buffer(4096);
  const ComputePipeline pipeline = client.pipeline(
      "#version 460\n#extension GL_NV_shader_sm_builtins : require\nlayout(local_size_x = 32) in;\n"
      "layout(set = 0, binding = 0) buffer Out { uvec4 v[]; };\n"
      "void main() { if (gl_LocalInvocationIndex == 0) v[gl_WorkGroupID.x] = uvec4(gl_SMIDNV, gl_SMCountNV, "
      "gl_WarpIDNV, gl_WarpsPerSMNV); }\n",
      {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}});
  const VkDescriptorSet set = client.set(pipeline.set_layout, {{out.buffer, 0, VK_WHOLE_SIZE}});

  REQUIRE(client.dispatch(pipeline, set, {64, 1, 1}) == VK_SUCCESS);

  CHECK(cores.shaderSMCount == 8);
  CHECK(cores.shaderWarpsPerSM == 32);
  for (uint32_t i = 0; i < 64; ++i) {
    const auto v = out.as<uint32_t>().subspan(4 * i, 4);
    REQUIRE(v[0] < v[1]);
    REQUIRE(v[1] <= cores.shaderSMCount);
    REQUIRE(v[2] < v[3]);
    REQUIRE(v[3] <= cores.shaderWarpsPerSM);
  }
  CHECK(client.messages.empty());
}

}  // namespace
}  // namespace glint::test

// Tests that wrong use, faults and endless shaders give results and messages, and leave the application
// alive.
// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "tests/support/catch.h"
#include "tests/vulkan/client.h"

namespace glint::test::wrong_use_test {
namespace {

constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
const std::string kHead =
    "#version 460\nlayout(local_size_x = 64) in;\n"
    "layout(set = 0, binding = 0) buffer A { uint a[]; };\n";

std::string joined(const std::vector<std::string>& texts) {
  std::string out;
  for (const std::string& each : texts) out += each + "\n";
  return out;
}

TEST_CASE("an access past a buffer is said with its GLSL line, and the application goes on") {
  Client client;
  const MappedBuffer out = client.buffer(256);
  const ComputePipeline pipeline =
      client.pipeline(kHead + "void main() {\n  a[gl_GlobalInvocationID.x] = 3;\n}\n", {{kStorage}});
  const VkDescriptorSet set = client.set(pipeline.set_layout, {{out.buffer, 0, VK_WHOLE_SIZE}});

  REQUIRE(client.dispatch(pipeline, set, {2, 1, 1}) == VK_SUCCESS);

  CHECK(out.as<uint32_t>()[63] == 3);
  REQUIRE(client.messages.size() == 1);
  CHECK_THAT(client.messages[0],
             Catch::Contains("client.comp:5") && Catch::Contains("past the end of 'buffer 1'"));
}

TEST_CASE("a descriptor's range ends where it says, inside of its buffer") {
  Client client;
  const MappedBuffer out = client.buffer(1024);
  std::memset(out.data, 0, out.bytes);
  const ComputePipeline pipeline =
      client.pipeline(kHead + "void main() { a[gl_GlobalInvocationID.x] = 3; }\n", {{kStorage}});
  const VkDescriptorSet set = client.set(pipeline.set_layout, {{out.buffer, 256, 128}});

  REQUIRE(client.dispatch(pipeline, set, {1, 1, 1}) == VK_SUCCESS);

  for (uint32_t i = 0; i < 256; ++i) REQUIRE(out.as<uint32_t>()[i] == (i >= 64 && i < 96 ? 3 : 0));
  CHECK_THAT(joined(client.messages), Catch::Contains("bytes 256 to 384"));
}

TEST_CASE("with robustBufferAccess the same access is no fault") {
  Client::Options options;
  options.features.robustBufferAccess = VK_TRUE;
  Client client(options);
  const MappedBuffer out = client.buffer(256);
  const ComputePipeline pipeline =
      client.pipeline(kHead + "void main() { a[gl_GlobalInvocationID.x] = 3; }\n", {{kStorage}});
  const VkDescriptorSet set = client.set(pipeline.set_layout, {{out.buffer, 0, VK_WHOLE_SIZE}});

  REQUIRE(client.dispatch(pipeline, set, {2, 1, 1}) == VK_SUCCESS);
  CHECK(client.messages.empty());
}

TEST_CASE("a shader that does not end loses the device and says where") {
  Client client;
  const MappedBuffer out = client.buffer(256);
  const ComputePipeline pipeline =
      client.pipeline(kHead + "void main() {\n  while (true) {\n    a[0] += 1;\n  }\n}\n", {{kStorage}});
  const VkDescriptorSet set = client.set(pipeline.set_layout, {{out.buffer, 0, VK_WHOLE_SIZE}});

  CHECK(client.dispatch(pipeline, set, {1, 1, 1}) == VK_ERROR_DEVICE_LOST);

  CHECK_THAT(joined(client.messages), Catch::Contains("client.comp:6"));
  CHECK(vkQueueWaitIdle(client.queue) == VK_ERROR_DEVICE_LOST);
}

// Returns a module whose entry point does nothing. `returned` is the type of what the entry point returns.
std::vector<uint32_t> empty_module(uint32_t returned) {
  constexpr uint32_t kVoid = 2, kBound = 5, kMain = 0x6e69616d;
  return {0x07230203,
          0x10000,
          0,
          kBound,
          0,  // the header
          2 << 16 | 17,
          1,  // OpCapability Shader
          3 << 16 | 14,
          0,
          1,  // OpMemoryModel Logical GLSL450
          5 << 16 | 15,
          5,
          1,
          kMain,
          0,  // OpEntryPoint GLCompute %1 "main"
          6 << 16 | 16,
          1,
          17,
          1,
          1,
          1,  // OpExecutionMode %1 LocalSize 1 1 1
          2 << 16 | 19,
          kVoid,  // %2 = OpTypeVoid
          3 << 16 | 33,
          3,
          kVoid,  // %3 = OpTypeFunction %2
          5 << 16 | 54,
          returned,
          1,
          0,
          3,
          2 << 16 | 248,
          4,  // %1 = OpFunction, %4 = OpLabel
          1 << 16 | 253,
          1 << 16 | 56};  // OpReturn, OpFunctionEnd
}

TEST_CASE("a shader that is no valid SPIR-V is refused when it runs, with what is wrong in it") {
  const auto run = [](Client& client, const std::vector<uint32_t>& words) {
    PipelineOptions options;
    options.module = client.module(words);
    return client.dispatch(client.pipeline({}, options), nullptr, {1, 1, 1});
  };
  Client valid;
  CHECK(run(valid, empty_module(2)) == VK_SUCCESS);
  CHECK(joined(valid.messages).empty());
  Client unknown_type;
  CHECK(run(unknown_type, empty_module(77)) < VK_SUCCESS);
  CHECK_THAT(joined(unknown_type.messages), Catch::Contains("shader 1: error: invalid SPIR-V"));
  Client cut_off;
  std::vector<uint32_t> half = empty_module(2);
  half.resize(half.size() / 2);
  CHECK(run(cut_off, half) < VK_SUCCESS);
  CHECK_THAT(joined(cut_off.messages), Catch::Contains("shader 1: error: invalid SPIR-V"));
}

TEST_CASE("a stage that asks for another size of subgroups than the device's is refused") {
  Client client;
  VkPipelineShaderStageRequiredSubgroupSizeCreateInfo size{
      VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO, nullptr, 32};
  PipelineOptions options;
  options.more_stage_info = &size;
  CHECK_NOTHROW(client.pipeline(kHead + "void main() {}\n", options));
  size.requiredSubgroupSize = 8;
  CHECK_THROWS(client.pipeline(kHead + "void main() {}\n", options));
  CHECK_THAT(joined(client.messages), Catch::Contains("subgroups of 8 threads, and the device's have 32"));
}

TEST_CASE("a copy that leaves its buffer fails the recording") {
  Client client;
  const MappedBuffer from = client.buffer(64), to = client.buffer(64);
  VkCommandBuffer commands = nullptr;
  const VkBufferCopy region{32, 0, 64};

  const VkResult end = client.record(
      commands, [&](VkCommandBuffer into) { vkCmdCopyBuffer(into, from.buffer, to.buffer, 1, &region); });

  CHECK(end == VK_ERROR_VALIDATION_FAILED_EXT);
  CHECK_THAT(joined(client.messages),
             Catch::Contains("vkCmdCopyBuffer: 64 bytes from byte 32 on leave buffer 1"));
}

TEST_CASE("a command on a buffer whose memory was freed is refused, and names the buffer") {
  Client client;
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = 256, info.usage = Client::kAllUses;
  VkBuffer buffer = nullptr;
  check(vkCreateBuffer(client.device, &info, nullptr, &buffer), "vkCreateBuffer");
  const VkMemoryAllocateInfo wanted{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, info.size, 0};
  VkDeviceMemory memory = nullptr;
  check(vkAllocateMemory(client.device, &wanted, nullptr, &memory), "vkAllocateMemory");
  check(vkBindBufferMemory(client.device, buffer, memory, 0), "vkBindBufferMemory");
  VkCommandBuffer commands = nullptr;
  REQUIRE(client.record(commands, [&](VkCommandBuffer to) {
    vkCmdFillBuffer(to, buffer, 0, VK_WHOLE_SIZE, 1);
  }) == VK_SUCCESS);
  vkFreeMemory(client.device, memory, nullptr);

  // A shader finds nothing bound.
  const ComputePipeline pipeline = client.pipeline(kHead + "void main() { a[0] = 3; }\n", {{kStorage}});
  const VkDescriptorSet set = client.set(pipeline.set_layout, {{buffer, 0, VK_WHOLE_SIZE}});
  CHECK(client.dispatch(pipeline, set, {1, 1, 1}) == VK_SUCCESS);
  CHECK_THAT(joined(client.messages), Catch::Contains("set 0 binding 0, to which nothing is bound"));

  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1, submit.pCommandBuffers = &commands;
  CHECK(vkQueueSubmit(client.queue, 1, &submit, nullptr) < VK_SUCCESS);
  CHECK_THAT(joined(client.messages), Catch::Contains("the memory of buffer 1 was freed"));
  vkDestroyBuffer(client.device, buffer, nullptr);
}

TEST_CASE("more memory than the heap has is refused, and the rest stays usable") {
  Client client;
  std::vector<VkDeviceMemory> all;
  VkResult result = VK_SUCCESS;
  while (result == VK_SUCCESS && all.size() < 100) {
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, VkDeviceSize{3} << 30, 0};
    all.push_back(nullptr);
    result = vkAllocateMemory(client.device, &info, nullptr, &all.back());
  }

  CHECK(result == VK_ERROR_OUT_OF_DEVICE_MEMORY);
  CHECK(all.size() == 6);  // 16 GiB hold five of 3 GiB.
  all.pop_back();
  for (const VkDeviceMemory each : all) vkFreeMemory(client.device, each, nullptr);
  CHECK(client.buffer(64).data != nullptr);
}

TEST_CASE(
    "a dispatch of more workgroups than an axis may have is refused, and an indirect one loses the device") {
  Client client;
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(client.physical, &properties);
  const uint32_t most = properties.limits.maxComputeWorkGroupCount[1];
  const MappedBuffer out = client.buffer(256), size = client.buffer(12);
  const ComputePipeline pipeline = client.pipeline(kHead + "void main() { a[0] = 1; }\n", {{kStorage}});
  const VkDescriptorSet set = client.set(pipeline.set_layout, {{out.buffer, 0, VK_WHOLE_SIZE}});
  CHECK(client.dispatch(pipeline, set, {1, most + 1, 1}) == VK_ERROR_VALIDATION_FAILED_EXT);
  CHECK_THAT(joined(client.messages),
             Catch::Contains("vkCmdDispatch: a dispatch of 1 x 4194304 x 1 workgroups"));
  CHECK(client.run([&](VkCommandBuffer into) {
    vkCmdBindPipeline(into, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline);
    vkCmdDispatchBase(into, 0, most, 0, 1, 1, 1);
  }) == VK_ERROR_VALIDATION_FAILED_EXT);

  size.as<uint32_t>()[0] = 1, size.as<uint32_t>()[1] = most + 1, size.as<uint32_t>()[2] = 1;
  CHECK(client.run([&](VkCommandBuffer into) {
    vkCmdBindPipeline(into, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline);
    vkCmdBindDescriptorSets(into, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, 0, 1, &set, 0, nullptr);
    vkCmdDispatchIndirect(into, size.buffer, 0);
  }) < 0);
  CHECK(vkDeviceWaitIdle(client.device) == VK_ERROR_DEVICE_LOST);
  CHECK(out.as<uint32_t>()[0] == 0);
}

TEST_CASE("an image that is empty, too wide or has too many levels is refused") {
  Client client;
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(client.physical, &properties);
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO, info.imageType = VK_IMAGE_TYPE_2D;
  info.format = VK_FORMAT_R8_UNORM, info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  const auto make = [&](VkExtent3D extent, uint32_t levels, uint32_t layers) {
    info.extent = extent, info.mipLevels = levels, info.arrayLayers = layers;
    VkImage image = nullptr;
    const VkResult result = vkCreateImage(client.device, &info, nullptr, &image);
    if (result == VK_SUCCESS) vkDestroyImage(client.device, image, nullptr);
    return result;
  };
  const uint32_t most = properties.limits.maxImageDimension2D;
  CHECK(make({most, 1, 1}, 1, 1) == VK_SUCCESS);
  CHECK(make({most + 1, 1, 1}, 1, 1) == VK_ERROR_VALIDATION_FAILED_EXT);
  CHECK(make({0, 8, 1}, 1, 1) == VK_ERROR_VALIDATION_FAILED_EXT);
  CHECK(make({8, 5, 1}, 4, 1) == VK_SUCCESS);
  CHECK(make({8, 5, 1}, 5, 1) == VK_ERROR_VALIDATION_FAILED_EXT);
  CHECK(make({8, 8, 1}, 1, 0) == VK_ERROR_VALIDATION_FAILED_EXT);
  CHECK(make({8, 8, 1}, 1, properties.limits.maxImageArrayLayers + 1) == VK_ERROR_VALIDATION_FAILED_EXT);
}

TEST_CASE("memory of a type that the device has not is refused") {
  Client client;
  const VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, 64, 3};
  VkDeviceMemory memory = nullptr;
  CHECK(vkAllocateMemory(client.device, &info, nullptr, &memory) == VK_ERROR_VALIDATION_FAILED_EXT);
  CHECK_THAT(joined(client.messages), Catch::Contains("memory type 3 is not there, only 0 to 2"));
}

TEST_CASE("a feature that is not announced is refused by name") {
  Client::Options options;
  options.features.geometryShader = VK_TRUE;
  CHECK_THROWS_WITH(Client(options), Catch::Contains("vkCreateDevice returned -8"));
}

TEST_CASE("what a shader prints reaches the messenger") {
  Client client;
  const ComputePipeline pipeline = client.pipeline(
      "#version 460\n#extension GL_EXT_debug_printf : require\nlayout(local_size_x = 2) in;\n"
      "void main() { debugPrintfEXT(\"thread %u\", gl_LocalInvocationIndex); }\n",
      {{}});

  REQUIRE(client.dispatch(pipeline, nullptr, {1, 1, 1}) == VK_SUCCESS);

  CHECK(client.prints == "thread 0\nthread 1\n");
}

TEST_CASE("instances and devices come and go a hundred times", "[portable]") {
  for (int i = 0; i < 100; ++i) {
    Client client;
    const MappedBuffer out = client.buffer(64);
    REQUIRE(client.run([&](VkCommandBuffer commands) {
      vkCmdFillBuffer(commands, out.buffer, 0, VK_WHOLE_SIZE, uint32_t(i));
    }) == VK_SUCCESS);
    REQUIRE(out.as<uint32_t>()[15] == uint32_t(i));
  }
}

}  // namespace
}  // namespace glint::test::wrong_use_test

// Is the program of timing_test.py, recording_test.py and capsule_test.py: three launches of two pipelines,
// with a label around the last, one over addresses, many launches, and one that does not end.
// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <cstring>
#include <iostream>

#include "tests/support/catch.h"
#include "tests/vulkan/client.h"

namespace glint::test::timing_test {
namespace {

constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
const std::string kHead =
    "#version 460\nlayout(local_size_x = 64) in;\n"
    "layout(set = 0, binding = 0) buffer A { uint a[]; };\n";

// The shader finds the second buffer in the first one, whose address is pushed. Nothing is bound.
TEST_CASE("a launch writes to what it reaches by addresses alone", "[.][addresses]") {
  VkPhysicalDeviceVulkan12Features features{};
  features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  features.bufferDeviceAddress = VK_TRUE;
  Client::Options options;
  options.more_features = &features, options.features.shaderInt64 = VK_TRUE;
  Client client(options);
  constexpr VkBufferUsageFlags kUses = Client::kAllUses | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
  const MappedBuffer first = client.buffer(64, kUses), second = client.buffer(256, kUses),
                     unused = client.buffer(1 << 20, kUses);
  std::memset(first.data, 0, first.bytes);
  std::memset(second.data, 0, second.bytes);
  std::memset(unused.data, 1, unused.bytes);
  const auto address_of = [&](const MappedBuffer& of) {
    const VkBufferDeviceAddressInfo info{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO, nullptr, of.buffer};
    return vkGetBufferDeviceAddress(client.device, &info);
  };
  const uint64_t pushed = address_of(first), found = address_of(second);
  std::memcpy(static_cast<char*>(first.data) + 8, &found, sizeof found);
  const ComputePipeline pipeline = client.pipeline(
      "#version 460\n#extension GL_EXT_buffer_reference : require\nlayout(local_size_x = 64) in;\n"
      "layout(buffer_reference) buffer Second { uint v[]; };\n"
      "layout(buffer_reference) buffer First { uvec2 nothing; Second second; };\n"
      "layout(push_constant) uniform P { First first; };\n"
      "void main() { uint i = gl_LocalInvocationIndex; first.second.v[i] = i ^ 21u; }\n",
      {{}, 8});
  REQUIRE(client.dispatch(pipeline, nullptr, {1, 1, 1}, {uint32_t(pushed), uint32_t(pushed >> 32)}) ==
          VK_SUCCESS);
  CHECK(second.as<uint32_t>()[63] == (63 ^ 21));
}

TEST_CASE("three launches say what the timing machine took for them", "[.][three_launches]") {
  Client client;
  const MappedBuffer out = client.buffer(4096);
  const ComputePipeline add =
      client.pipeline(kHead + "void main() { a[gl_GlobalInvocationID.x] += 3; }\n", {{kStorage}});
  const ComputePipeline square = client.pipeline(
      kHead + "void main() { uint i = gl_GlobalInvocationID.x; a[i] = a[i] * a[i]; }\n", {{kStorage}});
  const VkDescriptorSet set = client.set(add.set_layout, {{out.buffer, 0, VK_WHOLE_SIZE}});
  const auto begin = reinterpret_cast<PFN_vkCmdBeginDebugUtilsLabelEXT>(
      vkGetInstanceProcAddr(client.instance, "vkCmdBeginDebugUtilsLabelEXT"));
  const auto end = reinterpret_cast<PFN_vkCmdEndDebugUtilsLabelEXT>(
      vkGetInstanceProcAddr(client.instance, "vkCmdEndDebugUtilsLabelEXT"));

  REQUIRE(client.dispatch(add, set, {16, 1, 1}) == VK_SUCCESS);
  REQUIRE(client.dispatch(square, set, {16, 1, 1}) == VK_SUCCESS);
  REQUIRE(client.run([&](VkCommandBuffer commands) {
    VkDebugUtilsLabelEXT label{};
    label.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, label.pLabelName = "last";
    begin(commands, &label);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, add.pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, add.layout, 0, 1, &set, 0, nullptr);
    vkCmdDispatch(commands, 16, 1, 1);
    end(commands);
  }) == VK_SUCCESS);

  for (const uint32_t value : out.as<uint32_t>()) REQUIRE(value == 12);
  std::cout << client.prints;
}

TEST_CASE("many launches tell when they have ended", "[.][many_launches]") {
  Client client;
  const MappedBuffer out = client.buffer(4096);
  const ComputePipeline add =
      client.pipeline(kHead + "void main() { a[gl_GlobalInvocationID.x] += 3; }\n", {{kStorage}});
  const VkDescriptorSet set = client.set(add.set_layout, {{out.buffer, 0, VK_WHOLE_SIZE}});
  for (int i = 1; i <= 200; ++i) {
    REQUIRE(client.dispatch(add, set, {16, 1, 1}) == VK_SUCCESS);
    std::cout << "ended " << i << std::endl;
  }
}

TEST_CASE("an application ends without destroying what it made", "[.][leaving]") {
  auto* const client = new Client;
  const MappedBuffer out = client->buffer(4096);
  const ComputePipeline add =
      client->pipeline(kHead + "void main() { a[gl_GlobalInvocationID.x] += 3; }\n", {{kStorage}});
  const VkDescriptorSet set = client->set(add.set_layout, {{out.buffer, 0, VK_WHOLE_SIZE}});
  for (int i = 0; i < 100; ++i) REQUIRE(client->dispatch(add, set, {1, 1, 1}) == VK_SUCCESS);
  std::exit(0);
}

TEST_CASE("a launch that does not end loses the device", "[.][endless_launch]") {
  Client client;
  const MappedBuffer out = client.buffer(4096);
  const ComputePipeline endless =
      client.pipeline(kHead + "void main() { while (a[1] == 0) a[0] += a[1]; }\n", {{kStorage}});
  const VkDescriptorSet set = client.set(endless.set_layout, {{out.buffer, 0, VK_WHOLE_SIZE}});
  std::memset(out.data, 0, out.bytes);
  CHECK(client.dispatch(endless, set, {1, 1, 1}) == VK_ERROR_DEVICE_LOST);
  CHECK(vkQueueWaitIdle(client.queue) == VK_ERROR_DEVICE_LOST);
}

}  // namespace
}  // namespace glint::test::timing_test

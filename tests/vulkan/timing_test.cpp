// Is the program of timing_test.py and recording_test.py: three launches of two pipelines, with a label
// around the last, many launches, and one that does not end.
// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <cstring>
#include <iostream>

#include "tests/support/catch.h"
#include "tests/vulkan/client.h"

namespace glint::test {
namespace {

constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
const std::string kHead =
    "#version 460\nlayout(local_size_x = 64) in;\n"
    "layout(set = 0, binding = 0) buffer A { uint a[]; };\n";

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
}  // namespace glint::test

// Tests fences, semaphores, events and timestamps over the Vulkan loader.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstring>

#include "tests/support/catch.h"
#include "tests/vulkan/client.h"

namespace glint::test {
namespace {

Client::Options with_timelines() {
  static VkPhysicalDeviceVulkan12Features features = [] {
    VkPhysicalDeviceVulkan12Features out{};
    out.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    out.timelineSemaphore = out.hostQueryReset = VK_TRUE;
    return out;
  }();
  Client::Options options;
  options.more_features = &features;
  return options;
}

// Submits nothing but the semaphore where there are no commands.
void submit_after(VkQueue queue, VkSemaphore semaphore, uint64_t waited, uint64_t signaled,
                  VkCommandBuffer commands, VkFence fence) {
  VkTimelineSemaphoreSubmitInfo values{};
  values.sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO;
  values.waitSemaphoreValueCount = values.signalSemaphoreValueCount = 1;
  values.pWaitSemaphoreValues = &waited, values.pSignalSemaphoreValues = &signaled;
  const VkPipelineStageFlags stages = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
  VkSubmitInfo submit{};
  submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, submit.pNext = &values;
  submit.waitSemaphoreCount = 1, submit.pWaitSemaphores = &semaphore, submit.pWaitDstStageMask = &stages;
  submit.commandBufferCount = commands ? 1 : 0, submit.pCommandBuffers = &commands;
  submit.signalSemaphoreCount = 1, submit.pSignalSemaphores = &semaphore;
  check(vkQueueSubmit(queue, 1, &submit, fence), "vkQueueSubmit");
}

TEST_CASE("a queue that waits for another one goes on when that one has signaled") {
  Client::Options options = with_timelines();
  options.queues = 3;
  Client client(options);
  std::array<VkQueue, 3> queues{};
  for (uint32_t i = 0; i < queues.size(); ++i) vkGetDeviceQueue(client.device, 0, i, &queues[i]);
  CHECK(queues[0] != queues[1]);
  CHECK(queues[1] != queues[2]);
  const MappedBuffer out = client.buffer(64);
  std::memset(out.data, 0, out.bytes);
  const VkSemaphore timeline = client.timeline(0);
  const VkFence fence = client.fence();
  // The copy on queue 2 waits for 2, which the fill on queue 1 signals; the fill waits for 1.
  VkCommandBuffer fill = nullptr, copy = nullptr;
  REQUIRE(client.record(fill, [&](VkCommandBuffer to) { vkCmdFillBuffer(to, out.buffer, 0, 16, 77); }) ==
          VK_SUCCESS);
  const VkBufferCopy region{0, 32, 16};
  REQUIRE(client.record(copy, [&](VkCommandBuffer to) {
    vkCmdCopyBuffer(to, out.buffer, out.buffer, 1, &region);
  }) == VK_SUCCESS);

  submit_after(queues[2], timeline, 2, 3, copy, fence);
  submit_after(queues[1], timeline, 1, 2, fill, nullptr);

  CHECK(vkQueueWaitIdle(queues[0]) == VK_SUCCESS);
  CHECK(vkGetFenceStatus(client.device, fence) == VK_NOT_READY);
  submit_after(queues[0], timeline, 0, 1, nullptr, nullptr);
  CHECK(vkGetFenceStatus(client.device, fence) == VK_SUCCESS);
  CHECK(vkDeviceWaitIdle(client.device) == VK_SUCCESS);
  CHECK(out.as<uint32_t>()[8] == 77);
}

TEST_CASE("a submission waits for a timeline that the host signals later", "[portable]") {
  Client client(with_timelines());
  const MappedBuffer out = client.buffer(64);
  std::memset(out.data, 0, out.bytes);
  const VkSemaphore timeline = client.timeline(4);
  const VkFence fence = client.fence();
  VkCommandBuffer commands = nullptr;
  REQUIRE(client.record(commands, [&](VkCommandBuffer to) {
    vkCmdFillBuffer(to, out.buffer, 0, VK_WHOLE_SIZE, 77);
  }) == VK_SUCCESS);

  submit_after(client.queue, timeline, 5, 9, commands, fence);

  CHECK(vkGetFenceStatus(client.device, fence) == VK_NOT_READY);
  CHECK(vkWaitForFences(client.device, 1, &fence, VK_TRUE, 1000) == VK_TIMEOUT);
  CHECK(out.as<uint32_t>()[0] == 0);
  const VkSemaphoreSignalInfo signal{VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO, nullptr, timeline, 5};
  REQUIRE(vkSignalSemaphore(client.device, &signal) == VK_SUCCESS);
  CHECK(vkWaitForFences(client.device, 1, &fence, VK_TRUE, UINT64_MAX) == VK_SUCCESS);
  uint64_t value = 9;  // It may come after the fence.
  const VkSemaphoreWaitInfo end{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO, nullptr, 0, 1, &timeline, &value};
  CHECK(vkWaitSemaphores(client.device, &end, UINT64_MAX) == VK_SUCCESS);
  REQUIRE(vkGetSemaphoreCounterValue(client.device, timeline, &value) == VK_SUCCESS);
  CHECK(value == 9);
  CHECK(out.as<uint32_t>()[15] == 77);
}

TEST_CASE("the queue parks at an event until the host sets it", "[portable]") {
  Client client;
  const MappedBuffer out = client.buffer(64);
  std::memset(out.data, 0, out.bytes);
  VkEventCreateInfo info{VK_STRUCTURE_TYPE_EVENT_CREATE_INFO, nullptr, 0};
  VkEvent event = nullptr;
  REQUIRE(vkCreateEvent(client.device, &info, nullptr, &event) == VK_SUCCESS);
  const VkFence fence = client.fence();
  VkCommandBuffer commands = nullptr;
  REQUIRE(client.record(commands, [&](VkCommandBuffer to) {
    vkCmdWaitEvents(to, 1, &event, VK_PIPELINE_STAGE_HOST_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, nullptr, 0,
                    nullptr, 0, nullptr);
    vkCmdFillBuffer(to, out.buffer, 0, VK_WHOLE_SIZE, 5);
  }) == VK_SUCCESS);
  VkSubmitInfo submit{};
  submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  submit.commandBufferCount = 1, submit.pCommandBuffers = &commands;

  REQUIRE(vkQueueSubmit(client.queue, 1, &submit, fence) == VK_SUCCESS);

  CHECK(vkGetFenceStatus(client.device, fence) == VK_NOT_READY);
  CHECK(out.as<uint32_t>()[0] == 0);
  REQUIRE(vkSetEvent(client.device, event) == VK_SUCCESS);
  CHECK(vkWaitForFences(client.device, 1, &fence, VK_TRUE, UINT64_MAX) == VK_SUCCESS);
  CHECK(out.as<uint32_t>()[0] == 5);
  vkDestroyEvent(client.device, event, nullptr);
}

TEST_CASE("timestamps grow over work and reach a buffer with their availability") {
  Client client(with_timelines());
  const MappedBuffer out = client.buffer(64), work = client.buffer(1 << 20);
  VkQueryPoolCreateInfo info{
      VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, nullptr, 0, VK_QUERY_TYPE_TIMESTAMP, 3, 0};
  VkQueryPool pool = nullptr;
  REQUIRE(vkCreateQueryPool(client.device, &info, nullptr, &pool) == VK_SUCCESS);
  vkResetQueryPool(client.device, pool, 0, 3);
  const VkQueryResultFlags flags = VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WITH_AVAILABILITY_BIT;

  REQUIRE(client.run([&](VkCommandBuffer to) {
    vkCmdWriteTimestamp(to, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, pool, 0);
    vkCmdFillBuffer(to, work.buffer, 0, VK_WHOLE_SIZE, 5);
    vkCmdWriteTimestamp(to, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, pool, 1);
    vkCmdCopyQueryPoolResults(to, pool, 0, 3, out.buffer, 0, 16, flags);
  }) == VK_SUCCESS);

  const auto words = out.as<uint64_t>();
  CHECK(words[1] == 1);
  CHECK(words[3] == 1);
  CHECK(words[5] == 0);
  // 1 MiB at 56 GB/s takes 18.7 us, which are 25,559 cycles of 1365 MHz.
  CHECK(words[2] - words[0] == 25560);
  std::array<uint64_t, 2> last{};
  CHECK(vkGetQueryPoolResults(client.device, pool, 2, 1, sizeof last, last.data(), 16, flags) ==
        VK_NOT_READY);
  vkDestroyQueryPool(client.device, pool, nullptr);
}

TEST_CASE("a query of statistics counts the threads of compute shaders, and none of graphics", "[portable]") {
  Client::Options options;
  options.features.pipelineStatisticsQuery = VK_TRUE;
  Client client(options);
  const MappedBuffer out = client.buffer(64), result = client.buffer(32);
  const ComputePipeline pipeline = client.pipeline(
      "#version 460\nlayout(local_size_x = 8, local_size_y = 3) in;\n"
      "layout(set = 0, binding = 0) buffer O { uint o; };\nvoid main() { o = 1; }\n",
      {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}});
  const VkDescriptorSet set = client.set(pipeline.set_layout, {{out.buffer, 0, VK_WHOLE_SIZE}});
  VkQueryPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, info.queryCount = 1;
  info.queryType = VK_QUERY_TYPE_PIPELINE_STATISTICS;
  info.pipelineStatistics = VK_QUERY_PIPELINE_STATISTIC_COMPUTE_SHADER_INVOCATIONS_BIT;
  VkQueryPool pool = nullptr;
  REQUIRE(vkCreateQueryPool(client.device, &info, nullptr, &pool) == VK_SUCCESS);
  const auto dispatch = [&](VkCommandBuffer to, uint32_t groups) {
    vkCmdBindPipeline(to, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline);
    vkCmdBindDescriptorSets(to, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, 0, 1, &set, 0, nullptr);
    vkCmdDispatch(to, groups, 1, 1);
  };

  REQUIRE(client.run([&](VkCommandBuffer to) {
    vkCmdResetQueryPool(to, pool, 0, 1);
    dispatch(to, 7);
    vkCmdBeginQuery(to, pool, 0, 0);
    dispatch(to, 2), dispatch(to, 3);
    vkCmdEndQuery(to, pool, 0);
    dispatch(to, 5);
    vkCmdCopyQueryPoolResults(
        to, pool, 0, 1, result.buffer, 0, 16,
        VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT | VK_QUERY_RESULT_WITH_AVAILABILITY_BIT);
  }) == VK_SUCCESS);

  CHECK(result.as<uint64_t>()[0] == 5 * 24);
  CHECK(result.as<uint64_t>()[1] == 1);
  uint64_t again = 0;
  CHECK(vkGetQueryPoolResults(client.device, pool, 0, 1, sizeof again, &again, 8, VK_QUERY_RESULT_64_BIT) ==
        VK_SUCCESS);
  CHECK(again == 5 * 24);
  vkDestroyQueryPool(client.device, pool, nullptr);
}

TEST_CASE("statistics stand in the order of their bits, and occlusion is 0") {
  Client client;
  std::array<uint32_t, 4> numbers{9, 9, 9, 9};
  for (const VkQueryType type : {VK_QUERY_TYPE_PIPELINE_STATISTICS, VK_QUERY_TYPE_OCCLUSION}) {
    VkQueryPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, info.queryCount = 1, info.queryType = type;
    info.pipelineStatistics = VK_QUERY_PIPELINE_STATISTIC_CLIPPING_PRIMITIVES_BIT |
                              VK_QUERY_PIPELINE_STATISTIC_FRAGMENT_SHADER_INVOCATIONS_BIT |
                              VK_QUERY_PIPELINE_STATISTIC_COMPUTE_SHADER_INVOCATIONS_BIT;
    const bool has_three = type == VK_QUERY_TYPE_PIPELINE_STATISTICS;
    VkQueryPool pool = nullptr;
    REQUIRE(vkCreateQueryPool(client.device, &info, nullptr, &pool) == VK_SUCCESS);
    const ComputePipeline pipeline =
        client.pipeline("#version 460\nlayout(local_size_x = 4) in;\nvoid main() {}\n", {});
    REQUIRE(client.run([&](VkCommandBuffer to) {
      vkCmdResetQueryPool(to, pool, 0, 1);
      vkCmdBeginQuery(to, pool, 0, 0);
      vkCmdBindPipeline(to, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline);
      vkCmdDispatch(to, 2, 1, 1);
      vkCmdEndQuery(to, pool, 0);
    }) == VK_SUCCESS);
    numbers.fill(9);
    CHECK(vkGetQueryPoolResults(client.device, pool, 0, 1, sizeof numbers, numbers.data(), 16,
                                VK_QUERY_RESULT_WITH_AVAILABILITY_BIT) == VK_SUCCESS);
    CHECK(numbers == (has_three ? std::array<uint32_t, 4>{0, 0, 8, 1} : std::array<uint32_t, 4>{0, 1, 9, 9}));
    vkDestroyQueryPool(client.device, pool, nullptr);
  }
}

TEST_CASE("synchronization2 orders commands, events and submissions", "[portable]") {
  const VkPhysicalDeviceTimelineSemaphoreFeatures timelines{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES, nullptr, VK_TRUE};
  const VkPhysicalDeviceSynchronization2Features features{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES,
      const_cast<VkPhysicalDeviceTimelineSemaphoreFeatures*>(&timelines), VK_TRUE};
  Client::Options options;
  options.more_features = &features;
  Client client(options);
  const MappedBuffer first = client.buffer(64), second = client.buffer(64);
  const VkSemaphore timeline = client.timeline(0);
  VkEventCreateInfo made{VK_STRUCTURE_TYPE_EVENT_CREATE_INFO, nullptr, VK_EVENT_CREATE_DEVICE_ONLY_BIT};
  VkEvent event = nullptr;
  check(vkCreateEvent(client.device, &made, nullptr, &event), "vkCreateEvent");
  client.at_end([&client, event] { vkDestroyEvent(client.device, event, nullptr); });
  const VkMemoryBarrier2 barrier{
      VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,   nullptr,
      VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
      VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT};
  VkDependencyInfo dependency{};
  dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  dependency.memoryBarrierCount = 1, dependency.pMemoryBarriers = &barrier;
  const VkBufferCopy half{0, 32, 32}, all{0, 0, 64};
  VkCommandBuffer fill = nullptr, copy = nullptr;
  REQUIRE(client.record(fill, [&](VkCommandBuffer to) {
    vkCmdFillBuffer(to, first.buffer, 0, VK_WHOLE_SIZE, 1);
    vkCmdPipelineBarrier2(to, &dependency);
    vkCmdFillBuffer(to, first.buffer, 0, 32, 2);
    vkCmdSetEvent2(to, event, &dependency);
    vkCmdWaitEvents2(to, 1, &event, &dependency);
    vkCmdCopyBuffer(to, first.buffer, second.buffer, 1, &all);
  }) == VK_SUCCESS);
  REQUIRE(client.record(copy, [&](VkCommandBuffer to) {
    vkCmdCopyBuffer(to, first.buffer, second.buffer, 1, &half);
  }) == VK_SUCCESS);
  const auto place = [&](uint64_t value) {
    return VkSemaphoreSubmitInfo{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO, nullptr, timeline, value,
                                 VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,    0};
  };
  const VkSemaphoreSubmitInfo waited = place(3), between = place(4), end = place(5);
  const VkCommandBufferSubmitInfo commands[] = {
      {VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO, nullptr, fill, 0},
      {VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO, nullptr, copy, 0}};
  const VkSubmitInfo2 submits[] = {
      {VK_STRUCTURE_TYPE_SUBMIT_INFO_2, nullptr, 0, 1, &waited, 1, &commands[0], 1, &between},
      {VK_STRUCTURE_TYPE_SUBMIT_INFO_2, nullptr, 0, 1, &between, 1, &commands[1], 1, &end}};

  REQUIRE(vkQueueSubmit2(client.queue, 2, submits, nullptr) == VK_SUCCESS);
  uint64_t value = 9;
  REQUIRE(vkGetSemaphoreCounterValue(client.device, timeline, &value) == VK_SUCCESS);
  CHECK(value == 0);
  const VkSemaphoreSignalInfo signal{VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO, nullptr, timeline, 3};
  REQUIRE(vkSignalSemaphore(client.device, &signal) == VK_SUCCESS);
  REQUIRE(vkQueueWaitIdle(client.queue) == VK_SUCCESS);

  REQUIRE(vkGetSemaphoreCounterValue(client.device, timeline, &value) == VK_SUCCESS);
  CHECK(value == 5);
  for (uint32_t i = 0; i < 16; ++i) CHECK(first.as<uint32_t>()[i] == (i < 8 ? 2 : 1));
  for (uint32_t i = 0; i < 16; ++i) CHECK(second.as<uint32_t>()[i] == 2);
}

}  // namespace
}  // namespace glint::test

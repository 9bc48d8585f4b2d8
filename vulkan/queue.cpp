// Runs what applications submit, in order, in the calls of the application. There are no threads.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/queue.h"

#include <algorithm>
#include <utility>

#include "vulkan/chain.h"
#include "vulkan/command_buffer.h"
#include "vulkan/device.h"
#include "vulkan/sync.h"

using glint::vulkan::Submission;

void VkQueue_T::submit(Submission submission) {
  pending_.push_back(std::move(submission));
}

bool VkQueue_T::advance() {
  bool has_run = false;
  while (!pending_.empty() && !device.is_lost) {
    Submission& first = pending_.front();
    const size_t before = first.next;
    const bool has_ended = run(first);
    has_run = has_run || has_ended || first.next != before;
    if (!has_ended) break;
    pending_.pop_front();
  }
  return has_run;
}

bool VkQueue_T::run(Submission& submission) {
  if (!submission.has_begun) {
    for (const auto& [semaphore, value] : submission.waits)
      if (!semaphore->has_reached(value)) return false;
    for (const auto& [semaphore, value] : submission.waits)
      if (!semaphore->is_timeline) semaphore->value = 0;
    submission.has_begun = true;
  }
  if (!run_commands(submission)) return false;
  for (const auto& [semaphore, value] : submission.signals)
    semaphore->value = semaphore->is_timeline ? value : 1;
  if (submission.fence) submission.fence->is_signaled = true;
  return true;
}

bool VkQueue_T::run_commands(Submission& submission) {
  try {
    for (; submission.next < submission.commands.size(); ++submission.next)
      if (!(*submission.commands[submission.next])(*this)) return false;
    return true;
  } catch (...) {
    device.is_lost = true;
    throw;
  }
}

namespace glint::vulkan {
namespace {

Submission submission_of(const VkSubmitInfo& info) {
  Submission out;
  const auto* timeline =
      find_in_chain<VkTimelineSemaphoreSubmitInfo>(&info, VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO);
  for (uint32_t i = 0; i < info.waitSemaphoreCount; ++i)
    out.waits.push_back({info.pWaitSemaphores[i], timeline && i < timeline->waitSemaphoreValueCount
                                                      ? timeline->pWaitSemaphoreValues[i]
                                                      : 0});
  for (uint32_t i = 0; i < info.commandBufferCount; ++i) info.pCommandBuffers[i]->append_to(out.commands);
  for (uint32_t i = 0; i < info.signalSemaphoreCount; ++i)
    out.signals.push_back({info.pSignalSemaphores[i], timeline && i < timeline->signalSemaphoreValueCount
                                                          ? timeline->pSignalSemaphoreValues[i]
                                                          : 0});
  return out;
}

Submission submission_of(const VkSubmitInfo2& info) {
  Submission out;
  for (uint32_t i = 0; i < info.waitSemaphoreInfoCount; ++i)
    out.waits.push_back({info.pWaitSemaphoreInfos[i].semaphore, info.pWaitSemaphoreInfos[i].value});
  for (uint32_t i = 0; i < info.commandBufferInfoCount; ++i)
    info.pCommandBufferInfos[i].commandBuffer->append_to(out.commands);
  for (uint32_t i = 0; i < info.signalSemaphoreInfoCount; ++i)
    out.signals.push_back({info.pSignalSemaphoreInfos[i].semaphore, info.pSignalSemaphoreInfos[i].value});
  return out;
}

template <class Info>
VkResult submit(Queue& queue, uint32_t count, const Info* infos, VkFence fence) {
  if (queue.device.is_lost) return VK_ERROR_DEVICE_LOST;
  std::vector<Submission> all;
  for (uint32_t i = 0; i < count; ++i) all.push_back(submission_of(infos[i]));
  if (fence && all.empty()) all.emplace_back();
  if (fence) all.back().fence = fence;
  for (Submission& each : all) queue.submit(std::move(each));
  queue.device.advance();
  return VK_SUCCESS;
}

VkResult wait_until(Device& device, const std::function<bool()>& is_idle) {
  device.advance();
  device.changed.wait(device.mutex, [&] { return device.is_lost || is_idle(); });
  return device.is_lost ? VK_ERROR_DEVICE_LOST : VK_SUCCESS;
}

}  // namespace

VkResult QueueSubmit(Queue& queue, uint32_t count, const VkSubmitInfo* infos, VkFence fence) {
  return submit(queue, count, infos, fence);
}
VkResult QueueSubmit2(Queue& queue, uint32_t count, const VkSubmitInfo2* infos, VkFence fence) {
  return submit(queue, count, infos, fence);
}
VkResult QueueWaitIdle(Queue& queue) {
  return wait_until(queue.device, [&] { return queue.is_idle(); });
}
VkResult DeviceWaitIdle(Device& device) {
  return wait_until(device, [&] {
    return std::all_of(device.queues.begin(), device.queues.end(),
                       [](const Queue& each) { return each.is_idle(); });
  });
}
// Nothing is sparse, so only semaphores and the fence are left.
VkResult QueueBindSparse(Queue& queue, uint32_t count, const VkBindSparseInfo* infos, VkFence fence) {
  std::vector<VkSubmitInfo> submits(count);
  for (uint32_t i = 0; i < count; ++i) {
    if (infos[i].bufferBindCount || infos[i].imageBindCount || infos[i].imageOpaqueBindCount)
      throw Refusal(VK_ERROR_FEATURE_NOT_PRESENT, "sparse memory is not there");
    submits[i].sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submits[i].pNext = infos[i].pNext;
    submits[i].waitSemaphoreCount = infos[i].waitSemaphoreCount;
    submits[i].pWaitSemaphores = infos[i].pWaitSemaphores;
    submits[i].signalSemaphoreCount = infos[i].signalSemaphoreCount;
    submits[i].pSignalSemaphores = infos[i].pSignalSemaphores;
  }
  return submit(queue, count, submits.data(), fence);
}

}  // namespace glint::vulkan

// Makes fences, semaphores and events, and lets the host wait for them and set them.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/sync.h"

#include <algorithm>
#include <chrono>
#include <functional>

#include "vulkan/chain.h"
#include "vulkan/device.h"

namespace glint::vulkan {
namespace {

// Lets the queue go on, then waits until `is_done` or until the time is over. The device's lock is free while
// the thread sleeps, so that other threads may submit and signal.
VkResult wait(Device& device, uint64_t nanoseconds, const std::function<bool()>& is_done) {
  device.advance();
  const auto is_over = [&] { return device.is_lost || is_done(); };
  // A wait of more than a year has no end.
  constexpr uint64_t kLongest = uint64_t{1} << 55;
  if (nanoseconds > kLongest)
    device.changed.wait(device.mutex, is_over);
  else if (nanoseconds > 0)
    device.changed.wait_for(device.mutex, std::chrono::nanoseconds(nanoseconds), is_over);
  if (device.is_lost) return VK_ERROR_DEVICE_LOST;
  return is_done() ? VK_SUCCESS : VK_TIMEOUT;
}

}  // namespace

VkResult CreateFence(Device&, const VkFenceCreateInfo* info, VkFence* out) {
  *out = new VkFence_T{(info->flags & VK_FENCE_CREATE_SIGNALED_BIT) != 0};
  return VK_SUCCESS;
}
void DestroyFence(Device&, VkFence fence) {
  delete fence;
}
VkResult ResetFences(Device&, uint32_t count, const VkFence* fences) {
  for (uint32_t i = 0; i < count; ++i) fences[i]->is_signaled = false;
  return VK_SUCCESS;
}
VkResult GetFenceStatus(Device& device, VkFence fence) {
  device.advance();
  if (device.is_lost) return VK_ERROR_DEVICE_LOST;
  return fence->is_signaled ? VK_SUCCESS : VK_NOT_READY;
}
VkResult WaitForFences(Device& device, uint32_t count, const VkFence* fences, VkBool32 wait_all,
                       uint64_t nanoseconds) {
  const auto is_signaled = [](VkFence fence) { return fence->is_signaled; };
  return wait(device, nanoseconds, [&] {
    return wait_all ? std::all_of(fences, fences + count, is_signaled)
                    : std::any_of(fences, fences + count, is_signaled);
  });
}

VkResult CreateSemaphore(Device&, const VkSemaphoreCreateInfo* info, VkSemaphore* out) {
  const auto* type =
      find_in_chain<VkSemaphoreTypeCreateInfo>(info, VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO);
  const bool is_timeline = type && type->semaphoreType == VK_SEMAPHORE_TYPE_TIMELINE;
  *out = new VkSemaphore_T{is_timeline, is_timeline ? type->initialValue : 0};
  return VK_SUCCESS;
}
void DestroySemaphore(Device&, VkSemaphore semaphore) {
  delete semaphore;
}
VkResult GetSemaphoreCounterValue(Device& device, VkSemaphore semaphore, uint64_t* out) {
  device.advance();
  *out = semaphore->value;
  return device.is_lost ? VK_ERROR_DEVICE_LOST : VK_SUCCESS;
}
VkResult SignalSemaphore(Device& device, const VkSemaphoreSignalInfo* info) {
  if (info->value <= info->semaphore->value)
    throw Refusal("the new value of a timeline is larger than the old one");
  info->semaphore->value = info->value;
  device.advance();
  return VK_SUCCESS;
}
VkResult WaitSemaphores(Device& device, const VkSemaphoreWaitInfo* info, uint64_t nanoseconds) {
  return wait(device, nanoseconds, [&] {
    uint32_t reached = 0;
    for (uint32_t i = 0; i < info->semaphoreCount; ++i)
      reached += info->pSemaphores[i]->has_reached(info->pValues[i]);
    return info->flags & VK_SEMAPHORE_WAIT_ANY_BIT ? reached > 0 : reached == info->semaphoreCount;
  });
}

VkResult CreateEvent(Device&, const VkEventCreateInfo*, VkEvent* out) {
  *out = new VkEvent_T;
  return VK_SUCCESS;
}
void DestroyEvent(Device&, VkEvent event) {
  delete event;
}
VkResult GetEventStatus(Device& device, VkEvent event) {
  if (device.is_lost) return VK_ERROR_DEVICE_LOST;
  return event->is_set ? VK_EVENT_SET : VK_EVENT_RESET;
}
VkResult SetEvent(Device& device, VkEvent event) {
  event->is_set = true;
  device.advance();
  return VK_SUCCESS;
}
VkResult ResetEvent(Device&, VkEvent event) {
  event->is_set = false;
  return VK_SUCCESS;
}

}  // namespace glint::vulkan

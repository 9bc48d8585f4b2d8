// Runs what applications submit, in order, in the calls of the application. There are no threads.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "vulkan/handles.h"

namespace glint::vulkan {

// Is the number of queues of a family. Some frameworks want one for graphics, one for copies and one for
// computing, and refuse a device with fewer.
inline constexpr uint32_t kQueues = 4;

// Returns what each family of queues does. Some programs want a family for computing and one for copies that
// do nothing else, as many GPUs with graphics have them.
inline std::vector<VkQueueFlags> queue_families(bool is_universal) {
  const VkQueueFlags copies = VK_QUEUE_TRANSFER_BIT, computes = copies | VK_QUEUE_COMPUTE_BIT;
  if (!is_universal) return {computes};
  return {computes | VK_QUEUE_GRAPHICS_BIT, computes, copies};
}

// Is one recorded command. It returns false when it has to wait for the host, and is then called again.
using Command = std::function<bool(Queue&)>;
using CommandList = std::vector<std::shared_ptr<const Command>>;

struct SemaphoreUse {
  VkSemaphore semaphore = nullptr;
  uint64_t value = 0;  // of a timeline
};

// Is one batch of vkQueueSubmit.
struct Submission {
  std::vector<SemaphoreUse> waits, signals;
  CommandList commands;
  VkFence fence = nullptr;
  bool has_begun = false;
  size_t next = 0;  // the command that runs next
};

}  // namespace glint::vulkan

struct VkQueue_T : glint::vulkan::Dispatchable {
  explicit VkQueue_T(VkDevice_T& of) : device(of) {}

  void submit(glint::vulkan::Submission submission);
  // Runs submissions as far as they come, and returns whether anything ran.
  bool advance();
  // Forgets what was submitted.
  void clear() { pending_.clear(); }
  bool is_idle() const { return pending_.empty(); }

  VkDevice_T& device;
  std::vector<std::string> labels;  // of debug utils that are open on the queue, outermost first

 private:
  // Return whether the submission has ended, or all of its commands have.
  bool run(glint::vulkan::Submission& submission);
  bool run_commands(glint::vulkan::Submission& submission);

  std::deque<glint::vulkan::Submission> pending_;
};

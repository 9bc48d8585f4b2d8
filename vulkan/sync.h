// Holds fences, semaphores and events.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "vulkan/handles.h"

struct VkFence_T {
  bool is_signaled = false;
};

struct VkSemaphore_T {
  bool is_timeline = false;
  uint64_t value = 0;  // of a binary semaphore: 1 when it is signalled

  bool has_reached(uint64_t wanted) const { return value >= (is_timeline ? wanted : 1); }
};

struct VkEvent_T {
  bool is_set = false;
};

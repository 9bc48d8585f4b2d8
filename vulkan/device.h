// Holds a device: its memory, its queue, and what the application asked for when it made it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <mutex>
#include <set>
#include <string_view>

#include "memsys/address_space.h"
#include "vulkan/instance.h"
#include "vulkan/queue.h"

struct VkDevice_T : glint::vulkan::Dispatchable {
  explicit VkDevice_T(VkPhysicalDevice_T& of) : physical(of) {}

  glint::vulkan::Messages& messages() const { return physical.instance.messages; }
  // Returns whether the application asked for a feature by its Vulkan name.
  bool has(std::string_view feature) const { return features.count(feature) != 0; }

  VkPhysicalDevice_T& physical;
  std::mutex mutex;  // A command that is given this device, or its queue, holds it (guard.h).
  std::set<std::string_view> features;
  glint::mem::AddressSpace memory;
  VkQueue_T queue{*this};
};

struct VkCommandBuffer_T : glint::vulkan::Dispatchable {};

// Reads descriptors that an application keeps in buffers of its own (VK_EXT_descriptor_buffer).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "base/types.h"
#include "vulkan/descriptor_set.h"

namespace glint::vulkan {

// Choice: every descriptor has the same size, and a binding's descriptors lie one after another. Bindings lie
// in the order of their numbers.
constexpr uint32_t kStoredBytes = 32;

// Is a set whose descriptors lie in memory. What the memory has when a launch runs counts.
struct StoredSet {
  DescriptorSetLayout layout;
  Address address = 0;
};

// Returns the byte of a stored set at which a binding begins. Throws Refusal where the layout has none.
VkDeviceSize stored_offset(const DescriptorSetLayout& layout, uint32_t number);

// Reads the descriptors of a binding. Bytes that are no descriptor of the binding's kind, and bytes beyond
// the end of the buffer, are descriptors of nothing.
std::vector<Descriptor> read_stored(const Device& device, const StoredSet& set, uint32_t number);

}  // namespace glint::vulkan

// Holds device memory and the buffers that are bound to it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "base/types.h"
#include "memsys/address_space.h"
#include "vulkan/handles.h"

// Is bytes of simulated memory. They have no address of their own: buffers and images are windows on them.
struct VkDeviceMemory_T {
  glint::mem::Backing backing{};
  VkDeviceSize bytes = 0;
  bool is_imported = false;  // The bytes are the application's and do not count against the heap.
};

// Is a window on device memory, with an address and an end of its own.
struct VkBuffer_T {
  VkDeviceSize bytes = 0;
  VkBufferUsageFlags usage = 0;
  std::string name;
  VkDeviceMemory memory = nullptr;
  VkDeviceSize offset = 0;     // of the buffer in the memory
  glint::Address address = 0;  // 0: not bound to memory
  // Windows on parts, by offset and bytes. Descriptors show parts, and an access past the part is found.
  std::map<std::pair<VkDeviceSize, VkDeviceSize>, glint::Address> parts;
};

namespace glint::vulkan {

using Buffer = VkBuffer_T;
using DeviceMemory = VkDeviceMemory_T;

// Names bytes on the host and where they are in simulated memory.
struct HostRange {
  std::byte* data = nullptr;
  uint64_t bytes = 0;
};

// Returns the bytes of `range` from `offset` on; VK_WHOLE_SIZE stands for all that follow. Throws Refusal
// when the buffer has no memory or the range leaves it.
HostRange bytes_of(const Device& device, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize range);

// Returns the address of a part of a buffer whose end is the part's end. Throws as bytes_of().
Address address_of_part(Device& device, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize bytes);

}  // namespace glint::vulkan

// Holds device memory and the buffers that are bound to it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

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
  uint32_t number = 0;  // of the device's buffers
  std::string name;
  VkDeviceMemory memory = nullptr;
  VkDeviceSize offset = 0;     // of the buffer in the memory
  glint::Address address = 0;  // 0: not bound to memory
};

namespace glint::vulkan {

using Buffer = VkBuffer_T;
using DeviceMemory = VkDeviceMemory_T;

// These commands serve swapchains, too.
VkResult AllocateMemory(Device& device, const VkMemoryAllocateInfo* info, VkDeviceMemory* out);
void FreeMemory(Device& device, VkDeviceMemory memory);

// Names bytes on the host and where they are in simulated memory.
struct HostRange {
  std::byte* data = nullptr;
  uint64_t bytes = 0;
};

// What buffers and images ask of memory: whole windows of it, of any type.
VkMemoryRequirements requirements_of(VkDeviceSize bytes);
// Answers the same with all structures that hang on `out`.
void answer_requirements(VkMemoryRequirements2* out, VkDeviceSize bytes);

// Opens a window of `bytes` at `offset` of the memory for a buffer or an image. Throws Refusal when it does
// not fit there.
Address bind_window(Device& device, const std::string& name, VkDeviceSize bytes, VkDeviceMemory memory,
                    VkDeviceSize offset);

// Throws Refusal when `range` bytes from `offset` on leave a buffer.
void check_part(const Buffer& buffer, VkDeviceSize offset, VkDeviceSize range);
// Returns the bytes of `range` from `offset` on; VK_WHOLE_SIZE stands for all that follow. Throws Refusal
// when the buffer has no memory, its memory was freed or the range leaves it.
HostRange bytes_of(const Device& device, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize range);

// Keeps windows on parts of buffers. Descriptors show parts, and an access past the part is found.
class BufferParts {
 public:
  // Returns the address of a part, whose end is the part's end. It holds until forget() or trim().
  Address open(mem::AddressSpace& memory, const Buffer& buffer, VkDeviceSize offset, VkDeviceSize bytes);
  // Does the same for bytes that only their address names. Where the address or the end is in no allocation,
  // it returns the address.
  Address open(mem::AddressSpace& memory, Address address, uint64_t bytes);
  // Closes the windows on a buffer.
  void forget(mem::AddressSpace& memory, const Buffer& buffer);
  // Closes all windows when they are many: the address space has few places, and an application may have more
  // dynamic offsets. Nobody may use an address of a part any longer.
  void trim(mem::AddressSpace& memory);

 private:
  struct Part {
    uint32_t buffer;  // its number: addresses must not depend on where the host puts the object
    VkDeviceSize offset, bytes;
    auto operator<=>(const Part&) const = default;
  };
  struct AddressPart {
    Address first;
    uint64_t bytes;
    auto operator<=>(const AddressPart&) const = default;
  };
  std::map<Part, Address> windows_;
  std::map<AddressPart, Address> windows_at_;  // on parts that an address names
};

// Returns the address of a part of a buffer whose end is the part's end. Throws as bytes_of().
Address address_of_part(Device& device, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize bytes);

}  // namespace glint::vulkan

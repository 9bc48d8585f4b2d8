// Makes buffers and binds them to memory.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <memory>

#include "vulkan/acceleration_structure.h"
#include "vulkan/chain.h"
#include "vulkan/device.h"
#include "vulkan/memory.h"

namespace glint::vulkan {
namespace {

constexpr size_t kManyParts = 1024;  // The address space has 65,536 places for buffers, images and parts.

}  // namespace

Address BufferParts::open(mem::AddressSpace& memory, const Buffer& buffer, VkDeviceSize offset,
                          VkDeviceSize bytes) {
  const auto [found, is_new] = windows_.try_emplace(Part{buffer.number, offset, bytes}, 0);
  if (is_new)
    found->second = memory.open_window(fmt::format("{}, bytes {} to {}", buffer.name, offset, offset + bytes),
                                       buffer.memory->backing, buffer.offset + offset, bytes);
  return found->second;
}

Address BufferParts::open(mem::AddressSpace& memory, Address address, uint64_t bytes) {
  const auto slots = memory.slots();
  const uint64_t number = address >> mem::AddressSpace::kShift, first = uint32_t(address);
  if (number >= slots.size() || first > slots[number].bytes || bytes >= slots[number].bytes - first)
    return address;
  const mem::AddressSpace::Slot slot = slots[number];
  if (slot.ended || !slot.data) return address;
  const auto [found, is_new] = windows_at_.try_emplace(AddressPart{address, bytes}, 0);
  if (is_new)
    found->second = memory.open_window(fmt::format("{} bytes at address {:#x}", bytes, address), slot.backing,
                                       uint64_t(slot.data - memory.data(slot.backing)) + first, bytes);
  return found->second;
}

void BufferParts::forget(mem::AddressSpace& memory, const Buffer& buffer) {
  const Address begin = buffer.address;
  auto part = begin ? windows_at_.lower_bound(AddressPart{begin, 0}) : windows_at_.end();
  for (; part != windows_at_.end() && part->first.first - begin <= buffer.bytes;
       part = windows_at_.erase(part))
    memory.free(part->second);
  auto at = windows_.lower_bound(Part{buffer.number, 0, 0});
  for (; at != windows_.end() && at->first.buffer == buffer.number; at = windows_.erase(at))
    memory.free(at->second);
}

void BufferParts::trim(mem::AddressSpace& memory) {
  if (windows_.size() + windows_at_.size() < kManyParts) return;
  for (const auto& [part, address] : windows_) memory.free(address);
  for (const auto& [part, address] : windows_at_) memory.free(address);
  windows_.clear(), windows_at_.clear();
}

void check_part(const Buffer& buffer, VkDeviceSize offset, VkDeviceSize range) {
  if (offset > buffer.bytes || (range != VK_WHOLE_SIZE && range > buffer.bytes - offset))
    throw Refusal(fmt::format("{} bytes from byte {} on leave {}, which has {} bytes", range, offset,
                              buffer.name, buffer.bytes));
}

HostRange bytes_of(const Device& device, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize range) {
  if (!buffer->address) throw Refusal(fmt::format("{} is not bound to memory", buffer->name));
  check_part(*buffer, offset, range);
  const VkDeviceSize bytes = range == VK_WHOLE_SIZE ? buffer->bytes - offset : range;
  std::byte* const data = device.memory.find(buffer->address, buffer->bytes);
  if (!data) throw Refusal(fmt::format("the memory of {} was freed", buffer->name));
  return {data + offset, bytes};
}

Address address_of_part(Device& device, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize bytes) {
  bytes_of(device, buffer, offset, bytes);
  if (offset + bytes == buffer->bytes) return buffer->address + offset;
  return device.parts.open(device.memory, *buffer, offset, bytes);
}

VkResult CreateBuffer(Device& device, const VkBufferCreateInfo* info, VkBuffer* out) {
  if (info->flags & (VK_BUFFER_CREATE_SPARSE_BINDING_BIT | VK_BUFFER_CREATE_PROTECTED_BIT))
    throw Refusal(VK_ERROR_FEATURE_NOT_PRESENT, "sparse and protected buffers are not there");
  if (info->size > kMaxAllocationBytes)
    throw Refusal(VK_ERROR_OUT_OF_DEVICE_MEMORY,
                  fmt::format("a buffer has at most {} bytes, not {}", kMaxAllocationBytes, info->size));
  auto made = std::make_unique<Buffer>();
  made->bytes = info->size, made->usage = info->usage;
  made->number = ++device.buffers_made;
  made->name = fmt::format("buffer {}", made->number);
  device.bindable.insert(made.get());
  *out = made.release();
  return VK_SUCCESS;
}

void DestroyBuffer(Device& device, VkBuffer buffer) {
  if (!buffer) return;
  device.bindable.erase(buffer);
  device.parts.forget(device.memory, *buffer);
  forget_structures(device, *buffer);
  if (buffer->address) device.memory.free(buffer->address);
  delete buffer;
}

VkResult BindBufferMemory(Device& device, VkBuffer buffer, VkDeviceMemory memory, VkDeviceSize offset) {
  buffer->address = bind_window(device, buffer->name, buffer->bytes, memory, offset);
  buffer->memory = memory, buffer->offset = offset;
  place_structures(device, *buffer);
  return VK_SUCCESS;
}

VkResult BindBufferMemory2(Device& device, uint32_t count, const VkBindBufferMemoryInfo* infos) {
  for (uint32_t i = 0; i < count; ++i)
    BindBufferMemory(device, infos[i].buffer, infos[i].memory, infos[i].memoryOffset);
  return VK_SUCCESS;
}

void GetBufferMemoryRequirements(Device&, VkBuffer buffer, VkMemoryRequirements* out) {
  *out = requirements_of(buffer->bytes);
}
void GetBufferMemoryRequirements2(Device&, const VkBufferMemoryRequirementsInfo2* info,
                                  VkMemoryRequirements2* out) {
  answer_requirements(out, info->buffer->bytes);
}
void GetDeviceBufferMemoryRequirements(Device&, const VkDeviceBufferMemoryRequirements* info,
                                       VkMemoryRequirements2* out) {
  answer_requirements(out, info->pCreateInfo->size);
}

VkDeviceAddress GetBufferDeviceAddress(Device&, const VkBufferDeviceAddressInfo* info) {
  return info->buffer->address;
}
uint64_t GetBufferOpaqueCaptureAddress(Device&, const VkBufferDeviceAddressInfo*) {
  return 0;
}

}  // namespace glint::vulkan

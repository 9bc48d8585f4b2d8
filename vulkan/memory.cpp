// Allocates, maps and frees device memory.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/memory.h"

#include <bit>
#include <fmt/format.h>
#include <memory>

#include "vulkan/chain.h"
#include "vulkan/device.h"

namespace glint::vulkan {
namespace {

constexpr VkDeviceSize kAlignment = mem::AddressSpace::kWindowAlignment;

void import_or_allocate(Device& device, DeviceMemory& memory, const VkMemoryAllocateInfo* info) {
  if (const auto* host = find_in_chain<VkImportMemoryHostPointerInfoEXT>(
          info, VK_STRUCTURE_TYPE_IMPORT_MEMORY_HOST_POINTER_INFO_EXT);
      host && host->handleType) {
    if (reinterpret_cast<uintptr_t>(host->pHostPointer) % kHostPointerAlignment ||
        memory.bytes % kHostPointerAlignment)
      throw Refusal(
          VK_ERROR_INVALID_EXTERNAL_HANDLE,
          fmt::format("an imported pointer and its size are multiples of {}", kHostPointerAlignment));
    memory.is_imported = true;
    memory.backing = device.memory.import_backing(static_cast<std::byte*>(host->pHostPointer), memory.bytes);
    return;
  }
  if (memory.bytes > kMaxAllocationBytes || memory.bytes > kHeapBytes - device.allocated_bytes)
    throw Refusal(
        VK_ERROR_OUT_OF_DEVICE_MEMORY,
        fmt::format("{} bytes do not fit: {} of {} bytes are allocated, and an allocation has at most {}",
                    memory.bytes, device.allocated_bytes, kHeapBytes, kMaxAllocationBytes));
  memory.backing = device.memory.add_backing(memory.bytes);
  device.allocated_bytes += memory.bytes, used_by_process() += memory.bytes;
}

}  // namespace

VkMemoryRequirements requirements_of(VkDeviceSize bytes) {
  return {(bytes + kAlignment - 1) / kAlignment * kAlignment, kAlignment, kAllMemoryTypes};
}

void answer_requirements(VkMemoryRequirements2* out, VkDeviceSize bytes) {
  out->memoryRequirements = requirements_of(bytes);
  if (auto* dedicated =
          find_in_output<VkMemoryDedicatedRequirements>(out, VK_STRUCTURE_TYPE_MEMORY_DEDICATED_REQUIREMENTS))
    dedicated->prefersDedicatedAllocation = dedicated->requiresDedicatedAllocation = VK_FALSE;
}

Address bind_window(Device& device, const std::string& name, VkDeviceSize bytes, VkDeviceMemory memory,
                    VkDeviceSize offset) {
  if (offset % kAlignment || offset > memory->bytes || bytes > memory->bytes - offset)
    throw Refusal(VK_ERROR_OUT_OF_DEVICE_MEMORY,
                  fmt::format("{} ({} bytes) does not fit at byte {} of {} bytes of memory", name, bytes,
                              offset, memory->bytes));
  return device.memory.open_window(name, memory->backing, offset, bytes);
}

VkResult AllocateMemory(Device& device, const VkMemoryAllocateInfo* info, VkDeviceMemory* out) {
  if (constexpr auto kTypes = uint32_t(std::bit_width(kAllMemoryTypes)); info->memoryTypeIndex >= kTypes)
    throw Refusal(
        fmt::format("memory type {} is not there, only 0 to {}", info->memoryTypeIndex, kTypes - 1));
  auto made = std::make_unique<DeviceMemory>();
  made->bytes = info->allocationSize;
  import_or_allocate(device, *made, info);
  *out = made.release();
  return VK_SUCCESS;
}

void FreeMemory(Device& device, VkDeviceMemory memory) {
  if (!memory) return;
  device.memory.free(memory->backing);
  if (!memory->is_imported) device.allocated_bytes -= memory->bytes, used_by_process() -= memory->bytes;
  delete memory;
}

VkResult MapMemory(Device& device, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize, VkMemoryMapFlags,
                   void** out) {
  if (offset >= memory->bytes)
    throw Refusal(VK_ERROR_MEMORY_MAP_FAILED,
                  fmt::format("offset {} is outside of the {} bytes", offset, memory->bytes));
  *out = device.memory.data(memory->backing) + offset;
  return VK_SUCCESS;
}

// Simulated memory is the host's, so nothing has to be flushed or invalidated.
void UnmapMemory(Device&, VkDeviceMemory) {
}
VkResult FlushMappedMemoryRanges(Device&, uint32_t, const VkMappedMemoryRange*) {
  return VK_SUCCESS;
}
VkResult InvalidateMappedMemoryRanges(Device&, uint32_t, const VkMappedMemoryRange*) {
  return VK_SUCCESS;
}

void GetDeviceMemoryCommitment(Device&, VkDeviceMemory memory, VkDeviceSize* out) {
  *out = memory->bytes;
}

uint64_t GetDeviceMemoryOpaqueCaptureAddress(Device&, const VkDeviceMemoryOpaqueCaptureAddressInfo*) {
  return 0;
}

VkResult GetMemoryHostPointerPropertiesEXT(Device&, VkExternalMemoryHandleTypeFlagBits, const void*,
                                           VkMemoryHostPointerPropertiesEXT* out) {
  out->memoryTypeBits = kAllMemoryTypes;
  return VK_SUCCESS;
}

}  // namespace glint::vulkan

// Holds micromaps: bytes of a buffer that say which parts of triangles are opaque (VK_EXT_opacity_micromap).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/types.h"
#include "pipeline/device_micromaps.h"
#include "vulkan/handles.h"

struct VkMicromapEXT_T {
  std::string name;
  VkBuffer buffer = nullptr;   // It may get its memory later, and may be gone.
  glint::Address address = 0;  // in the buffer; 0: the buffer had no memory yet
  VkDeviceSize offset = 0;     // in the buffer
  VkDeviceSize bytes = 0;      // that the application has given to it
};

namespace glint::vulkan {

using Micromap = VkMicromapEXT_T;

// Returns where a micromap lies. Throws Refusal while its buffer has no memory.
Address address_of(const Device& device, Micromap& micromap);
// Returns the array of maps that was built or copied into a micromap. Throws Refusal when there is none.
std::span<const std::byte> maps_of(const Device& device, Micromap& micromap);

// Returns the kinds of maps that a build names, from whichever of the pointers is not null.
std::vector<pipeline::MicromapUsage> usage_of(uint32_t count, const VkMicromapUsageEXT* all,
                                              const VkMicromapUsageEXT* const* each);

// Looks for bytes where a program has put them: in the device's memory, or on the host.
pipeline::FindBytes find_bytes(const Device& device, bool on_host);

// Says which micromaps the triangles of a geometry have. It is a copy, because a recorded build runs later.
struct GeometryMicromaps {
  VkIndexType index_type = VK_INDEX_TYPE_NONE_KHR;
  Address indices = 0;
  VkDeviceSize stride = 0;
  uint32_t base = 0;
  Micromap* micromap = nullptr;  // null: all indices are special
  std::vector<pipeline::MicromapUsage> usage;
};

// Returns what hangs on a geometry, or nothing.
std::optional<GeometryMicromaps> micromaps_of(const VkAccelerationStructureGeometryKHR& geometry);
pipeline::DeviceMicromaps device_micromaps(const Device& device, const GeometryMicromaps& from, bool on_host);
// Returns the bytes that the maps of a structure take at most, by what the build says of their kinds.
uint64_t most_bytes_of(std::span<const std::optional<GeometryMicromaps>> geometries);

}  // namespace glint::vulkan

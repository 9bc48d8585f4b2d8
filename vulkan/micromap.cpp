// Makes micromaps, and reads those that geometries name.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/micromap.h"

#include <algorithm>
#include <fmt/format.h>
#include <memory>

#include "rtunit/structure/micromaps.h"
#include "vulkan/chain.h"
#include "vulkan/device.h"

namespace glint::vulkan {
namespace {

constexpr VkDeviceSize kMicromapAlignment = 256;  // Vulkan asks for it.

uint32_t index_bytes_of(VkIndexType type) {
  switch (type) {
    case VK_INDEX_TYPE_UINT16:
      return 2;
    case VK_INDEX_TYPE_UINT32:
      return 4;
    case VK_INDEX_TYPE_NONE_KHR:
      return 0;
    default:
      throw Refusal(
          fmt::format("micromaps have indices of 16 or 32 bits or none, and not of type {}", int(type)));
  }
}

}  // namespace

std::span<const std::byte> maps_of(const Device& device, Micromap& micromap) {
  const auto array = pipeline::micromap_array_at(find_bytes(device, false), address_of(device, micromap));
  if (array.empty()) throw Refusal(fmt::format("'{}' is not built", micromap.name));
  return array;
}

Address address_of(const Device& device, Micromap& micromap) {
  if (!micromap.address && device.bindable.contains(micromap.buffer) && micromap.buffer->address)
    micromap.address = micromap.buffer->address + micromap.offset;
  if (!micromap.address) throw Refusal(fmt::format("'{}' lies in no memory", micromap.name));
  return micromap.address;
}

std::vector<pipeline::MicromapUsage> usage_of(uint32_t count, const VkMicromapUsageEXT* all,
                                              const VkMicromapUsageEXT* const* each) {
  std::vector<pipeline::MicromapUsage> out;
  if (count && !all && !each) throw Refusal("a micromap has neither pUsageCounts nor ppUsageCounts");
  for (uint32_t i = 0; i < count; ++i) {
    const VkMicromapUsageEXT& from = all ? all[i] : *each[i];
    if (!from.count) continue;
    out.push_back({from.count, from.subdivisionLevel, from.format});
    try {
      pipeline::micromap_format(from.subdivisionLevel, from.format);
    } catch (const UserError& error) {
      throw Refusal(error.what());
    }
  }
  return out;
}

pipeline::FindBytes find_bytes(const Device& device, bool on_host) {
  if (on_host)
    return [](Address at, uint64_t) -> const std::byte* {
      constexpr Address kFirstPage = 4096;  // in which a null pointer with an offset lies
      return at < kFirstPage ? nullptr : reinterpret_cast<const std::byte*>(uintptr_t(at));
    };
  return [&memory = device.memory](Address at, uint64_t bytes) -> const std::byte* {
    return memory.find(at, bytes);
  };
}

std::optional<GeometryMicromaps> micromaps_of(const VkAccelerationStructureGeometryKHR& geometry) {
  if (geometry.geometryType != VK_GEOMETRY_TYPE_TRIANGLES_KHR) return {};
  const auto* const from = find_in_chain<VkAccelerationStructureTrianglesOpacityMicromapEXT>(
      &geometry.geometry.triangles, VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_TRIANGLES_OPACITY_MICROMAP_EXT);
  if (!from) return {};
  index_bytes_of(from->indexType);
  return GeometryMicromaps{
      from->indexType,   from->indexBuffer.deviceAddress,
      from->indexStride, from->baseTriangle,
      from->micromap,    usage_of(from->usageCountsCount, from->pUsageCounts, from->ppUsageCounts)};
}

pipeline::DeviceMicromaps device_micromaps(const Device& device, const GeometryMicromaps& from,
                                           bool on_host) {
  pipeline::DeviceMicromaps out;
  out.index_bytes = index_bytes_of(from.index_type), out.indices = from.indices, out.stride = from.stride;
  out.base = from.base, out.find_indices = find_bytes(device, on_host);
  if (from.micromap) out.array = maps_of(device, *from.micromap);
  return out;
}

uint64_t most_bytes_of(std::span<const std::optional<GeometryMicromaps>> geometries) {
  bool has_any = false;
  uint64_t maps = 0;
  rt::MicromapFormat format{true, 0};
  for (const auto& geometry : geometries) {
    if (!geometry) continue;
    has_any = true;
    for (const pipeline::MicromapUsage& each : geometry->usage) {
      maps += each.count;
      format = pipeline::common_format(format, pipeline::micromap_format(each.level, each.format));
    }
  }
  // The table lies at the end of the nodes, and its last sector is whole.
  return has_any ? sizeof(rt::MicromapTable) + maps * format.bytes() + rt::kLeafBytes : 0;
}

VkResult CreateMicromapEXT(Device& device, const VkMicromapCreateInfoEXT* info, VkMicromapEXT* out) {
  if (!device.has("micromap")) throw Refusal("micromaps need the feature micromap");
  if (info->deviceAddress)
    throw Refusal(VK_ERROR_FEATURE_NOT_PRESENT, "the device cannot put a micromap at an address of before");
  if (info->type != VK_MICROMAP_TYPE_OPACITY_MICROMAP_EXT)
    throw Refusal(fmt::format("micromaps of type {} are not there, only those of opacity", int(info->type)));
  if (info->offset % kMicromapAlignment)
    throw Refusal(
        fmt::format("the offset {} of a micromap is not a multiple of {}", info->offset, kMicromapAlignment));
  check_part(*info->buffer, info->offset, info->size);
  auto made = std::make_unique<Micromap>();
  made->name = fmt::format("micromap {}", ++device.micromaps_made);
  made->buffer = info->buffer, made->offset = info->offset, made->bytes = info->size;
  if (info->buffer->address) made->address = info->buffer->address + info->offset;
  *out = made.release();
  return VK_SUCCESS;
}

void DestroyMicromapEXT(Device&, VkMicromapEXT micromap) {
  delete micromap;
}

}  // namespace glint::vulkan

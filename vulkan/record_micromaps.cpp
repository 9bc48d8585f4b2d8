// Records builds, copies and queries of micromaps, and does the same at once for the host.
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstring>
#include <fmt/format.h>
#include <span>
#include <utility>
#include <vector>

#include "vulkan/acceleration_structure.h"
#include "vulkan/command_buffer.h"
#include "vulkan/device.h"
#include "vulkan/micromap.h"
#include "vulkan/query.h"

namespace glint::vulkan {
namespace {

// Choice: builds need no scratch memory of the application (as those of structures).
constexpr VkDeviceSize kScratchBytes = 256;

// Begins a serialised micromap (Vulkan, "vkCmdCopyMicromapToMemoryEXT"). The array follows it.
struct SerialMicromap {
  uint8_t driver[VK_UUID_SIZE]{};
  uint8_t compatibility[VK_UUID_SIZE]{'G', 'l', 'i', 'n', 't', ' ', 'm', 'i',
                                      'c', 'r', 'o', 'm', 'a', 'p', '0', '1'};
};
static_assert(sizeof(SerialMicromap) == 2 * VK_UUID_SIZE);

// Holds a copy of what one build was asked for, because a recorded build runs later.
struct MicromapBuild {
  Micromap* to = nullptr;
  std::vector<pipeline::MicromapUsage> usage;
  Address data = 0, triangles = 0;
  VkDeviceSize stride = 0;
  bool on_host = false;
};

uint32_t count_of(const std::vector<pipeline::MicromapUsage>& usage) {
  uint64_t out = 0;
  for (const pipeline::MicromapUsage& each : usage) out += each.count;
  if (out >> 32) throw Refusal(fmt::format("a micromap of {} triangles is too large", out));
  return uint32_t(out);
}

std::byte* room_at(const Device& device, Micromap& micromap, uint64_t bytes) {
  if (bytes > micromap.bytes)
    throw Refusal(
        fmt::format("{} bytes do not fit into '{}', which has {}", bytes, micromap.name, micromap.bytes));
  std::byte* const out = device.memory.find(address_of(device, micromap), bytes);
  if (!out) throw Refusal(fmt::format("the memory of '{}' is gone", micromap.name));
  return out;
}

MicromapBuild build_of(const VkMicromapBuildInfoEXT& info, bool on_host) {
  if (info.type != VK_MICROMAP_TYPE_OPACITY_MICROMAP_EXT)
    throw Refusal(fmt::format("micromaps of type {} are not there, only those of opacity", int(info.type)));
  return {info.dstMicromap,         usage_of(info.usageCountsCount, info.pUsageCounts, info.ppUsageCounts),
          info.data.deviceAddress,  info.triangleArray.deviceAddress,
          info.triangleArrayStride, on_host};
}

void check_room(const MicromapBuild& build) {
  if (!build.to) throw Refusal("a build needs a micromap to write to");
  if (const uint64_t most = pipeline::micromap_bytes(build.usage); most > build.to->bytes)
    throw Refusal(fmt::format("a micromap of {} triangles needs {} bytes, and '{}' has {}",
                              count_of(build.usage), most, build.to->name, build.to->bytes));
}

// Model: building takes no simulated time, as with structures.
void build(Device& device, const MicromapBuild& build) {
  check_room(build);
  const auto made = pipeline::encode_micromaps(find_bytes(device, build.on_host), build.triangles,
                                               build.stride, count_of(build.usage), build.data);
  std::memcpy(room_at(device, *build.to, made.size()), made.data(), made.size());
}

void copy(Device& device, Micromap& from, Micromap& to) {
  const auto bytes = maps_of(device, from);
  std::memmove(room_at(device, to, bytes.size()), bytes.data(), bytes.size());
  device.clock.add_transfer(bytes.size());
}

SerialMicromap serial_header(const Device& device) {
  SerialMicromap out;
  std::memcpy(out.driver, device.physical.properties.driverUUID, VK_UUID_SIZE);
  return out;
}

void serialize(const Device& device, Micromap& from, std::byte* to) {
  const SerialMicromap header = serial_header(device);
  const auto bytes = maps_of(device, from);
  std::memcpy(to, &header, sizeof header);
  std::memcpy(to + sizeof header, bytes.data(), bytes.size());
}
uint64_t serial_bytes(const Device& device, Micromap& from) {
  return sizeof(SerialMicromap) + maps_of(device, from).size();
}

// Returns how many bytes were read.
uint64_t deserialize(const Device& device, const pipeline::FindBytes& find, Address from, Micromap& to) {
  const SerialMicromap wanted = serial_header(device);
  const std::byte* const header = find(from, sizeof wanted);
  if (!header || std::memcmp(header, &wanted, sizeof wanted) != 0)
    throw Refusal(fmt::format("no serialised micromap of this driver lies at {:#x}", from));
  const auto array = pipeline::micromap_array_at(find, from + sizeof wanted);
  if (array.empty()) throw Refusal(fmt::format("the serialised micromap at {:#x} is damaged", from));
  std::memcpy(room_at(device, to, array.size()), array.data(), array.size());
  return sizeof wanted + array.size();
}

uint64_t property_of(const Device& device, Micromap& micromap, VkQueryType type) {
  switch (int(type)) {
    case VK_QUERY_TYPE_MICROMAP_SERIALIZATION_SIZE_EXT:
      return serial_bytes(device, micromap);
    case VK_QUERY_TYPE_MICROMAP_COMPACTED_SIZE_EXT:
      return maps_of(device, micromap).size();
    default:
      throw Refusal(fmt::format("a micromap has no property for the query type {}", int(type)));
  }
}

}  // namespace

void GetMicromapBuildSizesEXT(Device&, VkAccelerationStructureBuildTypeKHR,
                              const VkMicromapBuildInfoEXT* info, VkMicromapBuildSizesInfoEXT* out) {
  out->micromapSize = pipeline::micromap_bytes(build_of(*info, false).usage);
  out->buildScratchSize = kScratchBytes;
  out->discardable = VK_TRUE;  // A structure has copies of its maps.
}

void GetDeviceMicromapCompatibilityEXT(Device& device, const VkMicromapVersionInfoEXT* info,
                                       VkAccelerationStructureCompatibilityKHR* out) {
  const SerialMicromap header = serial_header(device);
  *out = std::memcmp(info->pVersionData, &header, sizeof header) == 0
             ? VK_ACCELERATION_STRUCTURE_COMPATIBILITY_COMPATIBLE_KHR
             : VK_ACCELERATION_STRUCTURE_COMPATIBILITY_INCOMPATIBLE_KHR;
}

void CmdBuildMicromapsEXT(CommandBuffer& commands, uint32_t count, const VkMicromapBuildInfoEXT* infos) {
  for (uint32_t i = 0; i < count; ++i) {
    MicromapBuild asked = build_of(infos[i], false);
    check_room(asked);
    commands.record([asked = std::move(asked)](Queue& queue) {
      run_or_say(queue.device, "vkCmdBuildMicromapsEXT", [&] { build(queue.device, asked); });
    });
  }
}
VkResult BuildMicromapsEXT(Device& device, VkDeferredOperationKHR operation, uint32_t count,
                           const VkMicromapBuildInfoEXT* infos) {
  for (uint32_t i = 0; i < count; ++i) build(device, build_of(infos[i], true));
  return done_at_once(operation);
}

void CmdCopyMicromapEXT(CommandBuffer& commands, const VkCopyMicromapInfoEXT* info) {
  commands.record([from = info->src, to = info->dst](Queue& queue) {
    run_or_say(queue.device, "vkCmdCopyMicromapEXT", [&] { copy(queue.device, *from, *to); });
  });
}
VkResult CopyMicromapEXT(Device& device, VkDeferredOperationKHR operation,
                         const VkCopyMicromapInfoEXT* info) {
  copy(device, *info->src, *info->dst);
  return done_at_once(operation);
}

void CmdCopyMicromapToMemoryEXT(CommandBuffer& commands, const VkCopyMicromapToMemoryInfoEXT* info) {
  commands.record([from = info->src, at = info->dst.deviceAddress](Queue& queue) {
    Device& device = queue.device;
    run_or_say(device, "vkCmdCopyMicromapToMemoryEXT", [&] {
      const uint64_t bytes = serial_bytes(device, *from);
      std::byte* const to = device.memory.find(at, bytes);
      if (!to) throw Refusal(fmt::format("{} bytes have no room at address {:#x}", bytes, at));
      serialize(device, *from, to);
      device.clock.add_transfer(bytes);
    });
  });
}
VkResult CopyMicromapToMemoryEXT(Device& device, VkDeferredOperationKHR operation,
                                 const VkCopyMicromapToMemoryInfoEXT* info) {
  serialize(device, *info->src, static_cast<std::byte*>(info->dst.hostAddress));
  return done_at_once(operation);
}

void CmdCopyMemoryToMicromapEXT(CommandBuffer& commands, const VkCopyMemoryToMicromapInfoEXT* info) {
  commands.record([at = info->src.deviceAddress, to = info->dst](Queue& queue) {
    Device& device = queue.device;
    run_or_say(device, "vkCmdCopyMemoryToMicromapEXT",
               [&] { device.clock.add_transfer(deserialize(device, find_bytes(device, false), at, *to)); });
  });
}
VkResult CopyMemoryToMicromapEXT(Device& device, VkDeferredOperationKHR operation,
                                 const VkCopyMemoryToMicromapInfoEXT* info) {
  deserialize(device, find_bytes(device, true), info->src.deviceAddress, *info->dst);
  return done_at_once(operation);
}

void CmdWriteMicromapsPropertiesEXT(CommandBuffer& commands, uint32_t count, const VkMicromapEXT* micromaps,
                                    VkQueryType type, VkQueryPool pool, uint32_t first) {
  check_range(pool, first, count);
  for (uint32_t i = 0; i < count; ++i)
    commands.record([micromap = micromaps[i], type, pool, query = first + i](Queue& queue) {
      pool->values[query] = 0;
      run_or_say(queue.device, "vkCmdWriteMicromapsPropertiesEXT",
                 [&] { pool->values[query] = property_of(queue.device, *micromap, type); });
    });
}
VkResult WriteMicromapsPropertiesEXT(Device& device, uint32_t count, const VkMicromapEXT* micromaps,
                                     VkQueryType type, size_t bytes, void* out, size_t stride) {
  for (uint32_t i = 0; i < count; ++i) {
    const uint64_t value = property_of(device, *micromaps[i], type);
    if (i * stride + sizeof value > bytes)
      throw Refusal(fmt::format("{} properties do not fit into {} bytes", count, bytes));
    std::memcpy(static_cast<std::byte*>(out) + i * stride, &value, sizeof value);
  }
  return VK_SUCCESS;
}

}  // namespace glint::vulkan

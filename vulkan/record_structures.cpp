// Records builds, copies and queries of acceleration structures, and does the same at once for the host.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstring>
#include <fmt/format.h>
#include <span>
#include <utility>
#include <vector>

#include "rtunit/structure/in_memory.h"
#include "vulkan/acceleration_structure.h"
#include "vulkan/command_buffer.h"
#include "vulkan/device.h"
#include "vulkan/query.h"

namespace glint::vulkan {
namespace {

// Model: copies and queries of structures take the time of a transfer of their bytes.
void copy(Device& device, Structure* from, Structure* to) {
  const auto info = rt::structure_at(device.memory, from->address);
  if (info && info->bytes > to->bytes)
    throw Refusal(fmt::format("'{}' has {} bytes, and '{}' has room for {}", from->name, info->bytes,
                              to->name, to->bytes));
  rt::copy_structure(device.memory, from->address, to->address);
  to->update_bytes = from->update_bytes;
  to->inputs = from->inputs, to->built = ++device.builds;
  device.clock.add_transfer(info ? info->bytes : 0);
}

// Returns the list of bottom levels in serialised bytes, which the caller knows to be there.
std::span<std::byte> list_of_bottoms(std::byte* serial) {
  const auto header = rt::load<rt::SerialHeader>(serial);
  return {serial + sizeof header, size_t(header.num_bottoms * sizeof(Address))};
}

// Replaces each address or handle in a list of bottom levels.
template <class Replace>
void replace_all(std::span<std::byte> list, Replace&& replace) {
  for (size_t at = 0; at + sizeof(uint64_t) <= list.size(); at += sizeof(uint64_t)) {
    const uint64_t value = replace(rt::load<uint64_t>(list.data() + at));
    std::memcpy(list.data() + at, &value, sizeof value);
  }
}

void serialize(const Device& device, const Structure* from, std::span<std::byte> to) {
  std::array<uint8_t, VK_UUID_SIZE> driver;
  std::copy_n(device.physical.properties.driverUUID, VK_UUID_SIZE, driver.begin());
  rt::serialize(device.memory, from->address, driver, to);
}

// Reads how many bytes a serialised structure has. Throws Refusal when they do not lie in memory.
std::span<const std::byte> serial_at(const Device& device, Address from) {
  const std::byte* const begin = device.memory.find(from, sizeof(rt::SerialHeader));
  const uint64_t bytes = begin ? rt::load<rt::SerialHeader>(begin).serial_bytes : 0;
  if (!begin || bytes > rt::kMostBytes || !device.memory.find(from, bytes))
    throw Refusal(fmt::format("no serialised structure lies at address {:#x}", from));
  return {begin, size_t(bytes)};
}

void deserialize(Device& device, std::span<const std::byte> from, Structure* to) {
  const auto header = rt::load<rt::SerialHeader>(from.data());
  if (header.bytes > to->bytes)
    throw Refusal(fmt::format("a serialised structure of {} bytes has no room in '{}', which has {}",
                              header.bytes, to->name, to->bytes));
  rt::deserialize(device.memory, from, to->address);
  to->update_bytes = 0;
  to->inputs = nullptr, to->built = ++device.builds;
}

// An updatable structure keeps the room that an update may need when it is compacted.
uint64_t property_of(const Device& device, const Structure* structure, VkQueryType type) {
  const auto info = rt::structure_at(device.memory, structure->address);
  if (!info) throw Refusal(fmt::format("'{}' is not built", structure->name));
  switch (int(type)) {
    case VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR:
      return std::max<uint64_t>(info->bytes, structure->update_bytes);
    case VK_QUERY_TYPE_ACCELERATION_STRUCTURE_SERIALIZATION_SIZE_KHR:
      return rt::serial_bytes(device.memory, structure->address);
    case VK_QUERY_TYPE_ACCELERATION_STRUCTURE_SERIALIZATION_BOTTOM_LEVEL_POINTERS_KHR:
      return rt::bottoms_of(device.memory, structure->address).size();
    case VK_QUERY_TYPE_ACCELERATION_STRUCTURE_SIZE_KHR:
      return structure->bytes;
    default:
      throw Refusal(fmt::format("a structure has no property for the query type {}", int(type)));
  }
}

// Reads the ranges of an indirect build.
std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges_at(const Device& device, Address at,
                                                                uint32_t stride, size_t count) {
  std::vector<VkAccelerationStructureBuildRangeInfoKHR> out(count);
  for (size_t i = 0; i < count; ++i) {
    const std::byte* const from = device.memory.find(at + i * stride, sizeof out[i]);
    if (!from) throw Refusal(fmt::format("the range of geometry {} at {:#x} is not in memory", i, at));
    std::memcpy(&out[i], from, sizeof out[i]);
  }
  return out;
}

}  // namespace

void CmdBuildAccelerationStructuresKHR(CommandBuffer& commands, uint32_t count,
                                       const VkAccelerationStructureBuildGeometryInfoKHR* infos,
                                       const VkAccelerationStructureBuildRangeInfoKHR* const* ranges) {
  for (uint32_t i = 0; i < count; ++i) {
    BuildInput input = input_of(infos[i], ranges[i], false);
    check_room(commands.device, input);
    commands.record([input = std::move(input)](Queue& queue) {
      run_or_say(queue.device, "vkCmdBuildAccelerationStructuresKHR", [&] { build(queue.device, input); });
    });
  }
}

void CmdBuildAccelerationStructuresIndirectKHR(CommandBuffer& commands, uint32_t count,
                                               const VkAccelerationStructureBuildGeometryInfoKHR* infos,
                                               const VkDeviceAddress* addresses, const uint32_t* strides,
                                               const uint32_t* const*) {
  for (uint32_t i = 0; i < count; ++i)
    commands.record(
        [input = input_of(infos[i], nullptr, false), at = addresses[i], stride = strides[i]](Queue& queue) {
          run_or_say(queue.device, "vkCmdBuildAccelerationStructuresIndirectKHR", [&] {
            BuildInput whole = input;
            whole.ranges = ranges_at(queue.device, at, stride, whole.geometries.size());
            build(queue.device, whole);
          });
        });
}

VkResult BuildAccelerationStructuresKHR(Device& device, VkDeferredOperationKHR operation, uint32_t count,
                                        const VkAccelerationStructureBuildGeometryInfoKHR* infos,
                                        const VkAccelerationStructureBuildRangeInfoKHR* const* ranges) {
  for (uint32_t i = 0; i < count; ++i) build(device, input_of(infos[i], ranges[i], true));
  return done_at_once(operation);
}

void CmdCopyAccelerationStructureKHR(CommandBuffer& commands,
                                     const VkCopyAccelerationStructureInfoKHR* info) {
  commands.record([from = info->src, to = info->dst](Queue& queue) {
    run_or_say(queue.device, "vkCmdCopyAccelerationStructureKHR", [&] { copy(queue.device, from, to); });
  });
}
VkResult CopyAccelerationStructureKHR(Device& device, VkDeferredOperationKHR operation,
                                      const VkCopyAccelerationStructureInfoKHR* info) {
  copy(device, info->src, info->dst);
  return done_at_once(operation);
}

void CmdCopyAccelerationStructureToMemoryKHR(CommandBuffer& commands,
                                             const VkCopyAccelerationStructureToMemoryInfoKHR* info) {
  commands.record([from = info->src, at = info->dst.deviceAddress](Queue& queue) {
    Device& device = queue.device;
    run_or_say(device, "vkCmdCopyAccelerationStructureToMemoryKHR", [&] {
      const uint64_t bytes = rt::serial_bytes(device.memory, from->address);
      std::byte* const to = device.memory.find(at, bytes);
      if (!to) throw Refusal(fmt::format("{} bytes have no room at address {:#x}", bytes, at));
      serialize(device, from, {to, size_t(bytes)});
      device.clock.add_transfer(bytes);
    });
  });
}
// For the host, the list of bottom levels has handles.
VkResult CopyAccelerationStructureToMemoryKHR(Device& device, VkDeferredOperationKHR operation,
                                              const VkCopyAccelerationStructureToMemoryInfoKHR* info) {
  auto* const to = static_cast<std::byte*>(info->dst.hostAddress);
  serialize(device, info->src, {to, size_t(rt::serial_bytes(device.memory, info->src->address))});
  replace_all(list_of_bottoms(to), [&](Address address) -> uint64_t {
    Structure* const found = find_structure(device, address);
    return found ? reinterpret_cast<uint64_t>(found) : address;
  });
  return done_at_once(operation);
}

void CmdCopyMemoryToAccelerationStructureKHR(CommandBuffer& commands,
                                             const VkCopyMemoryToAccelerationStructureInfoKHR* info) {
  commands.record([at = info->src.deviceAddress, to = info->dst](Queue& queue) {
    run_or_say(queue.device, "vkCmdCopyMemoryToAccelerationStructureKHR", [&] {
      const auto from = serial_at(queue.device, at);
      deserialize(queue.device, from, to);
      queue.device.clock.add_transfer(from.size());
    });
  });
}
VkResult CopyMemoryToAccelerationStructureKHR(Device& device, VkDeferredOperationKHR operation,
                                              const VkCopyMemoryToAccelerationStructureInfoKHR* info) {
  const auto* const from = static_cast<const std::byte*>(info->src.hostAddress);
  const auto header = rt::load<rt::SerialHeader>(from);
  if (header.serial_bytes > rt::kMostBytes || header.serial_bytes < sizeof header ||
      header.num_bottoms > (header.serial_bytes - sizeof header) / sizeof(Address))
    throw Refusal("the bytes are no serialised structure");
  std::vector<std::byte> copied(from, from + header.serial_bytes);
  replace_all(list_of_bottoms(copied.data()), [&](uint64_t handle) {
    const Address address = address_of_handle(device, handle);
    return address ? address : handle;
  });
  deserialize(device, copied, info->dst);
  return done_at_once(operation);
}

void CmdWriteAccelerationStructuresPropertiesKHR(CommandBuffer& commands, uint32_t count,
                                                 const VkAccelerationStructureKHR* structures,
                                                 VkQueryType type, VkQueryPool pool, uint32_t first) {
  check_range(pool, first, count);
  for (uint32_t i = 0; i < count; ++i)
    commands.record([structure = structures[i], type, pool, query = first + i](Queue& queue) {
      pool->values[query] = 0;
      run_or_say(queue.device, "vkCmdWriteAccelerationStructuresPropertiesKHR",
                 [&] { pool->values[query] = property_of(queue.device, structure, type); });
    });
}

VkResult WriteAccelerationStructuresPropertiesKHR(Device& device, uint32_t count,
                                                  const VkAccelerationStructureKHR* structures,
                                                  VkQueryType type, size_t bytes, void* out, size_t stride) {
  for (uint32_t i = 0; i < count; ++i) {
    const uint64_t value = property_of(device, structures[i], type);
    if (i * stride + sizeof value > bytes)
      throw Refusal(fmt::format("{} properties do not fit into {} bytes", count, bytes));
    std::memcpy(static_cast<std::byte*>(out) + i * stride, &value, sizeof value);
  }
  return VK_SUCCESS;
}

}  // namespace glint::vulkan

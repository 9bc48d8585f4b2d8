// Builds acceleration structures from what applications have put into buffers or hold on the host.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/device_geometry.h"
#include "rtunit/structure/in_memory.h"
#include "vulkan/acceleration_structure.h"
#include "vulkan/device.h"
#include "vulkan/image.h"

namespace glint::vulkan {
namespace {

constexpr size_t kMostNotes = 4;  // of a build that are said one by one

bool is_top(const BuildInput& input) {
  return !input.geometries.empty() && input.geometries[0].geometryType == VK_GEOMETRY_TYPE_INSTANCES_KHR;
}

uint64_t primitives_of(const BuildInput& input) {
  uint64_t out = 0;
  for (const auto& range : input.ranges) out += range.primitiveCount;
  return out;
}

uint32_t index_bytes_of(VkIndexType type) {
  switch (type) {
    case VK_INDEX_TYPE_UINT16:
      return 2;
    case VK_INDEX_TYPE_UINT32:
      return 4;
    case VK_INDEX_TYPE_UINT8_EXT:
      return 1;
    default:
      return 0;
  }
}

template <class From, class To>
void set_flags(const From& from, To& to) {
  to.opaque = (from.flags & VK_GEOMETRY_OPAQUE_BIT_KHR) != 0;
  to.no_duplicate_any_hit = (from.flags & VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR) != 0;
}

// A pointer of the host and an address of the device have the same bits in their union.
pipeline::DeviceTriangles triangles_of(const Device& device, const BuildInput& input, size_t number) {
  const VkAccelerationStructureGeometryKHR& geometry = input.geometries[number];
  const VkAccelerationStructureBuildRangeInfoKHR& range = input.ranges[number];
  const VkAccelerationStructureGeometryTrianglesDataKHR& from = geometry.geometry.triangles;
  pipeline::DeviceTriangles to;
  if (from.vertexFormat != VK_FORMAT_R32G32B32_SFLOAT) to.format = texel_format_of(from.vertexFormat);
  to.index_bytes = index_bytes_of(from.indexType);
  to.vertices = from.vertexData.deviceAddress + (to.index_bytes ? 0 : range.primitiveOffset);
  to.stride = from.vertexStride;
  to.indices = from.indexData.deviceAddress + range.primitiveOffset;
  to.first_vertex = range.firstVertex;
  if (from.transformData.deviceAddress)
    to.transform = from.transformData.deviceAddress + range.transformOffset;
  to.count = range.primitiveCount;
  set_flags(geometry, to);
  if (const auto& micromaps = input.micromaps[number])
    to.micromaps = device_micromaps(device, *micromaps, input.on_host);
  return to;
}

pipeline::DeviceBoxes boxes_of(const VkAccelerationStructureGeometryKHR& geometry,
                               const VkAccelerationStructureBuildRangeInfoKHR& range) {
  const VkAccelerationStructureGeometryAabbsDataKHR& from = geometry.geometry.aabbs;
  pipeline::DeviceBoxes to;
  to.boxes = from.data.deviceAddress + range.primitiveOffset;
  to.stride = from.stride;
  to.count = range.primitiveCount;
  set_flags(geometry, to);
  return to;
}

// Returns whether what a structure is built from is kept, because launches are saved.
bool keeps_inputs(const Device& device) {
  return !device.physical.instance.settings.save.is_empty();
}

rt::EncodedStructure encode_bottom(Device& device, const BuildInput& input, std::vector<std::string>& notes) {
  pipeline::DeviceGeometry geometry =
      input.on_host ? pipeline::DeviceGeometry() : pipeline::DeviceGeometry(device.memory);
  for (size_t i = 0; i < input.geometries.size(); ++i) {
    if (input.geometries[i].geometryType == VK_GEOMETRY_TYPE_TRIANGLES_KHR)
      geometry.add(triangles_of(device, input, i));
    else
      geometry.add(boxes_of(input.geometries[i], input.ranges[i]));
  }
  geometry.finish();
  notes = geometry.notes();
  if (keeps_inputs(device)) input.to->inputs = pipeline::inputs_of(geometry.level());
  return rt::encode_bottom(input.to->name, geometry.level(), device.physical.gpu.bvh,
                           device.physical.instance.settings.threads);
}

const std::byte* find(const Device& device, const BuildInput& input, Address at, uint64_t bytes) {
  return input.on_host ? reinterpret_cast<const std::byte*>(at) : device.memory.find(at, bytes);
}

std::vector<rt::DeviceInstance> instances_of(const Device& device, const BuildInput& input,
                                             std::vector<std::string>& notes) {
  const VkAccelerationStructureGeometryInstancesDataKHR& from = input.geometries[0].geometry.instances;
  std::vector<rt::DeviceInstance> out;
  uint64_t unread = 0;
  for (uint64_t i = 0; i < input.ranges[0].primitiveCount; ++i) {
    const Address base = from.data.deviceAddress + input.ranges[0].primitiveOffset;
    rt::DeviceInstance& to = out.emplace_back();
    Address at = base + i * sizeof to;
    if (from.arrayOfPointers) {
      const std::byte* const pointer = find(device, input, base + i * sizeof at, sizeof at);
      at = 0;
      if (pointer) std::memcpy(&at, pointer, sizeof at);
    }
    const std::byte* const bytes = at ? find(device, input, at, sizeof to) : nullptr;
    if (!bytes) {
      ++unread;
      continue;
    }
    std::memcpy(&to, bytes, sizeof to);
    if (input.on_host) to.structure = address_of_handle(device, to.structure);
  }
  if (unread)
    notes.push_back(
        fmt::format("'{}': {} instances lie outside of memory and are inactive", input.to->name, unread));
  return out;
}

rt::EncodedStructure encode_top(Device& device, const BuildInput& input, std::vector<std::string>& notes) {
  const std::vector<rt::DeviceInstance> instances = instances_of(device, input, notes);
  if (keeps_inputs(device)) {
    auto inputs = std::make_shared<pipeline::StructureInputs>();
    inputs->is_top = true, inputs->instances = instances;
    input.to->inputs = std::move(inputs);
  }
  return rt::encode_top(device.memory, input.to->name, instances, device.physical.gpu.bvh, notes);
}

// Choice: what is inactive is no fault. Applications hide instances by transforms without an inverse.
void say_notes(const Device& device, const std::string& name, const std::vector<std::string>& notes) {
  for (size_t i = 0; i < notes.size() && i < kMostNotes; ++i) device.messages().info(notes[i]);
  if (notes.size() > kMostNotes)
    device.messages().info(fmt::format("'{}': {} more notes", name, notes.size() - kMostNotes));
}

}  // namespace

BuildInput input_of(const VkAccelerationStructureBuildGeometryInfoKHR& info,
                    const VkAccelerationStructureBuildRangeInfoKHR* ranges, bool on_host) {
  BuildInput out;
  out.on_host = on_host;
  out.is_update = info.mode == VK_BUILD_ACCELERATION_STRUCTURE_MODE_UPDATE_KHR;
  out.allows_update = (info.flags & VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_UPDATE_BIT_KHR) != 0;
  out.to = info.dstAccelerationStructure;
  if (info.geometryCount && !info.pGeometries && !info.ppGeometries)
    throw Refusal("a build has neither pGeometries nor ppGeometries");
  for (uint32_t i = 0; i < info.geometryCount; ++i)
    out.geometries.push_back(info.pGeometries ? info.pGeometries[i] : *info.ppGeometries[i]);
  for (const VkAccelerationStructureGeometryKHR& each : out.geometries)
    out.micromaps.push_back(micromaps_of(each));
  if (ranges) out.ranges.assign(ranges, ranges + info.geometryCount);
  const bool needs_instances = info.type == VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR;
  if (needs_instances && out.geometries.size() != 1)
    throw Refusal(fmt::format("a top level has one geometry, not {}", out.geometries.size()));
  for (const VkAccelerationStructureGeometryKHR& each : out.geometries)
    if ((each.geometryType == VK_GEOMETRY_TYPE_INSTANCES_KHR) != needs_instances)
      throw Refusal("a top level has instances, and a bottom level has triangles or boxes");
  return out;
}

uint64_t most_bytes_of(const Device& device, const BuildInput& input, uint64_t primitives) {
  return rt::most_bytes(is_top(input) ? 1 : 0, primitives, device.physical.gpu.bvh) +
         most_bytes_of(input.micromaps);
}

void check_room(const Device& device, const BuildInput& input) {
  if (!input.to) throw Refusal("a build needs a structure to write to");
  const uint64_t primitives = primitives_of(input);
  const uint64_t most = most_bytes_of(device, input, primitives);
  if (!input.is_update && most > input.to->bytes)
    throw Refusal(fmt::format("a structure of {} primitives needs up to {} bytes, and '{}' has {}",
                              primitives, most, input.to->name, input.to->bytes));
}

namespace {

void record(Device& device, const BuildInput& input, uint64_t bytes) {
  if (!device.recording.is_on()) return;
  report::DeviceCommand command;
  command.kind = "build", command.structure = input.to->name;
  command.begin = command.end = device.clock.now(), command.frame = device.frames;
  command.count = primitives_of(input), command.bytes = bytes;
  command.is_top = is_top(input), command.is_update = input.is_update, command.on_host = input.on_host;
  device.recording.add(command);
}

}  // namespace

// Model: building takes no simulated time.
void build(Device& device, const BuildInput& input) {
  check_room(device, input);
  std::vector<std::string> notes;
  const rt::EncodedStructure made =
      is_top(input) ? encode_top(device, input, notes) : encode_bottom(device, input, notes);
  say_notes(device, input.to->name, notes);
  if (made.bytes.size() > input.to->bytes)
    throw Refusal(
        fmt::format("the structure has {} bytes, and '{}' has room for {}: it is updated with more, "
                    "or its micromaps are others than pUsageCounts says",
                    made.bytes.size(), input.to->name, input.to->bytes));
  rt::write_structure(device.memory, made, input.to->address);
  input.to->built = ++device.builds;
  input.to->update_bytes = input.allows_update ? most_bytes_of(device, input, primitives_of(input)) : 0;
  record(device, input, made.bytes.size());
}

}  // namespace glint::vulkan

// Builds the acceleration structures of a frame on the device.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "drawing.h"

namespace rt_frames {
namespace {

constexpr VkDeviceSize kChunk = VkDeviceSize{256} << 20;  // bytes of structures that share a buffer
constexpr VkDeviceSize kAlignment = 256;                  // of structures within a buffer

VkDeviceSize aligned(VkDeviceSize bytes, VkDeviceSize alignment) {
  return (bytes + alignment - 1) / alignment * alignment;
}

}  // namespace

struct Drawing::Order {
  std::vector<VkAccelerationStructureGeometryKHR> geometries;
  std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges;
  VkAccelerationStructureBuildGeometryInfoKHR info{};
  VkAccelerationStructureBuildSizesInfoKHR sizes{};

  void add(const VkAccelerationStructureGeometryKHR& geometry, uint64_t primitives) {
    geometries.push_back(geometry);
    ranges.push_back({uint32_t(primitives), 0, 0, 0});
  }
};

void Drawing::build_structures() {
  std::vector<Order> orders;
  for (const std::vector<Geometry>& level : frame_.bottom_levels) {
    Order& order = orders.emplace_back();
    for (const Geometry& from : level) {
      VkAccelerationStructureGeometryKHR to{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
      to.flags = from.flags;
      if (from.is_boxes()) {
        to.geometryType = VK_GEOMETRY_TYPE_AABBS_KHR;
        auto& boxes = to.geometry.aabbs;
        boxes = {VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_AABBS_DATA_KHR};
        boxes.data.deviceAddress = buffer(from.boxes.buffer).address + from.boxes.offset;
        boxes.stride = sizeof(VkAabbPositionsKHR);
        order.add(to, from.boxes.count);
        continue;
      }
      to.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
      auto& triangles = to.geometry.triangles;
      triangles = {VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR};
      triangles.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT, triangles.indexType = VK_INDEX_TYPE_UINT32;
      triangles.vertexData.deviceAddress = buffer(from.vertices.buffer).address + from.vertices.offset;
      triangles.vertexStride = from.vertices.stride;
      triangles.maxVertex = uint32_t(from.vertices.count ? from.vertices.count - 1 : 0);
      triangles.indexData.deviceAddress = buffer(from.indices.buffer).address + from.indices.offset;
      order.add(to, from.indices.count / 3);
    }
  }
  build_top(build(orders, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR));
}

std::vector<Structure> Drawing::build(std::vector<Order>& orders, VkAccelerationStructureTypeKHR type) {
  VkDeviceSize scratch_bytes = 0;
  for (Order& order : orders) {
    order.info = {VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR};
    order.info.type = type, order.info.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
    order.info.geometryCount = uint32_t(order.geometries.size());
    order.info.pGeometries = order.geometries.data();
    std::vector<uint32_t> counts;
    for (const auto& range : order.ranges) counts.push_back(range.primitiveCount);
    order.sizes = {VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
    call_.build_sizes(device_.device, VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &order.info,
                      counts.data(), &order.sizes);
    scratch_bytes = std::max(scratch_bytes, order.sizes.buildScratchSize);
  }
  const VkDeviceSize alignment = device_.structures.minAccelerationStructureScratchOffsetAlignment;
  const Buffer scratch = device_.device_buffer(scratch_bytes + alignment);

  std::vector<Structure> out;
  Buffer chunk;
  VkDeviceSize used = 0;
  for (Order& order : orders) {
    const VkDeviceSize bytes = aligned(order.sizes.accelerationStructureSize, kAlignment);
    if (used + bytes > chunk.bytes)
      chunk = device_.device_buffer(orders.size() > 1 ? std::max(bytes, kChunk) : bytes), used = 0;
    VkAccelerationStructureCreateInfoKHR info{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR};
    info.buffer = chunk.buffer, info.offset = used, info.type = type;
    info.size = order.sizes.accelerationStructureSize;
    used += bytes, structure_bytes_ += info.size;
    Structure& made = out.emplace_back();
    check(call_.create_structure(device_.device, &info, nullptr, &made.handle),
          "vkCreateAccelerationStructureKHR");
    device_.at_end([this, handle = made.handle, destroy = call_.destroy_structure, &device = device_] {
      destroy(device.device, handle, nullptr);
    });
    const VkAccelerationStructureDeviceAddressInfoKHR where{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR, nullptr, made.handle};
    made.address = call_.address_of(device_.device, &where);
    order.info.dstAccelerationStructure = made.handle;
    order.info.scratchData.deviceAddress = aligned(scratch.address, alignment);
    device_.run([&](VkCommandBuffer commands) {
      const auto* ranges = order.ranges.data();
      call_.build(commands, 1, &order.info, &ranges);
    });
  }
  return out;
}

void Drawing::build_top(const std::vector<Structure>& bottoms) {
  std::vector<VkAccelerationStructureInstanceKHR> records(frame_.instances.count);
  const std::filesystem::path file = frame_.buffers.at(frame_.instances.buffer);
  std::ifstream in(file, std::ios::binary);
  in.seekg(std::streamoff(frame_.instances.offset));
  if (!in.read(reinterpret_cast<char*>(records.data()), std::streamsize(records.size() * sizeof records[0])))
    throw std::runtime_error("cannot read the instances of " + file.string());
  for (auto& record : records) {
    if (record.accelerationStructureReference >= bottoms.size())
      throw std::runtime_error("an instance names a bottom level that is not there");
    record.accelerationStructureReference = bottoms[record.accelerationStructureReference].address;
  }
  const Buffer uploaded = device_.upload(records.data(), records.size() * sizeof records[0]);
  VkAccelerationStructureGeometryKHR geometry{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
  geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
  geometry.geometry.instances = {VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR};
  geometry.geometry.instances.data.deviceAddress = uploaded.address;
  std::vector<Order> orders(1);
  orders[0].add(geometry, records.size());
  top_ = build(orders, VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR)[0];
}

}  // namespace rt_frames

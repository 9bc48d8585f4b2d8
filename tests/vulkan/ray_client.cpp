// Is a small Vulkan program that traces rays: structures and queries on top of client.h.
// SPDX-License-Identifier: Apache-2.0
#include "tests/vulkan/ray_client.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <string_view>
#include <type_traits>
#include <utility>

namespace glint::test {
namespace {

// Returns what a device that traces rays needs. The structures live on, because the options point to them.
Client::Options ray_options(std::vector<const char*> more, const void* more_features) {
  struct Features {
    VkPhysicalDeviceAccelerationStructureFeaturesKHR structures{};
    VkPhysicalDeviceRayQueryFeaturesKHR queries{};
    VkPhysicalDeviceVulkan12Features core{};
  };
  static std::deque<Features> all;
  Features& wanted = all.emplace_back();
  wanted.structures.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR;
  wanted.structures.accelerationStructure = wanted.structures.accelerationStructureHostCommands = VK_TRUE;
  wanted.structures.accelerationStructureIndirectBuild = VK_TRUE;
  wanted.structures.pNext = &wanted.queries;
  wanted.queries.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR;
  wanted.queries.rayQuery = VK_TRUE, wanted.queries.pNext = &wanted.core;
  wanted.core.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  wanted.core.bufferDeviceAddress = wanted.core.descriptorIndexing = VK_TRUE;
  wanted.core.hostQueryReset = wanted.core.scalarBlockLayout = VK_TRUE;
  wanted.core.pNext = const_cast<void*>(more_features);
  Client::Options out;
  out.extensions = std::move(more);
  for (const char* const each :
       {VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME, VK_KHR_RAY_QUERY_EXTENSION_NAME,
        VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME})
    out.extensions.push_back(each);
  out.features.shaderInt64 = VK_TRUE;
  out.more_features = &wanted.structures;
  return out;
}

}  // namespace

bool RayClient::is_possible() {
  const Client client;
  uint32_t count = 0;
  vkEnumerateDeviceExtensionProperties(client.physical, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> all(count);
  vkEnumerateDeviceExtensionProperties(client.physical, nullptr, &count, all.data());
  return std::any_of(all.begin(), all.end(), [](const VkExtensionProperties& each) {
    return std::string_view(each.extensionName) == VK_KHR_RAY_QUERY_EXTENSION_NAME;
  });
}

RayClient::RayClient(std::vector<const char*> more_extensions, const void* more_features)
    : Client(ray_options(std::move(more_extensions), more_features)) {
  const auto get = [&](auto& to, const char* name) { to = load<std::decay_t<decltype(to)>>(name); };
  get(create, "vkCreateAccelerationStructureKHR");
  get(destroy, "vkDestroyAccelerationStructureKHR");
  get(build_sizes, "vkGetAccelerationStructureBuildSizesKHR");
  get(address_of, "vkGetAccelerationStructureDeviceAddressKHR");
  get(cmd_build, "vkCmdBuildAccelerationStructuresKHR");
  get(cmd_build_indirect, "vkCmdBuildAccelerationStructuresIndirectKHR");
  get(host_build, "vkBuildAccelerationStructuresKHR");
  get(cmd_copy, "vkCmdCopyAccelerationStructureKHR");
  get(cmd_serialize, "vkCmdCopyAccelerationStructureToMemoryKHR");
  get(cmd_deserialize, "vkCmdCopyMemoryToAccelerationStructureKHR");
  get(host_serialize, "vkCopyAccelerationStructureToMemoryKHR");
  get(host_deserialize, "vkCopyMemoryToAccelerationStructureKHR");
  get(cmd_write_properties, "vkCmdWriteAccelerationStructuresPropertiesKHR");
  scratch_ = buffer_with_address(1 << 16);
}

MappedBuffer RayClient::buffer_with_address(VkDeviceSize bytes) {
  return buffer(bytes, kAllUses | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                           VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR |
                           VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR);
}

VkDeviceAddress RayClient::address(const MappedBuffer& buffer) const {
  const VkBufferDeviceAddressInfo info{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO, nullptr, buffer.buffer};
  return vkGetBufferDeviceAddress(device, &info);
}

namespace {

template <class T>
VkDeviceOrHostAddressConstKHR place(RayClient& client, const std::vector<T>& values, bool on_host) {
  const size_t bytes = std::max<size_t>(1, values.size()) * sizeof(T);
  VkDeviceOrHostAddressConstKHR out{};
  if (on_host) {
    void* const copy = std::aligned_alloc(64, (bytes + 63) / 64 * 64);
    std::copy(values.begin(), values.end(), static_cast<T*>(copy));
    client.at_end([copy] { std::free(copy); });
    out.hostAddress = copy;
    return out;
  }
  const MappedBuffer buffer = client.buffer_with_address(bytes);
  std::copy(values.begin(), values.end(), static_cast<T*>(buffer.data));
  out.deviceAddress = client.address(buffer);
  return out;
}

VkAccelerationStructureGeometryKHR geometry_of(VkGeometryTypeKHR type, VkGeometryFlagsKHR flags) {
  VkAccelerationStructureGeometryKHR out{};
  out.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR;
  out.geometryType = type, out.flags = flags;
  return out;
}

}  // namespace

BuildOrder RayClient::triangles(const Corners& corners, bool on_host, VkGeometryFlagsKHR flags) {
  BuildOrder out;
  VkAccelerationStructureGeometryKHR geometry = geometry_of(VK_GEOMETRY_TYPE_TRIANGLES_KHR, flags);
  auto& to = geometry.geometry.triangles;
  to.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR;
  to.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT, to.vertexStride = sizeof corners[0];
  to.maxVertex = uint32_t(corners.size()), to.indexType = VK_INDEX_TYPE_NONE_KHR;
  to.vertexData = place(*this, corners, on_host);
  out.geometries.push_back(geometry);
  out.ranges.push_back({uint32_t(corners.size() / 3), 0, 0, 0});
  return out;
}

BuildOrder RayClient::boxes(const std::vector<VkAabbPositionsKHR>& boxes) {
  BuildOrder out;
  VkAccelerationStructureGeometryKHR geometry = geometry_of(VK_GEOMETRY_TYPE_AABBS_KHR, 0);
  geometry.geometry.aabbs = {VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_AABBS_DATA_KHR, nullptr,
                             place(*this, boxes, false), sizeof boxes[0]};
  out.geometries.push_back(geometry);
  out.ranges.push_back({uint32_t(boxes.size()), 0, 0, 0});
  return out;
}

BuildOrder RayClient::instances(const std::vector<VkAccelerationStructureInstanceKHR>& all, bool on_host) {
  BuildOrder out;
  out.type = VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR;
  VkAccelerationStructureGeometryKHR geometry = geometry_of(VK_GEOMETRY_TYPE_INSTANCES_KHR, 0);
  geometry.geometry.instances = {VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR,
                                 nullptr, VK_FALSE, place(*this, all, on_host)};
  out.geometries.push_back(geometry);
  out.ranges.push_back({uint32_t(all.size()), 0, 0, 0});
  return out;
}

VkAccelerationStructureBuildGeometryInfoKHR RayClient::info_of(const BuildOrder& order) const {
  VkAccelerationStructureBuildGeometryInfoKHR out{};
  out.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR;
  out.type = order.type, out.flags = order.flags;
  out.geometryCount = uint32_t(order.geometries.size()), out.pGeometries = order.geometries.data();
  out.scratchData.deviceAddress = address(scratch_);
  return out;
}

VkDeviceSize RayClient::size_of(const BuildOrder& order, bool on_host) {
  const auto info = info_of(order);
  std::vector<uint32_t> counts;
  for (const auto& range : order.ranges) counts.push_back(range.primitiveCount);
  VkAccelerationStructureBuildSizesInfoKHR out{};
  out.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR;
  build_sizes(device,
              on_host ? VK_ACCELERATION_STRUCTURE_BUILD_TYPE_HOST_KHR
                      : VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR,
              &info, counts.data(), &out);
  return out.accelerationStructureSize;
}

RayStructure RayClient::structure(VkAccelerationStructureTypeKHR type, VkDeviceSize bytes) {
  RayStructure out;
  out.bytes = bytes;
  out.storage = buffer_with_address(bytes);
  VkAccelerationStructureCreateInfoKHR info{};
  info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR;
  info.buffer = out.storage.buffer, info.size = bytes, info.type = type;
  check(create(device, &info, nullptr, &out.handle), "vkCreateAccelerationStructureKHR");
  at_end([this, made = out.handle] { destroy(device, made, nullptr); });
  VkAccelerationStructureDeviceAddressInfoKHR wanted{
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR, nullptr, out.handle};
  out.address = address_of(device, &wanted);
  return out;
}

void RayClient::record_build(VkCommandBuffer commands, const BuildOrder& order, const RayStructure& to,
                             const RayStructure* from) {
  auto info = info_of(order);
  if (from) info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_UPDATE_KHR;
  info.srcAccelerationStructure = from ? from->handle : nullptr, info.dstAccelerationStructure = to.handle;
  const VkAccelerationStructureBuildRangeInfoKHR* const ranges = order.ranges.data();
  cmd_build(commands, 1, &info, &ranges);
}

RayStructure RayClient::build(const BuildOrder& order) {
  RayStructure out = structure(order.type, size_of(order));
  check(run([&](VkCommandBuffer commands) { record_build(commands, order, out); }), "the build");
  return out;
}

RayStructure RayClient::build_on_host(const BuildOrder& order) {
  RayStructure out = structure(order.type, size_of(order, true));
  auto info = info_of(order);
  std::vector<std::byte> scratch(1 << 16);
  info.scratchData.hostAddress = scratch.data();
  info.dstAccelerationStructure = out.handle;
  const VkAccelerationStructureBuildRangeInfoKHR* const ranges = order.ranges.data();
  check(host_build(device, nullptr, 1, &info, &ranges), "vkBuildAccelerationStructuresKHR");
  return out;
}

VkDescriptorSet RayClient::ray_set(VkDescriptorSetLayout layout, const RayStructure& top,
                                   const std::vector<VkBuffer>& buffers) {
  const std::array<VkDescriptorPoolSize, 2> sizes{
      {{VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1},
       {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, std::max(1u, uint32_t(buffers.size()))}}};
  VkDescriptorPoolCreateInfo pools{
      VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, nullptr, 0, 1, 2, sizes.data()};
  VkDescriptorPool pool_of_set = nullptr;
  check(vkCreateDescriptorPool(device, &pools, nullptr, &pool_of_set), "vkCreateDescriptorPool");
  at_end([this, pool_of_set] { vkDestroyDescriptorPool(device, pool_of_set, nullptr); });
  VkDescriptorSetAllocateInfo wanted{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, pool_of_set, 1,
                                     &layout};
  VkDescriptorSet out = nullptr;
  check(vkAllocateDescriptorSets(device, &wanted, &out), "vkAllocateDescriptorSets");
  VkWriteDescriptorSetAccelerationStructureKHR structures{
      VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR, nullptr, 1, &top.handle};
  VkWriteDescriptorSet write{};
  write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, write.pNext = &structures, write.dstSet = out;
  write.descriptorCount = 1, write.descriptorType = VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR;
  if (top.handle) vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
  for (uint32_t i = 0; i < buffers.size(); ++i) {
    const VkDescriptorBufferInfo buffer{buffers[i], 0, VK_WHOLE_SIZE};
    write.pNext = nullptr, write.dstBinding = i + 1, write.pBufferInfo = &buffer;
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
  }
  return out;
}

uint32_t RayClient::property(const RayStructure& structure, VkQueryType type) {
  VkQueryPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, info.queryType = type, info.queryCount = 1;
  VkQueryPool queries = nullptr;
  check(vkCreateQueryPool(device, &info, nullptr, &queries), "vkCreateQueryPool");
  at_end([this, queries] { vkDestroyQueryPool(device, queries, nullptr); });
  vkResetQueryPool(device, queries, 0, 1);
  check(run([&](VkCommandBuffer commands) {
          cmd_write_properties(commands, 1, &structure.handle, type, queries, 0);
        }),
        "the query");
  uint32_t out = 0;
  check(vkGetQueryPoolResults(device, queries, 0, 1, sizeof out, &out, sizeof out, VK_QUERY_RESULT_WAIT_BIT),
        "vkGetQueryPoolResults");
  return out;
}

VkAccelerationStructureInstanceKHR instance_at(float x, uint32_t custom_index, uint64_t bottom) {
  VkAccelerationStructureInstanceKHR out{};
  out.transform = {{{1, 0, 0, x}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  out.instanceCustomIndex = custom_index & 0xff'ffff;
  out.mask = 0xff;
  out.accelerationStructureReference = bottom;
  return out;
}

const Corners& unit_square() {
  static const Corners corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  return corners;
}

}  // namespace glint::test

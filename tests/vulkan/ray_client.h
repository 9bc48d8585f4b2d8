// Is a small Vulkan program that traces rays: structures and queries on top of client.h.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/vulkan/client.h"

namespace glint::test {

struct RayStructure {
  VkAccelerationStructureKHR handle = nullptr;
  VkDeviceAddress address = 0;
  MappedBuffer storage;
  VkDeviceSize bytes = 0;
};

// Describes one structure that is to be built. Its buffers live as long as the client.
struct BuildOrder {
  VkAccelerationStructureTypeKHR type = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR;
  VkBuildAccelerationStructureFlagsKHR flags = 0;
  std::vector<VkAccelerationStructureGeometryKHR> geometries;
  std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges;
};

using Corners = std::vector<std::array<float, 3>>;  // Each three are a triangle.

class RayClient : public Client {
 public:
  explicit RayClient(std::vector<const char*> more_extensions = {}, const void* more_features = nullptr);

  // Returns whether the device can trace rays, which not every device of the portable tests can.
  static bool is_possible();

  MappedBuffer buffer_with_address(VkDeviceSize bytes);
  VkDeviceAddress address(const MappedBuffer& buffer) const;

  // Return orders whose data lie in buffers of the device, or with `on_host` on the host.
  BuildOrder triangles(const Corners& corners, bool on_host = false,
                       VkGeometryFlagsKHR flags = VK_GEOMETRY_OPAQUE_BIT_KHR);
  BuildOrder boxes(const std::vector<VkAabbPositionsKHR>& boxes);
  BuildOrder instances(const std::vector<VkAccelerationStructureInstanceKHR>& all, bool on_host = false);

  VkDeviceSize size_of(const BuildOrder& order, bool on_host = false);
  // Makes a structure of so many bytes that is not built.
  RayStructure structure(VkAccelerationStructureTypeKHR type, VkDeviceSize bytes);
  // Records the build of a structure, from `from` when it is an update.
  void record_build(VkCommandBuffer commands, const BuildOrder& order, const RayStructure& to,
                    const RayStructure* from = nullptr);
  RayStructure build(const BuildOrder& order);
  RayStructure build_on_host(const BuildOrder& order);
  // Returns a set whose binding 0 is the structure, and whose bindings from 1 on are buffers.
  VkDescriptorSet ray_set(VkDescriptorSetLayout layout, const RayStructure& top,
                          const std::vector<VkBuffer>& buffers);

  uint32_t property(const RayStructure& structure, VkQueryType type);

  PFN_vkCreateAccelerationStructureKHR create;
  PFN_vkDestroyAccelerationStructureKHR destroy;
  PFN_vkGetAccelerationStructureBuildSizesKHR build_sizes;
  PFN_vkGetAccelerationStructureDeviceAddressKHR address_of;
  PFN_vkCmdBuildAccelerationStructuresKHR cmd_build;
  PFN_vkCmdBuildAccelerationStructuresIndirectKHR cmd_build_indirect;
  PFN_vkBuildAccelerationStructuresKHR host_build;
  PFN_vkCmdCopyAccelerationStructureKHR cmd_copy;
  PFN_vkCmdCopyAccelerationStructureToMemoryKHR cmd_serialize;
  PFN_vkCmdCopyMemoryToAccelerationStructureKHR cmd_deserialize;
  PFN_vkCopyAccelerationStructureToMemoryKHR host_serialize;
  PFN_vkCopyMemoryToAccelerationStructureKHR host_deserialize;
  PFN_vkCmdWriteAccelerationStructuresPropertiesKHR cmd_write_properties;

 private:
  VkAccelerationStructureBuildGeometryInfoKHR info_of(const BuildOrder& order) const;
  MappedBuffer scratch_;
};

// Returns an instance that is moved along x.
VkAccelerationStructureInstanceKHR instance_at(float x, uint32_t custom_index, uint64_t bottom);
// Is a square of side 1 with a corner at the origin, in the plane z = 0: two triangles.
const Corners& unit_square();

}  // namespace glint::test

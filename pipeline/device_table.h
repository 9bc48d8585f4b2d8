// Reads a shader binding table that a program has put into memory, with groups recognised by their handles.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "pipeline/binding_table.h"

namespace glint::pipeline {

// Corresponds to VkStridedDeviceAddressRegionKHR. An address of 0 means that there are no records.
struct DeviceRegion {
  Address base = 0;
  uint64_t stride = 0;  // bytes; 0: every index means the first record
  uint64_t bytes = 0;
};
struct DeviceTable {
  DeviceRegion raygen, miss, hit, callable;
};

// Returns the handle of a group (vkGetRayTracingShaderGroupHandlesKHR). `pipeline` is a number that no other
// pipeline has, so that the handle of a pipeline that is gone is recognised.
using GroupHandle = std::array<std::byte, exec::kHandleBytes>;
GroupHandle group_handle(uint64_t pipeline, uint32_t group);

// Sets raygen, miss, hit, callable and table of the world, whose image is linked, from the records in memory.
// A handle of zeros calls nothing. Records with another handle than one of the pipeline, or with a group that
// does not fit their region, may lie in the table; their use is a fault. Throws UserError when the record of
// ray generation is no ray generation group of the pipeline, or a stride is one that Vulkan forbids.
void read_binding_table(exec::World& world, const mem::AddressSpace& memory, const DeviceTable& table,
                        std::span<const ShaderGroup> groups, uint64_t pipeline);

}  // namespace glint::pipeline

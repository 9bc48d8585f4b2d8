// Holds acceleration structures: bytes of a buffer that a build, a copy or a deserialisation fills.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/types.h"
#include "pipeline/capsule/capsule.h"
#include "rtunit/structure/build.h"
#include "vulkan/handles.h"
#include "vulkan/memory.h"
#include "vulkan/micromap.h"

struct VkAccelerationStructureKHR_T {
  std::string name;
  glint::Address address = 0;     // in the buffer; also the device address that applications get
  VkBuffer buffer = nullptr;      // while it has no memory yet, and the structure no address
  VkDeviceSize offset = 0;        // in the buffer
  VkDeviceSize bytes = 0;         // that the application has given to it
  VkDeviceSize update_bytes = 0;  // that an update may need; 0: it was built without updates
  // What it was built from, if launches are saved; null: nobody knows.
  std::shared_ptr<const glint::pipeline::StructureInputs> inputs;
  uint64_t built = 0;  // The larger, the later it was built.
};

namespace glint::vulkan {

using Structure = VkAccelerationStructureKHR_T;

// Returns the structure at an address, or null. Where several begin, any of them.
Structure* find_structure(const Device& device, Address address);
// Returns where the structure of a handle that the application wrote into memory lies, or 0 when the device
// has no such structure.
Address address_of_handle(const Device& device, uint64_t handle);
// Gives the structures of a buffer their addresses. The buffer has memory now.
void place_structures(Device& device, const Buffer& buffer);
// Lets the structures of a buffer that ends without memory have no address.
void forget_structures(Device& device, const Buffer& buffer);
// Returns the stack entries that the worst ray needs in any structure of the device.
uint32_t stack_need(const Device& device);

// Is a copy of all that one build was asked for, because a recorded build runs later.
struct BuildInput {
  bool on_host = false;  // Addresses are the host's, and instances name their bottom levels by handle.
  bool is_update = false, allows_update = false;
  Structure* to = nullptr;
  std::vector<VkAccelerationStructureGeometryKHR> geometries;
  std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges;  // one for each geometry
  std::vector<std::optional<GeometryMicromaps>> micromaps;       // one for each geometry
};

// Copies what a build was asked for. Without `ranges` they come later. Throws Refusal for geometries that do
// not belong together.
BuildInput input_of(const VkAccelerationStructureBuildGeometryInfoKHR& info,
                    const VkAccelerationStructureBuildRangeInfoKHR* ranges, bool on_host);
// Returns how many bytes a structure of that many primitives needs at most.
uint64_t most_bytes_of(const Device& device, const BuildInput& input, uint64_t primitives);
// Throws Refusal when the structure that is built may need more bytes than the application gave to it.
void check_room(const Device& device, const BuildInput& input);
// Builds a structure. What cannot be read or reached is inactive and noted. Throws Refusal or UserError when
// there can be no structure.
void build(Device& device, const BuildInput& input);

// Returns the result of an operation that might have been deferred. Choice: all of them are done at once.
VkResult done_at_once(VkDeferredOperationKHR operation);

// Runs a recorded part of a command that may meet structures which are not built or do not fit. It says why,
// and the queue goes on.
void run_or_say(const Device& device, const char* command, const std::function<void()>& part);

}  // namespace glint::vulkan

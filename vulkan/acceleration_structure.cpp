// Makes acceleration structures, and answers what applications ask about them.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/acceleration_structure.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <fmt/format.h>
#include <memory>
#include <vector>

#include "rtunit/structure/in_memory.h"
#include "vulkan/device.h"
#include "vulkan/memory.h"

namespace glint::vulkan {
namespace {

// Choice: builds need no scratch memory of the application. Applications that divide by the size or make a
// buffer of it get more than 0.
constexpr VkDeviceSize kScratchBytes = 256;
constexpr VkDeviceSize kStructureAlignment = 256;  // Vulkan asks for it.

}  // namespace

Structure* find_structure(const Device& device, Address address) {
  for (Structure* const each : device.structures)
    if (each->address == address) return each;
  return nullptr;
}

Address address_of_handle(const Device& device, uint64_t handle) {
  const auto found = device.structures.find(reinterpret_cast<Structure*>(handle));
  return found == device.structures.end() ? 0 : (*found)->address;
}

void place_structures(Device& device, const Buffer& buffer) {
  for (Structure* const each : device.unplaced_structures)
    if (each->buffer == &buffer) each->address = buffer.address + each->offset;
  forget_structures(device, buffer);
}

void forget_structures(Device& device, const Buffer& buffer) {
  std::erase_if(device.unplaced_structures, [&](const Structure* each) { return each->buffer == &buffer; });
}

uint32_t stack_need(const Device& device) {
  uint32_t most = 0;
  for (const Structure* const each : device.structures)
    if (const auto info = rt::structure_at(device.memory, each->address))
      most = std::max(most, info->stack_need);
  return most;
}

void run_or_say(const Device& device, const char* command, const std::function<void()>& part) {
  const auto say = [&](const std::exception& error) {
    device.messages().error(fmt::format("{}: {}", command, error.what()));
  };
  try {
    part();
  } catch (const Refusal& refusal) {
    say(refusal);
  } catch (const mem::OutOfMemory&) {
    throw;
  } catch (const UserError& error) {
    say(error);
  }
}

VkResult CreateAccelerationStructureKHR(Device& device, const VkAccelerationStructureCreateInfoKHR* info,
                                        VkAccelerationStructureKHR* out) {
  if (info->deviceAddress)
    throw Refusal(VK_ERROR_FEATURE_NOT_PRESENT, "the device cannot put a structure at an address of before");
  if (info->offset % kStructureAlignment)
    throw Refusal(fmt::format("the offset {} of a structure is not a multiple of {}", info->offset,
                              kStructureAlignment));
  check_part(*info->buffer, info->offset, info->size);
  auto made = std::make_unique<Structure>();
  made->name = fmt::format("acceleration structure {}", ++device.structures_made);
  made->buffer = info->buffer, made->offset = info->offset, made->bytes = info->size;
  device.structures.insert(made.get());
  device.unplaced_structures.push_back(made.get());
  if (info->buffer->address) place_structures(device, *info->buffer);
  *out = made.release();
  return VK_SUCCESS;
}

void DestroyAccelerationStructureKHR(Device& device, VkAccelerationStructureKHR structure) {
  if (!structure) return;
  device.structures.erase(structure);
  std::erase(device.unplaced_structures, structure);
  delete structure;
}

VkDeviceAddress GetAccelerationStructureDeviceAddressKHR(
    Device&, const VkAccelerationStructureDeviceAddressInfoKHR* info) {
  return info->accelerationStructure->address;
}

void GetAccelerationStructureBuildSizesKHR(Device& device, VkAccelerationStructureBuildTypeKHR,
                                           const VkAccelerationStructureBuildGeometryInfoKHR* info,
                                           const uint32_t* most_primitives,
                                           VkAccelerationStructureBuildSizesInfoKHR* out) {
  const BuildInput input = input_of(*info, nullptr, false);
  uint64_t primitives = 0;
  for (size_t i = 0; i < input.geometries.size(); ++i) primitives += most_primitives[i];
  out->accelerationStructureSize = most_bytes_of(device, input, primitives);
  out->buildScratchSize = kScratchBytes;
  out->updateScratchSize = input.allows_update ? kScratchBytes : 0;
}

void GetDeviceAccelerationStructureCompatibilityKHR(Device& device,
                                                    const VkAccelerationStructureVersionInfoKHR* info,
                                                    VkAccelerationStructureCompatibilityKHR* out) {
  const auto& driver = device.physical.properties.driverUUID;
  const bool is_same = std::memcmp(info->pVersionData, driver, VK_UUID_SIZE) == 0 &&
                       std::memcmp(info->pVersionData + VK_UUID_SIZE, rt::kSerialVersion.data(),
                                   rt::kSerialVersion.size()) == 0;
  *out = is_same ? VK_ACCELERATION_STRUCTURE_COMPATIBILITY_COMPATIBLE_KHR
                 : VK_ACCELERATION_STRUCTURE_COMPATIBILITY_INCOMPATIBLE_KHR;
}

}  // namespace glint::vulkan

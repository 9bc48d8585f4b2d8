// Holds an instance and the one physical device that it has.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "pipeline/params.h"
#include "vulkan/announced.h"
#include "vulkan/messages.h"
#include "vulkan/settings.h"

// Is the simulated GPU as applications see it before they make a device.
struct VkPhysicalDevice_T : glint::vulkan::Dispatchable {
  explicit VkPhysicalDevice_T(VkInstance_T& of);

  VkInstance_T& instance;
  const glint::pipeline::GpuParams& gpu;
  VkPhysicalDeviceProperties core{};           // with the limits
  glint::vulkan::DeviceProperties properties;  // all others
};

struct VkInstance_T : glint::vulkan::Dispatchable {
  explicit VkInstance_T(glint::vulkan::Settings asked) : settings(std::move(asked)) {}

  const glint::vulkan::Settings settings;         // The device reads them when it is made.
  std::set<std::string, std::less<>> extensions;  // that the application enabled
  glint::vulkan::Messages messages;
  VkDebugUtilsMessengerEXT_T first_messenger;  // of VkInstanceCreateInfo
  VkPhysicalDevice_T physical{*this};
};

namespace glint::vulkan {

// Choice: a simulated device has no memory of its own, and the host gives pages when they are first touched.
inline constexpr VkDeviceSize kHeapBytes = VkDeviceSize{16} << 30;
// An address names its allocation in the upper 32 bits (memsys/address_space.h).
inline constexpr VkDeviceSize kMaxAllocationBytes = VkDeviceSize{1} << 32;
// A set has many bindings, each of which may be an array.
inline constexpr uint32_t kManyDescriptors = 1 << 20;
inline constexpr uint32_t kAllMemoryTypes = 0b111;
inline constexpr uint32_t kMaxPushConstantBytes = 256;
inline constexpr VkDeviceSize kHostPointerAlignment = 4096;
inline constexpr uint32_t kMaxRayRecursion = 31, kMaxRays = 1u << 30;

// Says what the device can do with formats, sizes and numbers.
VkPhysicalDeviceLimits limits_of(const pipeline::GpuParams& gpu, bool is_universal);
// Returns whether the device says that it has a feature.
bool announces(const PhysicalDevice& device, const Feature& feature);
DeviceProperties properties_of(const pipeline::GpuParams& gpu, const std::string& preset, bool is_universal);
// Returns the extensions that an application enables. Throws Refusal for one that is not announced; `whose`
// is "instance" or "device".
std::set<std::string, std::less<>> enabled_extensions(std::span<const VkExtensionProperties> announced,
                                                      const char* const* names, uint32_t count,
                                                      std::string_view whose);

}  // namespace glint::vulkan

// Holds what the device says that it can do: extensions, features and properties.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

#include "vulkan/handles.h"

namespace glint::vulkan {

// tools/vulkan_entry.py writes the tables of the first three from vulkan/announced.toml when Glint is built.
std::span<const VkExtensionProperties> instance_extensions();
std::span<const VkExtensionProperties> device_extensions();

// Returns the name of a core format, such as "VK_FORMAT_R8_UNORM", or "".
std::string_view name_of(VkFormat format);

struct Feature {
  std::string_view name;
  bool announced;
  bool with_graphics;  // whether it is announced when the device pretends to have graphics
};
// Describes a structure of features: after sType and pNext it has one VkBool32 for each member.
struct FeatureStruct {
  VkStructureType type;
  std::span<const Feature> members;
};
std::span<const FeatureStruct> feature_structs();

// Returns the members of a structure of features of this type, or nothing.
std::span<const Feature> features_of(VkStructureType type);
bool is_announced(std::span<const VkExtensionProperties> extensions, std::string_view name);

// Holds all properties of the device by their Vulkan names. What is not set is 0.
struct DeviceProperties : VkPhysicalDeviceVulkan11Properties,
                          VkPhysicalDeviceVulkan12Properties,
                          VkPhysicalDeviceVulkan13Properties,
                          VkPhysicalDeviceAccelerationStructurePropertiesKHR,
                          VkPhysicalDeviceRayTracingPipelinePropertiesKHR,
                          VkPhysicalDeviceRayTracingInvocationReorderPropertiesNV,
                          VkPhysicalDeviceDescriptorBufferPropertiesEXT,
                          VkPhysicalDeviceRobustness2PropertiesEXT,
                          VkPhysicalDeviceShaderSMBuiltinsPropertiesNV,
                          VkPhysicalDeviceOpacityMicromapPropertiesEXT,
                          VkPhysicalDeviceCustomBorderColorPropertiesEXT {
  // The structures of 1.1 rename these.
  VkShaderStageFlags supportedStages = 0;
  VkSubgroupFeatureFlags supportedOperations = 0;
  VkBool32 quadOperationsInAllStages = VK_FALSE;
  // Extensions bring these.
  uint32_t maxPushDescriptors = 0;
  VkDeviceSize minImportedHostPointerAlignment = 0;
  size_t combinedImageSamplerDensityMapDescriptorSize = 0;
};

// Fills one structure of a pNext chain, if it is one of those that the driver knows.
void fill_properties(VkBaseOutStructure* base, const DeviceProperties& from);

template <class To>
void assign(To& to, const To& from) {
  if constexpr (std::is_array_v<To>)
    std::copy(std::begin(from), std::end(from), std::begin(to));
  else
    to = from;
}

}  // namespace glint::vulkan

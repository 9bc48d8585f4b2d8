// Answers what applications ask of the device before they make one.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <span>
#include <string_view>

#include "vulkan/chain.h"
#include "vulkan/instance.h"
#include "vulkan/process.h"

namespace glint::vulkan {

std::span<const Feature> features_of(VkStructureType type) {
  for (const FeatureStruct& each : feature_structs())
    if (each.type == type) return each.members;
  return {};
}

bool is_announced(std::span<const VkExtensionProperties> extensions, std::string_view name) {
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const VkExtensionProperties& each) { return name == each.extensionName; });
}

VkResult EnumerateDeviceExtensionProperties(PhysicalDevice&, const char*, uint32_t* count,
                                            VkExtensionProperties* out) {
  const auto all = device_extensions();
  return enumerate(uint32_t(all.size()), count, out, [&](auto& to, uint32_t i) { to = all[i]; });
}

VkResult EnumerateDeviceLayerProperties(PhysicalDevice&, uint32_t* count, VkLayerProperties*) {
  *count = 0;
  return VK_SUCCESS;
}

// Walking rays in code asks no filter, so it knows no micromaps.
bool announces(const PhysicalDevice& device, const Feature& feature) {
  if (feature.name.starts_with("micromap") && device.gpu.rt.unit == rt::kSoftware) return false;
  return device.instance.settings.is_universal ? feature.with_graphics : feature.announced;
}

void GetPhysicalDeviceFeatures(PhysicalDevice& device, VkPhysicalDeviceFeatures* out) {
  auto* to = reinterpret_cast<VkBool32*>(out);
  for (const Feature& each : features_of(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2))
    *to++ = announces(device, each);
}

void GetPhysicalDeviceFeatures2(PhysicalDevice& device, VkPhysicalDeviceFeatures2* out) {
  GetPhysicalDeviceFeatures(device, &out->features);
  for_each_output(out, [&](VkBaseOutStructure* each) {
    auto* to = reinterpret_cast<VkBool32*>(each + 1);
    for (const Feature& feature : features_of(each->sType)) *to++ = announces(device, feature);
  });
}

void GetPhysicalDeviceProperties(PhysicalDevice& device, VkPhysicalDeviceProperties* out) {
  *out = device.core;
}

void GetPhysicalDeviceProperties2(PhysicalDevice& device, VkPhysicalDeviceProperties2* out) {
  out->properties = device.core;
  for_each_output(out, [&](VkBaseOutStructure* each) { fill_properties(each, device.properties); });
}

void GetPhysicalDeviceQueueFamilyProperties(PhysicalDevice& device, uint32_t* count,
                                            VkQueueFamilyProperties* out) {
  const std::vector<VkQueueFlags> families = queue_families(device.instance.settings.is_universal);
  enumerate(uint32_t(families.size()), count, out, [&](auto& to, uint32_t i) {
    to = {families[i], kQueues, 64, {1, 1, 1}};
  });
}

void GetPhysicalDeviceQueueFamilyProperties2(PhysicalDevice& device, uint32_t* count,
                                             VkQueueFamilyProperties2* out) {
  const std::vector<VkQueueFlags> families = queue_families(device.instance.settings.is_universal);
  enumerate(uint32_t(families.size()), count, out, [&](auto& to, uint32_t i) {
    to.queueFamilyProperties = {families[i], kQueues, 64, {1, 1, 1}};
  });
}

// Simulated memory is the host's, so every type can be mapped. Applications choose by the flags, and put what
// only shaders use in the first type and what the host reads in the last.
void GetPhysicalDeviceMemoryProperties(PhysicalDevice&, VkPhysicalDeviceMemoryProperties* out) {
  *out = {};
  constexpr VkMemoryPropertyFlags kMapped =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  for (const VkMemoryPropertyFlags flags :
       {VkMemoryPropertyFlags(VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT),
        VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | kMapped,
        VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | kMapped | VK_MEMORY_PROPERTY_HOST_CACHED_BIT})
    out->memoryTypes[out->memoryTypeCount++] = {flags, 0};
  out->memoryHeapCount = 1;
  out->memoryHeaps[0] = {kHeapBytes, VK_MEMORY_HEAP_DEVICE_LOCAL_BIT};
}

void GetPhysicalDeviceMemoryProperties2(PhysicalDevice& device, VkPhysicalDeviceMemoryProperties2* out) {
  GetPhysicalDeviceMemoryProperties(device, &out->memoryProperties);
  if (auto* budget = find_in_output<VkPhysicalDeviceMemoryBudgetPropertiesEXT>(
          out, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_BUDGET_PROPERTIES_EXT)) {
    std::fill_n(budget->heapBudget, VK_MAX_MEMORY_HEAPS, 0);
    std::fill_n(budget->heapUsage, VK_MAX_MEMORY_HEAPS, 0);
    budget->heapBudget[0] = kHeapBytes, budget->heapUsage[0] = used_by_process();
  }
}

void GetPhysicalDeviceSparseImageFormatProperties(PhysicalDevice&, VkFormat, VkImageType,
                                                  VkSampleCountFlagBits, VkImageUsageFlags, VkImageTiling,
                                                  uint32_t* count, VkSparseImageFormatProperties*) {
  *count = 0;
}

void GetPhysicalDeviceSparseImageFormatProperties2(PhysicalDevice&,
                                                   const VkPhysicalDeviceSparseImageFormatInfo2*,
                                                   uint32_t* count, VkSparseImageFormatProperties2*) {
  *count = 0;
}

VkResult GetPhysicalDeviceToolProperties(PhysicalDevice&, uint32_t* count,
                                         VkPhysicalDeviceToolProperties* out) {
  return enumerate(1, count, out, [](auto& to, uint32_t) {
    std::strcpy(to.name, "Glint");
    std::strcpy(to.version, GLINT_VERSION);
    std::strcpy(to.description, "This device is an emulator of a GPU.");
    to.purposes = VK_TOOL_PURPOSE_PROFILING_BIT;
    to.layer[0] = 0;
  });
}

// The next three say that nothing can be shared with other processes.
void GetPhysicalDeviceExternalBufferProperties(PhysicalDevice&, const VkPhysicalDeviceExternalBufferInfo*,
                                               VkExternalBufferProperties* out) {
  out->externalMemoryProperties = {};
}

void GetPhysicalDeviceExternalFenceProperties(PhysicalDevice&, const VkPhysicalDeviceExternalFenceInfo*,
                                              VkExternalFenceProperties* out) {
  out->exportFromImportedHandleTypes = out->compatibleHandleTypes = 0, out->externalFenceFeatures = 0;
}

void GetPhysicalDeviceExternalSemaphoreProperties(PhysicalDevice&,
                                                  const VkPhysicalDeviceExternalSemaphoreInfo*,
                                                  VkExternalSemaphoreProperties* out) {
  out->exportFromImportedHandleTypes = out->compatibleHandleTypes = 0, out->externalSemaphoreFeatures = 0;
}

}  // namespace glint::vulkan

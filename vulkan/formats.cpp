// Says what the device does with each format.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/instance.h"

namespace glint::vulkan {

void GetPhysicalDeviceFormatProperties(PhysicalDevice&, VkFormat, VkFormatProperties* out) {
  *out = {};
}

void GetPhysicalDeviceFormatProperties2(PhysicalDevice& device, VkFormat format, VkFormatProperties2* out) {
  GetPhysicalDeviceFormatProperties(device, format, &out->formatProperties);
}

VkResult GetPhysicalDeviceImageFormatProperties(PhysicalDevice&, VkFormat, VkImageType, VkImageTiling,
                                                VkImageUsageFlags, VkImageCreateFlags,
                                                VkImageFormatProperties* out) {
  *out = {};
  return VK_ERROR_FORMAT_NOT_SUPPORTED;
}

VkResult GetPhysicalDeviceImageFormatProperties2(PhysicalDevice& device,
                                                 const VkPhysicalDeviceImageFormatInfo2* info,
                                                 VkImageFormatProperties2* out) {
  return GetPhysicalDeviceImageFormatProperties(device, info->format, info->type, info->tiling, info->usage,
                                                info->flags, &out->imageFormatProperties);
}

}  // namespace glint::vulkan

// Makes debug messengers, and keeps the names and labels that applications give.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/debug_utils.h"

#include <memory>

#include "vulkan/instance.h"

namespace glint::vulkan {

VkDebugUtilsMessengerEXT_T messenger_of(const VkDebugUtilsMessengerCreateInfoEXT& info) {
  return {info.messageSeverity, info.messageType, info.pfnUserCallback, info.pUserData};
}

VkResult CreateDebugUtilsMessengerEXT(Instance& instance, const VkDebugUtilsMessengerCreateInfoEXT* info,
                                      VkDebugUtilsMessengerEXT* out) {
  *out = new VkDebugUtilsMessengerEXT_T(messenger_of(*info));
  instance.messages.add(*out);
  return VK_SUCCESS;
}

void DestroyDebugUtilsMessengerEXT(Instance& instance, VkDebugUtilsMessengerEXT messenger) {
  if (!messenger) return;
  instance.messages.remove(messenger);
  delete messenger;
}

void SubmitDebugUtilsMessageEXT(Instance& instance, VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                VkDebugUtilsMessageTypeFlagsEXT types,
                                const VkDebugUtilsMessengerCallbackDataEXT* data) {
  instance.messages.pass_on(severity, types, *data);
}

}  // namespace glint::vulkan

// Makes debug messengers, and keeps the names and labels that applications give.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vulkan/messages.h"

namespace glint::vulkan {

VkDebugUtilsMessengerEXT_T messenger_of(const VkDebugUtilsMessengerCreateInfoEXT& info);

}  // namespace glint::vulkan

// Carries what the driver has to say to the application's debug messengers, or to stderr without them.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/messages.h"

#include <algorithm>
#include <cstdio>

namespace glint::vulkan {

void write_to_stderr(const std::string& text) {
  const std::string line = "glint: " + text + "\n";
  std::fwrite(line.data(), 1, line.size(), stderr);
}

void Messages::add(VkDebugUtilsMessengerEXT messenger) {
  const std::lock_guard lock(mutex_);
  messengers_.push_back(messenger);
}

void Messages::remove(VkDebugUtilsMessengerEXT messenger) {
  const std::lock_guard lock(mutex_);
  messengers_.erase(std::remove(messengers_.begin(), messengers_.end(), messenger), messengers_.end());
}

void Messages::say(VkDebugUtilsMessageSeverityFlagBitsEXT severity, const std::string& text) const {
  VkDebugUtilsMessengerCallbackDataEXT data{};
  data.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CALLBACK_DATA_EXT;
  data.pMessageIdName = "glint";
  data.pMessage = text.c_str();
  if (!pass_on(severity, VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT, data)) write_to_stderr(text);
}

bool Messages::pass_on(VkDebugUtilsMessageSeverityFlagBitsEXT severity, VkDebugUtilsMessageTypeFlagsEXT types,
                       const VkDebugUtilsMessengerCallbackDataEXT& data) const {
  std::vector<VkDebugUtilsMessengerEXT> those;  // A callback may add and remove messengers.
  {
    const std::lock_guard lock(mutex_);
    for (const VkDebugUtilsMessengerEXT each : messengers_)
      if ((each->severities & severity) && (each->types & types)) those.push_back(each);
  }
  for (const VkDebugUtilsMessengerEXT each : those) each->callback(severity, types, &data, each->user_data);
  return !those.empty();
}

}  // namespace glint::vulkan

// Carries what the driver has to say to the application's debug messengers, or to stderr without them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include "vulkan/handles.h"

namespace glint::vulkan {

// Ends a command that the application may not use so. The guard of the command returns the result and says
// why.
class Refusal : public std::runtime_error {
 public:
  Refusal(VkResult result, const std::string& why) : std::runtime_error(why), result_(result) {}
  // The application breaks a rule that has no result of its own.
  explicit Refusal(const std::string& why) : Refusal(VK_ERROR_VALIDATION_FAILED_EXT, why) {}
  VkResult result() const { return result_; }

 private:
  VkResult result_;
};

// Writes one line "glint: ..." to stderr. It serves only where there is no instance yet.
void write_to_stderr(const std::string& text);

// Belongs to an instance. Any thread may call any function.
class Messages {
 public:
  void add(VkDebugUtilsMessengerEXT messenger);
  void remove(VkDebugUtilsMessengerEXT messenger);

  void error(const std::string& text) const { say(VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT, text); }
  void warning(const std::string& text) const { say(VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT, text); }
  void info(const std::string& text) const { say(VK_DEBUG_UTILS_MESSAGE_SEVERITY_INFO_BIT_EXT, text); }
  // Says a text to every messenger that wants the severity. When none does, stderr gets it.
  void say(VkDebugUtilsMessageSeverityFlagBitsEXT severity, const std::string& text) const;
  // Passes on a message of the application. Returns whether a messenger took it.
  bool pass_on(VkDebugUtilsMessageSeverityFlagBitsEXT severity, VkDebugUtilsMessageTypeFlagsEXT types,
               const VkDebugUtilsMessengerCallbackDataEXT& data) const;

 private:
  mutable std::mutex mutex_;
  std::vector<VkDebugUtilsMessengerEXT> messengers_;
};

}  // namespace glint::vulkan

// Is one debug messenger of the application.
struct VkDebugUtilsMessengerEXT_T {
  VkDebugUtilsMessageSeverityFlagsEXT severities = 0;
  VkDebugUtilsMessageTypeFlagsEXT types = 0;
  PFN_vkDebugUtilsMessengerCallbackEXT callback = nullptr;
  void* user_data = nullptr;
};

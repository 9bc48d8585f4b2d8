// Stands between the application and the driver's functions: no exception leaves, and one thread at a time
// uses a device.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "vulkan/handles.h"

namespace glint::vulkan {

// Says what a command's first parameter is, and so who may ask for its address.
enum class Level : uint8_t { OfAll, OfInstance, OfPhysicalDevice, OfDevice };

struct EntryPoint {
  std::string_view name;  // such as "vkCreateBuffer"
  PFN_vkVoidFunction function;
  Level level;
  std::string_view extensions;  // Each of these brings it, with spaces between them; empty: the core
};

// Returns all commands, sorted by name. tools/vulkan_entry.py writes the table when Glint is built.
std::span<const EntryPoint> entry_points();

// Is true once.
class Once {
 public:
  bool first() { return !done_.exchange(true); }

 private:
  std::atomic<bool> done_ = false;
};

// Returns the result of the exception that is being handled, and says what is wrong. Commands without a
// result tell their object.
VkResult caught(const char* command, std::nullptr_t);
VkResult caught(const char* command, Instance* instance);
VkResult caught(const char* command, PhysicalDevice* device);
VkResult caught(const char* command, Device* device);
VkResult caught(const char* command, Queue* queue);
VkResult caught(const char* command, CommandBuffer* commands);

// Return what keeps other threads out while a command runs. A command buffer belongs to one thread at a time
// anyway.
std::unique_lock<std::mutex> lock_of(Device* device);
std::unique_lock<std::mutex> lock_of(Queue* queue);
template <class Unlocked>
std::unique_lock<std::mutex> lock_of(Unlocked) {
  return {};
}

template <class Result, class Object, class Call>
Result guarded(const char* command, Object object, Call&& call) {
  try {
    const auto lock = lock_of(object);
    return call();
  } catch (...) {
    const VkResult result = caught(command, object);
    if constexpr (std::is_same_v<Result, VkResult>)
      return result;
    else
      return Result();
  }
}

// Answers for a core command that the driver does not have. It says the command's name once.
void say_not_written(const char* command);
// Returns the names of those that the process has called, sorted.
std::vector<std::string> commands_not_there();
template <class Result>
Result not_written(const char* command, Once& said) {
  if (said.first()) say_not_written(command);
  if constexpr (std::is_same_v<Result, VkResult>)
    return VK_ERROR_FEATURE_NOT_PRESENT;
  else
    return Result();
}

}  // namespace glint::vulkan

// Stands between the application and the driver's functions: no exception leaves, and one thread at a time
// uses a device.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/guard.h"

#include <exception>
#include <fmt/format.h>
#include <new>
#include <set>
#include <string>

#include "base/diagnostics.h"
#include "vulkan/command_buffer.h"
#include "vulkan/device.h"

namespace glint::vulkan {
namespace {

VkResult result_of(const Error& error) {
  switch (error.exit()) {
    case Exit::Unsupported:
      return VK_ERROR_FEATURE_NOT_PRESENT;
    case Exit::Fault:
    case Exit::Stuck:
      return VK_ERROR_DEVICE_LOST;
    case Exit::Ok:
    case Exit::Failure:
    case Exit::UserInput:
      break;
  }
  return VK_ERROR_UNKNOWN;
}

// Returns the result of the exception that is being handled, says its text, and notes it for the index.
VkResult explain(const char* command, const Messages* messages, Device* device = nullptr) {
  VkResult result = VK_ERROR_UNKNOWN;
  std::string why;
  try {
    throw;
  } catch (const Refusal& refusal) {
    result = refusal.result(), why = refusal.what();
  } catch (const mem::OutOfMemory& error) {
    result = VK_ERROR_OUT_OF_DEVICE_MEMORY, why = error.what();
  } catch (const Error& error) {
    result = result_of(error), why = error.what();
  } catch (const std::bad_alloc&) {
    result = VK_ERROR_OUT_OF_HOST_MEMORY, why = "the host has no more memory";
  } catch (const std::exception& error) {
    why = error.what();
  }
  const std::string text = fmt::format("{}: {}", command, why);
  messages ? messages->error(text) : write_to_stderr(text);
  if (device) device->recording.add_refusal(command, why);
  return result;
}

// Trampolines of such commands have no object to tell, so there is one list for the process.
struct CommandsNotThere {
  std::mutex mutex;
  std::set<std::string> names;
  static CommandsNotThere& instance() {
    static CommandsNotThere all;
    return all;
  }
};

}  // namespace

VkResult caught(const char* command, std::nullptr_t) {
  return explain(command, nullptr);
}
VkResult caught(const char* command, Instance* instance) {
  return explain(command, &instance->messages);
}
VkResult caught(const char* command, PhysicalDevice* device) {
  return explain(command, &device->instance.messages);
}
VkResult caught(const char* command, Device* device) {
  return explain(command, &device->messages(), device);
}
VkResult caught(const char* command, Queue* queue) {
  return explain(command, &queue->device.messages(), &queue->device);
}
// Most commands that are recorded have no result. The end of the recording has it.
VkResult caught(const char* command, CommandBuffer* commands) {
  return commands->failure = explain(command, &commands->device.messages(), &commands->device);
}

std::unique_lock<std::mutex> lock_of(Device* device) {
  return std::unique_lock(device->mutex);
}
std::unique_lock<std::mutex> lock_of(Queue* queue) {
  return std::unique_lock(queue->device.mutex);
}

void say_not_written(const char* command) {
  write_to_stderr(fmt::format("{} is not there: the device does no graphics", command));
  auto& [mutex, names] = CommandsNotThere::instance();
  const std::lock_guard lock(mutex);
  names.insert(command);
}

std::vector<std::string> commands_not_there() {
  auto& [mutex, names] = CommandsNotThere::instance();
  const std::lock_guard lock(mutex);
  return {names.begin(), names.end()};
}

}  // namespace glint::vulkan

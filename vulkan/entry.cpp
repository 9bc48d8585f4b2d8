// Holds what the loader calls: the only functions of the driver that other libraries see.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string_view>

#include "vulkan/device.h"
#include "vulkan/guard.h"

namespace glint::vulkan {
namespace {

const EntryPoint* find_entry(std::string_view name) {
  const auto all = entry_points();
  const auto found = std::lower_bound(
      all.begin(), all.end(), name, [](const EntryPoint& each, std::string_view n) { return each.name < n; });
  return found != all.end() && found->name == name ? &*found : nullptr;
}

// Returns whether the core or an extension that the application enabled brings a command.
bool is_given(const EntryPoint& entry, const Device& device) {
  for (std::string_view rest = entry.extensions; !rest.empty();) {
    const size_t end = std::min(rest.find(' '), rest.size());
    const std::string_view name = rest.substr(0, end);
    if (device.extensions.contains(name) || device.physical.instance.extensions.contains(name)) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return entry.extensions.empty();
}

// Choice: interface 5 is the newest one without functions that only other systems need.
constexpr uint32_t kLoaderInterface = 5;

}  // namespace

PFN_vkVoidFunction GetInstanceProcAddr(VkInstance, const char* name) {
  const EntryPoint* const entry = find_entry(name);
  return entry ? entry->function : nullptr;
}

PFN_vkVoidFunction GetDeviceProcAddr(Device& device, const char* name) {
  const EntryPoint* const entry = find_entry(name);
  return entry && entry->level == Level::OfDevice && is_given(*entry, device) ? entry->function : nullptr;
}

}  // namespace glint::vulkan

using namespace glint::vulkan;

extern "C" {

VKAPI_ATTR VkResult VKAPI_CALL vk_icdNegotiateLoaderICDInterfaceVersion(uint32_t* version) {
  *version = std::min(*version, kLoaderInterface);
  return VK_SUCCESS;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vk_icdGetInstanceProcAddr(VkInstance instance, const char* name) {
  return GetInstanceProcAddr(instance, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vk_icdGetPhysicalDeviceProcAddr(VkInstance, const char* name) {
  const EntryPoint* const entry = find_entry(name);
  return entry && entry->level == Level::OfPhysicalDevice ? entry->function : nullptr;
}

}  // extern "C"

// Makes and ends instances.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/instance.h"

#include <fmt/format.h>
#include <memory>

#include "vulkan/chain.h"
#include "vulkan/debug_utils.h"

namespace glint::vulkan {
namespace {

Settings settings() {
  try {
    return settings_of_environment();
  } catch (const UserError& error) {
    throw Refusal(VK_ERROR_INITIALIZATION_FAILED, error.what());
  }
}

}  // namespace

VkResult EnumerateInstanceVersion(uint32_t* version) {
  *version = VK_API_VERSION_1_3;
  return VK_SUCCESS;
}

VkResult EnumerateInstanceExtensionProperties(const char*, uint32_t* count, VkExtensionProperties* out) {
  const auto all = instance_extensions();
  return enumerate(uint32_t(all.size()), count, out, [&](auto& to, uint32_t i) { to = all[i]; });
}

// The driver has no layers.
VkResult EnumerateInstanceLayerProperties(uint32_t* count, VkLayerProperties*) {
  *count = 0;
  return VK_SUCCESS;
}

VkResult CreateInstance(const VkInstanceCreateInfo* info, VkInstance* out) {
  auto made = std::make_unique<Instance>(settings());
  made->extensions = enabled_extensions(instance_extensions(), info->ppEnabledExtensionNames,
                                        info->enabledExtensionCount, "instance");
  if (const auto* messenger = find_in_chain<VkDebugUtilsMessengerCreateInfoEXT>(
          info, VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT)) {
    made->first_messenger = messenger_of(*messenger);
    made->messages.add(&made->first_messenger);
  }
  *out = made.release();
  return VK_SUCCESS;
}

std::set<std::string, std::less<>> enabled_extensions(std::span<const VkExtensionProperties> announced,
                                                      const char* const* names, uint32_t count,
                                                      std::string_view whose) {
  for (uint32_t i = 0; i < count; ++i)
    if (!is_announced(announced, names[i]))
      throw Refusal(VK_ERROR_EXTENSION_NOT_PRESENT,
                    fmt::format("there is no {} extension {}", whose, names[i]));
  return {names, names + count};
}

void DestroyInstance(Instance& instance) {
  delete &instance;
}

VkResult EnumeratePhysicalDevices(Instance& instance, uint32_t* count, VkPhysicalDevice* out) {
  return enumerate(1, count, out, [&](auto& to, uint32_t) { to = &instance.physical; });
}

VkResult EnumeratePhysicalDeviceGroups(Instance& instance, uint32_t* count,
                                       VkPhysicalDeviceGroupProperties* out) {
  return enumerate(1, count, out, [&](auto& to, uint32_t) {
    to.physicalDeviceCount = 1;
    to.physicalDevices[0] = &instance.physical;
    to.subsetAllocation = VK_FALSE;
  });
}

}  // namespace glint::vulkan

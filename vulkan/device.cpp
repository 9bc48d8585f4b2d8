// Makes and ends devices.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/device.h"

#include <fmt/format.h>
#include <memory>
#include <string>

#include "vulkan/chain.h"

namespace glint::vulkan {
namespace {

// Notes the features that a structure asks for. Throws Refusal when the device does not have one.
void ask_for(Device& device, VkStructureType type, const void* members) {
  auto* asked = static_cast<const VkBool32*>(members);
  for (const Feature& each : features_of(type)) {
    if (!*asked++) continue;
    if (!announces(device.physical, each))
      throw Refusal(VK_ERROR_FEATURE_NOT_PRESENT, fmt::format("the device has no feature {}", each.name));
    device.features.insert(each.name);
  }
}

}  // namespace
}  // namespace glint::vulkan

// What one queue signals may free another one.
void VkDevice_T::advance() {
  for (bool has_run = true; has_run && !is_lost;) {
    has_run = false;
    for (VkQueue_T& each : queues) has_run = each.advance() || has_run;
  }
  if (is_lost)
    for (VkQueue_T& each : queues) each.clear();
  changed.notify_all();
}

namespace glint::vulkan {

VkResult CreateDevice(PhysicalDevice& physical, const VkDeviceCreateInfo* info, VkDevice* out) {
  auto made = std::make_unique<Device>(physical);
  made->extensions = enabled_extensions(device_extensions(), info->ppEnabledExtensionNames,
                                        info->enabledExtensionCount, "device");
  if (info->pEnabledFeatures)
    ask_for(*made, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, info->pEnabledFeatures);
  for (auto* each = static_cast<const VkBaseInStructure*>(info->pNext); each; each = each->pNext)
    ask_for(*made, each->sType, each + 1);
  if (physical.instance.settings.is_universal)
    made->messages().warning("GLINT_VK_QUEUE is universal: the device announces graphics and has none of it");
  *out = made.release();
  return VK_SUCCESS;
}

// Says what ran, so that a user who does not know what can be timed sees it.
void DestroyDevice(Device& device) {
  const auto& [all, timed, cycles] = device.launches;
  const std::string folder = device.recording.folder();
  if (all && timed)
    device.messages().info(fmt::format("{} of {} launches were timed: {} cycles{}", timed, all, cycles,
                                       folder.empty() ? "" : fmt::format("; glint report {}", folder)));
  else if (all)
    device.messages().info(
        fmt::format("{} launches ran, none of them timed; GLINT_TIMING chooses some", all));
  delete &device;
}

void GetDeviceQueue(Device& device, uint32_t family, uint32_t index, VkQueue* out) {
  const uint64_t families = device.queues.size() / kQueues;
  if (family >= families || index >= kQueues)
    throw Refusal(fmt::format("queue {} of family {} is not there: {} families have {} queues each", index,
                              family, families, kQueues));
  *out = &device.queues[family * kQueues + index];
}

void GetDeviceQueue2(Device& device, const VkDeviceQueueInfo2* info, VkQueue* out) {
  GetDeviceQueue(device, info->queueFamilyIndex, info->queueIndex, out);
}

void GetDeviceGroupPeerMemoryFeatures(Device&, uint32_t, uint32_t, uint32_t, VkPeerMemoryFeatureFlags* out) {
  *out = VK_PEER_MEMORY_FEATURE_COPY_SRC_BIT | VK_PEER_MEMORY_FEATURE_COPY_DST_BIT |
         VK_PEER_MEMORY_FEATURE_GENERIC_SRC_BIT | VK_PEER_MEMORY_FEATURE_GENERIC_DST_BIT;
}

}  // namespace glint::vulkan

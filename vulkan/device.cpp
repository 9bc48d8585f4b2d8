// Makes and ends devices.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/device.h"

#include <fmt/format.h>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "vulkan/chain.h"

namespace glint::vulkan {
namespace {

// Notes the features that a structure asks for. Throws Refusal when the device does not have one.
void ask_for(const PhysicalDevice& device, VkStructureType type, const void* members,
             std::set<std::string_view>& features) {
  auto* asked = static_cast<const VkBool32*>(members);
  for (const Feature& each : features_of(type)) {
    if (!*asked++) continue;
    if (!announces(device, each))
      throw Refusal(VK_ERROR_FEATURE_NOT_PRESENT, fmt::format("the device has no feature {}", each.name));
    features.insert(each.name);
  }
}

std::set<std::string_view> asked_features(const PhysicalDevice& device, const VkDeviceCreateInfo& info) {
  std::set<std::string_view> out;
  if (info.pEnabledFeatures)
    ask_for(device, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, info.pEnabledFeatures, out);
  for (auto* each = static_cast<const VkBaseInStructure*>(info.pNext); each; each = each->pNext)
    ask_for(device, each->sType, each + 1, out);
  return out;
}

// Returns the machine of a device. With micromaps its RT units ask the filter that reads them.
pipeline::GpuParams machine_of(const PhysicalDevice& device, const std::set<std::string_view>& features) {
  pipeline::GpuParams out = device.gpu;
  if (features.count("micromap") && out.rt.leaf_filter.name == rt::LeafFilter::kNone)
    out.rt.leaf_filter = rt::LeafFilter::kMicromaps;
  return out;
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
  std::set<std::string_view> features = asked_features(physical, *info);
  auto made = std::make_unique<Device>(physical, machine_of(physical, features));
  made->features = std::move(features);
  made->extensions = enabled_extensions(device_extensions(), info->ppEnabledExtensionNames,
                                        info->enabledExtensionCount, "device");
  if (physical.instance.settings.is_universal)
    made->messages().warning(
        "GLINT_VK_QUEUE is universal: the device announces graphics and has none of it, and a "
        "conformance that nobody certified");
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

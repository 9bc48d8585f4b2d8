// Makes debug messengers, and keeps the names and labels that applications give.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/debug_utils.h"

#include <memory>

#include "vulkan/command_buffer.h"
#include "vulkan/device.h"
#include "vulkan/memory.h"
#include "vulkan/pipeline.h"

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

// The name of a buffer, shader or pipeline stands in messages about it.
VkResult SetDebugUtilsObjectNameEXT(Device& device, const VkDebugUtilsObjectNameInfoEXT* info) {
  const std::string name = info->pObjectName ? info->pObjectName : "";
  switch (info->objectType) {
    case VK_OBJECT_TYPE_BUFFER: {
      auto* const buffer = reinterpret_cast<VkBuffer>(info->objectHandle);
      buffer->name = name;
      if (buffer->address) device.memory.rename(buffer->address, name);
      break;
    }
    case VK_OBJECT_TYPE_SHADER_MODULE:
      reinterpret_cast<VkShaderModule>(info->objectHandle)->name = name;
      break;
    case VK_OBJECT_TYPE_PIPELINE:
      reinterpret_cast<VkPipeline>(info->objectHandle)->name = name;
      break;
    default:
      break;
  }
  return VK_SUCCESS;
}
VkResult SetDebugUtilsObjectTagEXT(Device&, const VkDebugUtilsObjectTagInfoEXT*) {
  return VK_SUCCESS;
}

void QueueBeginDebugUtilsLabelEXT(Queue& queue, const VkDebugUtilsLabelEXT* label) {
  queue.labels.emplace_back(label->pLabelName);
}
void QueueEndDebugUtilsLabelEXT(Queue& queue) {
  if (!queue.labels.empty()) queue.labels.pop_back();
}
void CmdBeginDebugUtilsLabelEXT(CommandBuffer& commands, const VkDebugUtilsLabelEXT* label) {
  commands.record([name = std::string(label->pLabelName)](Queue& queue) { queue.labels.push_back(name); });
}
void CmdEndDebugUtilsLabelEXT(CommandBuffer& commands) {
  commands.record([](Queue& queue) { QueueEndDebugUtilsLabelEXT(queue); });
}
// A label without an end marks a moment, and nothing of Glint looks at moments.
void QueueInsertDebugUtilsLabelEXT(Queue&, const VkDebugUtilsLabelEXT*) {
}
void CmdInsertDebugUtilsLabelEXT(CommandBuffer&, const VkDebugUtilsLabelEXT*) {
}

}  // namespace glint::vulkan

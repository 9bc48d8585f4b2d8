// Makes, begins and ends command buffers.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/command_buffer.h"

#include "vulkan/device.h"

void VkCommandBuffer_T::reset() {
  state = State::Initial;
  failure = VK_SUCCESS;
  commands.clear();
  bound = bound_for_rays = {};
  descriptor_buffers.clear();
  graphics_pipeline.clear();
  rendering = {};
}

void VkCommandBuffer_T::append_to(glint::vulkan::CommandList& list) const {
  if (state != State::Executable)
    throw glint::vulkan::Refusal(
        "a command buffer that is submitted or executed was not recorded to its end");
  list.insert(list.end(), commands.begin(), commands.end());
}

namespace glint::vulkan {

VkResult CreateCommandPool(Device&, const VkCommandPoolCreateInfo*, VkCommandPool* out) {
  *out = new VkCommandPool_T;
  return VK_SUCCESS;
}
void DestroyCommandPool(Device&, VkCommandPool pool) {
  if (!pool) return;
  for (CommandBuffer* commands : pool->buffers) delete commands;
  delete pool;
}
VkResult ResetCommandPool(Device&, VkCommandPool pool, VkCommandPoolResetFlags) {
  for (CommandBuffer* commands : pool->buffers) commands->reset();
  return VK_SUCCESS;
}
void TrimCommandPool(Device&, VkCommandPool, VkCommandPoolTrimFlags) {
}

VkResult AllocateCommandBuffers(Device& device, const VkCommandBufferAllocateInfo* info,
                                VkCommandBuffer* out) {
  for (uint32_t i = 0; i < info->commandBufferCount; ++i) {
    out[i] = new CommandBuffer(device, info->commandPool);
    info->commandPool->buffers.insert(out[i]);
  }
  return VK_SUCCESS;
}
void FreeCommandBuffers(Device&, VkCommandPool pool, uint32_t count, const VkCommandBuffer* buffers) {
  for (uint32_t i = 0; i < count; ++i) {
    pool->buffers.erase(buffers[i]);
    delete buffers[i];
  }
}

VkResult BeginCommandBuffer(CommandBuffer& commands, const VkCommandBufferBeginInfo*) {
  commands.reset();
  commands.state = CommandBuffer::State::Recording;
  return VK_SUCCESS;
}
VkResult EndCommandBuffer(CommandBuffer& commands) {
  if (commands.failure != VK_SUCCESS) return commands.failure;
  commands.state = CommandBuffer::State::Executable;
  return VK_SUCCESS;
}
VkResult ResetCommandBuffer(CommandBuffer& commands, VkCommandBufferResetFlags) {
  commands.reset();
  return VK_SUCCESS;
}

void CmdExecuteCommands(CommandBuffer& commands, uint32_t count, const VkCommandBuffer* secondaries) {
  for (uint32_t i = 0; i < count; ++i) secondaries[i]->append_to(commands.commands);
  commands.bound = commands.bound_for_rays = {};  // Vulkan says that nothing stays bound.
  commands.descriptor_buffers.clear();
}

// There is one device in the group.
void CmdSetDeviceMask(CommandBuffer&, uint32_t) {
}

}  // namespace glint::vulkan

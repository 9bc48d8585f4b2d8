// Drops draws, each pipeline's with a word, and what only draws would look at.
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "vulkan/command_buffer.h"
#include "vulkan/device.h"
#include "vulkan/pipeline.h"
#include "vulkan/query.h"
#include "vulkan/render_pass.h"

namespace glint::vulkan {
namespace {

void record_dropped(CommandBuffer& commands, const char* command) {
  commands.record([command, pipeline = commands.graphics_pipeline](Queue& queue) {
    drop_draws(queue.device, command, pipeline);
  });
}

}  // namespace

void CmdDraw(CommandBuffer& commands, uint32_t, uint32_t, uint32_t, uint32_t) {
  record_dropped(commands, "vkCmdDraw");
}
void CmdDrawIndexed(CommandBuffer& commands, uint32_t, uint32_t, uint32_t, int32_t, uint32_t) {
  record_dropped(commands, "vkCmdDrawIndexed");
}
void CmdDrawIndirect(CommandBuffer& commands, VkBuffer, VkDeviceSize, uint32_t, uint32_t) {
  record_dropped(commands, "vkCmdDrawIndirect");
}
void CmdDrawIndexedIndirect(CommandBuffer& commands, VkBuffer, VkDeviceSize, uint32_t, uint32_t) {
  record_dropped(commands, "vkCmdDrawIndexedIndirect");
}
void CmdDrawIndirectCount(CommandBuffer& commands, VkBuffer, VkDeviceSize, VkBuffer, VkDeviceSize, uint32_t,
                          uint32_t) {
  record_dropped(commands, "vkCmdDrawIndirectCount");
}
void CmdDrawIndexedIndirectCount(CommandBuffer& commands, VkBuffer, VkDeviceSize, VkBuffer, VkDeviceSize,
                                 uint32_t, uint32_t) {
  record_dropped(commands, "vkCmdDrawIndexedIndirectCount");
}

// Only draws read the following.
void CmdBindIndexBuffer(CommandBuffer&, VkBuffer, VkDeviceSize, VkIndexType) {
}
void CmdBindVertexBuffers(CommandBuffer&, uint32_t, uint32_t, const VkBuffer*, const VkDeviceSize*) {
}
void CmdBindVertexBuffers2(CommandBuffer&, uint32_t, uint32_t, const VkBuffer*, const VkDeviceSize*,
                           const VkDeviceSize*, const VkDeviceSize*) {
}
void CmdSetBlendConstants(CommandBuffer&, const float*) {
}
void CmdSetCullMode(CommandBuffer&, VkCullModeFlags) {
}
void CmdSetDepthBias(CommandBuffer&, float, float, float) {
}
void CmdSetDepthBiasEnable(CommandBuffer&, VkBool32) {
}
void CmdSetDepthBounds(CommandBuffer&, float, float) {
}
void CmdSetDepthBoundsTestEnable(CommandBuffer&, VkBool32) {
}
void CmdSetDepthCompareOp(CommandBuffer&, VkCompareOp) {
}
void CmdSetDepthTestEnable(CommandBuffer&, VkBool32) {
}
void CmdSetDepthWriteEnable(CommandBuffer&, VkBool32) {
}
void CmdSetFrontFace(CommandBuffer&, VkFrontFace) {
}
void CmdSetLineWidth(CommandBuffer&, float) {
}
void CmdSetLogicOpEXT(CommandBuffer&, VkLogicOp) {
}
void CmdSetPatchControlPointsEXT(CommandBuffer&, uint32_t) {
}
void CmdSetPrimitiveRestartEnable(CommandBuffer&, VkBool32) {
}
void CmdSetPrimitiveTopology(CommandBuffer&, VkPrimitiveTopology) {
}
void CmdSetRasterizerDiscardEnable(CommandBuffer&, VkBool32) {
}
void CmdSetScissor(CommandBuffer&, uint32_t, uint32_t, const VkRect2D*) {
}
void CmdSetScissorWithCount(CommandBuffer&, uint32_t, const VkRect2D*) {
}
void CmdSetStencilCompareMask(CommandBuffer&, VkStencilFaceFlags, uint32_t) {
}
void CmdSetStencilOp(CommandBuffer&, VkStencilFaceFlags, VkStencilOp, VkStencilOp, VkStencilOp, VkCompareOp) {
}
void CmdSetStencilReference(CommandBuffer&, VkStencilFaceFlags, uint32_t) {
}
void CmdSetStencilTestEnable(CommandBuffer&, VkBool32) {
}
void CmdSetStencilWriteMask(CommandBuffer&, VkStencilFaceFlags, uint32_t) {
}
void CmdSetViewport(CommandBuffer&, uint32_t, uint32_t, const VkViewport*) {
}
void CmdSetViewportWithCount(CommandBuffer&, uint32_t, const VkViewport*) {
}

}  // namespace glint::vulkan

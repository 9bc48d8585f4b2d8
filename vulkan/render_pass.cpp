// Makes render passes, framebuffers and graphics pipelines. Nothing is ever drawn with them.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/render_pass.h"

#include <algorithm>
#include <fmt/format.h>
#include <memory>

#include "vulkan/chain.h"
#include "vulkan/device.h"
#include "vulkan/pipeline.h"

namespace glint::vulkan {
namespace {

// Both generations of the structure have the members that are read here.
template <class Info>
VkRenderPass render_pass_of(const Info& info) {
  auto made = std::make_unique<VkRenderPass_T>();
  for (uint32_t i = 0; i < info.attachmentCount; ++i)
    made->attachments.push_back({info.pAttachments[i].loadOp, info.pAttachments[i].stencilLoadOp});
  for (uint32_t i = 0; i < info.subpassCount; ++i) {
    const auto& from = info.pSubpasses[i];
    VkRenderPass_T::Subpass& to = made->subpasses.emplace_back();
    for (uint32_t j = 0; j < from.colorAttachmentCount; ++j)
      to.colours.push_back(from.pColorAttachments[j].attachment);
    if (from.pDepthStencilAttachment) to.depth = from.pDepthStencilAttachment->attachment;
  }
  return made.release();
}

}  // namespace

VkResult CreateRenderPass(Device&, const VkRenderPassCreateInfo* info, VkRenderPass* out) {
  *out = render_pass_of(*info);
  return VK_SUCCESS;
}
VkResult CreateRenderPass2(Device&, const VkRenderPassCreateInfo2* info, VkRenderPass* out) {
  *out = render_pass_of(*info);
  return VK_SUCCESS;
}
void DestroyRenderPass(Device&, VkRenderPass pass) {
  delete pass;
}
void GetRenderAreaGranularity(Device&, VkRenderPass, VkExtent2D* out) {
  *out = {1, 1};
}

VkResult CreateFramebuffer(Device&, const VkFramebufferCreateInfo* info, VkFramebuffer* out) {
  auto made = std::make_unique<VkFramebuffer_T>();
  if (!(info->flags & VK_FRAMEBUFFER_CREATE_IMAGELESS_BIT))
    made->views.assign(info->pAttachments, info->pAttachments + info->attachmentCount);
  *out = made.release();
  return VK_SUCCESS;
}
void DestroyFramebuffer(Device&, VkFramebuffer framebuffer) {
  delete framebuffer;
}

VkResult CreateGraphicsPipelines(Device& device, VkPipelineCache, uint32_t count,
                                 const VkGraphicsPipelineCreateInfo* infos, VkPipeline* out) {
  std::fill_n(out, count, VkPipeline{});
  if (!device.physical.instance.settings.is_universal)
    throw Refusal(VK_ERROR_FEATURE_NOT_PRESENT, "the device does no graphics");
  for (uint32_t i = 0; i < count; ++i) {
    answer_feedback(infos[i]);
    auto made = std::make_unique<VkPipeline_T>();
    made->name = fmt::format("graphics pipeline {}", ++device.graphics_pipelines_made);
    if (infos[i].layout) made->layout = *infos[i].layout;
    out[i] = made.release();
  }
  return VK_SUCCESS;
}

void drop_draws(Device& device, const char* command, const std::string& pipeline) {
  const std::string what = fmt::format("draws with {}", pipeline.empty() ? "no pipeline" : pipeline);
  const std::string why = "the device does no graphics";
  if (device.recording.add_dropped(what, why))
    device.messages().warning(fmt::format("{}: {} are dropped, because {}", command, what, why));
}

}  // namespace glint::vulkan

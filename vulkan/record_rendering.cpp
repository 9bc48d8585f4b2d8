// Records render passes and dynamic rendering, of which the clears are done.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "vulkan/chain.h"
#include "vulkan/command_buffer.h"
#include "vulkan/device.h"
#include "vulkan/image.h"
#include "vulkan/render_pass.h"

namespace glint::vulkan {
namespace {

struct Layers {
  uint32_t first, count;
};

// Writes one value to a rectangle of a view's first level, as far as the rectangle lies in it.
void clear(Queue& queue, const exec::ImageView& view, const VkRect2D& area, const Layers& layers,
           const exec::Words& words) {
  const uint32_t texel_bytes = view.texel_bytes();
  if (exec::info_of(view.format).block > 1) throw Refusal("an attachment with blocks");
  std::array<std::byte, 16> texel{};
  exec::encode(view.format, words, texel.data());
  const auto first = [](int32_t at) { return uint32_t(std::max(at, 0)); };
  const uint32_t x = first(area.offset.x), y0 = first(area.offset.y);
  const uint32_t x_end = std::min(view.width, x + area.extent.width);
  const uint32_t y_end = std::min(view.height, y0 + area.extent.height);
  if (x >= x_end) return;
  std::vector<std::byte> cleared(uint64_t{x_end - x} * texel_bytes);
  for (uint64_t at = 0; at < cleared.size(); at += texel_bytes)
    std::memcpy(cleared.data() + at, texel.data(), texel_bytes);
  uint64_t rows = 0;
  for (uint32_t layer = layers.first; layer < std::min(view.layers, layers.first + layers.count); ++layer)
    for (uint32_t y = y0; y < y_end; ++y, ++rows) {
      std::byte* const row = queue.device.memory.find(view.address_of({x, y, 0, layer, 0}), cleared.size());
      if (!row) return;
      std::ranges::copy(cleared, row);
    }
  if (rows) queue.device.clock.add_transfer(rows * cleared.size());
}

exec::Words words_of(const VkClearColorValue& colour) {
  exec::Words out{};
  std::memcpy(out.data(), &colour, sizeof out);
  return out;
}
void record_clear(CommandBuffer& commands, VkImageView view, const VkRect2D& area, const Layers& layers,
                  const exec::Words& words) {
  if (!view) return;
  commands.record(
      [of = view->view, area, layers, words](Queue& queue) { clear(queue, of, area, layers, words); });
}

// Clears the aspects of a view of depth and stencil.
void record_clear(CommandBuffer& commands, VkImageView view, VkImageAspectFlags aspects, const VkRect2D& area,
                  const Layers& layers, const VkClearDepthStencilValue& value) {
  if (!view) return;
  const bool is_stencil = exec::is_integer(exec::info_of(view->view.format));
  if (aspects & (is_stencil ? VK_IMAGE_ASPECT_STENCIL_BIT : VK_IMAGE_ASPECT_DEPTH_BIT))
    record_clear(commands, view, area, layers, cleared_words(view->view.format, value));
  if (view->stencil && (aspects & VK_IMAGE_ASPECT_STENCIL_BIT))
    commands.record([of = *view->stencil, area, layers, value](Queue& queue) {
      clear(queue, of, area, layers, cleared_words(of.format, value));
    });
}

constexpr Layers kAllLayers{0, ~0u >> 1};

// Takes the attachments of a subpass of the pass that is open.
void enter(Rendering& rendering, uint32_t subpass) {
  rendering.colours.clear(), rendering.depth = nullptr;
  rendering.subpass = subpass;
  if (!rendering.pass || subpass >= rendering.pass->subpasses.size()) return;
  const auto view_of = [&](uint32_t attachment) {
    return attachment < rendering.views.size() ? rendering.views[attachment] : nullptr;
  };
  const VkRenderPass_T::Subpass& of = rendering.pass->subpasses[subpass];
  for (const uint32_t each : of.colours) rendering.colours.push_back(view_of(each));
  rendering.depth = view_of(of.depth);
}

bool is_depth_of(const VkRenderPass_T& pass, uint32_t attachment) {
  return std::any_of(pass.subpasses.begin(), pass.subpasses.end(),
                     [&](const VkRenderPass_T::Subpass& each) { return each.depth == attachment; });
}

bool is_cleared(const VkRenderingAttachmentInfo* attachment) {
  return attachment && attachment->loadOp == VK_ATTACHMENT_LOAD_OP_CLEAR;
}

}  // namespace

void CmdBeginRenderPass2(CommandBuffer& commands, const VkRenderPassBeginInfo* info,
                         const VkSubpassBeginInfo*) {
  Rendering& rendering = commands.rendering = {};
  rendering.pass = info->renderPass, rendering.views = info->framebuffer->views;
  if (const auto* with = find_in_chain<VkRenderPassAttachmentBeginInfo>(
          info, VK_STRUCTURE_TYPE_RENDER_PASS_ATTACHMENT_BEGIN_INFO);
      with && with->attachmentCount)
    rendering.views.assign(with->pAttachments, with->pAttachments + with->attachmentCount);
  const VkRenderPass_T& pass = *info->renderPass;
  for (uint32_t i = 0; i < pass.attachments.size() && i < rendering.views.size(); ++i) {
    if (i >= info->clearValueCount) continue;
    const VkClearValue& value = info->pClearValues[i];
    const bool clears = pass.attachments[i].load == VK_ATTACHMENT_LOAD_OP_CLEAR;
    VkImageAspectFlags aspects = 0;
    if (clears) aspects |= VK_IMAGE_ASPECT_DEPTH_BIT;
    if (pass.attachments[i].stencil_load == VK_ATTACHMENT_LOAD_OP_CLEAR)
      aspects |= VK_IMAGE_ASPECT_STENCIL_BIT;
    if (is_depth_of(pass, i))
      record_clear(commands, rendering.views[i], aspects, info->renderArea, kAllLayers, value.depthStencil);
    else if (clears)
      record_clear(commands, rendering.views[i], info->renderArea, kAllLayers, words_of(value.color));
  }
  enter(rendering, 0);
}
void CmdBeginRenderPass(CommandBuffer& commands, const VkRenderPassBeginInfo* info, VkSubpassContents) {
  CmdBeginRenderPass2(commands, info, nullptr);
}
void CmdNextSubpass(CommandBuffer& commands, VkSubpassContents) {
  enter(commands.rendering, commands.rendering.subpass + 1);
}
void CmdNextSubpass2(CommandBuffer& commands, const VkSubpassBeginInfo*, const VkSubpassEndInfo*) {
  CmdNextSubpass(commands, VK_SUBPASS_CONTENTS_INLINE);
}
void CmdEndRenderPass(CommandBuffer& commands) {
  commands.rendering = {};
}
void CmdEndRenderPass2(CommandBuffer& commands, const VkSubpassEndInfo*) {
  CmdEndRenderPass(commands);
}

void CmdBeginRendering(CommandBuffer& commands, const VkRenderingInfo* info) {
  Rendering& rendering = commands.rendering = {};
  const bool is_resumed = (info->flags & VK_RENDERING_RESUMING_BIT) != 0;
  for (uint32_t i = 0; i < info->colorAttachmentCount; ++i) {
    rendering.colours.push_back(info->pColorAttachments[i].imageView);
    if (!is_resumed && is_cleared(&info->pColorAttachments[i]))
      record_clear(commands, info->pColorAttachments[i].imageView, info->renderArea, kAllLayers,
                   words_of(info->pColorAttachments[i].clearValue.color));
  }
  const VkRenderingAttachmentInfo *const depth = info->pDepthAttachment, *const stencil =
                                                                             info->pStencilAttachment;
  rendering.depth = depth && depth->imageView ? depth->imageView : stencil ? stencil->imageView : nullptr;
  if (is_resumed) return;
  if (is_cleared(depth))
    record_clear(commands, depth->imageView, VK_IMAGE_ASPECT_DEPTH_BIT, info->renderArea, kAllLayers,
                 depth->clearValue.depthStencil);
  if (is_cleared(stencil))
    record_clear(commands, stencil->imageView, VK_IMAGE_ASPECT_STENCIL_BIT, info->renderArea, kAllLayers,
                 stencil->clearValue.depthStencil);
}
void CmdEndRendering(CommandBuffer& commands) {
  commands.rendering = {};
}

// A secondary command buffer does not know to what it renders, and clears nothing.
void CmdClearAttachments(CommandBuffer& commands, uint32_t count, const VkClearAttachment* attachments,
                         uint32_t num_rects, const VkClearRect* rects) {
  const Rendering& rendering = commands.rendering;
  for (uint32_t i = 0; i < count; ++i)
    for (uint32_t j = 0; j < num_rects; ++j) {
      const VkClearAttachment& each = attachments[i];
      const Layers layers{rects[j].baseArrayLayer, rects[j].layerCount};
      if (each.aspectMask & (VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT))
        record_clear(commands, rendering.depth, each.aspectMask, rects[j].rect, layers,
                     each.clearValue.depthStencil);
      else if ((each.aspectMask & VK_IMAGE_ASPECT_COLOR_BIT) &&
               each.colorAttachment < rendering.colours.size())
        record_clear(commands, rendering.colours[each.colorAttachment], rects[j].rect, layers,
                     words_of(each.clearValue.color));
    }
}

}  // namespace glint::vulkan

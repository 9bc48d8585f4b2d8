// Holds render passes and framebuffers. Their clears are done, and what is drawn in them is dropped.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "vulkan/handles.h"

struct VkRenderPass_T {
  struct Attachment {
    VkAttachmentLoadOp load, stencil_load;
  };
  // Names attachments by number; VK_ATTACHMENT_UNUSED stands for none.
  struct Subpass {
    std::vector<uint32_t> colours;
    uint32_t depth = VK_ATTACHMENT_UNUSED;
  };
  std::vector<Attachment> attachments;
  std::vector<Subpass> subpasses;
};

struct VkFramebuffer_T {
  std::vector<VkImageView> views;  // none of a framebuffer without images
};

namespace glint::vulkan {

// Is what a command buffer renders to while it is recorded.
struct Rendering {
  VkRenderPass pass = nullptr;     // null: dynamic rendering, or none
  std::vector<VkImageView> views;  // of the pass's attachments
  uint32_t subpass = 0;
  std::vector<VkImageView> colours;  // of the subpass; null for those that are not used
  VkImageView depth = nullptr;
};

// Says that draws are dropped, once for each pipeline, and counts them.
void drop_draws(Device& device, const char* command, const std::string& pipeline);

}  // namespace glint::vulkan

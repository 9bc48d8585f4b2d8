// Holds images, views of them, samplers and views of buffers as texels.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>

#include "exec/image_view.h"
#include "vulkan/handles.h"

// Is a window on device memory that holds texels in rows (exec/image_view.h). Images of linear and of optimal
// tiling lie in the same way.
struct VkImage_T {
  // All levels and layers, in which samples count as layers. Its base is 0 before memory is bound.
  glint::exec::ImageView whole;
  VkImageType type = VK_IMAGE_TYPE_2D;
  VkDeviceMemory memory = nullptr;
  VkDeviceSize offset = 0;  // in the memory
};

struct VkImageView_T {
  glint::exec::ImageView view;
};

struct VkSampler_T {
  glint::exec::Sampler sampler;
};

struct VkBufferView_T {
  VkBuffer buffer = nullptr;
  VkDeviceSize offset = 0, range = 0;
  glint::exec::TexelFormat format{};
};

namespace glint::vulkan {

using Image = VkImage_T;

// These commands serve swapchains, too.
VkResult CreateImage(Device& device, const VkImageCreateInfo* info, VkImage* out);
void DestroyImage(Device& device, VkImage image);
VkResult BindImageMemory(Device& device, VkImage image, VkDeviceMemory memory, VkDeviceSize offset);

// Each bit is a number of samples that images may have.
inline constexpr VkSampleCountFlags kSamples = VK_SAMPLE_COUNT_1_BIT | VK_SAMPLE_COUNT_2_BIT |
                                               VK_SAMPLE_COUNT_4_BIT | VK_SAMPLE_COUNT_8_BIT |
                                               VK_SAMPLE_COUNT_16_BIT;

// Returns the format that the simulated GPU has for a format of Vulkan, or nothing.
std::optional<exec::TexelFormat> format_of(VkFormat format);
// Returns it, or throws Refusal that names the format.
exec::TexelFormat texel_format_of(VkFormat format);
// Returns the texels along each side of an image's blocks, or 1.
inline uint32_t block_of(const Image& image) {
  return exec::info_of(image.whole.format).block;
}
// Returns what the device can do with images of a format, and with texels in buffers.
VkFormatFeatureFlags2 image_features_of(VkFormat format);
VkFormatFeatureFlags2 buffer_features_of(VkFormat format);

// Returns the levels and layers that a range with VK_REMAINING_* means, with the samples as layers. Throws
// Refusal when the image does not have them.
exec::ImageRange range_of(const Image& image, const VkImageSubresourceRange& range);

// Returns the host's bytes of a texel. Throws Refusal when the image has no memory.
std::byte* texel_of(const Device& device, const Image& image, const exec::TexelIndex& at);

// Calls `row(level's texel index)` for each row of texels of a range.
template <class Row>
void for_each_row(const exec::ImageView& image, const exec::ImageRange& range, Row&& row) {
  for (uint32_t level = range.first_level; level < range.first_level + range.levels; ++level)
    for (uint32_t layer = range.first_layer; layer < range.first_layer + range.layers; ++layer)
      for (uint32_t z = 0; z < image.extent(2, level); ++z)
        for (uint32_t y = 0; y < image.extent(1, level); ++y) row(exec::TexelIndex{0, y, z, layer, level});
}

}  // namespace glint::vulkan

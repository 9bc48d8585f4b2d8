// Holds images, views of them, samplers and views of buffers as texels.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "exec/image_view.h"
#include "vulkan/handles.h"
#include "vulkan/messages.h"

// Is a window on device memory that holds texels in rows (exec/image_view.h). Images of linear and of optimal
// tiling lie in the same way.
struct VkImage_T {
  // All levels and layers, in which samples count as layers. Its base is 0 before memory is bound.
  glint::exec::ImageView whole;
  VkImageType type = VK_IMAGE_TYPE_2D;
  // Depth has 24 bits in buffers. In the image it is a float, which can tell all of them apart.
  bool has_24_bits = false;
  // The stencil of an image that has depth and stencil. It lies behind the depth in the same window.
  std::unique_ptr<VkImage_T> stencil;
};

struct VkImageView_T {
  glint::exec::ImageView view;
  // What a view of both depth and stencil shows besides. Passes clear it.
  std::optional<glint::exec::ImageView> stencil;
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

bool has_depth_and_stencil(VkFormat format);
bool has_depth_of_24_bits(VkFormat format);
// Returns the parts of an image that the aspects name: itself, its stencil, both, or a null pointer in place
// of one. Without any aspect it is the image.
std::array<Image*, 2> planes_of(VkImage image, VkImageAspectFlags aspects);
// Returns the one part that an aspect names.
Image* plane_of(VkImage image, VkImageAspectFlags aspect);
// Calls `each(source, target)` for the parts of two images that the aspects name. Throws Refusal when these
// differ.
template <class Each>
void for_each_plane(VkImage source, VkImageAspectFlags of_source, VkImage target,
                    VkImageAspectFlags of_target, Each&& each) {
  const auto from = planes_of(source, of_source), to = planes_of(target, of_target);
  for (size_t i = 0; i < from.size(); ++i) {
    if (!from[i] != !to[i]) throw Refusal("the aspects of a copy are not those of both images");
    if (from[i]) each(from[i], to[i]);
  }
}
// Returns the bytes of memory that an image takes.
VkDeviceSize bytes_of(const Image& image);

// Returns the texel that a clear writes to depth, or to stencil where the format has integers.
exec::Words cleared_words(exec::TexelFormat format, const VkClearDepthStencilValue& value);

// Returns the levels and layers that a range with VK_REMAINING_* means, with the samples as layers. Throws
// Refusal when the image does not have them.
exec::ImageRange range_of(const Image& image, const VkImageSubresourceRange& range);

// Throws Refusal for an image that is not bound to memory.
void check_bound(const Image& image);
// Returns the host's bytes of a texel. Throws Refusal when the image has no memory, or its memory was freed.
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

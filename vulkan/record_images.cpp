// Records copies between images and buffers, and clears of images.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cstring>
#include <fmt/format.h>
#include <vector>

#include "vulkan/command_buffer.h"
#include "vulkan/device.h"
#include "vulkan/image.h"
#include "vulkan/memory.h"

namespace glint::vulkan {
namespace {

// Names a box of texels of an image. Slices of an image with three axes and layers of others count alike.
struct Box {
  const Image* image;
  uint32_t level, first_layer;
  VkOffset3D offset;

  exec::TexelIndex at(uint32_t y, uint32_t slice) const {
    const bool has_depth = image->type == VK_IMAGE_TYPE_3D;
    return {uint32_t(offset.x), uint32_t(offset.y) + y, has_depth ? uint32_t(offset.z) + slice : 0,
            first_layer + (has_depth ? 0 : slice), level};
  }
};

Box box_of(VkImage image, const VkImageSubresourceLayers& part, const VkOffset3D& offset) {
  return {image, part.mipLevel, part.baseArrayLayer * image->whole.samples, offset};
}

// Returns the slices or layers of a part. The samples of a texel are layers, too.
uint32_t slices_of(const Image& image, const VkImageSubresourceLayers& part, const VkExtent3D& extent) {
  if (image.type == VK_IMAGE_TYPE_3D) return extent.depth;
  const uint32_t samples = image.whole.samples;
  return part.layerCount == VK_REMAINING_ARRAY_LAYERS ? image.whole.layers - part.baseArrayLayer * samples
                                                      : part.layerCount * samples;
}

// Throws Refusal when the box leaves the image.
void check_box(const Box& box, const VkExtent3D& extent, uint32_t slices) {
  const exec::ImageView& whole = box.image->whole;
  const bool has_depth = box.image->type == VK_IMAGE_TYPE_3D;
  const auto fits = [](int32_t first, uint32_t count, uint32_t there) {
    return first >= 0 && uint32_t(first) <= there && count <= there - uint32_t(first);
  };
  if (!box.image->memory) throw Refusal(fmt::format("{} is not bound to memory", whole.name));
  if (box.level >= whole.levels || !fits(box.offset.x, extent.width, whole.extent(0, box.level)) ||
      !fits(box.offset.y, extent.height, whole.extent(1, box.level)) ||
      !(has_depth ? fits(box.offset.z, slices, whole.extent(2, box.level))
                  : fits(int32_t(box.first_layer), slices, whole.layers)))
    throw Refusal(fmt::format("a region of {} x {} x {} texels at level {} leaves {}", extent.width,
                              extent.height, slices, box.level, whole.name));
}

enum class Direction : bool { ToImage, ToBuffer };

void copy_rows(Queue& queue, VkBuffer buffer, const VkBufferImageCopy2& region, const Box& box,
               uint32_t slices, Direction direction) {
  const uint64_t texel = box.image->whole.texel_bytes();
  const uint64_t row = (region.bufferRowLength ? region.bufferRowLength : region.imageExtent.width) * texel;
  const uint64_t slice =
      row * (region.bufferImageHeight ? region.bufferImageHeight : region.imageExtent.height);
  const uint64_t bytes = region.imageExtent.width * texel;
  for (uint32_t z = 0; z < slices; ++z)
    for (uint32_t y = 0; y < region.imageExtent.height; ++y) {
      std::byte* const in_buffer =
          bytes_of(queue.device, buffer, region.bufferOffset + z * slice + y * row, bytes).data;
      std::byte* const in_image = texel_of(queue.device, *box.image, box.at(y, z));
      const bool to_image = direction == Direction::ToImage;
      std::memmove(to_image ? in_image : in_buffer, to_image ? in_buffer : in_image, bytes);
    }
  queue.device.clock.add_transfer(2 * bytes * region.imageExtent.height * slices);
}

void record_copy(CommandBuffer& commands, VkBuffer buffer, VkImage image, const VkBufferImageCopy2& region,
                 Direction direction) {
  if (image->whole.samples > 1) throw Refusal("a copy between a buffer and an image of several samples");
  const Box box = box_of(image, region.imageSubresource, region.imageOffset);
  const uint32_t slices = slices_of(*image, region.imageSubresource, region.imageExtent);
  check_box(box, region.imageExtent, slices);
  commands.record([=](Queue& queue) { copy_rows(queue, buffer, region, box, slices, direction); });
}

VkBufferImageCopy2 newer(const VkBufferImageCopy& region) {
  return {VK_STRUCTURE_TYPE_BUFFER_IMAGE_COPY_2,
          nullptr,
          region.bufferOffset,
          region.bufferRowLength,
          region.bufferImageHeight,
          region.imageSubresource,
          region.imageOffset,
          region.imageExtent};
}

void record_clear(CommandBuffer& commands, VkImage image, const exec::Words& words, uint32_t count,
                  const VkImageSubresourceRange* ranges) {
  for (uint32_t i = 0; i < count; ++i)
    commands.record([=, range = range_of(*image, ranges[i])](Queue& queue) {
      const exec::ImageView& whole = image->whole;
      const uint32_t bytes = whole.texel_bytes();
      std::array<std::byte, 16> texel{};
      exec::encode(whole.format, words, texel.data());
      uint64_t cleared = 0;
      for_each_row(whole, range, [&](const exec::TexelIndex& at) {
        std::byte* to = texel_of(queue.device, *image, at);
        for (uint32_t x = 0; x < whole.extent(0, at.level); ++x, to += bytes, cleared += bytes)
          std::memcpy(to, texel.data(), bytes);
      });
      queue.device.clock.add_transfer(cleared);
    });
}

}  // namespace

void CmdCopyBufferToImage2(CommandBuffer& commands, const VkCopyBufferToImageInfo2* info) {
  for (uint32_t i = 0; i < info->regionCount; ++i)
    record_copy(commands, info->srcBuffer, info->dstImage, info->pRegions[i], Direction::ToImage);
}
void CmdCopyBufferToImage(CommandBuffer& commands, VkBuffer from, VkImage to, VkImageLayout, uint32_t count,
                          const VkBufferImageCopy* regions) {
  for (uint32_t i = 0; i < count; ++i) record_copy(commands, from, to, newer(regions[i]), Direction::ToImage);
}
void CmdCopyImageToBuffer2(CommandBuffer& commands, const VkCopyImageToBufferInfo2* info) {
  for (uint32_t i = 0; i < info->regionCount; ++i)
    record_copy(commands, info->dstBuffer, info->srcImage, info->pRegions[i], Direction::ToBuffer);
}
void CmdCopyImageToBuffer(CommandBuffer& commands, VkImage from, VkImageLayout, VkBuffer to, uint32_t count,
                          const VkBufferImageCopy* regions) {
  for (uint32_t i = 0; i < count; ++i)
    record_copy(commands, to, from, newer(regions[i]), Direction::ToBuffer);
}

void CmdCopyImage2(CommandBuffer& commands, const VkCopyImageInfo2* info) {
  for (uint32_t i = 0; i < info->regionCount; ++i) {
    const VkImageCopy2& region = info->pRegions[i];
    const Box from = box_of(info->srcImage, region.srcSubresource, region.srcOffset);
    const Box to = box_of(info->dstImage, region.dstSubresource, region.dstOffset);
    const uint32_t slices = std::max(slices_of(*info->srcImage, region.srcSubresource, region.extent),
                                     slices_of(*info->dstImage, region.dstSubresource, region.extent));
    const uint32_t texel = info->srcImage->whole.texel_bytes();
    if (texel != info->dstImage->whole.texel_bytes())
      throw Refusal("the texels of both images differ in size");
    if (info->srcImage->whole.samples != info->dstImage->whole.samples)
      throw Refusal("a copy between images that differ in their number of samples");
    check_box(from, region.extent, slices), check_box(to, region.extent, slices);
    commands.record([=, extent = region.extent](Queue& queue) {
      for (uint32_t z = 0; z < slices; ++z)
        for (uint32_t y = 0; y < extent.height; ++y)
          std::memmove(texel_of(queue.device, *to.image, to.at(y, z)),
                       texel_of(queue.device, *from.image, from.at(y, z)), uint64_t{extent.width} * texel);
      queue.device.clock.add_transfer(uint64_t{2} * extent.width * extent.height * slices * texel);
    });
  }
}
void CmdCopyImage(CommandBuffer& commands, VkImage from, VkImageLayout from_layout, VkImage to,
                  VkImageLayout to_layout, uint32_t count, const VkImageCopy* regions) {
  std::vector<VkImageCopy2> all;
  for (uint32_t i = 0; i < count; ++i)
    all.push_back({VK_STRUCTURE_TYPE_IMAGE_COPY_2, nullptr, regions[i].srcSubresource, regions[i].srcOffset,
                   regions[i].dstSubresource, regions[i].dstOffset, regions[i].extent});
  const VkCopyImageInfo2 info{
      VK_STRUCTURE_TYPE_COPY_IMAGE_INFO_2, nullptr, from, from_layout, to, to_layout, count, all.data()};
  CmdCopyImage2(commands, &info);
}

void CmdClearColorImage(CommandBuffer& commands, VkImage image, VkImageLayout, const VkClearColorValue* color,
                        uint32_t count, const VkImageSubresourceRange* ranges) {
  exec::Words words{};
  std::memcpy(words.data(), color, sizeof words);
  record_clear(commands, image, words, count, ranges);
}
void CmdClearDepthStencilImage(CommandBuffer& commands, VkImage image, VkImageLayout,
                               const VkClearDepthStencilValue* value, uint32_t count,
                               const VkImageSubresourceRange* ranges) {
  const bool is_stencil = exec::is_integer(exec::info_of(image->whole.format));
  record_clear(commands, image,
               {is_stencil ? value->stencil : std::bit_cast<uint32_t>(value->depth), 0, 0, 0}, count, ranges);
}

}  // namespace glint::vulkan

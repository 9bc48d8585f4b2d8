// Records copies between images and buffers, and clears of images.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <vector>

#include "vulkan/command_buffer.h"
#include "vulkan/device.h"
#include "vulkan/image.h"
#include "vulkan/memory.h"

namespace glint::vulkan {
namespace {

// Names a box of an image. Slices of an image with three axes and layers of others count alike.
struct Box {
  const Image* image;
  uint32_t level, first_layer;
  VkOffset3D offset;               // texels
  uint32_t columns, rows, slices;  // blocks of texels, or texels that stand alone

  exec::TexelIndex at(uint32_t row, uint32_t slice) const {
    const bool has_depth = image->type == VK_IMAGE_TYPE_3D;
    return {uint32_t(offset.x), uint32_t(offset.y) + row * block_of(*image),
            has_depth ? uint32_t(offset.z) + slice : 0, first_layer + (has_depth ? 0 : slice), level};
  }
  uint64_t row_bytes() const { return uint64_t{columns} * image->whole.texel_bytes(); }
};

// Returns the slices or layers of a part. The samples of a texel are layers, too.
uint32_t slices_of(const Image& image, const VkImageSubresourceLayers& part, const VkExtent3D& extent) {
  if (image.type == VK_IMAGE_TYPE_3D) return extent.depth;
  const uint32_t samples = image.whole.samples;
  return part.layerCount == VK_REMAINING_ARRAY_LAYERS ? image.whole.layers - part.baseArrayLayer * samples
                                                      : part.layerCount * samples;
}

// Returns the blocks along an axis from `offset` on. Throws Refusal when some are not meant as a whole,
// unless the level ends in them.
uint32_t whole_blocks(const Image& image, uint32_t level, int axis, int32_t offset, uint32_t extent) {
  const uint32_t block = block_of(image);
  if (extent % block && uint64_t(offset) + extent != image.whole.extent(axis, level))
    throw Refusal(
        fmt::format("{} texels from {} on are no whole blocks of {}", extent, offset, image.whole.name));
  return exec::blocks_of(extent, block);
}

// Throws Refusal when the box leaves the image, or begins within a block. Choice: a block at the end of a
// level may be named with all of its texels, although Vulkan wants those that the level has.
void check_box(const Box& box) {
  const exec::ImageView& whole = box.image->whole;
  const bool has_depth = box.image->type == VK_IMAGE_TYPE_3D;
  const auto block = int32_t(block_of(*box.image));
  const auto fits = [](int32_t first, uint32_t count, uint32_t there) {
    return first >= 0 && uint32_t(first) <= there && count <= there - uint32_t(first);
  };
  check_bound(*box.image);
  if (box.offset.x % block || box.offset.y % block)
    throw Refusal(fmt::format("a region begins within a block of {}", whole.name));
  if (box.level >= whole.levels || !fits(box.offset.x / block, box.columns, whole.blocks(0, box.level)) ||
      !fits(box.offset.y / block, box.rows, whole.blocks(1, box.level)) ||
      !(has_depth ? fits(box.offset.z, box.slices, whole.extent(2, box.level))
                  : fits(int32_t(box.first_layer), box.slices, whole.layers)))
    throw Refusal(fmt::format("a region of {} x {} x {} {} at level {} leaves {}", box.columns, box.rows,
                              box.slices, block > 1 ? "blocks" : "texels", box.level, whole.name));
}

// Returns the box of `extent` texels, if the image has it.
Box box_of(VkImage image, const VkImageSubresourceLayers& part, const VkOffset3D& offset,
           const VkExtent3D& extent) {
  const Box out{image,
                part.mipLevel,
                part.baseArrayLayer * image->whole.samples,
                offset,
                whole_blocks(*image, part.mipLevel, 0, offset.x, extent.width),
                whole_blocks(*image, part.mipLevel, 1, offset.y, extent.height),
                slices_of(*image, part, extent)};
  check_box(out);
  return out;
}

enum class Direction : bool { ToImage, ToBuffer };

// Returns the blocks of a row or a column in a buffer: as many as the image has, unless `texels` says more.
uint64_t blocks_in_buffer(const Image& image, uint32_t texels, uint32_t in_image) {
  if (texels % block_of(image))
    throw Refusal(
        fmt::format("rows of {} texels in a buffer are no whole blocks of {}", texels, image.whole.name));
  return texels ? texels / block_of(image) : in_image;
}

// In buffers, depth of 24 bits lies in the low bits of words (Vulkan, "Copying Data Between Buffers and
// Images").
constexpr uint32_t kMost24Bits = 0xff'ffff;

void copy_24_bits_in(const std::byte* from, std::byte* to, uint32_t columns) {
  for (uint32_t i = 0; i < columns; ++i) {
    uint32_t word;
    std::memcpy(&word, from + i * sizeof word, sizeof word);
    const auto depth = float(double(word & kMost24Bits) / kMost24Bits);
    std::memcpy(to + i * sizeof depth, &depth, sizeof depth);
  }
}
void copy_24_bits_out(const std::byte* from, std::byte* to, uint32_t columns) {
  for (uint32_t i = 0; i < columns; ++i) {
    float depth;
    std::memcpy(&depth, from + i * sizeof depth, sizeof depth);
    const auto word = uint32_t(double(std::clamp(depth, 0.0f, 1.0f)) * kMost24Bits + 0.5);
    std::memcpy(to + i * sizeof word, &word, sizeof word);
  }
}

void copy_rows(Queue& queue, VkBuffer buffer, VkDeviceSize offset, const Box& box, uint64_t row_bytes,
               uint64_t rows, Direction direction) {
  const uint64_t bytes = box.row_bytes();
  for (uint32_t slice = 0; slice < box.slices; ++slice)
    for (uint32_t row = 0; row < box.rows; ++row) {
      const uint64_t at = offset + (slice * rows + row) * row_bytes;
      std::byte* const in_buffer = bytes_of(queue.device, buffer, at, bytes).data;
      std::byte* const in_image = texel_of(queue.device, *box.image, box.at(row, slice));
      const bool to_image = direction == Direction::ToImage;
      if (box.image->has_24_bits)
        to_image ? copy_24_bits_in(in_buffer, in_image, box.columns)
                 : copy_24_bits_out(in_image, in_buffer, box.columns);
      else
        std::memmove(to_image ? in_image : in_buffer, to_image ? in_buffer : in_image, bytes);
    }
  queue.device.clock.add_transfer(2 * bytes * box.rows * box.slices);
}

void record_copy(CommandBuffer& commands, VkBuffer buffer, VkImage whole, const VkBufferImageCopy2& region,
                 Direction direction) {
  Image* const image = plane_of(whole, region.imageSubresource.aspectMask);
  if (image->whole.samples > 1) throw Refusal("a copy between a buffer and an image of several samples");
  const Box box = box_of(image, region.imageSubresource, region.imageOffset, region.imageExtent);
  const uint64_t row_bytes =
      blocks_in_buffer(*image, region.bufferRowLength, box.columns) * image->whole.texel_bytes();
  const uint64_t rows = blocks_in_buffer(*image, region.bufferImageHeight, box.rows);
  commands.record([=, offset = region.bufferOffset](Queue& queue) {
    copy_rows(queue, buffer, offset, box, row_bytes, rows, direction);
  });
}

// Records a copy between images that have one aspect each.
void record_copy(CommandBuffer& commands, Image* source, Image* target, const VkImageCopy2& region) {
  if (source->whole.texel_bytes() != target->whole.texel_bytes())
    throw Refusal("the texels of both images differ in size");
  if (source->whole.samples != target->whole.samples)
    throw Refusal("a copy between images that differ in their number of samples");
  Box from = box_of(source, region.srcSubresource, region.srcOffset, region.extent);
  // The extent has the source's texels. Where only one image has blocks, a block is copied as a texel.
  Box to = {target,
            region.dstSubresource.mipLevel,
            region.dstSubresource.baseArrayLayer * target->whole.samples,
            region.dstOffset,
            from.columns,
            from.rows,
            slices_of(*target, region.dstSubresource, region.extent)};
  from.slices = to.slices = std::max(from.slices, to.slices);
  check_box(from), check_box(to);
  commands.record([=](Queue& queue) {
    for (uint32_t slice = 0; slice < from.slices; ++slice)
      for (uint32_t row = 0; row < from.rows; ++row)
        std::memmove(texel_of(queue.device, *to.image, to.at(row, slice)),
                     texel_of(queue.device, *from.image, from.at(row, slice)), from.row_bytes());
    queue.device.clock.add_transfer(2 * from.row_bytes() * from.rows * from.slices);
  });
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
  if (block_of(*image) > 1) throw Refusal(fmt::format("a clear of {}, which has blocks", image->whole.name));
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
    for_each_plane(info->srcImage, region.srcSubresource.aspectMask, info->dstImage,
                   region.dstSubresource.aspectMask,
                   [&](Image* from, Image* to) { record_copy(commands, from, to, region); });
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
  for (uint32_t i = 0; i < count; ++i)
    for (Image* const plane : planes_of(image, ranges[i].aspectMask))
      if (plane) record_clear(commands, plane, cleared_words(plane->whole.format, *value), 1, &ranges[i]);
}

}  // namespace glint::vulkan

// Records resolves, which make one texel of the samples of each texel.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <bit>
#include <fmt/format.h>
#include <vector>

#include "vulkan/command_buffer.h"
#include "vulkan/device.h"
#include "vulkan/image.h"

namespace glint::vulkan {
namespace {

struct Resolve {
  const Image *from, *to;
  VkImageResolve2 region;
  uint32_t layers;
};

// Returns the mean of the samples of a texel, or the first sample of integers, of which Vulkan wants one.
exec::Words resolved(const Device& device, const Image& from, exec::TexelIndex at) {
  const exec::ImageView& whole = from.whole;
  const exec::Words first = exec::decode(whole.format, texel_of(device, from, at));
  if (exec::is_integer(exec::info_of(whole.format))) return first;
  std::array<double, 4> sum{};
  for (uint32_t sample = 0; sample < whole.samples; ++sample, ++at.layer) {
    const exec::Words words = exec::decode(whole.format, texel_of(device, from, at));
    for (size_t i = 0; i < 4; ++i) sum[i] += double(std::bit_cast<float>(words[i]));
  }
  exec::Words out;
  for (size_t i = 0; i < 4; ++i) out[i] = std::bit_cast<uint32_t>(float(sum[i] / whole.samples));
  return out;
}

void run(Queue& queue, const Resolve& resolve) {
  const auto& [from, to, region, layers] = resolve;
  const VkOffset3D &source = region.srcOffset, &target = region.dstOffset;
  for (uint32_t layer = 0; layer < layers; ++layer)
    for (uint32_t y = 0; y < region.extent.height; ++y)
      for (uint32_t x = 0; x < region.extent.width; ++x) {
        const exec::Words texel =
            resolved(queue.device, *from,
                     {uint32_t(source.x) + x, uint32_t(source.y) + y, 0,
                      (region.srcSubresource.baseArrayLayer + layer) * from->whole.samples,
                      region.srcSubresource.mipLevel});
        const exec::TexelIndex at{uint32_t(target.x) + x, uint32_t(target.y) + y, 0,
                                  region.dstSubresource.baseArrayLayer + layer,
                                  region.dstSubresource.mipLevel};
        exec::encode(to->whole.format, texel, texel_of(queue.device, *to, at));
      }
  queue.device.clock.add_transfer(uint64_t{layers} * region.extent.width * region.extent.height *
                                  (from->whole.samples + 1) * from->whole.texel_bytes());
}

// Throws Refusal when a region leaves its image.
void check_region(const Image& image, const VkImageSubresourceLayers& part, const VkOffset3D& offset,
                  const VkExtent3D& extent, uint32_t layers) {
  const exec::ImageView& whole = image.whole;
  const auto fits = [](int32_t first, uint32_t count, uint32_t there) {
    return first >= 0 && uint32_t(first) <= there && count <= there - uint32_t(first);
  };
  check_bound(image);
  if (part.mipLevel >= whole.levels || !fits(offset.x, extent.width, whole.extent(0, part.mipLevel)) ||
      !fits(offset.y, extent.height, whole.extent(1, part.mipLevel)) ||
      !fits(int32_t(part.baseArrayLayer), layers, whole.layers / whole.samples))
    throw Refusal(fmt::format("a resolve of {} x {} texels of {} layers leaves {}", extent.width,
                              extent.height, layers, whole.name));
}

}  // namespace

void CmdResolveImage2(CommandBuffer& commands, const VkResolveImageInfo2* info) {
  const Image &from = *info->srcImage, &to = *info->dstImage;
  if (from.whole.samples == 1 || to.whole.samples != 1)
    throw Refusal("a resolve makes an image with one sample of one with several samples");
  if (from.whole.format != to.whole.format) throw Refusal("the images of a resolve differ in their formats");
  for (uint32_t i = 0; i < info->regionCount; ++i) {
    const VkImageResolve2& region = info->pRegions[i];
    const VkImageSubresourceLayers &source = region.srcSubresource, &target = region.dstSubresource;
    const uint32_t layers = source.layerCount == VK_REMAINING_ARRAY_LAYERS
                                ? from.whole.layers / from.whole.samples - source.baseArrayLayer
                                : source.layerCount;
    check_region(from, source, region.srcOffset, region.extent, layers);
    check_region(to, target, region.dstOffset, region.extent, layers);
    commands.record([resolve = Resolve{&from, &to, region, layers}](Queue& queue) { run(queue, resolve); });
  }
}

void CmdResolveImage(CommandBuffer& commands, VkImage from, VkImageLayout from_layout, VkImage to,
                     VkImageLayout to_layout, uint32_t count, const VkImageResolve* regions) {
  std::vector<VkImageResolve2> all;
  for (uint32_t i = 0; i < count; ++i)
    all.push_back({VK_STRUCTURE_TYPE_IMAGE_RESOLVE_2, nullptr, regions[i].srcSubresource,
                   regions[i].srcOffset, regions[i].dstSubresource, regions[i].dstOffset, regions[i].extent});
  const VkResolveImageInfo2 info{
      VK_STRUCTURE_TYPE_RESOLVE_IMAGE_INFO_2, nullptr, from, from_layout, to, to_layout, count, all.data()};
  CmdResolveImage2(commands, &info);
}

}  // namespace glint::vulkan

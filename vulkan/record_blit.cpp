// Records blits: copies of images that scale, mirror, filter and convert.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <vector>

#include "vulkan/command_buffer.h"
#include "vulkan/device.h"
#include "vulkan/image.h"

namespace glint::vulkan {
namespace {

// Maps texels of one axis of the destination to places in the source.
struct Axis {
  int from0, from1, to0, to1;

  int first() const { return std::min(to0, to1); }
  int end() const { return std::max(to0, to1); }
  // Returns where the middle of a destination texel lies in the source, in texels.
  double source(int to) const { return (to + 0.5 - to0) * double(from1 - from0) / (to1 - to0) + from0; }
};

struct Blit {
  const Image *from, *to;
  uint32_t from_level, to_level, from_layer, to_layer, layers;
  std::array<Axis, 3> axes;
  bool is_linear;
};

exec::Words read(const Device& device, const Blit& blit, uint32_t layer, std::array<int, 3> at) {
  const exec::ImageView& whole = blit.from->whole;
  for (int axis = 0; axis < 3; ++axis)
    at[size_t(axis)] = std::clamp(at[size_t(axis)], 0, int(whole.extent(axis, blit.from_level)) - 1);
  const exec::TexelIndex place{uint32_t(at[0]), uint32_t(at[1]), uint32_t(at[2]), blit.from_layer + layer,
                               blit.from_level};
  return exec::decode_at(whole.format, texel_of(device, *blit.from, place), place.x, place.y);
}

// Returns the mean of the eight texels around a place, weighted by their nearness.
exec::Words read_linear(const Device& device, const Blit& blit, uint32_t layer,
                        const std::array<double, 3>& place) {
  std::array<int, 3> low;
  std::array<double, 3> part;
  for (size_t i = 0; i < 3; ++i) low[i] = int(std::floor(place[i] - 0.5)), part[i] = place[i] - 0.5 - low[i];
  std::array<double, 4> sum{};
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::array<int, 3> at = low;
    for (int i = 0; i < 3; ++i) {
      const bool is_high = (corner >> i & 1) != 0;
      at[size_t(i)] += is_high;
      weight *= is_high ? part[size_t(i)] : 1 - part[size_t(i)];
    }
    if (weight == 0) continue;
    const exec::Words texel = read(device, blit, layer, at);
    for (size_t i = 0; i < 4; ++i) sum[i] += weight * double(std::bit_cast<float>(texel[i]));
  }
  exec::Words out;
  for (size_t i = 0; i < 4; ++i) out[i] = std::bit_cast<uint32_t>(float(sum[i]));
  return out;
}

void run(Queue& queue, const Blit& blit) {
  const Device& device = queue.device;
  const auto& [x_axis, y_axis, z_axis] = blit.axes;
  uint64_t texels = 0;
  for (uint32_t layer = 0; layer < blit.layers; ++layer)
    for (int z = z_axis.first(); z < z_axis.end(); ++z)
      for (int y = y_axis.first(); y < y_axis.end(); ++y)
        for (int x = x_axis.first(); x < x_axis.end(); ++x, ++texels) {
          const std::array place{x_axis.source(x), y_axis.source(y), z_axis.source(z)};
          const exec::Words texel =
              blit.is_linear
                  ? read_linear(device, blit, layer, place)
                  : read(device, blit, layer,
                         {int(std::floor(place[0])), int(std::floor(place[1])), int(std::floor(place[2]))});
          const exec::TexelIndex at{uint32_t(x), uint32_t(y), uint32_t(z), blit.to_layer + layer,
                                    blit.to_level};
          exec::encode(blit.to->whole.format, texel, texel_of(device, *blit.to, at));
        }
  queue.device.clock.add_transfer(texels * (blit.from->whole.texel_bytes() + blit.to->whole.texel_bytes()));
}

// Throws Refusal when the destination leaves its image.
void check_destination(const Blit& blit) {
  const exec::ImageView& whole = blit.to->whole;
  if (whole.samples > 1 || blit.from->whole.samples > 1)
    throw Refusal("a blit of an image of several samples");
  if (block_of(*blit.to) > 1) throw Refusal(fmt::format("a blit to {}, which has blocks", whole.name));
  bool fits = blit.to_level < whole.levels && blit.to_layer + blit.layers <= whole.layers &&
              blit.from_level < blit.from->whole.levels &&
              blit.from_layer + blit.layers <= blit.from->whole.layers;
  for (int axis = 0; axis < 3; ++axis) {
    const Axis& each = blit.axes[size_t(axis)];
    fits = fits && each.first() >= 0 && each.end() <= int(whole.extent(axis, blit.to_level));
  }
  if (!fits) throw Refusal("a blit leaves an image");
}

Blit blit_of(const Image* from, const Image* to, const VkImageBlit2& region, VkFilter filter) {
  const auto& [from0, from1] = region.srcOffsets;
  const auto& [to0, to1] = region.dstOffsets;
  return {from,
          to,
          region.srcSubresource.mipLevel,
          region.dstSubresource.mipLevel,
          region.srcSubresource.baseArrayLayer,
          region.dstSubresource.baseArrayLayer,
          region.srcSubresource.layerCount,
          {Axis{from0.x, from1.x, to0.x, to1.x}, Axis{from0.y, from1.y, to0.y, to1.y},
           Axis{from0.z, from1.z, to0.z, to1.z}},
          filter == VK_FILTER_LINEAR};
}

}  // namespace

void CmdBlitImage2(CommandBuffer& commands, const VkBlitImageInfo2* info) {
  for (uint32_t i = 0; i < info->regionCount; ++i) {
    const VkImageBlit2& region = info->pRegions[i];
    for_each_plane(info->srcImage, region.srcSubresource.aspectMask, info->dstImage,
                   region.dstSubresource.aspectMask, [&](const Image* from, const Image* to) {
                     const Blit blit = blit_of(from, to, region, info->filter);
                     check_destination(blit);
                     commands.record([blit](Queue& queue) { run(queue, blit); });
                   });
  }
}

void CmdBlitImage(CommandBuffer& commands, VkImage from, VkImageLayout from_layout, VkImage to,
                  VkImageLayout to_layout, uint32_t count, const VkImageBlit* regions, VkFilter filter) {
  std::vector<VkImageBlit2> all;
  for (uint32_t i = 0; i < count; ++i) {
    const VkImageBlit& r = regions[i];
    all.push_back({VK_STRUCTURE_TYPE_IMAGE_BLIT_2,
                   nullptr,
                   r.srcSubresource,
                   {r.srcOffsets[0], r.srcOffsets[1]},
                   r.dstSubresource,
                   {r.dstOffsets[0], r.dstOffsets[1]}});
  }
  const VkBlitImageInfo2 info{VK_STRUCTURE_TYPE_BLIT_IMAGE_INFO_2,
                              nullptr,
                              from,
                              from_layout,
                              to,
                              to_layout,
                              count,
                              all.data(),
                              filter};
  CmdBlitImage2(commands, &info);
}

}  // namespace glint::vulkan

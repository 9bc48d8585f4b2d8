// Makes views of images and of buffers, and samplers.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <fmt/format.h>
#include <memory>

#include "vulkan/chain.h"
#include "vulkan/device.h"
#include "vulkan/image.h"
#include "vulkan/memory.h"

namespace glint::vulkan {
namespace {

isa::ImageShape shape_of(VkImageViewType type) {
  switch (type) {
    case VK_IMAGE_VIEW_TYPE_1D:
      return isa::ImageShape::D1;
    case VK_IMAGE_VIEW_TYPE_3D:
      return isa::ImageShape::D3;
    case VK_IMAGE_VIEW_TYPE_CUBE:
      return isa::ImageShape::Cube;
    case VK_IMAGE_VIEW_TYPE_1D_ARRAY:
      return isa::ImageShape::A1d;
    case VK_IMAGE_VIEW_TYPE_2D_ARRAY:
      return isa::ImageShape::A2d;
    case VK_IMAGE_VIEW_TYPE_CUBE_ARRAY:
      return isa::ImageShape::Acube;
    case VK_IMAGE_VIEW_TYPE_2D:
    case VK_IMAGE_VIEW_TYPE_MAX_ENUM:
      break;
  }
  return isa::ImageShape::D2;
}

exec::Component component_of(VkComponentSwizzle swizzle, exec::Component same) {
  switch (swizzle) {
    case VK_COMPONENT_SWIZZLE_ZERO:
      return exec::Component::Zero;
    case VK_COMPONENT_SWIZZLE_ONE:
      return exec::Component::One;
    case VK_COMPONENT_SWIZZLE_R:
      return exec::Component::Red;
    case VK_COMPONENT_SWIZZLE_G:
      return exec::Component::Green;
    case VK_COMPONENT_SWIZZLE_B:
      return exec::Component::Blue;
    case VK_COMPONENT_SWIZZLE_A:
      return exec::Component::Alpha;
    case VK_COMPONENT_SWIZZLE_IDENTITY:
    case VK_COMPONENT_SWIZZLE_MAX_ENUM:
      break;
  }
  return same;
}

exec::Filter filter_of(bool is_linear) {
  return is_linear ? exec::Filter::Linear : exec::Filter::Nearest;
}

exec::Wrap wrap_of(VkSamplerAddressMode mode) {
  switch (mode) {
    case VK_SAMPLER_ADDRESS_MODE_REPEAT:
      return exec::Wrap::Repeat;
    case VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT:
      return exec::Wrap::MirroredRepeat;
    case VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER:
      return exec::Wrap::ClampToBorder;
    case VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE:
      return exec::Wrap::MirrorClampToEdge;
    case VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE:
    case VK_SAMPLER_ADDRESS_MODE_MAX_ENUM:
      break;
  }
  return exec::Wrap::ClampToEdge;
}

exec::Words border_of(const VkSamplerCreateInfo& info) {
  constexpr uint32_t kOne = std::bit_cast<uint32_t>(1.0f);
  switch (info.borderColor) {
    case VK_BORDER_COLOR_FLOAT_CUSTOM_EXT:
    case VK_BORDER_COLOR_INT_CUSTOM_EXT: {
      const auto* own = find_in_chain<VkSamplerCustomBorderColorCreateInfoEXT>(
          &info, VK_STRUCTURE_TYPE_SAMPLER_CUSTOM_BORDER_COLOR_CREATE_INFO_EXT);
      if (!own) throw Refusal("a sampler with a border colour of its own does not name it");
      return std::bit_cast<exec::Words>(own->customBorderColor);
    }
    case VK_BORDER_COLOR_FLOAT_OPAQUE_BLACK:
      return {0, 0, 0, kOne};
    case VK_BORDER_COLOR_INT_OPAQUE_BLACK:
      return {0, 0, 0, 1};
    case VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE:
      return {kOne, kOne, kOne, kOne};
    case VK_BORDER_COLOR_INT_OPAQUE_WHITE:
      return {1, 1, 1, 1};
    default:
      return {};
  }
}

// Gives a view its format. A view of blocks in a format without them shows each block as a texel.
void show_as(exec::ImageView& view, exec::TexelFormat format) {
  const exec::FormatInfo &stored = exec::info_of(view.format), &shown = exec::info_of(format);
  if (stored.bytes != shown.bytes)
    throw Refusal(fmt::format("{} has texels or blocks of {} bytes, and those of its view have {}", view.name,
                              stored.bytes, shown.bytes));
  if (stored.block != shown.block && (shown.block > 1 || view.levels > 1))
    throw Refusal(fmt::format("a view of {} can show its blocks as texels only of one level", view.name));
  if (stored.block != shown.block) {
    view.width = exec::blocks_of(view.width, stored.block);
    view.height = exec::blocks_of(view.height, stored.block);
  }
  view.format = format;
}

// Returns a view of slices of an image with three axes, which it shows as layers.
exec::ImageView slices_of(const Image& image, const VkImageSubresourceRange& range) {
  const uint32_t level = range.baseMipLevel, there = image.whole.extent(2, level);
  const uint32_t first = range.baseArrayLayer, rest = first < there ? there - first : 0;
  const uint32_t count = range.layerCount == VK_REMAINING_ARRAY_LAYERS ? rest : range.layerCount;
  if (level >= image.whole.levels || range.levelCount != 1 || count == 0 || count > rest)
    throw Refusal(fmt::format("slices {} to {} of one level are not in {}, whose level {} has {} slices",
                              first, first + count, image.whole.name, level, there));
  exec::ImageView view = exec::part_of(image.whole, {level, 1, 0, 1});
  view.depth = 1, view.layers = count, view.first_layer = first, view.stored_layers = there;
  return view;
}

exec::Reduction reduction_of(const VkSamplerCreateInfo& info) {
  const auto* asked = find_in_chain<VkSamplerReductionModeCreateInfo>(
      &info, VK_STRUCTURE_TYPE_SAMPLER_REDUCTION_MODE_CREATE_INFO);
  if (!asked || asked->reductionMode == VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE)
    return exec::Reduction::Mean;
  return asked->reductionMode == VK_SAMPLER_REDUCTION_MODE_MIN ? exec::Reduction::Least
                                                               : exec::Reduction::Greatest;
}

}  // namespace

VkResult CreateImageView(Device& device, const VkImageViewCreateInfo* info, VkImageView* out) {
  check_bound(*info->image);
  auto made = std::make_unique<VkImageView_T>();
  exec::ImageView& view = made->view;
  const bool shows_slices = info->image->type == VK_IMAGE_TYPE_3D && info->viewType != VK_IMAGE_VIEW_TYPE_3D;
  const auto [first, second] = planes_of(info->image, info->subresourceRange.aspectMask);
  const Image& shown = first ? *first : *second;
  view = shows_slices ? slices_of(*info->image, info->subresourceRange)
                      : exec::part_of(shown.whole, range_of(shown, info->subresourceRange));
  show_as(view, first ? texel_format_of(info->format) : shown.whole.format);
  view.shape = shape_of(info->viewType);
  if (first && second)
    made->stencil = exec::part_of(second->whole, range_of(*second, info->subresourceRange));
  const VkComponentMapping& map = info->components;
  view.swizzle = {component_of(map.r, exec::Component::Red), component_of(map.g, exec::Component::Green),
                  component_of(map.b, exec::Component::Blue), component_of(map.a, exec::Component::Alpha)};
  device.bindable.insert(made.get());
  *out = made.release();
  return VK_SUCCESS;
}
void DestroyImageView(Device& device, VkImageView view) {
  device.bindable.erase(view);
  delete view;
}

VkResult CreateBufferView(Device& device, const VkBufferViewCreateInfo* info, VkBufferView* out) {
  *out = new VkBufferView_T{info->buffer, info->offset, info->range, texel_format_of(info->format)};
  device.bindable.insert(*out);
  return VK_SUCCESS;
}
void DestroyBufferView(Device& device, VkBufferView view) {
  device.bindable.erase(view);
  delete view;
}

VkResult CreateSampler(Device& device, const VkSamplerCreateInfo* info, VkSampler* out) {
  exec::Sampler s;
  s.mag = filter_of(info->magFilter == VK_FILTER_LINEAR),
  s.min = filter_of(info->minFilter == VK_FILTER_LINEAR);
  s.mip = filter_of(info->mipmapMode == VK_SAMPLER_MIPMAP_MODE_LINEAR);
  s.wrap = {wrap_of(info->addressModeU), wrap_of(info->addressModeV), wrap_of(info->addressModeW)};
  s.border = border_of(*info), s.reduction = reduction_of(*info);
  s.lod_bias = info->mipLodBias, s.min_lod = info->minLod, s.max_lod = info->maxLod;
  s.unnormalized = info->unnormalizedCoordinates;
  static_assert(int(exec::Comparison::Always) == VK_COMPARE_OP_ALWAYS);
  if (info->anisotropyEnable)
    s.max_anisotropy = std::clamp(info->maxAnisotropy, 1.0f, float(exec::kMaxAnisotropy));
  if (info->compareEnable) s.compare = exec::Comparison(info->compareOp);
  *out = new VkSampler_T{s};
  device.bindable.insert(*out);
  return VK_SUCCESS;
}
void DestroySampler(Device& device, VkSampler sampler) {
  device.bindable.erase(sampler);
  delete sampler;
}

}  // namespace glint::vulkan

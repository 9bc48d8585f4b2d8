// Makes images and binds them to memory.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/image.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <fmt/format.h>
#include <memory>

#include "vulkan/chain.h"
#include "vulkan/device.h"
#include "vulkan/memory.h"
#include "vulkan/swapchain.h"

namespace glint::vulkan {
namespace {

// Throws Refusal when an image is empty, or larger than the device announces.
void check_size(const Device& device, const VkImageCreateInfo& info) {
  const VkPhysicalDeviceLimits& limits = device.physical.core.limits;
  const auto& [width, height, depth] = info.extent;
  const uint32_t most = info.imageType == VK_IMAGE_TYPE_1D   ? limits.maxImageDimension1D
                        : info.imageType == VK_IMAGE_TYPE_2D ? limits.maxImageDimension2D
                                                             : limits.maxImageDimension3D;
  const auto [least, longest] = std::minmax({width, height, depth});
  if (!least || longest > most)
    throw Refusal(fmt::format("an image of {} x {} x {} texels is not there: each side has 1 to {} texels",
                              width, height, depth, most));
  if (!info.arrayLayers || info.arrayLayers > limits.maxImageArrayLayers)
    throw Refusal(fmt::format("an image of {} layers is not there: there are 1 to {}", info.arrayLayers,
                              limits.maxImageArrayLayers));
  if (const auto levels = uint32_t(std::bit_width(longest)); !info.mipLevels || info.mipLevels > levels)
    throw Refusal(fmt::format("an image of {} x {} x {} texels has 1 to {} levels, and not {}", width, height,
                              depth, levels, info.mipLevels));
}

// Throws Refusal when an image with blocks is asked for what only texels that stand alone can do.
void check_blocks(const VkImageCreateInfo& info) {
  constexpr VkImageUsageFlags kPossible =
      VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  const bool is_usable = !(info.usage & ~kPossible) || (info.flags & VK_IMAGE_CREATE_EXTENDED_USAGE_BIT);
  if (info.imageType == VK_IMAGE_TYPE_1D || info.samples != VK_SAMPLE_COUNT_1_BIT || !is_usable)
    throw Refusal(
        VK_ERROR_FORMAT_NOT_SUPPORTED,
        fmt::format("images of format {} have two or three axes and one sample, and can only be copied "
                    "and sampled",
                    int(info.format)));
}

exec::ImageView whole_of(const Device& device, const VkImageCreateInfo& info) {
  exec::ImageView out;
  out.format = texel_format_of(info.format);
  check_size(device, info);
  if (info.flags & VK_IMAGE_CREATE_SPARSE_BINDING_BIT)
    throw Refusal(VK_ERROR_FEATURE_NOT_PRESENT, "sparse images are not there");
  if (exec::info_of(out.format).block > 1) check_blocks(info);
  if (!(kSamples & info.samples))
    throw Refusal(
        VK_ERROR_FEATURE_NOT_PRESENT,
        fmt::format("images of {} samples are not there, only of 1, 2, 4, 8 and 16", int(info.samples)));
  out.samples = info.samples;
  out.width = info.extent.width, out.height = info.extent.height, out.depth = info.extent.depth;
  out.levels = info.mipLevels, out.layers = info.arrayLayers * out.samples;
  return out;
}

// Choice: stencil begins at a multiple of the alignment of windows.
VkDeviceSize stencil_offset(const Image& image) {
  constexpr VkDeviceSize kStep = mem::AddressSpace::kWindowAlignment;
  return (image.whole.bytes() + kStep - 1) / kStep * kStep;
}

std::unique_ptr<Image> image_of(const Device& device, const VkImageCreateInfo& info) {
  auto out = std::make_unique<Image>();
  out->whole = whole_of(device, info), out->type = info.imageType;
  out->has_24_bits = has_depth_of_24_bits(info.format);
  if (!has_depth_and_stencil(info.format)) return out;
  VkImageCreateInfo stencil = info;
  stencil.format = VK_FORMAT_S8_UINT;
  out->stencil = image_of(device, stencil);
  return out;
}

}  // namespace

exec::Words cleared_words(exec::TexelFormat format, const VkClearDepthStencilValue& value) {
  const bool is_stencil = exec::is_integer(exec::info_of(format));
  return {is_stencil ? value.stencil : std::bit_cast<uint32_t>(value.depth), 0, 0, 0};
}

VkDeviceSize bytes_of(const Image& image) {
  return image.stencil ? stencil_offset(image) + image.stencil->whole.bytes() : image.whole.bytes();
}

std::array<Image*, 2> planes_of(VkImage image, VkImageAspectFlags aspects) {
  if (!image->stencil || !(aspects & VK_IMAGE_ASPECT_STENCIL_BIT)) return {image, nullptr};
  return {aspects & VK_IMAGE_ASPECT_DEPTH_BIT ? image : nullptr, image->stencil.get()};
}

Image* plane_of(VkImage image, VkImageAspectFlags aspect) {
  const auto [first, second] = planes_of(image, aspect);
  return first ? first : second;
}

exec::ImageRange range_of(const Image& image, const VkImageSubresourceRange& range) {
  const auto count = [](uint32_t asked, uint32_t first, uint32_t there) {
    const uint32_t rest = first < there ? there - first : 0;
    const uint32_t out = asked == VK_REMAINING_MIP_LEVELS ? rest : asked;
    if (out == 0 || out > rest)
      throw Refusal(
          fmt::format("levels or layers {} to {} are not in an image of {}", first, first + out, there));
    return out;
  };
  static_assert(VK_REMAINING_MIP_LEVELS == VK_REMAINING_ARRAY_LAYERS);
  const uint32_t samples = image.whole.samples;
  return {range.baseMipLevel, count(range.levelCount, range.baseMipLevel, image.whole.levels),
          range.baseArrayLayer * samples,
          count(range.layerCount, range.baseArrayLayer, image.whole.layers / samples) * samples};
}

void check_bound(const Image& image) {
  if (!image.whole.base) throw Refusal(fmt::format("{} is not bound to memory", image.whole.name));
}

std::byte* texel_of(const Device& device, const Image& image, const exec::TexelIndex& at) {
  check_bound(image);
  std::byte* const texel = device.memory.find(image.whole.address_of(at), image.whole.texel_bytes());
  if (!texel) throw Refusal(fmt::format("the memory of {} was freed", image.whole.name));
  return texel;
}

VkResult CreateImage(Device& device, const VkImageCreateInfo* info, VkImage* out) {
  std::unique_ptr<Image> made = image_of(device, *info);
  if (bytes_of(*made) > kMaxAllocationBytes)
    throw Refusal(VK_ERROR_OUT_OF_DEVICE_MEMORY,
                  fmt::format("an image has at most {} bytes", kMaxAllocationBytes));
  made->whole.name = fmt::format("image {}", ++device.images_made);
  if (made->stencil) made->stencil->whole.name = made->whole.name + "'s stencil";
  *out = made.release();
  return VK_SUCCESS;
}
void DestroyImage(Device& device, VkImage image) {
  if (!image) return;
  if (image->whole.base) device.memory.free(image->whole.base);
  delete image;
}

VkResult BindImageMemory(Device& device, VkImage image, VkDeviceMemory memory, VkDeviceSize offset) {
  image->whole.base = bind_window(device, image->whole.name, bytes_of(*image), memory, offset);
  if (Image* const stencil = image->stencil.get())
    stencil->whole.base = image->whole.base + stencil_offset(*image);
  return VK_SUCCESS;
}
VkResult BindImageMemory2(Device& device, uint32_t count, const VkBindImageMemoryInfo* infos) {
  for (uint32_t i = 0; i < count; ++i)
    if (const auto* of = find_in_chain<VkBindImageMemorySwapchainInfoKHR>(
            &infos[i], VK_STRUCTURE_TYPE_BIND_IMAGE_MEMORY_SWAPCHAIN_INFO_KHR);
        of && of->swapchain)
      bind_to_swapchain(device, infos[i].image, *of);
    else
      BindImageMemory(device, infos[i].image, infos[i].memory, infos[i].memoryOffset);
  return VK_SUCCESS;
}

void GetImageMemoryRequirements(Device&, VkImage image, VkMemoryRequirements* out) {
  *out = requirements_of(bytes_of(*image));
}
void GetImageMemoryRequirements2(Device&, const VkImageMemoryRequirementsInfo2* info,
                                 VkMemoryRequirements2* out) {
  answer_requirements(out, bytes_of(*info->image));
}
void GetDeviceImageMemoryRequirements(Device& device, const VkDeviceImageMemoryRequirements* info,
                                      VkMemoryRequirements2* out) {
  answer_requirements(out, bytes_of(*image_of(device, *info->pCreateInfo)));
}

// Nothing is sparse.
void GetImageSparseMemoryRequirements(Device&, VkImage, uint32_t* count, VkSparseImageMemoryRequirements*) {
  *count = 0;
}
void GetImageSparseMemoryRequirements2(Device&, const VkImageSparseMemoryRequirementsInfo2*, uint32_t* count,
                                       VkSparseImageMemoryRequirements2*) {
  *count = 0;
}
void GetDeviceImageSparseMemoryRequirements(Device&, const VkDeviceImageMemoryRequirements*, uint32_t* count,
                                            VkSparseImageMemoryRequirements2*) {
  *count = 0;
}

void GetImageSubresourceLayout(Device&, VkImage image, const VkImageSubresource* part,
                               VkSubresourceLayout* out) {
  const exec::ImageView& whole = plane_of(image, part->aspectMask)->whole;
  const uint32_t level = part->mipLevel;
  out->offset = whole.address_of({0, 0, 0, part->arrayLayer, level}) - image->whole.base;
  out->rowPitch = VkDeviceSize{whole.blocks(0, level)} * whole.texel_bytes();
  out->depthPitch = out->rowPitch * whole.blocks(1, level);
  out->arrayPitch = out->size = out->depthPitch * whole.extent(2, level);
}

}  // namespace glint::vulkan

// Says what the device does with each format.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <string_view>

#include "vulkan/announced.h"
#include "vulkan/chain.h"
#include "vulkan/image.h"
#include "vulkan/instance.h"

namespace glint::vulkan {
namespace {

constexpr VkFormatFeatureFlags2 kTransfer =
    VK_FORMAT_FEATURE_2_TRANSFER_SRC_BIT | VK_FORMAT_FEATURE_2_TRANSFER_DST_BIT;
constexpr VkFormatFeatureFlags2 kWithoutFormat = VK_FORMAT_FEATURE_2_STORAGE_READ_WITHOUT_FORMAT_BIT |
                                                 VK_FORMAT_FEATURE_2_STORAGE_WRITE_WITHOUT_FORMAT_BIT;

bool is_depth(VkFormat format) {
  return std::string_view(name_of(format)).substr(0, 11) == "VK_FORMAT_D" ||
         format == VK_FORMAT_X8_D24_UNORM_PACK32;
}

// Returns whether texels of a format come in blocks, which can be copied and sampled, and nothing else.
bool has_blocks(const std::optional<exec::TexelFormat>& format) {
  return format && exec::info_of(*format).block > 1;
}

// Returns whether shaders may store to images of a format: those that SPIR-V has names for, and that of most
// swapchains, which ray tracers store to before they copy.
bool can_store(exec::TexelFormat format) {
  const exec::FormatInfo& info = exec::info_of(format);
  if (info.numeric == exec::Numeric::Srgb) return false;
  return format <= exec::TexelFormat::Rgb10a2Uint;
}

bool can_be_atomic(exec::TexelFormat format) {
  return format == exec::TexelFormat::R32Uint || format == exec::TexelFormat::R32Sint ||
         format == exec::TexelFormat::R32Float;
}

// Returns whether texels are integers of 64 bits, which shaders store, load and change, and cannot sample.
bool has_64_bits(VkFormat format) {
  return format == VK_FORMAT_R64_UINT || format == VK_FORMAT_R64_SINT;
}

// Returns whether triangles of acceleration structures may have corners of a format.
bool can_be_vertex(VkFormat format, const std::optional<exec::TexelFormat>& texels) {
  if (format == VK_FORMAT_R32G32B32_SFLOAT) return true;
  if (!texels || is_depth(format) || has_blocks(texels)) return false;
  const exec::FormatInfo& info = exec::info_of(*texels);
  return info.channels >= 2 && info.bits >= 16 && !exec::is_integer(info);
}

// Says for what an image may be used that has these features.
VkImageUsageFlags usage_of(VkFormatFeatureFlags2 features) {
  VkImageUsageFlags out = 0;
  if (features & VK_FORMAT_FEATURE_2_TRANSFER_SRC_BIT) out |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  if (features & VK_FORMAT_FEATURE_2_TRANSFER_DST_BIT) out |= VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  if (features & VK_FORMAT_FEATURE_2_SAMPLED_IMAGE_BIT) out |= VK_IMAGE_USAGE_SAMPLED_BIT;
  if (features & VK_FORMAT_FEATURE_2_STORAGE_IMAGE_BIT) out |= VK_IMAGE_USAGE_STORAGE_BIT;
  constexpr VkImageUsageFlags kOfPasses =
      VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSIENT_ATTACHMENT_BIT;
  if (features & VK_FORMAT_FEATURE_2_COLOR_ATTACHMENT_BIT)
    out |= kOfPasses | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  if (features & VK_FORMAT_FEATURE_2_DEPTH_STENCIL_ATTACHMENT_BIT)
    out |= kOfPasses | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  return out;
}

}  // namespace

bool has_depth_and_stencil(VkFormat format) {
  return format == VK_FORMAT_D32_SFLOAT_S8_UINT || format == VK_FORMAT_D24_UNORM_S8_UINT;
}

bool has_depth_of_24_bits(VkFormat format) {
  return format == VK_FORMAT_D24_UNORM_S8_UINT || format == VK_FORMAT_X8_D24_UNORM_PACK32;
}

std::optional<exec::TexelFormat> format_of(VkFormat format) {
  if (format == VK_FORMAT_X8_D24_UNORM_PACK32) format = VK_FORMAT_D32_SFLOAT;  // VkImage_T::has_24_bits
  return exec::format_of_vulkan(name_of(format));
}

// Of depth and stencil it is the depth's: the stencil is an image of its own (VkImage_T::stencil).
exec::TexelFormat texel_format_of(VkFormat format) {
  if (has_depth_and_stencil(format)) format = VK_FORMAT_D32_SFLOAT;
  if (const auto out = format_of(format)) return *out;
  throw Refusal(VK_ERROR_FORMAT_NOT_SUPPORTED, fmt::format("format {} is not there", int(format)));
}

VkFormatFeatureFlags2 image_features_of(VkFormat format) {
  const auto texels = format_of(format);
  // Each aspect is copied, cleared and sampled on its own.
  if (has_depth_and_stencil(format))
    return kTransfer | VK_FORMAT_FEATURE_2_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_2_BLIT_SRC_BIT |
           VK_FORMAT_FEATURE_2_BLIT_DST_BIT | VK_FORMAT_FEATURE_2_SAMPLED_IMAGE_DEPTH_COMPARISON_BIT;
  if (!texels) return 0;
  VkFormatFeatureFlags2 out = kTransfer | VK_FORMAT_FEATURE_2_SAMPLED_IMAGE_BIT |
                              VK_FORMAT_FEATURE_2_BLIT_SRC_BIT | VK_FORMAT_FEATURE_2_BLIT_DST_BIT;
  if (has_64_bits(format))
    return kTransfer | VK_FORMAT_FEATURE_2_STORAGE_IMAGE_BIT | VK_FORMAT_FEATURE_2_STORAGE_IMAGE_ATOMIC_BIT |
           kWithoutFormat;
  if (has_blocks(texels))
    return (out & ~VK_FORMAT_FEATURE_2_BLIT_DST_BIT) | VK_FORMAT_FEATURE_2_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
  constexpr VkFormatFeatureFlags2 kMinMax = VK_FORMAT_FEATURE_2_SAMPLED_IMAGE_FILTER_MINMAX_BIT;
  if (is_depth(format)) return out | kMinMax | VK_FORMAT_FEATURE_2_SAMPLED_IMAGE_DEPTH_COMPARISON_BIT;
  if (format == VK_FORMAT_S8_UINT) return out;
  if (!exec::is_integer(exec::info_of(*texels)))
    out |= kMinMax | VK_FORMAT_FEATURE_2_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
  if (can_store(*texels)) out |= VK_FORMAT_FEATURE_2_STORAGE_IMAGE_BIT | kWithoutFormat;
  if (can_be_atomic(*texels)) out |= VK_FORMAT_FEATURE_2_STORAGE_IMAGE_ATOMIC_BIT;
  return out;
}

VkFormatFeatureFlags2 buffer_features_of(VkFormat format) {
  const auto texels = format_of(format);
  const VkFormatFeatureFlags2 vertex =
      can_be_vertex(format, texels) ? VK_FORMAT_FEATURE_2_ACCELERATION_STRUCTURE_VERTEX_BUFFER_BIT_KHR : 0;
  if (!texels || is_depth(format) || format == VK_FORMAT_S8_UINT || has_blocks(texels)) return vertex;
  VkFormatFeatureFlags2 out = vertex | VK_FORMAT_FEATURE_2_UNIFORM_TEXEL_BUFFER_BIT;
  if (can_store(*texels)) out |= VK_FORMAT_FEATURE_2_STORAGE_TEXEL_BUFFER_BIT | kWithoutFormat;
  if (can_be_atomic(*texels)) out |= VK_FORMAT_FEATURE_2_STORAGE_TEXEL_BUFFER_ATOMIC_BIT;
  return out;
}

// Returns as which attachments images with a format could serve. Vulkan asks for these formats of every
// device, and runners of tests ask for them before they compute, but no queue of the device draws. A
// universal queue has to have formats of both depth and stencil: Dawn ends the process where there is none.
VkFormatFeatureFlags2 attachment_features_of(const PhysicalDevice& device, VkFormat format) {
  if (has_depth_and_stencil(format))
    return device.instance.settings.is_universal ? VK_FORMAT_FEATURE_2_DEPTH_STENCIL_ATTACHMENT_BIT : 0;
  const auto texels = format_of(format);
  if (!texels || has_blocks(texels)) return 0;
  if (is_depth(format) || format == VK_FORMAT_S8_UINT)
    return VK_FORMAT_FEATURE_2_DEPTH_STENCIL_ATTACHMENT_BIT;
  return VK_FORMAT_FEATURE_2_COLOR_ATTACHMENT_BIT |
         (exec::is_integer(exec::info_of(*texels)) ? 0 : VK_FORMAT_FEATURE_2_COLOR_ATTACHMENT_BLEND_BIT);
}

// Returns what buffers with a format could hold for graphics. Programs that make graphics pipelines ask for
// it.
VkFormatFeatureFlags2 graphics_features_of(const PhysicalDevice& device, VkFormat format) {
  const bool is_triple = format >= VK_FORMAT_R32G32B32_UINT && format <= VK_FORMAT_R32G32B32_SFLOAT;
  const auto texels = format_of(format);
  const bool has_colour = texels && !has_blocks(texels) && !is_depth(format) && format != VK_FORMAT_S8_UINT &&
                          exec::info_of(*texels).numeric != exec::Numeric::Srgb;
  const bool is_vertex = device.instance.settings.is_universal && (is_triple || has_colour);
  return is_vertex ? VK_FORMAT_FEATURE_2_VERTEX_BUFFER_BIT : 0;
}

void GetPhysicalDeviceFormatProperties(PhysicalDevice& device, VkFormat format, VkFormatProperties* out) {
  // The flags of the older structure are the lower half.
  out->linearTilingFeatures = VkFormatFeatureFlags(image_features_of(format) & ~kWithoutFormat);
  out->optimalTilingFeatures =
      out->linearTilingFeatures | VkFormatFeatureFlags(attachment_features_of(device, format));
  out->bufferFeatures = VkFormatFeatureFlags(buffer_features_of(format) & ~kWithoutFormat) |
                        VkFormatFeatureFlags(graphics_features_of(device, format));
}

void GetPhysicalDeviceFormatProperties2(PhysicalDevice& device, VkFormat format, VkFormatProperties2* out) {
  GetPhysicalDeviceFormatProperties(device, format, &out->formatProperties);
  if (auto* more = find_in_output<VkFormatProperties3>(out, VK_STRUCTURE_TYPE_FORMAT_PROPERTIES_3)) {
    more->linearTilingFeatures = image_features_of(format);
    more->optimalTilingFeatures = more->linearTilingFeatures | attachment_features_of(device, format);
    more->bufferFeatures = buffer_features_of(format) | graphics_features_of(device, format);
  }
}

VkResult GetPhysicalDeviceImageFormatProperties(PhysicalDevice& device, VkFormat format, VkImageType type,
                                                VkImageTiling tiling, VkImageUsageFlags usage,
                                                VkImageCreateFlags flags, VkImageFormatProperties* out) {
  *out = {};
  constexpr VkImageCreateFlags kKnownFlags =
      VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT | VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT |
      VK_IMAGE_CREATE_EXTENDED_USAGE_BIT | VK_IMAGE_CREATE_ALIAS_BIT |
      VK_IMAGE_CREATE_BLOCK_TEXEL_VIEW_COMPATIBLE_BIT | VK_IMAGE_CREATE_2D_ARRAY_COMPATIBLE_BIT |
      VK_IMAGE_CREATE_2D_VIEW_COMPATIBLE_BIT_EXT;
  const bool is_tiled = tiling == VK_IMAGE_TILING_OPTIMAL || tiling == VK_IMAGE_TILING_LINEAR;
  VkFormatFeatureFlags2 features = image_features_of(format);
  if (tiling == VK_IMAGE_TILING_OPTIMAL) features |= attachment_features_of(device, format);
  const VkImageUsageFlags possible = usage_of(features);
  const bool is_usable = features && (!(usage & ~possible) || (flags & VK_IMAGE_CREATE_EXTENDED_USAGE_BIT));
  const bool fits = !has_blocks(format_of(format)) || type != VK_IMAGE_TYPE_1D;
  if (!is_tiled || !is_usable || !fits || (flags & ~kKnownFlags)) return VK_ERROR_FORMAT_NOT_SUPPORTED;
  const VkPhysicalDeviceLimits& limits = device.core.limits;
  const uint32_t width = type == VK_IMAGE_TYPE_1D   ? limits.maxImageDimension1D
                         : type == VK_IMAGE_TYPE_2D ? limits.maxImageDimension2D
                                                    : limits.maxImageDimension3D;
  out->maxExtent = {width, type == VK_IMAGE_TYPE_1D ? 1 : width, type == VK_IMAGE_TYPE_3D ? width : 1};
  out->maxMipLevels = uint32_t(std::bit_width(width));
  out->maxArrayLayers = type == VK_IMAGE_TYPE_3D ? 1 : limits.maxImageArrayLayers;
  const bool has_samples = type == VK_IMAGE_TYPE_2D && tiling == VK_IMAGE_TILING_OPTIMAL &&
                           !(flags & VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT) &&
                           attachment_features_of(device, format);
  out->sampleCounts = has_samples ? kSamples : VkSampleCountFlags{VK_SAMPLE_COUNT_1_BIT};
  out->maxResourceSize = kMaxAllocationBytes;
  return VK_SUCCESS;
}

VkResult GetPhysicalDeviceImageFormatProperties2(PhysicalDevice& device,
                                                 const VkPhysicalDeviceImageFormatInfo2* info,
                                                 VkImageFormatProperties2* out) {
  // Images cannot be shared with other processes.
  if (const auto* external = find_in_chain<VkPhysicalDeviceExternalImageFormatInfo>(
          info, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_IMAGE_FORMAT_INFO);
      external && external->handleType)
    return VK_ERROR_FORMAT_NOT_SUPPORTED;
  return GetPhysicalDeviceImageFormatProperties(device, info->format, info->type, info->tiling, info->usage,
                                                info->flags, &out->imageFormatProperties);
}

}  // namespace glint::vulkan

// Finds formats of texels by Vulkan's names.
// SPDX-License-Identifier: Apache-2.0
#include <cctype>
#include <string>
#include <utility>

#include "exec/texture_format.h"

namespace glint::exec {
namespace {

using F = TexelFormat;

// Holds names that Vulkan gives to the bits of a format with another name, or that follow no rule.
constexpr std::pair<std::string_view, F> kOwnNames[] = {
    {"A8B8G8R8_UNORM_PACK32", F::Rgba8Unorm},
    {"A8B8G8R8_SNORM_PACK32", F::Rgba8Snorm},
    {"A8B8G8R8_UINT_PACK32", F::Rgba8Uint},
    {"A8B8G8R8_SINT_PACK32", F::Rgba8Sint},
    {"A8B8G8R8_SRGB_PACK32", F::Rgba8Srgb},
    {"A2B10G10R10_UNORM_PACK32", F::Rgb10a2Unorm},
    {"A2B10G10R10_UINT_PACK32", F::Rgb10a2Uint},
    {"A2R10G10B10_UNORM_PACK32", F::Bgr10a2Unorm},
    {"A2R10G10B10_UINT_PACK32", F::Bgr10a2Uint},
    {"B10G11R11_UFLOAT_PACK32", F::R11g11b10Float},
    {"E5B9G9R9_UFLOAT_PACK32", F::Rgb9e5Float},
    {"D16_UNORM", F::R16Unorm},
    {"D32_SFLOAT", F::R32Float},
    {"S8_UINT", F::R8Uint},
    // A texel of 64 bits is stored as two channels of 32 bits.
    {"R64_UINT", F::Rg32Uint},
    {"R64_SINT", F::Rg32Uint},
};

// Returns Vulkan's name of a format whose channels have one size: rgba8_unorm is R8G8B8A8_UNORM. Names of
// packed formats are Vulkan's in small letters.
std::string vulkan_name(const FormatInfo& info) {
  std::string out;
  const auto append = [&](std::string_view text) {
    for (const char c : text) out += char(std::toupper(static_cast<unsigned char>(c)));
  };
  if (info.bits == 0) return append(info.name), out;
  for (size_t i = 0; i < info.channels; ++i) append(info.name.substr(i, 1)), out += std::to_string(info.bits);
  if (info.numeric == Numeric::Float) return out + "_SFLOAT";
  append(info.name.substr(info.name.find('_')));
  return out;
}

}  // namespace

std::optional<TexelFormat> format_of_vulkan(std::string_view name) {
  constexpr std::string_view kPrefix = "VK_FORMAT_";
  if (name.substr(0, kPrefix.size()) == kPrefix) name.remove_prefix(kPrefix.size());
  for (const auto& [own, format] : kOwnNames)
    if (name == own) return format;
  for (size_t i = 0; i < size_t(F::Count); ++i)
    if (name == vulkan_name(info_of(F(i)))) return F(i);
  return {};
}

}  // namespace glint::exec

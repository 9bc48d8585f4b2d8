// Knows formats of texels: what their bits mean, and how to convert to and from the words of a register.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace glint::exec {

inline float float_of(uint32_t bits) {
  return std::bit_cast<float>(bits);
}

// Names formats by Vulkan's channels and bits, in the order of the table in texture_format.cpp.
enum class TexelFormat : uint8_t {
  R8Unorm,
  R8Snorm,
  R8Uint,
  R8Sint,
  Rg8Unorm,
  Rg8Snorm,
  Rg8Uint,
  Rg8Sint,
  Rgba8Unorm,
  Rgba8Snorm,
  Rgba8Uint,
  Rgba8Sint,
  Rgba8Srgb,
  Bgra8Unorm,
  Bgra8Srgb,
  R16Unorm,
  R16Snorm,
  R16Uint,
  R16Sint,
  R16Float,
  Rg16Unorm,
  Rg16Snorm,
  Rg16Uint,
  Rg16Sint,
  Rg16Float,
  Rgba16Unorm,
  Rgba16Snorm,
  Rgba16Uint,
  Rgba16Sint,
  Rgba16Float,
  R32Uint,
  R32Sint,
  R32Float,
  Rg32Uint,
  Rg32Sint,
  Rg32Float,
  Rgba32Uint,
  Rgba32Sint,
  Rgba32Float,
  R11g11b10Float,
  Rgb10a2Unorm,
  Rgb10a2Uint,
  Rgb9e5Float,
  // Vulkan's packed formats of less than 8 bits a channel have Vulkan's names, the highest bits first.
  R4g4Pack8,
  R4g4b4a4Pack16,
  B4g4r4a4Pack16,
  A4r4g4b4Pack16,
  A4b4g4r4Pack16,
  R5g6b5Pack16,
  B5g6r5Pack16,
  R5g5b5a1Pack16,
  B5g5r5a1Pack16,
  A1r5g5b5Pack16,
  Bgr10a2Unorm,
  Bgr10a2Uint,
  // Formats with blocks of 4 x 4 texels are read only. They have Vulkan's names.
  Bc1RgbUnorm,
  Bc1RgbSrgb,
  Bc1RgbaUnorm,
  Bc1RgbaSrgb,
  Bc2Unorm,
  Bc2Srgb,
  Bc3Unorm,
  Bc3Srgb,
  Bc4Unorm,
  Bc4Snorm,
  Bc5Unorm,
  Bc5Snorm,
  Bc6hUfloat,
  Bc6hSfloat,
  Bc7Unorm,
  Bc7Srgb,
  Count
};
// The formats before this one have texels that stand alone, and can be written.
inline constexpr TexelFormat kFirstBlockFormat = TexelFormat::Bc1RgbUnorm;

enum class Numeric : uint8_t { Unorm, Snorm, Uint, Sint, Float, Srgb };

struct FormatInfo {
  std::string_view name;  // such as "rgba8_unorm"
  uint8_t bytes;          // bytes of a texel or a block: 1, 2, 4, 8 or 16
  uint8_t channels;
  uint8_t bits;  // bits of a channel; 0: the channels differ
  Numeric numeric;
  uint16_t opencl_type;  // cl.h: CL_UNORM_INT8 and so on, which PTX's queries answer; 0: there is none
  uint16_t opencl_order;
  uint8_t block = 1;  // texels along each side of a block; 1: texels stand alone
};
const FormatInfo& info_of(TexelFormat format);
// Returns how many blocks, of so many texels a side, it takes for a number of texels.
constexpr uint32_t blocks_of(uint32_t texels, uint32_t block) {
  return block == 1 ? texels : (texels + block - 1) / block;
}
// Returns the format of a name as Vulkan has it, with or without VK_FORMAT_ before it. Formats with the same
// bits are one: A8B8G8R8_UNORM_PACK32 is R8G8B8A8_UNORM, and D16_UNORM is R16_UNORM.
std::optional<TexelFormat> format_of_vulkan(std::string_view name);
inline bool is_integer(const FormatInfo& info) {
  return info.numeric == Numeric::Uint || info.numeric == Numeric::Sint;
}
// Returns whether texels lie between 0 and 1, or -1 and 1.
inline bool is_normalized(const FormatInfo& info) {
  return !is_integer(info) && info.numeric != Numeric::Float;
}

// Holds red, green, blue and alpha. They are the bits of floats, or integers when the format has integers.
using Words = std::array<uint32_t, 4>;

// Returns the words of a texel that stands alone. Channels that a format lacks are 0, and alpha is 1 (Vulkan,
// "Conversion to RGBA").
Words decode(TexelFormat format, const std::byte* from);
// Returns the words of the texel (x, y) of an image. The texel, or the block that holds it, begins at `from`.
Words decode_at(TexelFormat format, const std::byte* from, uint32_t x, uint32_t y);
// Returns `words` without the channels that the format lacks, which is what a border colour becomes. Zeros
// become what a robust load outside of an image gives.
Words keep_channels(TexelFormat format, Words words);

// Writes a texel that stands alone. Floats are clamped to the range of normalised formats and rounded to
// nearest even, and NaN becomes 0 there. Choice: integers out of range are clamped, as Direct3D does; Vulkan
// leaves them undefined.
void encode(TexelFormat format, const Words& words, std::byte* to);

// Converts a value of a format with sRGB by "sRGB EOTF" of the Khronos Data Format specification 1.3.
double linear_of_srgb(double x);
// Convert floats of 16 bits.
float from_half(uint16_t bits);
uint16_t to_half(float value);

}  // namespace glint::exec

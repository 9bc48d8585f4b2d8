// Converts texels, after the Vulkan specification's chapters "Fixed-Point Data Conversions" and "Numbers".
// SPDX-License-Identifier: Apache-2.0
#include "exec/texture_format.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/check.h"
#include "exec/block_formats.h"

namespace glint::exec {
namespace {

using F = TexelFormat;
using enum Numeric;

// These are the channel orders of cl.h.
constexpr uint16_t kR = 0x10b0, kRg = 0x10b2, kRgb = 0x10b4, kRgba = 0x10b5, kBgra = 0x10b6, kSrgba = 0x10c1,
                   kSbgra = 0x10c2;

constexpr FormatInfo kFormats[] = {
    {"r8_unorm", 1, 1, 8, Unorm, 0x10d2, kR},
    {"r8_snorm", 1, 1, 8, Snorm, 0x10d0, kR},
    {"r8_uint", 1, 1, 8, Uint, 0x10da, kR},
    {"r8_sint", 1, 1, 8, Sint, 0x10d7, kR},
    {"rg8_unorm", 2, 2, 8, Unorm, 0x10d2, kRg},
    {"rg8_snorm", 2, 2, 8, Snorm, 0x10d0, kRg},
    {"rg8_uint", 2, 2, 8, Uint, 0x10da, kRg},
    {"rg8_sint", 2, 2, 8, Sint, 0x10d7, kRg},
    {"rgba8_unorm", 4, 4, 8, Unorm, 0x10d2, kRgba},
    {"rgba8_snorm", 4, 4, 8, Snorm, 0x10d0, kRgba},
    {"rgba8_uint", 4, 4, 8, Uint, 0x10da, kRgba},
    {"rgba8_sint", 4, 4, 8, Sint, 0x10d7, kRgba},
    {"rgba8_srgb", 4, 4, 8, Srgb, 0x10d2, kSrgba},
    {"bgra8_unorm", 4, 4, 8, Unorm, 0x10d2, kBgra},
    {"bgra8_srgb", 4, 4, 8, Srgb, 0x10d2, kSbgra},
    {"r16_unorm", 2, 1, 16, Unorm, 0x10d3, kR},
    {"r16_snorm", 2, 1, 16, Snorm, 0x10d1, kR},
    {"r16_uint", 2, 1, 16, Uint, 0x10db, kR},
    {"r16_sint", 2, 1, 16, Sint, 0x10d8, kR},
    {"r16_float", 2, 1, 16, Float, 0x10dd, kR},
    {"rg16_unorm", 4, 2, 16, Unorm, 0x10d3, kRg},
    {"rg16_snorm", 4, 2, 16, Snorm, 0x10d1, kRg},
    {"rg16_uint", 4, 2, 16, Uint, 0x10db, kRg},
    {"rg16_sint", 4, 2, 16, Sint, 0x10d8, kRg},
    {"rg16_float", 4, 2, 16, Float, 0x10dd, kRg},
    {"rgba16_unorm", 8, 4, 16, Unorm, 0x10d3, kRgba},
    {"rgba16_snorm", 8, 4, 16, Snorm, 0x10d1, kRgba},
    {"rgba16_uint", 8, 4, 16, Uint, 0x10db, kRgba},
    {"rgba16_sint", 8, 4, 16, Sint, 0x10d8, kRgba},
    {"rgba16_float", 8, 4, 16, Float, 0x10dd, kRgba},
    {"r32_uint", 4, 1, 32, Uint, 0x10dc, kR},
    {"r32_sint", 4, 1, 32, Sint, 0x10d9, kR},
    {"r32_float", 4, 1, 32, Float, 0x10de, kR},
    {"rg32_uint", 8, 2, 32, Uint, 0x10dc, kRg},
    {"rg32_sint", 8, 2, 32, Sint, 0x10d9, kRg},
    {"rg32_float", 8, 2, 32, Float, 0x10de, kRg},
    {"rgba32_uint", 16, 4, 32, Uint, 0x10dc, kRgba},
    {"rgba32_sint", 16, 4, 32, Sint, 0x10d9, kRgba},
    {"rgba32_float", 16, 4, 32, Float, 0x10de, kRgba},
    {"r11g11b10_float", 4, 3, 0, Float, 0, kRgb},
    {"rgb10a2_unorm", 4, 4, 0, Unorm, 0x10e0, kRgba},
    {"rgb10a2_uint", 4, 4, 0, Uint, 0, kRgba},
    {"rgb9e5_float", 4, 3, 0, Float, 0, kRgb},
    {"r4g4_unorm_pack8", 1, 2, 0, Unorm, 0, kRg},
    {"r4g4b4a4_unorm_pack16", 2, 4, 0, Unorm, 0, kRgba},
    {"b4g4r4a4_unorm_pack16", 2, 4, 0, Unorm, 0, kRgba},
    {"a4r4g4b4_unorm_pack16", 2, 4, 0, Unorm, 0, kRgba},
    {"a4b4g4r4_unorm_pack16", 2, 4, 0, Unorm, 0, kRgba},
    {"r5g6b5_unorm_pack16", 2, 3, 0, Unorm, 0x10d4, kRgb},
    {"b5g6r5_unorm_pack16", 2, 3, 0, Unorm, 0, kRgb},
    {"r5g5b5a1_unorm_pack16", 2, 4, 0, Unorm, 0, kRgba},
    {"b5g5r5a1_unorm_pack16", 2, 4, 0, Unorm, 0, kRgba},
    {"a1r5g5b5_unorm_pack16", 2, 4, 0, Unorm, 0, kRgba},
    {"bgr10a2_unorm", 4, 4, 0, Unorm, 0, kBgra},
    {"bgr10a2_uint", 4, 4, 0, Uint, 0, kBgra},
    {"bc1_rgb_unorm_block", 8, 3, 0, Unorm, 0, kRgb, 4},
    {"bc1_rgb_srgb_block", 8, 3, 0, Srgb, 0, kRgb, 4},
    {"bc1_rgba_unorm_block", 8, 4, 0, Unorm, 0, kRgba, 4},
    {"bc1_rgba_srgb_block", 8, 4, 0, Srgb, 0, kRgba, 4},
    {"bc2_unorm_block", 16, 4, 0, Unorm, 0, kRgba, 4},
    {"bc2_srgb_block", 16, 4, 0, Srgb, 0, kRgba, 4},
    {"bc3_unorm_block", 16, 4, 0, Unorm, 0, kRgba, 4},
    {"bc3_srgb_block", 16, 4, 0, Srgb, 0, kRgba, 4},
    {"bc4_unorm_block", 8, 1, 0, Unorm, 0, kR, 4},
    {"bc4_snorm_block", 8, 1, 0, Snorm, 0, kR, 4},
    {"bc5_unorm_block", 16, 2, 0, Unorm, 0, kRg, 4},
    {"bc5_snorm_block", 16, 2, 0, Snorm, 0, kRg, 4},
    {"bc6h_ufloat_block", 16, 3, 0, Float, 0, kRgb, 4},
    {"bc6h_sfloat_block", 16, 3, 0, Float, 0, kRgb, 4},
    {"bc7_unorm_block", 16, 4, 0, Unorm, 0, kRgba, 4},
    {"bc7_srgb_block", 16, 4, 0, Srgb, 0, kRgba, 4},
};
static_assert(std::size(kFormats) == size_t(F::Count));

uint32_t bits_of(float x) {
  return std::bit_cast<uint32_t>(x);
}
// These floats have 5 exponent bits, bias 15, and no sign: halves, and the channels of 11 and 10 bits.
constexpr int kBias = 15;
float from_small(uint32_t bits, int mantissa_bits) {
  const uint32_t mantissa = bits & ((1u << mantissa_bits) - 1);
  const int exponent = int(bits >> mantissa_bits);
  if (exponent == 31) return mantissa ? float_of(0x7fff'ffff) : float_of(0x7f80'0000);
  if (exponent == 0) return std::ldexp(float(mantissa), 1 - kBias - mantissa_bits);
  return std::ldexp(float(mantissa | 1u << mantissa_bits), exponent - kBias - mantissa_bits);
}

// Rounds to nearest even. A magnitude that is too large becomes `largest`. `magnitude` is not NaN.
uint32_t to_small(float magnitude, int mantissa_bits, uint32_t largest) {
  if (magnitude >= 65536.0f) return std::isinf(magnitude) ? 31u << mantissa_bits : largest;
  const int exponent = std::max(magnitude == 0.0f ? -126 : std::ilogb(magnitude), 1 - kBias);
  // `units` counts units of the last place. A carry out of the mantissa increases the exponent by itself.
  const auto units = uint32_t(std::nearbyint(std::ldexp(double(magnitude), mantissa_bits - exponent)));
  const uint32_t bits = units + (uint32_t(exponent + kBias - 1) << mantissa_bits);
  return bits >= 31u << mantissa_bits ? largest : bits;
}

// Converts to unsigned floats: negative numbers become 0, large ones the largest finite one, and NaN stays.
uint32_t to_unsigned_small(float x, int mantissa_bits) {
  if (std::isnan(x)) return (32u << mantissa_bits) - 1;
  return x > 0.0f ? to_small(x, mantissa_bits, (31u << mantissa_bits) - 1) : 0;
}

// By Vulkan's "RGB to Shared Exponent Conversion", there are 9 bits per channel and 5 of exponent.
constexpr int kSharedBits = 9;
uint32_t to_shared_exponent(const Words& words) {
  constexpr double kLargest = 65408.0;  // (2^9 - 1) / 2^9 * 2^16
  std::array<double, 3> c;
  for (size_t i = 0; i < 3; ++i)
    c[i] = float_of(words[i]) > 0.0f ? std::min(double(float_of(words[i])), kLargest) : 0.0;
  const double highest = std::max({c[0], c[1], c[2]});
  int exponent = std::max(highest > 0.0 ? std::ilogb(highest) : -16, -kBias - 1) + 1 + kBias;
  const auto scaled = [&](double x) {
    return uint32_t(std::floor(std::ldexp(x, kBias + kSharedBits - exponent) + 0.5));
  };
  if (scaled(highest) == 1u << kSharedBits) ++exponent;
  return scaled(c[0]) | scaled(c[1]) << 9 | scaled(c[2]) << 18 | uint32_t(exponent) << 27;
}

float from_srgb(uint8_t byte) {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> out;
    for (size_t i = 0; i < 256; ++i) out[i] = float(linear_of_srgb(double(i) / 255.0));
    return out;
  }();
  return table[byte];
}
// This is the inverse of linear_of_srgb().
double to_srgb(double x) {
  return x <= 0.0031308 ? x * 12.92 : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
}

uint32_t decode_channel(uint32_t bits, int width, Numeric numeric, bool is_alpha) {
  const auto as_signed = int32_t(bits << (32 - width)) >> (32 - width);
  const uint32_t highest = width == 32 ? ~0u : (1u << width) - 1;
  switch (numeric) {
    case Uint:
      return bits;
    case Sint:
      return uint32_t(as_signed);
    case Float:
      return width == 32 ? bits : bits_of(from_half(uint16_t(bits)));
    case Unorm:
      return bits_of(float(bits) / float(highest));
    case Snorm:
      return bits_of(std::max(float(as_signed) / float(highest >> 1), -1.0f));
    case Srgb:
      return bits_of(is_alpha ? float(bits) / 255.0f : from_srgb(uint8_t(bits)));
  }
  return 0;
}

// Computes in doubles: the product of a float and the highest integer is exact, so only one rounding takes
// place.
uint32_t to_unorm(float x, int width, bool srgb = false) {
  double clamped = x > 0.0f ? std::min(double(x), 1.0) : 0.0;
  if (srgb) clamped = to_srgb(clamped);
  return uint32_t(std::nearbyint(clamped * double((1u << width) - 1)));
}

uint32_t encode_channel(uint32_t word, int width, Numeric numeric, bool is_alpha) {
  if (width == 32) return word;
  const float x = float_of(word);
  const int32_t highest = int32_t(1u << (width - 1)) - 1;
  switch (numeric) {
    case Uint:
      return std::min(word, (1u << width) - 1);
    case Sint:
      return uint32_t(std::clamp(int32_t(word), -highest - 1, highest));
    case Float:
      return to_half(x);
    case Unorm:
      return to_unorm(x, width);
    case Srgb:
      return to_unorm(x, width, !is_alpha);
    case Snorm: {
      const double clamped = std::isnan(x) ? 0.0 : std::clamp(double(x), -1.0, 1.0);
      return uint32_t(int32_t(std::nearbyint(clamped * double(highest))));
    }
  }
  return 0;
}

// Says where the channels of a packed format of integers lie: the lowest bit of red, green, blue and alpha,
// and their widths.
struct PackedChannels {
  F format;
  struct Field {
    uint8_t at = 0, width = 0;
  };
  std::array<Field, 4> field;
};
constexpr PackedChannels kPacked[] = {
    {F::Rgb10a2Unorm, {{{0, 10}, {10, 10}, {20, 10}, {30, 2}}}},
    {F::Rgb10a2Uint, {{{0, 10}, {10, 10}, {20, 10}, {30, 2}}}},
    {F::Bgr10a2Unorm, {{{20, 10}, {10, 10}, {0, 10}, {30, 2}}}},
    {F::Bgr10a2Uint, {{{20, 10}, {10, 10}, {0, 10}, {30, 2}}}},
    {F::R4g4Pack8, {{{4, 4}, {0, 4}, {}, {}}}},
    {F::R4g4b4a4Pack16, {{{12, 4}, {8, 4}, {4, 4}, {0, 4}}}},
    {F::B4g4r4a4Pack16, {{{4, 4}, {8, 4}, {12, 4}, {0, 4}}}},
    {F::A4r4g4b4Pack16, {{{8, 4}, {4, 4}, {0, 4}, {12, 4}}}},
    {F::A4b4g4r4Pack16, {{{0, 4}, {4, 4}, {8, 4}, {12, 4}}}},
    {F::R5g6b5Pack16, {{{11, 5}, {5, 6}, {0, 5}, {}}}},
    {F::B5g6r5Pack16, {{{0, 5}, {5, 6}, {11, 5}, {}}}},
    {F::R5g5b5a1Pack16, {{{11, 5}, {6, 5}, {1, 5}, {0, 1}}}},
    {F::B5g5r5a1Pack16, {{{1, 5}, {6, 5}, {11, 5}, {0, 1}}}},
    {F::A1r5g5b5Pack16, {{{10, 5}, {5, 5}, {0, 5}, {15, 1}}}},
};
const PackedChannels& packed_channels(F format) {
  const auto* const found =
      std::find_if(std::begin(kPacked), std::end(kPacked), [&](const auto& p) { return p.format == format; });
  if (found == std::end(kPacked)) GLINT_PANIC("format {} is not packed", info_of(format).name);
  return *found;
}

// Decodes formats whose channels differ in size or have less than 8 bits.
Words decode_packed(F format, uint32_t bits) {
  const auto field = [&](int at, int width) { return bits >> at & ((1u << width) - 1); };
  switch (format) {
    case F::R11g11b10Float:
      return {bits_of(from_small(field(0, 11), 6)), bits_of(from_small(field(11, 11), 6)),
              bits_of(from_small(field(22, 10), 5)), bits_of(1.0f)};
    case F::Rgb9e5Float: {
      Words words{0, 0, 0, bits_of(1.0f)};
      for (int i = 0; i < 3; ++i)
        words[size_t(i)] =
            bits_of(std::ldexp(float(field(9 * i, 9)), int(field(27, 5)) - kBias - kSharedBits));
      return words;
    }
    default: {
      const PackedChannels& packed = packed_channels(format);
      Words words{};
      for (size_t i = 0; i < 4; ++i)
        if (const auto& f = packed.field[i]; f.width)
          words[i] = decode_channel(field(f.at, f.width), f.width, info_of(format).numeric, i == 3);
      return keep_channels(format, words);
    }
  }
}

uint32_t encode_packed(F format, const Words& w) {
  switch (format) {
    case F::R11g11b10Float:
      return to_unsigned_small(float_of(w[0]), 6) | to_unsigned_small(float_of(w[1]), 6) << 11 |
             to_unsigned_small(float_of(w[2]), 5) << 22;
    case F::Rgb9e5Float:
      return to_shared_exponent(w);
    default: {
      const PackedChannels& packed = packed_channels(format);
      uint32_t bits = 0;
      for (size_t i = 0; i < 4; ++i)
        if (const auto& f = packed.field[i]; f.width)
          bits |= encode_channel(w[i], f.width, info_of(format).numeric, i == 3) << f.at;
      return bits;
    }
  }
}

bool is_bgra(F format) {
  return format == F::Bgra8Unorm || format == F::Bgra8Srgb;
}

}  // namespace

const FormatInfo& info_of(TexelFormat format) {
  return kFormats[size_t(format)];
}

double linear_of_srgb(double x) {
  return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

float from_half(uint16_t bits) {
  const float magnitude = from_small(bits & 0x7fffu, 10);
  return bits & 0x8000u ? -magnitude : magnitude;
}

uint16_t to_half(float value) {
  const uint32_t sign = bits_of(value) >> 16 & 0x8000u;
  if (std::isnan(value)) return uint16_t(sign | 0x7fffu);
  return uint16_t(sign | to_small(std::fabs(value), 10, 0x7c00u));
}

Words decode(TexelFormat format, const std::byte* from) {
  Words four;
  // The two formats of most textures come first, because they need no loop over bits.
  if (format == F::Rgba32Float) {
    std::memcpy(four.data(), from, sizeof four);
    return four;
  }
  if (format == F::Rgba8Unorm) {
    for (size_t i = 0; i < 4; ++i) four[i] = bits_of(float(std::to_integer<int>(from[i])) / 255.0f);
    return four;
  }
  const FormatInfo& info = info_of(format);
  if (info.bits == 0) {
    uint32_t bits = 0;
    std::memcpy(&bits, from, info.bytes);
    return decode_packed(format, bits);
  }
  Words words{0, 0, 0, is_integer(info) ? 1 : bits_of(1.0f)};
  for (size_t i = 0; i < info.channels; ++i) {
    uint32_t bits = 0;
    std::memcpy(&bits, from + i * info.bits / 8, info.bits / 8);
    words[i] = decode_channel(bits, info.bits, info.numeric, i == 3);
  }
  if (is_bgra(format)) std::swap(words[0], words[2]);
  return words;
}

Words decode_at(TexelFormat format, const std::byte* from, uint32_t x, uint32_t y) {
  return format < kFirstBlockFormat ? decode(format, from) : decode_block(format, from, y % 4 * 4 + x % 4);
}

Words keep_channels(TexelFormat format, Words words) {
  const FormatInfo& info = info_of(format);
  for (size_t i = info.channels; i < 3; ++i) words[i] = 0;
  if (info.channels < 4) words[3] = is_integer(info) ? 1 : bits_of(1.0f);
  return words;
}

void encode(TexelFormat format, const Words& words, std::byte* to) {
  if (format == F::Rgba32Float) {
    std::memcpy(to, words.data(), sizeof words);
    return;
  }
  const FormatInfo& info = info_of(format);
  if (info.bits == 0) {
    const uint32_t bits = encode_packed(format, words);
    std::memcpy(to, &bits, info.bytes);
    return;
  }
  for (size_t i = 0; i < info.channels; ++i) {
    const size_t channel = is_bgra(format) && i < 3 ? 2 - i : i;
    const uint32_t bits = encode_channel(words[channel], info.bits, info.numeric, channel == 3);
    std::memcpy(to + i * info.bits / 8, &bits, info.bits / 8);
  }
}

}  // namespace glint::exec

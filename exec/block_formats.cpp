// Decodes the blocks of BC1 to BC5, and sends those of BC6H and BC7 to their decoders.
// SPDX-License-Identifier: Apache-2.0
#include "exec/block_formats.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/check.h"

namespace glint::exec {
namespace {

using F = TexelFormat;

uint32_t bits_of(double x) {
  return std::bit_cast<uint32_t>(float(x));
}

uint64_t load(const std::byte* from) {
  uint64_t out;
  std::memcpy(&out, from, sizeof out);
  return out;
}

// An interpolated channel of a colour is a whole number of sixths of the steps of its 5 or 6 bits.
constexpr uint32_t kParts = 6;
template <uint32_t Highest>
uint32_t colour_word(uint32_t parts, bool is_srgb) {
  if (!is_srgb) return bits_of(double(parts) / (kParts * Highest));
  static const auto linear = [] {
    std::array<float, kParts * Highest + 1> out;
    for (size_t i = 0; i < out.size(); ++i) out[i] = float(linear_of_srgb(double(i) / (kParts * Highest)));
    return out;
  }();
  return std::bit_cast<uint32_t>(linear[parts]);
}

// Says what the colours of a block may be.
enum class Palette : bool {
  FourColours,    // as BC2 and BC3 have them
  ByOrderOfEnds,  // as BC1 has them: three colours and black, unless the first end is the greater number
};

// Returns a texel's colour, with alpha 0 where a block of BC1 has black in place of a colour.
Words colour(const std::byte* block, uint32_t texel, Palette palette, bool is_srgb) {
  constexpr uint32_t kThirds[] = {0, 6, 2, 4}, kHalves[] = {0, 6, 3};  // parts of the second end
  const uint64_t bits = load(block);
  const uint32_t ends[] = {uint32_t(bits & 0xffff), uint32_t(bits >> 16 & 0xffff)};
  const auto code = size_t(bits >> (32 + 2 * texel) & 3);
  const bool has_black = palette == Palette::ByOrderOfEnds && ends[0] <= ends[1];
  if (has_black && code == 3) return {};
  const uint32_t second = has_black ? kHalves[code] : kThirds[code];
  const auto parts = [&](int at, uint32_t highest) {
    return (ends[0] >> at & highest) * (kParts - second) + (ends[1] >> at & highest) * second;
  };
  return {colour_word<31>(parts(11, 31), is_srgb), colour_word<63>(parts(5, 63), is_srgb),
          colour_word<31>(parts(0, 31), is_srgb), bits_of(1)};
}

// Returns a texel's value of a block with one channel: BC4, either half of BC5, and alpha of BC3. Choice: the
// ends are compared as they are stored, which Khronos leaves open for -127 and -128.
uint32_t channel(const std::byte* block, uint32_t texel, bool is_signed) {
  const uint64_t bits = load(block);
  const auto end = [&](int at) { return is_signed ? int(int8_t(bits >> at)) : int(uint8_t(bits >> at)); };
  const int stored[] = {end(0), end(8)}, highest = is_signed ? 127 : 255;
  const int ends[] = {std::max(stored[0], -highest), std::max(stored[1], -highest)};
  const auto code = int(bits >> (16 + 3 * texel) & 7);
  if (code < 2) return bits_of(double(ends[code]) / highest);
  const int steps = stored[0] > stored[1] ? 7 : 5;
  if (code > steps) return bits_of(code == 7 ? 1 : is_signed ? -1 : 0);
  return bits_of(double(ends[0] * (steps + 1 - code) + ends[1] * (code - 1)) / (steps * highest));
}

Words with_alpha(Words words, uint32_t alpha) {
  words[3] = alpha;
  return words;
}

}  // namespace

Words decode_block(TexelFormat format, const std::byte* block, uint32_t texel) {
  const uint32_t one = bits_of(1);
  const std::byte* const second_half = block + 8;
  const Numeric numeric = info_of(format).numeric;
  const bool is_srgb = numeric == Numeric::Srgb, is_signed = numeric == Numeric::Snorm;
  switch (format) {
    case F::Bc1RgbUnorm:
    case F::Bc1RgbSrgb:
      return with_alpha(colour(block, texel, Palette::ByOrderOfEnds, is_srgb), one);
    case F::Bc1RgbaUnorm:
    case F::Bc1RgbaSrgb:
      return colour(block, texel, Palette::ByOrderOfEnds, is_srgb);
    case F::Bc2Unorm:
    case F::Bc2Srgb:
      return with_alpha(colour(second_half, texel, Palette::FourColours, is_srgb),
                        bits_of(double(load(block) >> 4 * texel & 15) / 15));
    case F::Bc3Unorm:
    case F::Bc3Srgb:
      return with_alpha(colour(second_half, texel, Palette::FourColours, is_srgb),
                        channel(block, texel, false));
    case F::Bc4Unorm:
    case F::Bc4Snorm:
      return {channel(block, texel, is_signed), 0, 0, one};
    case F::Bc5Unorm:
    case F::Bc5Snorm:
      return {channel(block, texel, is_signed), channel(second_half, texel, is_signed), 0, one};
    case F::Bc6hUfloat:
    case F::Bc6hSfloat: {
      const auto halves = decode_bc6h(block, texel, format == F::Bc6hSfloat);
      return {bits_of(double(from_half(halves[0]))), bits_of(double(from_half(halves[1]))),
              bits_of(double(from_half(halves[2]))), one};
    }
    case F::Bc7Unorm:
    case F::Bc7Srgb: {
      const auto bytes = std::bit_cast<std::array<std::byte, 4>>(decode_bc7(block, texel));
      return decode(is_srgb ? F::Rgba8Srgb : F::Rgba8Unorm, bytes.data());
    }
    default:
      GLINT_PANIC("format {} has no blocks", info_of(format).name);
  }
}

}  // namespace glint::exec

// Decodes blocks of BC6H.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <span>
#include <string_view>

#include "exec/block_bits.h"
#include "exec/block_formats.h"

namespace glint::exec {
namespace {

// Describes a mode: the bits of an endpoint, and those of the channels of the later endpoints, which count
// from the first one if `is_transformed`. The layout says where the bits behind the mode's number go, such as
// "g2:4 r0:9-0" for bit 4 of the green of endpoint 2, and then the bits 0 to 9 of the red of endpoint 0. A
// partition of 5 bits ends it, if there are two subsets.
struct FloatMode {
  uint32_t number;
  bool has_two_subsets, is_transformed;
  uint32_t bits;
  std::array<uint32_t, 3> later_bits;
  std::string_view layout;
};
constexpr FloatMode kFloatModes[] = {
    {0,
     true,
     true,
     10,
     {5, 5, 5},
     "g2:4 b2:4 b3:4 r0:9-0 g0:9-0 b0:9-0 r1:4-0 g3:4 g2:3-0 g1:4-0 b3:0 g3:3-0 b1:4-0 b3:1 b2:3-0 r2:4-0 "
     "b3:2 r3:4-0 b3:3"},
    {1,
     true,
     true,
     7,
     {6, 6, 6},
     "g2:5 g3:4 g3:5 r0:6-0 b3:0 b3:1 b2:4 g0:6-0 b2:5 b3:2 g2:4 b0:6-0 b3:3 b3:5 b3:4 r1:5-0 g2:3-0 "
     "g1:5-0 g3:3-0 b1:5-0 b2:3-0 r2:5-0 r3:5-0"},
    {2,
     true,
     true,
     11,
     {5, 4, 4},
     "r0:9-0 g0:9-0 b0:9-0 r1:4-0 r0:10 g2:3-0 g1:3-0 g0:10 b3:0 g3:3-0 b1:3-0 b0:10 b3:1 b2:3-0 r2:4-0 "
     "b3:2 r3:4-0 b3:3"},
    {6,
     true,
     true,
     11,
     {4, 5, 4},
     "r0:9-0 g0:9-0 b0:9-0 r1:3-0 r0:10 g3:4 g2:3-0 g1:4-0 g0:10 g3:3-0 b1:3-0 b0:10 b3:1 b2:3-0 r2:3-0 "
     "b3:0 b3:2 r3:3-0 g2:4 b3:3"},
    {10,
     true,
     true,
     11,
     {4, 4, 5},
     "r0:9-0 g0:9-0 b0:9-0 r1:3-0 r0:10 b2:4 g2:3-0 g1:3-0 g0:10 b3:0 g3:3-0 b1:4-0 b0:10 b2:3-0 r2:3-0 "
     "b3:1 b3:2 r3:3-0 b3:4 b3:3"},
    {14,
     true,
     true,
     9,
     {5, 5, 5},
     "r0:8-0 b2:4 g0:8-0 g2:4 b0:8-0 b3:4 r1:4-0 g3:4 g2:3-0 g1:4-0 b3:0 g3:3-0 b1:4-0 b3:1 b2:3-0 r2:4-0 "
     "b3:2 r3:4-0 b3:3"},
    {18,
     true,
     true,
     8,
     {6, 5, 5},
     "r0:7-0 g3:4 b2:4 g0:7-0 b3:2 g2:4 b0:7-0 b3:3 b3:4 r1:5-0 g2:3-0 g1:4-0 b3:0 g3:3-0 b1:4-0 b3:1 "
     "b2:3-0 r2:5-0 r3:5-0"},
    {22,
     true,
     true,
     8,
     {5, 6, 5},
     "r0:7-0 b3:0 b2:4 g0:7-0 g2:5 g2:4 b0:7-0 g3:5 b3:4 r1:4-0 g3:4 g2:3-0 g1:5-0 g3:3-0 b1:4-0 b3:1 "
     "b2:3-0 r2:4-0 b3:2 r3:4-0 b3:3"},
    {26,
     true,
     true,
     8,
     {5, 5, 6},
     "r0:7-0 b3:1 b2:4 g0:7-0 b2:5 g2:4 b0:7-0 b3:5 b3:4 r1:4-0 g3:4 g2:3-0 g1:4-0 b3:0 g3:3-0 b1:5-0 "
     "b2:3-0 r2:4-0 b3:2 r3:4-0 b3:3"},
    {30,
     true,
     false,
     6,
     {6, 6, 6},
     "r0:5-0 g3:4 b3:0 b3:1 b2:4 g0:5-0 g2:5 b2:5 b3:2 g2:4 b0:5-0 g3:5 b3:3 b3:5 b3:4 r1:5-0 g2:3-0 "
     "g1:5-0 g3:3-0 b1:5-0 b2:3-0 r2:5-0 r3:5-0"},
    {3, false, false, 10, {10, 10, 10}, "r0:9-0 g0:9-0 b0:9-0 r1:9-0 g1:9-0 b1:9-0"},
    {7, false, true, 11, {9, 9, 9}, "r0:9-0 g0:9-0 b0:9-0 r1:8-0 r0:10 g1:8-0 g0:10 b1:8-0 b0:10"},
    {11, false, true, 12, {8, 8, 8}, "r0:9-0 g0:9-0 b0:9-0 r1:7-0 r0:10-11 g1:7-0 g0:10-11 b1:7-0 b0:10-11"},
    {15, false, true, 16, {4, 4, 4}, "r0:9-0 g0:9-0 b0:9-0 r1:3-0 r0:10-15 g1:3-0 g0:10-15 b1:3-0 b0:10-15"},
};

// Says to which bit of which channel, of which endpoint, a bit of the block belongs.
struct Target {
  uint8_t endpoint, channel, bit;
};
struct Layout {
  std::array<Target, 80> targets;
  uint32_t count = 0;
};

// Reads a layout, whose text is right.
Layout layout_of(std::string_view text) {
  Layout out;
  const auto number = [&] {
    uint8_t value = 0;
    for (; !text.empty() && text[0] >= '0' && text[0] <= '9'; text.remove_prefix(1))
      value = uint8_t(10 * value + (text[0] - '0'));
    return value;
  };
  while (!text.empty()) {
    const auto channel = uint8_t(std::string_view("rgb").find(text[0]));
    const auto endpoint = uint8_t(text[1] - '0');
    text.remove_prefix(3);
    const int last = number();
    int first = last;
    if (!text.empty() && text[0] == '-') text.remove_prefix(1), first = number();
    for (int bit = first, step = first <= last ? 1 : -1; bit != last + step; bit += step)
      out.targets[out.count++] = {endpoint, channel, uint8_t(bit)};
    if (!text.empty()) text.remove_prefix(1);
  }
  return out;
}

const Layout& layout_of(const FloatMode& mode) {
  static const auto layouts = [] {
    std::array<Layout, std::size(kFloatModes)> out;
    for (size_t i = 0; i < out.size(); ++i) out[i] = layout_of(kFloatModes[i].layout);
    return out;
  }();
  return layouts[size_t(&mode - kFloatModes)];
}

int with_sign(uint32_t value, uint32_t bits) {
  return int32_t(value << (32 - bits)) >> (32 - bits);
}

int unquantised(int value, uint32_t bits, bool is_signed) {
  if (bits == 16 || value == 0) return value;
  if (!is_signed) return value == (1 << bits) - 1 ? 0xffff : ((value << 15) + 0x4000) >> (bits - 1);
  const int magnitude = value < 0 ? -value : value;
  const int out = magnitude >= (1 << (bits - 1)) - 1 ? 0x7fff : ((magnitude << 15) + 0x4000) >> (bits - 1);
  return value < 0 ? -out : out;
}

// Maps an interpolated value to the bits of a half that is finite, or negative infinity.
uint16_t half_of(int value, bool is_signed) {
  if (!is_signed) return uint16_t(value * 31 >> 6);
  return value < 0 ? uint16_t((-value * 31 >> 5) | 0x8000) : uint16_t(value * 31 >> 5);
}

// Returns a channel of the four endpoints as they are interpolated.
std::array<int, 4> endpoints_of(const FloatMode& mode, const std::array<uint32_t, 4>& stored, size_t channel,
                                bool is_signed) {
  const uint32_t bits = mode.bits, mask = (1u << bits) - 1;
  std::array<int, 4> out;
  for (size_t i = 0; i < 4; ++i) {
    uint32_t value = stored[i];
    if (mode.is_transformed && i > 0)
      value = (stored[0] + uint32_t(with_sign(value, mode.later_bits[channel]))) & mask;
    out[i] = unquantised(is_signed ? with_sign(value, bits) : int(value), bits, is_signed);
  }
  return out;
}

}  // namespace

std::array<uint16_t, 3> decode_bc6h(const std::byte* block, uint32_t texel, bool is_signed) {
  BlockBits bits(block);
  uint32_t number = bits.take(2);
  if (number >= 2) number |= bits.take(3) << 2;
  const FloatMode* const mode = std::find_if(std::begin(kFloatModes), std::end(kFloatModes),
                                             [&](const FloatMode& m) { return m.number == number; });
  if (mode == std::end(kFloatModes)) return {};  // reserved
  std::array<std::array<uint32_t, 4>, 3> stored{};
  const Layout& layout = layout_of(*mode);
  for (const Target& to : std::span(layout.targets.data(), layout.count))
    stored[to.channel][to.endpoint] |= bits.take(1) << to.bit;
  BlockSubsets subsets;
  if (mode->has_two_subsets) subsets = {2, bits.take(5)};

  const auto weight = int(block_weight(bits, subsets, texel, bits.next(), mode->has_two_subsets ? 3 : 4));
  std::array<uint16_t, 3> out;
  for (size_t channel = 0; channel < 3; ++channel) {
    const std::array<int, 4> ends = endpoints_of(*mode, stored[channel], channel, is_signed);
    const int a = ends[2 * subsets.of(texel)], b = ends[2 * subsets.of(texel) + 1];
    out[channel] = half_of(((64 - weight) * a + weight * b + 32) >> 6, is_signed);
  }
  return out;
}

}  // namespace glint::exec

// Decodes blocks of BC7.
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <utility>

#include "exec/block_bits.h"
#include "exec/block_formats.h"

namespace glint::exec {
namespace {

// Says how many bits the fields of a mode have, in their order, and how many subsets a block has. A mode has
// a bit below each channel for each endpoint, or one for both of a subset, or none.
struct ColourMode {
  uint32_t subsets, partition, rotation, selector, colour, alpha;
  bool has_bit_of_endpoint, has_bit_of_subset;
  uint32_t index, second_index;
};
constexpr ColourMode kColourModes[8] = {
    {3, 4, 0, 0, 4, 0, true, false, 3, 0},  {2, 6, 0, 0, 6, 0, false, true, 3, 0},
    {3, 6, 0, 0, 5, 0, false, false, 2, 0}, {2, 6, 0, 0, 7, 0, true, false, 2, 0},
    {1, 0, 2, 1, 5, 6, false, false, 2, 3}, {1, 0, 2, 0, 7, 8, false, false, 2, 2},
    {1, 0, 0, 0, 7, 7, true, false, 4, 0},  {2, 6, 0, 0, 5, 5, true, false, 2, 0},
};

using Colour = std::array<uint32_t, 4>;

// Reads the endpoints, two for each subset, with 8 bits a channel.
std::array<Colour, 6> endpoints_of(const ColourMode& mode, BlockBits& bits) {
  const uint32_t count = 2 * mode.subsets, channels = mode.alpha ? 4 : 3;
  std::array<Colour, 6> out;
  for (uint32_t channel = 0; channel < channels; ++channel)
    for (uint32_t i = 0; i < count; ++i) out[i][channel] = bits.take(channel == 3 ? mode.alpha : mode.colour);
  const bool has_low_bit = mode.has_bit_of_endpoint || mode.has_bit_of_subset;
  uint32_t low = 0;
  for (uint32_t i = 0; i < count; ++i) {
    if (mode.has_bit_of_endpoint || (mode.has_bit_of_subset && i % 2 == 0)) low = bits.take(1);
    for (uint32_t channel = 0; channel < channels; ++channel) {
      uint32_t& value = out[i][channel];
      const uint32_t width = (channel == 3 ? mode.alpha : mode.colour) + has_low_bit;
      if (has_low_bit) value = value << 1 | low;
      value = value << (8 - width) | value >> (2 * width - 8);  // The highest bits come again below.
    }
    if (!mode.alpha) out[i][3] = 255;
  }
  return out;
}

}  // namespace

std::array<uint8_t, 4> decode_bc7(const std::byte* block, uint32_t texel) {
  BlockBits bits(block);
  const auto number = uint32_t(std::countr_zero(std::to_integer<uint8_t>(*block)));
  if (number == 8) return {};  // reserved
  const ColourMode& mode = kColourModes[number];
  bits.take(number + 1);
  const BlockSubsets subsets{mode.subsets, bits.take(mode.partition)};
  const uint32_t rotation = bits.take(mode.rotation);
  const bool swaps_indices = bits.take(mode.selector) != 0;
  const std::array<Colour, 6> endpoints = endpoints_of(mode, bits);

  const uint32_t first = bits.next();
  uint32_t of_colour = block_weight(bits, subsets, texel, first, mode.index), of_alpha = of_colour;
  if (mode.second_index)
    of_alpha = block_weight(bits, subsets, texel, first + 16 * mode.index - mode.subsets, mode.second_index);
  if (swaps_indices) std::swap(of_colour, of_alpha);
  const Colour &a = endpoints[2 * subsets.of(texel)], &b = endpoints[2 * subsets.of(texel) + 1];
  std::array<uint8_t, 4> out;
  for (size_t channel = 0; channel < 4; ++channel) {
    const uint32_t weight = channel == 3 ? of_alpha : of_colour;
    out[channel] = uint8_t(((64 - weight) * a[channel] + weight * b[channel] + 32) >> 6);
  }
  if (rotation) std::swap(out[3], out[rotation - 1]);
  return out;
}

}  // namespace glint::exec

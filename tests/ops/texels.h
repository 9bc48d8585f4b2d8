// Reads and writes texels in double precision, by the words of their format's name.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace glint::test {

// Names what the bits of a channel are.
enum class Kind : uint8_t { Unorm, Snorm, Uint, Sint, Float, Srgb };

// Describes a format as its name does: "bgra8_srgb" has the channels b, g, r, a of 8 bits, lowest first.
struct Format {
  std::string_view name;
  Kind kind = Kind::Float;
  struct Channel {
    char letter = 'r';  // r, g, b, a; e: the exponent that the others share
    int bits = 8;
  };
  std::vector<Channel> channels;
  bool is_integer() const { return kind == Kind::Uint || kind == Kind::Sint; }
  bool is_normalized() const { return kind == Kind::Unorm || kind == Kind::Snorm || kind == Kind::Srgb; }
  bool has_shared_exponent() const { return channels.back().letter == 'e'; }
  int bits() const;
  uint32_t bytes() const { return uint32_t(bits() / 8); }
};
Format format_of(std::string_view name);

// Holds red, green, blue and alpha as numbers. Integers are exact.
using Colour = std::array<double, 4>;
// Holds the same as registers do: bits of floats, or integers.
using Words = std::array<uint32_t, 4>;
Words words_of(const Format& format, const Colour& colour);
Colour colour_of(const Format& format, const Words& words);

// Returns the colour of a texel. Channels that the format lacks are 0, and alpha is 1.
Colour read_texel(const Format& format, const uint8_t* from);
// Returns the bytes that a store of the words leaves.
std::vector<uint8_t> texel_of(const Format& format, const Words& words);
// Returns the colour without the channels that the format lacks.
Colour kept(const Format& format, Colour colour);

}  // namespace glint::test

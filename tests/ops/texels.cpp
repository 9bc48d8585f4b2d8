// Reads and writes texels in double precision, by the words of their format's name.
// SPDX-License-Identifier: Apache-2.0
#include "tests/ops/texels.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

#include "tests/ops/numbers.h"

namespace glint::test {
namespace {

constexpr std::string_view kLetters = "rgba";

Kind kind_of(std::string_view word) {
  constexpr std::string_view kNames[] = {"unorm", "snorm", "uint", "sint", "float", "srgb"};
  for (size_t i = 0; i < std::size(kNames); ++i)
    if (kNames[i] == word) return Kind(i);
  throw std::logic_error(fmt::format("the oracle does not know texels of kind '{}'", word));
}

// Returns bits [at, at + count) of a texel, lowest byte first.
uint64_t field(const uint8_t* from, int at, int count) {
  uint64_t out = 0;
  for (int i = 0; i < count; ++i) out |= uint64_t(from[(at + i) / 8] >> ((at + i) % 8) & 1) << i;
  return out;
}
void put_field(uint8_t* to, int at, int count, uint64_t value) {
  for (int i = 0; i < count; ++i)
    if (value >> i & 1) to[(at + i) / 8] = uint8_t(to[(at + i) / 8] | 1 << ((at + i) % 8));
}

FloatFormat float_of(int bits) {
  if (bits == 32) return kSingle;
  return bits == 16 ? kHalf : FloatFormat{5, bits - 5, false};
}

double to_linear(double x) {
  return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}
double to_srgb(double x) {
  return x <= 0.0031308 ? x * 12.92 : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
}

double read_channel(const Format& format, const Format::Channel& channel, uint64_t bits) {
  const double top = std::ldexp(1.0, channel.bits) - 1, half = std::ldexp(1.0, channel.bits - 1) - 1;
  const auto number = double(bits);
  const double with_sign = number > half ? number - top - 1 : number;
  switch (format.kind) {
    case Kind::Unorm:
      return number / top;
    case Kind::Snorm:
      return std::max(with_sign / half, -1.0);
    case Kind::Uint:
      return number;
    case Kind::Sint:
      return with_sign;
    case Kind::Float:
      return value_of(float_of(channel.bits), bits);
    case Kind::Srgb:
      return channel.letter == 'a' ? number / top : to_linear(number / top);
  }
  return 0;
}

uint64_t float_channel(int bits, double x) {
  const FloatFormat format = float_of(bits);
  const uint64_t quiet = (uint64_t{1} << (format.exponent + format.fraction)) - 1;
  if (std::isnan(x)) return quiet | (format.has_sign && std::signbit(x) ? quiet + 1 : 0);
  if (format.has_sign || std::isinf(x)) return x < 0 && !format.has_sign ? 0 : bits_of(format, x);
  // What has no sign has no numbers below zero, and what is too large stays finite.
  const uint64_t largest = (uint64_t(2 * format.bias() + 1) << format.fraction) - 1;
  return x > 0 ? std::min(bits_of(format, x), largest) : 0;
}

uint64_t write_channel(const Format& format, const Format::Channel& channel, double x) {
  const double top = std::ldexp(1.0, channel.bits) - 1, half = std::ldexp(1.0, channel.bits - 1) - 1;
  const auto mask = ~uint64_t{0} >> (64 - channel.bits);
  const double unit = std::isnan(x) ? 0 : std::clamp(x, 0.0, 1.0);
  switch (format.kind) {
    case Kind::Unorm:
      return uint64_t(std::nearbyint(unit * top));
    case Kind::Srgb:
      return uint64_t(std::nearbyint((channel.letter == 'a' ? unit : to_srgb(unit)) * top));
    case Kind::Snorm:
      return uint64_t(int64_t(std::nearbyint((std::isnan(x) ? 0 : std::clamp(x, -1.0, 1.0)) * half))) & mask;
    case Kind::Uint:
      return uint64_t(std::min(x, top));
    case Kind::Sint:
      return uint64_t(int64_t(std::clamp(x, -half - 1, half))) & mask;
    case Kind::Float:
      return float_channel(channel.bits, x);
  }
  return 0;
}

// Three mantissas of 9 bits without a hidden one, and an exponent of 5 bits: x = mantissa * 2^(exponent -
// 24).
Colour read_shared(const uint8_t* from) {
  const double scale = std::ldexp(1.0, int(field(from, 27, 5)) - 24);
  return {double(field(from, 0, 9)) * scale, double(field(from, 9, 9)) * scale,
          double(field(from, 18, 9)) * scale, 1};
}
void write_shared(uint8_t* to, const Colour& colour) {
  std::array<double, 3> c{};
  for (size_t i = 0; i < 3; ++i) c[i] = colour[i] > 0 ? std::min(colour[i], 65408.0) : 0;
  const double most = std::max({c[0], c[1], c[2]});
  // The exponent is the least with which the largest mantissa, rounded, fits into 9 bits.
  int exponent = 0;
  while (std::floor(std::ldexp(most, 24 - exponent) + 0.5) > 511) ++exponent;
  for (int i = 0; i < 3; ++i)
    put_field(to, 9 * i, 9, uint64_t(std::floor(std::ldexp(c[size_t(i)], 24 - exponent) + 0.5)));
  put_field(to, 27, 5, uint64_t(exponent));
}

}  // namespace

int Format::bits() const {
  int out = 0;
  for (const Channel& channel : channels) out += channel.bits;
  return out;
}

Format format_of(std::string_view name) {
  Format out;
  out.name = name;
  const std::string_view channels = name.substr(0, name.find('_'));
  const std::string_view after = name.substr(name.find('_') + 1);
  out.kind = kind_of(after.substr(0, after.find('_')));
  // Letters stand before their number of bits: "rgb10a2" has three channels of 10 bits and one of 2.
  size_t unnumbered = 0;
  for (size_t at = 0; at < channels.size();) {
    if (std::isalpha(static_cast<unsigned char>(channels[at]))) {
      out.channels.push_back({channels[at++], 0});
      continue;
    }
    int bits = 0;
    while (at < channels.size() && std::isdigit(static_cast<unsigned char>(channels[at])))
      bits = 10 * bits + (channels[at++] - '0');
    for (; unnumbered < out.channels.size(); ++unnumbered) out.channels[unnumbered].bits = bits;
  }
  // Vulkan names the channels of packed formats from the highest bit on.
  if (after.find("_pack") != std::string_view::npos) std::reverse(out.channels.begin(), out.channels.end());
  return out;
}

Words words_of(const Format& format, const Colour& colour) {
  Words out{};
  for (size_t i = 0; i < 4; ++i)
    out[i] = format.is_integer() ? uint32_t(int64_t(colour[i])) : uint32_t(bits_of(kSingle, colour[i]));
  return out;
}
Colour colour_of(const Format& format, const Words& words) {
  Colour out{};
  for (size_t i = 0; i < 4; ++i)
    out[i] = format.kind == Kind::Uint   ? double(words[i])
             : format.kind == Kind::Sint ? double(int32_t(words[i]))
                                         : value_of(kSingle, words[i]);
  return out;
}

Colour read_texel(const Format& format, const uint8_t* from) {
  if (format.has_shared_exponent()) return read_shared(from);
  Colour out{0, 0, 0, 1};
  int at = 0;
  for (const Format::Channel& channel : format.channels) {
    out[kLetters.find(channel.letter)] = read_channel(format, channel, field(from, at, channel.bits));
    at += channel.bits;
  }
  return out;
}

std::vector<uint8_t> texel_of(const Format& format, const Words& words) {
  std::vector<uint8_t> out(format.bytes());
  const Colour colour = colour_of(format, words);
  if (format.has_shared_exponent()) return write_shared(out.data(), colour), out;
  int at = 0;
  for (const Format::Channel& channel : format.channels) {
    const size_t i = kLetters.find(channel.letter);
    // A channel of 32 bits takes the word as it is, whatever number it is.
    put_field(out.data(), at, channel.bits,
              channel.bits == 32 ? words[i] : write_channel(format, channel, colour[i]));
    at += channel.bits;
  }
  return out;
}

Colour kept(const Format& format, Colour colour) {
  for (size_t i = 0; i < 4; ++i) {
    const bool is_there = std::any_of(format.channels.begin(), format.channels.end(),
                                      [&](const auto& channel) { return channel.letter == kLetters[i]; });
    if (!is_there) colour[i] = i == 3 ? 1 : 0;
  }
  return colour;
}

}  // namespace glint::test

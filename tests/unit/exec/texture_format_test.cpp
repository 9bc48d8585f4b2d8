// Tests formats of texels against values worked out by hand from the Vulkan specification, and round trips.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <limits>

#include "tests/support/catch.h"
#include "tests/unit/exec/image_lab.h"

namespace glint::exec {
namespace {

using F = TexelFormat;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

template <class T>
Words decoded(F format, std::initializer_list<T> values) {
  std::array<std::byte, 16> bytes{};
  std::memcpy(bytes.data(), values.begin(), values.size() * sizeof(T));
  REQUIRE(values.size() * sizeof(T) == info_of(format).bytes);
  return decode(format, bytes.data());
}
template <class T>
std::vector<T> encoded(F format, const Words& words) {
  std::vector<T> out(16 / sizeof(T), T(0x5a5a'5a5a));
  encode(format, words, reinterpret_cast<std::byte*>(out.data()));
  for (size_t i = info_of(format).bytes / sizeof(T); i < out.size(); ++i) CHECK(out[i] == T(0x5a5a'5a5a));
  out.resize(info_of(format).bytes / sizeof(T));
  return out;
}
using Bytes = std::vector<uint8_t>;
using Halves = std::vector<uint16_t>;
using Longs = std::vector<uint32_t>;

}  // namespace

TEST_CASE("texels of 8 bits decode to the fractions and integers that Vulkan says") {
  CHECK(decoded<uint8_t>(F::R8Unorm, {51}) == floats(0.2f, 0, 0, 1));
  CHECK(decoded<uint8_t>(F::Rg8Unorm, {255, 0}) == floats(1, 0, 0, 1));
  CHECK(decoded<uint8_t>(F::Rgba8Unorm, {0, 51, 102, 255}) == floats(0, 0.2f, 0.4f, 1));
  CHECK(decoded<uint8_t>(F::Bgra8Unorm, {0, 51, 255, 102}) == floats(1, 0.2f, 0, 0.4f));
  CHECK(decoded<uint8_t>(F::R8Snorm, {0x7f}) == floats(1, 0, 0, 1));
  CHECK(decoded<uint8_t>(F::Rg8Snorm, {0x80, 0x81}) == floats(-1, -1, 0, 1));
  CHECK(decoded<uint8_t>(F::Rgba8Snorm, {0, 0xff, 0x40, 0x80}) == floats(0, -1 / 127.0f, 64 / 127.0f, -1));
  CHECK(decoded<uint8_t>(F::R8Uint, {200}) == Words{200, 0, 0, 1});
  CHECK(decoded<uint8_t>(F::Rg8Uint, {1, 2}) == Words{1, 2, 0, 1});
  CHECK(decoded<uint8_t>(F::Rgba8Uint, {1, 2, 3, 255}) == Words{1, 2, 3, 255});
  CHECK(decoded<uint8_t>(F::R8Sint, {0xff}) == Words{~0u, 0, 0, 1});
  CHECK(decoded<uint8_t>(F::Rg8Sint, {0x80, 127}) == Words{uint32_t(-128), 127, 0, 1});
  CHECK(decoded<uint8_t>(F::Rgba8Sint, {0, 1, 0xfe, 0x80}) == Words{0, 1, uint32_t(-2), uint32_t(-128)});
}

TEST_CASE("sRGB texels decode by the curve, alpha linearly") {
  const Words words = decoded<uint8_t>(F::Rgba8Srgb, {0, 10, 188, 51});
  CHECK(number(words[0]) == 0.0f);
  CHECK(number(words[1]) == Catch::Approx(10 / 255.0 / 12.92));
  CHECK(number(words[2]) == Catch::Approx(0.502886).margin(1e-6));
  CHECK(number(words[3]) == 0.2f);
  CHECK(decoded<uint8_t>(F::Bgra8Srgb, {188, 10, 0, 51}) == words);
  CHECK(encoded<uint8_t>(F::Rgba8Srgb, floats(0.5f, 0.0031f, 1, 0.5f)) == Bytes{188, 10, 255, 128});
}

TEST_CASE("texels of 16 and 32 bits decode to the numbers that Vulkan says") {
  CHECK(decoded<uint16_t>(F::R16Unorm, {13107}) == floats(0.2f, 0, 0, 1));
  CHECK(decoded<uint16_t>(F::Rg16Unorm, {65535, 1}) == floats(1, 1 / 65535.0f, 0, 1));
  CHECK(decoded<uint16_t>(F::Rgba16Unorm, {0, 1, 2, 3}) ==
        floats(0, 1 / 65535.0f, 2 / 65535.0f, 3 / 65535.0f));
  CHECK(decoded<uint16_t>(F::R16Snorm, {0x8000}) == floats(-1, 0, 0, 1));
  CHECK(decoded<uint16_t>(F::Rg16Snorm, {0x7fff, 0xffff}) == floats(1, -1 / 32767.0f, 0, 1));
  CHECK(decoded<uint16_t>(F::Rgba16Snorm, {0, 1, 0x8001, 0x8000}) == floats(0, 1 / 32767.0f, -1, -1));
  CHECK(decoded<uint16_t>(F::R16Uint, {65535}) == Words{65535, 0, 0, 1});
  CHECK(decoded<uint16_t>(F::Rg16Uint, {1, 2}) == Words{1, 2, 0, 1});
  CHECK(decoded<uint16_t>(F::Rgba16Uint, {1, 2, 3, 4}) == Words{1, 2, 3, 4});
  CHECK(decoded<uint16_t>(F::R16Sint, {0xffff}) == Words{~0u, 0, 0, 1});
  CHECK(decoded<uint16_t>(F::Rg16Sint, {0x8000, 5}) == Words{uint32_t(-32768), 5, 0, 1});
  CHECK(decoded<uint16_t>(F::Rgba16Sint, {1, 2, 3, 0xfffe}) == Words{1, 2, 3, uint32_t(-2)});
  CHECK(decoded<uint16_t>(F::R16Float, {0x3c00}) == floats(1, 0, 0, 1));
  CHECK(decoded<uint16_t>(F::Rg16Float, {0xc000, 0x7bff}) == floats(-2, 65504, 0, 1));
  CHECK(decoded<uint16_t>(F::Rgba16Float, {0x0001, 0x7c00, 0xfc00, 0x8000}) ==
        floats(0x1p-24f, kInf, -kInf, -0.0f));
  CHECK(decoded<uint32_t>(F::R32Uint, {0xffff'ffff}) == Words{~0u, 0, 0, 1});
  CHECK(decoded<uint32_t>(F::Rg32Sint, {7, 0x8000'0000}) == Words{7, 0x8000'0000, 0, 1});
  CHECK(decoded<float>(F::R32Float, {-0.5f}) == floats(-0.5f, 0, 0, 1));
  CHECK(decoded<float>(F::Rg32Float, {1, 2}) == floats(1, 2, 0, 1));
  CHECK(decoded<float>(F::Rgba32Float, {1, 2, 3, 4}) == floats(1, 2, 3, 4));
}

TEST_CASE("packed texels decode channel by channel, the first lowest") {
  CHECK(decoded<uint32_t>(F::R11g11b10Float, {0x3c0 | 0x400 << 11 | 0x1c0u << 22}) == floats(1, 2, 0.5f, 1));
  CHECK(decoded<uint32_t>(F::R11g11b10Float, {0x001 | 0x7bf << 11 | 0x3e0u << 22}) ==
        floats(0x1p-20f, 65024, kInf, 1));
  CHECK(decoded<uint32_t>(F::Rgb10a2Unorm, {1023 | 1 << 10 | 0 << 20 | 2u << 30}) ==
        floats(1, 1 / 1023.0f, 0, 2 / 3.0f));
  CHECK(decoded<uint32_t>(F::Rgb10a2Uint, {1023 | 1 << 10 | 7 << 20 | 2u << 30}) == Words{1023, 1, 7, 2});
  CHECK(decoded<uint32_t>(F::Rgb9e5Float, {0x8001'0100}) == floats(1, 0.5f, 0, 1));
  CHECK(decoded<uint32_t>(F::Rgb9e5Float, {511 | 31u << 27}) == floats(65408, 0, 0, 1));
}

TEST_CASE("stores clamp, round to nearest even, and make 0 of NaN") {
  CHECK(encoded<uint8_t>(F::Rgba8Unorm, floats(0.5f, -1, 7, kNan)) == Bytes{128, 0, 255, 0});
  CHECK(encoded<uint8_t>(F::Bgra8Unorm, floats(1, 0.2f, 0, 0.4f)) == Bytes{0, 51, 255, 102});
  CHECK(encoded<uint8_t>(F::Rgba8Snorm, floats(-2, -1, 0.5f, kNan)) == Bytes{0x81, 0x81, 64, 0});
  CHECK(encoded<uint8_t>(F::Rgba8Uint, {0, 255, 256, ~0u}) == Bytes{0, 255, 255, 255});
  CHECK(encoded<uint8_t>(F::Rgba8Sint, {uint32_t(-129), 200, uint32_t(-1), 5}) == Bytes{0x80, 127, 0xff, 5});
  CHECK(encoded<uint16_t>(F::Rg16Unorm, floats(0.5f, 2, 0, 0)) == Halves{32768, 65535});
  CHECK(encoded<uint16_t>(F::Rg16Float, floats(1 + 0x1p-11f, 1 + 3 * 0x1p-11f, 0, 0)) ==
        Halves{0x3c00, 0x3c02});
  CHECK(encoded<uint16_t>(F::Rgba16Float, floats(65520, 65519.996f, 0x1p-25f, -0x1.8p-25f)) ==
        Halves{0x7c00, 0x7bff, 0, 0x8001});
  CHECK(encoded<uint32_t>(F::R11g11b10Float, floats(-3, 1e9f, 0.5f, 0)) ==
        Longs{0x7bfu << 11 | 0x1c0u << 22});
  CHECK(encoded<uint32_t>(F::R11g11b10Float, floats(kInf, kNan, -kInf, 0)) == Longs{0x7c0u | 0x7ffu << 11});
  CHECK(encoded<uint32_t>(F::Rgb10a2Unorm, floats(1, 0, 2, 0.7f)) == Longs{1023u | 1023u << 20 | 2u << 30});
  CHECK(encoded<uint32_t>(F::Rgb10a2Uint, {5000, 1, 2, 9}) == Longs{1023u | 1u << 10 | 2u << 20 | 3u << 30});
  CHECK(encoded<uint32_t>(F::Rgb9e5Float, floats(1, 0.5f, -1, 0)) == Longs{0x8001'0100});
  CHECK(encoded<uint32_t>(F::Rgb9e5Float, floats(1e9f, 0, 0, 0)) == Longs{511u | 31u << 27});
}

TEST_CASE("every half but a NaN survives the way to a float and back") {
  int wrong = 0;
  for (uint32_t h = 0; h < 0x10000; ++h)
    if ((h & 0x7fff) <= 0x7c00) wrong += to_half(from_half(uint16_t(h))) != h;
  CHECK(wrong == 0);
}

TEST_CASE("every texel survives decoding and encoding, in every format") {
  for (size_t f = 0; f < size_t(kFirstBlockFormat); ++f) {
    const auto format = F(f);
    const FormatInfo& info = info_of(format);
    INFO(info.name);
    uint64_t state = 88172645463325252ull + f;
    int wrong = 0, tried = 0;
    for (int round = 0; round < 2000; ++round) {
      std::array<std::byte, 16> texel{}, again{};
      for (size_t i = 0; i < info.bytes; ++i) {
        state ^= state << 13, state ^= state >> 7, state ^= state << 17;
        texel[i] = std::byte(state >> 24);
      }
      const Words words = decode(format, texel.data());
      bool skip = false;  // skips texels that are not the only ones of their value
      for (uint32_t word : words) skip |= !is_integer(info) && info.bits != 32 && std::isnan(number(word));
      if (info.numeric == Numeric::Snorm)
        for (uint32_t word : words) skip |= number(word) == -1.0f;
      if (format == F::Rgb9e5Float)
        skip |= (std::to_integer<uint32_t>(texel[0]) | (std::to_integer<uint32_t>(texel[1]) & 1) << 8) < 256;
      if (skip) continue;
      ++tried;
      encode(format, words, again.data());
      wrong += again != texel;
    }
    CHECK(tried > 500);
    CHECK(wrong == 0);
  }
}

}  // namespace glint::exec

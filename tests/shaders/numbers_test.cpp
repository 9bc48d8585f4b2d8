// Compares bit tricks and packing with the bits that C++ gives, lane by lane.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "tests/shaders/lane_checks.h"
#include "tests/support/catch.h"

namespace glint::test::numbers_test {
namespace {

uint32_t pcg(uint32_t& state) {
  const uint32_t old = state;
  state = old * 747796405u + 2891336453u;
  const uint32_t word = ((old >> ((old >> 28) + 4)) ^ old) * 277803737u;
  return (word >> 22) ^ word;
}
uint32_t spread(uint32_t p) {
  uint32_t r = 0;
  for (uint32_t i = 0; i < 16; ++i) r |= (p >> i & 1) << (2 * i);
  return r;
}

Row bit_tricks(uint32_t lane) {
  Row row;
  uint32_t s = lane * 9781 + 1;
  const uint32_t first = pcg(s);
  row.push_back(first ^ pcg(s));
  row.push_back(bits(std::bit_cast<float>(0x3f80'0000u | pcg(s) >> 9) - 1.0f));
  row.push_back(spread(lane % 8 * 37) | spread(lane / 8 * 37) << 1);
  const uint32_t width = (lane & 7) + 1;
  row.push_back((s >> (lane & 15) & 0x7f) | uint32_t(int32_t(s << (32 - 3 - width)) >> (32 - width)) << 16);
  row.push_back((s & ~(0x3fu << 5)) | (lane & 0x3f) << 5);
  const uint32_t high = s >> (lane & 31), low = s << (lane & 15);
  row.push_back(
      uint32_t((high ? 31 - std::countl_zero(high) : -1) + 100 * (low ? std::countr_zero(low) : -1)));
  uint32_t reversed = 0;
  for (int i = 0; i < 32; ++i) reversed |= (s >> i & 1) << (31 - i);
  row.push_back(uint32_t(std::popcount(s)) + (reversed >> 24));
  const int32_t n = int32_t(lane) - 20;
  row.push_back(
      n < 0 ? 0
            : uint32_t(n / 3 * 1000 + n % 3 + (n >> 1) * 7));  // GLSL leaves % of a negative number undefined
  row.push_back(uint32_t(uint32_t(-n) > 5 ? std::abs(n) : (n > 0) - (n < 0)));
  row.push_back(uint32_t(std::max(0.0f, std::max(-3.7f, float(n)))) + 8);
  const uint64_t wide = uint64_t(s) * 0x9e3779b97f4a7c15ull + lane;
  row.push_back(uint32_t(wide >> 33) ^ uint32_t(wide));
  row.push_back(bits(float(n)) ^ uint32_t(lane < 10));
  const bool x = n<0, y = n> 2;
  row.push_back(1 | (x && y ? 2u : 0) | (x && y ? 0 : 4u) | uint32_t(x) << 3 | uint32_t(y) << 4);
  row.push_back(bits(y ? 20.0f : 2.0f));
  const uint32_t sum = s + 0xfffffff0u;
  row.push_back(sum + (sum < s));
  row.push_back((~lane & 0xff) ^ (lane << 3 | lane >> 1));
  return row;
}

TEST_CASE("random number generators and bit tricks give the bits that C++ gives") {
  RayLab lab({"bits.rgen", {}, {}, {}});
  lab.words_per_lane = 16;
  check_lanes(lab, [](uint32_t lane) {
    Row row = bit_tricks(lane);
    if (lane < 20) row.resize(7);  // from word 7 on, operands of % are negative
    return row;
  });
}

// Searches for the half nearest to x, and takes the even one of two.
double half_value(uint32_t h) {
  const uint32_t exponent = h >> 10 & 31, fraction = h & 1023;
  const double magnitude =
      exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, int(exponent) - 25);
  return h & 0x8000 ? -magnitude : magnitude;
}
uint32_t nearest_half(float x) {
  const uint32_t sign = std::signbit(x) ? 0x8000 : 0;
  const double magnitude = std::abs(double(x));
  if (std::isnan(x)) return sign | 0x7e00;
  uint32_t low = 0;  // the largest half that is not above x; 0x7c00 counts as 65536
  for (uint32_t step = 0x4000; step; step /= 2)
    if (low + step <= 0x7c00 && half_value(low + step) <= magnitude) low += step;
  if (low == 0x7c00) return sign | low;
  const double below = magnitude - half_value(low), above = half_value(low + 1) - magnitude;
  return sign | (above < below || (above == below && (low & 1)) ? low + 1 : low);
}

std::vector<uint32_t> pack_inputs() {
  std::vector<uint32_t> words;
  for (float f :
       {0.0f,     -0.0f, 1.0f,    0.5f,     0.1f,     1.00048828125f, 1.00146484375f, 65504.0f, 65519.0f,
        65520.0f, 1e9f,  6.1e-5f, 6.09e-5f, 5.96e-8f, 2.98e-8f,       2.99e-8f,       1e-20f,   1e-40f,
        0.7f,     2.0f,  0.999f,  0.00196f, 3.0e-7f,  -0.3f,          INFINITY,       NAN})
    words.push_back(bits(f));
  uint32_t state = 7;
  while (words.size() < RayLab::kLanesUsed - 3) words.push_back(pcg(state));
  words.insert(words.end(), {0x7c00'fc00, 0x8000'8180, 0x03ff'8001});
  return words;
}

uint32_t packed(const std::vector<float>& v, uint32_t width, bool is_signed) {
  const uint32_t mask = (1u << width) - 1;
  uint32_t result = 0;
  for (uint32_t i = 0; i < v.size(); ++i) {
    const float low = is_signed ? -1 : 0,
                x = std::isnan(v[i]) ? low + (is_signed ? 2 : 0) : std::min(std::max(v[i], low), 1.0f);
    result |= (uint32_t(int32_t(std::nearbyint(x * float(is_signed ? mask >> 1 : mask)))) & mask)
              << (i * width);
  }
  return result;
}

TEST_CASE("packing and unpacking of halves and normalised integers is exact, also for subnormals and ties") {
  RayLab lab({"pack.rgen", {}, {}, {}});
  lab.words_per_lane = 24;
  lab.buffers[10] = pack_inputs();
  check_lanes(lab, [](uint32_t lane) {
    const uint32_t w = pack_inputs()[lane];
    const float f = std::bit_cast<float>(w);
    Row row{nearest_half(f) | nearest_half(-f) << 16};
    if (std::isnan(f)) row[0] = 0x7fff'7fff;
    for (uint32_t h : {w & 0xffff, w >> 16}) {
      const uint32_t special = h & 0x3ff ? 0x7fff'ffff : (h & 0x8000) << 16 | 0x7f80'0000;
      row.push_back((h & 0x7c00) == 0x7c00 ? special : bits(float(half_value(h)) * 1.0f));
    }
    const std::vector<float> v{f, -f, f * 0.25f, float(lane) / 47.0f};
    row.insert(row.end(), {packed(v, 8, false), packed(v, 8, true), packed({v[2], v[3]}, 16, false),
                           packed({v[1], v[3]}, 16, true)});
    for (uint32_t i = 0; i < 4; ++i) row.push_back(bits(float(w >> (8 * i) & 255) / 255.0f));
    for (uint32_t i = 0; i < 4; ++i)
      row.push_back(bits(std::max(float(int8_t(w >> (8 * i))) / 127.0f, -1.0f)));
    for (uint32_t i = 0; i < 2; ++i) row.push_back(bits(float(w >> (16 * i) & 0xffff) / 65535.0f));
    for (uint32_t i = 0; i < 2; ++i)
      row.push_back(bits(std::max(float(int16_t(w >> (16 * i))) / 32767.0f, -1.0f)));
    return row;
  });
}

}  // namespace
}  // namespace glint::test::numbers_test

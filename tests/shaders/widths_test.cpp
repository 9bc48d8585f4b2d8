// Compares numbers of 8, 16 and 64 bits in shaders with what C++ gives, lane by lane, in registers and in
// memory.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>

#include "tests/shaders/lane_checks.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

// Returns the bits of the half nearest to x, and the even one of two.
uint16_t half_bits(double x) {
  const uint16_t sign = std::signbit(x) ? 0x8000 : 0;
  const double magnitude = std::abs(x);
  if (std::isnan(x)) return 0x7fff;
  if (magnitude >= 65520) return sign | 0x7c00;
  const int exponent = magnitude == 0 ? -14 : std::max(std::ilogb(magnitude), -14);
  const auto units = uint32_t(std::nearbyint(std::ldexp(magnitude, 10 - exponent)));
  return uint16_t(sign | (uint32_t(exponent + 14) * 1024 + units));
}
double half_value(uint16_t h) {
  const int exponent = h >> 10 & 31, fraction = h & 1023;
  const double magnitude =
      exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
  return h & 0x8000 ? -magnitude : magnitude;
}

std::vector<uint32_t> inputs() {
  std::vector<uint32_t> words{0,           1,           0xffff'ffff, 0x8000'8080,
                              0x7fff'7f7f, 0x0001'ff80, 0xff80'0001, 0x0000'8000};
  for (uint32_t state = 9; words.size() < RayLab::kLanesUsed;)
    words.push_back(state = state * 747796405u + 2891336453u);
  return words;
}

struct Mixed {  // scalar layout, which is also that of C++
  int8_t a;
  uint8_t b;
  int16_t c;
  uint16_t d, e;
  double f;
  int64_t g;
};
static_assert(sizeof(Mixed) == 24);

Mixed mixed(uint32_t lane) {
  const uint32_t w = inputs()[lane];
  return {int8_t(w),         uint8_t(w >> 3),  int16_t(w >> 7), half_bits(double(lane) - 20.5),
          uint16_t(w >> 11), double(w % 1000), int64_t(w) * -77};
}
std::vector<uint32_t> words_of(const std::vector<Mixed>& records) {
  std::vector<uint32_t> words(records.size() * sizeof(Mixed) / 4);
  std::memcpy(words.data(), records.data(), words.size() * 4);
  return words;
}

void push64(Row& row, uint64_t x) {
  row.insert(row.end(), {uint32_t(x), uint32_t(x >> 32)});
}
void push64(Row& row, double x) {
  push64(row, std::bit_cast<uint64_t>(x));
}

Row narrow(uint32_t w) {
  const auto i8 = int8_t(w), j8 = int8_t(w >> 8);
  const auto u8 = uint8_t(w), v8 = uint8_t(w >> 8);
  Row row{
      uint32_t(int8_t(i8 + j8)) ^ uint32_t(int8_t(i8 * j8)) << 8,
      uint32_t(uint8_t(u8 + v8)) | uint32_t(uint8_t(u8 * v8)) << 8 | uint32_t(u8 >> 3) << 16,
      uint32_t(i8 < j8) | uint32_t(u8 < v8) << 1 | uint32_t(i8 == j8) << 2 | uint32_t(int8_t(-i8) > j8) << 3,
      uint32_t(i8 >> 2) + uint32_t(std::min(i8, j8)) * 3 + std::max(u8, v8) * 5u +
          uint32_t(int8_t(std::abs(i8)))};
  const auto i16 = int16_t(w), j16 = int16_t(w >> 16);
  const auto u16 = uint16_t(w), v16 = uint16_t(w >> 16);
  row.push_back(uint32_t(int16_t(i16 - j16)));
  row.push_back(uint32_t(uint16_t(uint32_t(u16) * v16)) | uint32_t(u16 << 3) << 16);
  row.push_back(v16 == 0 ? 7 : uint32_t(u16 / v16) | uint32_t(u16 % v16) << 16);
  row.push_back(j16 == 0 ? 7 : uint32_t(int16_t(i16 / j16)));
  row.push_back(uint32_t(i16 <= j16) | uint32_t(u16 <= v16) << 1 | uint32_t(~i16) << 2);
  row.insert(row.end(), {bits(float(i16)), bits(float(v8)), uint32_t(int16_t(float(i8) * 3.5f))});
  return row;
}

void add_wide(Row& row, uint32_t w) {
  const int64_t a = int64_t(int32_t(w)) * 1000003, b = int64_t(int16_t(w >> 16)) - 7;
  push64(row, uint64_t(a) * uint64_t(b));
  push64(row, uint64_t(b == 0 ? 1 : a / b));
  const int64_t rest = b == 0 ? 1 : a % b;
  push64(row, uint64_t(rest != 0 && (rest < 0) != (b < 0) ? rest + b : rest));  // OpSMod: the divisor's sign
  push64(row, uint64_t(std::max(a, b) >> 3) ^ uint64_t(std::abs(a)) << 5);
  row.push_back(uint32_t(a < b) | uint32_t(uint64_t(a) < uint64_t(b)) << 1 |
                uint32_t((a > 0) - (a < 0) + 1) << 2);
  row.push_back(bits(float(a)));
  push64(row, double(a));
  const double d = double(a) / 3.0, s = double(b) + 0.25;
  push64(row, std::fma(d, s, 1.5));
  push64(row, std::sqrt(std::abs(d)));
  push64(row, std::min(d, s) - std::floor(s) * (d - std::floor(d)));
  row.push_back(uint32_t(d < s) | uint32_t(d != s) << 1 | uint32_t(int32_t(s)) << 2);
  row.push_back(bits(float(d)));
}

void add_halves(Row& row, uint32_t w) {
  const double h = half_value(uint16_t(w & 0x7bff)), k = half_value(half_bits(int8_t(w >> 8) * 0.125));
  row.push_back(half_bits(h + k) | uint32_t(half_bits(h * k)) << 16);
  row.push_back(half_bits(k == 0 ? h : h / k) | uint32_t(half_bits(std::sqrt(std::abs(k)))) << 16);
  row.push_back(bits(float(half_value(half_bits(h - k)))));
  row.push_back(uint32_t(h < k) | uint32_t(int32_t(k)) << 1);
  row.push_back(half_bits(h) | uint32_t(half_bits(k)) << 16);
}

void add_functions(Row& row, uint32_t w) {
  const double d = double(int64_t(int32_t(w)) * 1000003) / 3.0, s = double(int16_t(w >> 16)) - 7 + 0.25;
  const auto j8 = int8_t(w >> 8);
  int exponent;
  push64(row, std::frexp(d, &exponent));
  row.push_back(uint32_t(exponent));
  double whole;
  push64(row, std::modf(s, &whole));
  push64(row, whole);
  push64(row, std::ldexp(s, j8 * 9));
  push64(row, std::sqrt(s * s + 1 + 4));
  push64(row, std::fma(d, 0.25, s * 0.75));
  push64(row, -(1.0 * (1 / (s * 4 - 2 * 1))));
  const double h = half_value(uint16_t(w & 0x7bff)), k = half_value(half_bits(j8 * 0.125));
  row.push_back(half_bits(std::max(half_value(half_bits(std::ldexp(k, 3))), std::abs(h))));
  row.push_back(half_bits(double(float(std::exp2(k)))));
  row.push_back(uint32_t(int32_t(std::nearbyint(s))) + uint32_t(s >= d) +
                uint32_t((d > 0) - (d < 0) + 1) * 64);
}

TEST_CASE("numbers of 8, 16 and 64 bits, halves and doubles give the bits that C++ gives") {
  RayLab lab({"widths.rgen", {}, {}, {}});
  lab.words_per_lane = 58;
  lab.buffers[10] = inputs();
  std::vector<Mixed> records;
  for (uint32_t lane = 0; lane < RayLab::kLanesUsed; ++lane) records.push_back(mixed(lane));
  lab.buffers[11] = words_of(records);
  check_lanes(lab, [](uint32_t lane) {
    const uint32_t w = inputs()[lane];
    Row row = narrow(w);
    add_wide(row, w);
    add_halves(row, w);
    const Mixed m = mixed(lane);
    row.push_back(uint32_t(m.a) ^ uint32_t(m.b) << 8 ^ uint32_t(m.c) << 4 ^ m.e);
    row.push_back(bits(float(half_value(m.d))));
    row.push_back(uint32_t(m.g) ^ uint32_t(m.f));
    add_functions(row, w);
    return row;
  });
  for (Mixed& m : records)
    m = {int8_t(m.a + 1),
         uint8_t(m.b + 1),
         int16_t(m.c - 1),
         uint16_t(m.d ^ 0x8000),
         uint16_t(m.e - 1),
         m.f * 2,
         -m.g};
  CHECK(lab.buffers_after[11] == words_of(records));
}

}  // namespace
}  // namespace glint::test

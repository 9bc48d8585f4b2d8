// Reads and writes floats of any width, by their definition and in double precision.
// SPDX-License-Identifier: Apache-2.0
#include "tests/ops/numbers.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace glint::test {

double value_of(const FloatFormat& format, uint64_t bits) {
  if (format.fraction == kDouble.fraction) return std::bit_cast<double>(bits);
  const uint64_t fraction = bits & ((uint64_t{1} << format.fraction) - 1);
  const int exponent = int(bits >> format.fraction) & ((1 << format.exponent) - 1);
  const bool negative = format.has_sign && (bits >> (format.exponent + format.fraction) & 1);
  double magnitude = std::ldexp(double(fraction), 1 - format.bias() - format.fraction);
  if (exponent == (1 << format.exponent) - 1)
    magnitude = fraction ? std::numeric_limits<double>::quiet_NaN() : std::numeric_limits<double>::infinity();
  else if (exponent > 0)
    magnitude = std::ldexp(1.0 + std::ldexp(double(fraction), -format.fraction), exponent - format.bias());
  return negative ? -magnitude : magnitude;
}

uint64_t bits_of(const FloatFormat& format, double value) {
  if (format.fraction == kDouble.fraction) return std::bit_cast<uint64_t>(value);
  const uint64_t sign = std::signbit(value) ? uint64_t{1} << (format.exponent + format.fraction) : 0;
  const double magnitude = std::fabs(value);
  const int top = (1 << format.exponent) - 1;
  if (std::isinf(magnitude)) return sign | uint64_t(top) << format.fraction;
  int exponent = magnitude == 0 ? 1 - format.bias() : std::max(std::ilogb(magnitude), 1 - format.bias());
  // The magnitude is a count of units in the last place of its exponent, which nearbyint rounds to even.
  const auto units = uint64_t(std::nearbyint(std::ldexp(magnitude, format.fraction - exponent)));
  const uint64_t bits = units + (uint64_t(exponent + format.bias() - 1) << format.fraction);
  return sign | std::min(bits, uint64_t(top) << format.fraction);
}

uint64_t corner_of(const FloatFormat& format, uint64_t random) {
  const uint64_t sign = random >> 63 << (format.bits() - 1), one = uint64_t(format.bias()) << format.fraction;
  const uint64_t top = ((uint64_t{1} << format.exponent) - 1) << format.fraction;
  const uint64_t fraction = random & ((uint64_t{1} << format.fraction) - 1);
  switch (random >> 58 & 15) {
    case 0:
      return sign;
    case 1:
      return sign | top;
    case 2:
      return sign | top | fraction | 1;
    case 3:
      return sign | fraction;  // a subnormal
    case 4:
      return sign | uint64_t{1} << format.fraction | fraction;  // near the smallest normal number
    case 5:
      return random & (~uint64_t{0} >> (64 - format.bits()));
    case 6:
      return sign | (top - (uint64_t{1} << format.fraction)) | fraction;  // near the largest number
    default:
      return (sign | one) + ((random >> 40 & 3) << format.fraction) + fraction;
  }
}

}  // namespace glint::test

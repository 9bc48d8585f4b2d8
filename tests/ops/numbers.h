// Reads and writes floats of any width, by their definition and in double precision.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace glint::test {

// Describes a binary format of IEEE 754: the bits of the exponent and of the fraction. Formats without a sign
// are those of packed texels.
struct FloatFormat {
  int exponent, fraction;
  bool has_sign = true;
  constexpr int bias() const { return (1 << (exponent - 1)) - 1; }
  constexpr int bits() const { return exponent + fraction + int(has_sign); }
};
inline constexpr FloatFormat kHalf{5, 10}, kBfloat{8, 7}, kSingle{8, 23}, kDouble{11, 52};

// Returns the number that the bits stand for.
double value_of(const FloatFormat& format, uint64_t bits);
// Returns the bits of the number, rounded to nearest even. What is too large becomes infinity.
uint64_t bits_of(const FloatFormat& format, double value);
// Returns bits that are often special: zeros, infinities, NaNs, subnormals, numbers near one, and any bits.
uint64_t corner_of(const FloatFormat& format, uint64_t random);

}  // namespace glint::test

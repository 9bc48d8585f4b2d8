// Models the special-function unit: quadratic interpolation from tables, in fixed point, with the bits that a
// GPU recorded.
// SPDX-License-Identifier: Apache-2.0
//
// The scheme is that of S. Oberman and M. Siu, "A high-performance area-efficient multifunction interpolator"
// (ARITH 2005). The leading mantissa bits choose a segment. The result is C0 + C1 x + C2 square(x) of the
// bits below, where the squarer drops the partial products of low weight. tools/fit_approximate.py explains
// widths and coefficients. The unit takes subnormals for 0 and gives 0 for them. Only files of isa/ops
// include this file (see op_makers.h).
#pragma once
#include <cstddef>
#include <cstdint>

#include "isa/approximate_tables.h"
#include "isa/kernels.h"

namespace glint::isa::GLINT_ISA_PATH {

inline constexpr uint32_t kMantissaMask = 0x007f'ffff;
inline constexpr uint32_t kMagnitudeMask = 0x7fff'ffff;
inline constexpr uint32_t kSignMask = 0x8000'0000;
inline constexpr uint32_t kInfinityBits = 0x7f80'0000;
inline constexpr uint32_t kOneBits = 0x3f80'0000;

// Conditions are masks of 32 bits. For a conditional expression the compiler would branch around the read of
// the table and not vectorise. below(a, b) is a < b for numbers up to 2^31.
[[gnu::always_inline]] inline uint32_t below(uint32_t a, uint32_t b) {
  return uint32_t(int32_t(a - b) >> 31);
}
[[gnu::always_inline]] inline uint32_t is_negative(uint32_t bits) {
  return uint32_t(int32_t(bits) >> 31);
}
[[gnu::always_inline]] inline uint32_t pick(uint32_t mask, uint32_t a, uint32_t b) {
  return b ^ ((a ^ b) & mask);
}
[[gnu::always_inline]] inline uint64_t pick64(uint32_t mask, uint64_t a, uint64_t b) {
  return b ^ ((a ^ b) & uint64_t(int64_t(int32_t(mask))));
}

// Returns the square of x / 2^17 in multiples of 2^-15: the partial products x_i x_j of a folded squarer
// without the columns of lower weight. All products of the seven leading bits stay; of the ten bits below,
// only their products with leading bits stay.
[[gnu::always_inline]] inline uint32_t truncated_square(uint32_t x) {
  const uint32_t leading = x >> 10, low = x & 0x3ff;
  const auto row = [&](int j) { return (0u - (x >> j & 1u)) & (low >> (18 - j)); };
  return 2 * leading * leading + row(10) + row(11) + row(12) + row(13) + row(14) + row(15) + row(16);
}

// Holds a table with one word per segment, so that a lane reads memory once. The word has C0 above bit 36,
// |C1| in 20 bits above bit 16, and |C2|. All segments of a function have the same signs, and C1 and C2 are
// multiples of 2^kStep1 and 2^kStep2.
template <size_t kSize, int kSign1, int kSign2, int kStep1, int kStep2, int kBiasValue>
struct Table {
  static constexpr int64_t kBias = kBiasValue;
  uint64_t word[kSize];

  constexpr explicit Table(const Segment (&rows)[kSize]) : word{} {
    for (size_t i = 0; i < kSize; ++i) {
      const int64_t c1 = kSign1 * rows[i].c1, c2 = kSign2 * rows[i].c2;
      if (rows[i].c0 >> 28 || c1 % (1 << kStep1) || c1 >> (20 + kStep1) || c2 % (1 << kStep2) ||
          c2 >> (16 + kStep2))
        throw "a coefficient does not fit its field";
      word[i] = uint64_t(rows[i].c0) << 36 | uint64_t(c1 >> kStep1) << 16 | uint64_t(c2 >> kStep2);
    }
  }
  // Returns the sum of a segment in 2^-17 of the table's unit. x holds the 17 bits below those that chose the
  // segment.
  [[gnu::always_inline]] int64_t sum(uint32_t segment, uint32_t x) const {
    // Compilers do not vectorise arrays in objects, so a pointer is used.
    const uint64_t* const words = &word[0];
    const uint64_t bits = words[segment];
    const uint64_t first = ((bits >> 16 & 0xf'ffff) * x) << kStep1;
    const uint64_t second = ((bits & 0xffff) * truncated_square(x)) << (kStep2 + 2);
    const uint64_t start = (bits >> 36 << 15) + uint64_t(kBias);
    const uint64_t with_first = kSign1 > 0 ? start + first : start - first;
    return int64_t(kSign2 > 0 ? with_first + second : with_first - second);
  }
};

// The biases are added before sums are cut, and keep the mean error small: 2023, 6114 and 1674 / 2^15, and a
// value just below 0.
inline constexpr Table<128, -1, 1, 1, 0, 8092> kRcp{kRcpSegments};
inline constexpr Table<128, -1, 1, 1, 1, -2> kRsqrt{kRsqrtSegments};
inline constexpr Table<128, 1, -1, 1, 0, -2> kSqrt{kSqrtSegments};
inline constexpr Table<64, 1, 1, 1, 0, 24456> kEx2{kEx2Segments};
inline constexpr Table<64, 1, -1, 3, 1, 6696> kLg2{kLg2Segments};
inline constexpr Table<64, 1, -1, 4, 2, 0> kSin{kSinSegments};
inline constexpr Table<51, 1, -1, 1, 1, 0> kTanh{kTanhSegments};

// Returns the bits of an integer 0 <= v < 2^52 as a double.
[[gnu::always_inline]] inline uint64_t as_double_bits(int64_t v) {
  constexpr uint64_t kTwo52 = 0x4330'0000'0000'0000ull;
  return double_bits(double_of(uint64_t(v) | kTwo52) - double_of(kTwo52));
}

// Returns v * 2^exponent cut to a float, for 0 <= v < 2^52. The result must be normal or 0, or the caller
// drops it.
[[gnu::always_inline]] inline uint32_t cut_to_float(int64_t v, int32_t exponent) {
  const uint32_t bits = uint32_t(as_double_bits(v) >> 29) + (uint32_t(exponent - 896) << 23);
  return bits & ~uint32_t((v - 1) >> 63);
}

// Computes 1 / x.
[[gnu::always_inline]] inline float unit_rcp(float x) {
  const uint32_t bits = float_bits(x), sign = bits & kSignMask, magnitude = bits & kMagnitudeMask;
  const uint32_t mantissa = bits & kMantissaMask;
  const int64_t sum = kRcp.sum(mantissa >> 16, (mantissa & 0xffff) << 1);
  uint32_t out = cut_to_float(sum, 127 - 41 - int32_t(magnitude >> 23));
  out = pick(below(0x7e80'0000, magnitude), 0, out);  // above 2^126 the result is subnormal, or x is infinite
  out = pick(below(magnitude, 0x0080'0000), kInfinityBits, out);  // 0 and subnormals
  out |= sign;
  return float_of(pick(below(kInfinityBits, magnitude), kCanonicalNan, out));
}

// Holds what the two roots share: the exponent of x halved, and the choice between the two tables.
struct RootArgument {
  uint32_t segment, x;
  int32_t half;       // x = m * 4^half, m in [1, 4)
  uint32_t is_power;  // mask: m is 1
};
[[gnu::always_inline]] inline RootArgument root_argument(uint32_t magnitude) {
  const uint32_t mantissa = magnitude & kMantissaMask, exponent = magnitude >> 23;
  const uint32_t odd = ~exponent & 1u;
  return {(mantissa >> 17) + (odd << 6), mantissa & 0x1ffff, (int32_t(exponent - odd) - 127) >> 1,
          below(mantissa | odd, 1)};
}

// Computes 1 / sqrt(x).
[[gnu::always_inline]] inline float unit_rsqrt(float x) {
  const uint32_t bits = float_bits(x), magnitude = bits & kMagnitudeMask;
  const RootArgument a = root_argument(magnitude);
  const int64_t sum = kRsqrt.sum(a.segment, a.x);
  uint32_t out = cut_to_float(sum, -41 - a.half);
  out -= a.is_power;  // the table misses 1 by one ulp
  out = pick(below(kInfinityBits - 1, magnitude), 0, out);
  out = pick(is_negative(bits) | below(kInfinityBits, magnitude), kCanonicalNan, out);
  return float_of(pick(below(magnitude, 0x0080'0000), kInfinityBits | (bits & kSignMask), out));
}

// Computes sqrt(x).
[[gnu::always_inline]] inline float unit_sqrt(float x) {
  const uint32_t bits = float_bits(x), magnitude = bits & kMagnitudeMask;
  const RootArgument a = root_argument(magnitude);
  uint32_t out = cut_to_float(kSqrt.sum(a.segment, a.x), a.half - 41);
  out = pick(below(kInfinityBits - 1, magnitude), kInfinityBits, out);
  out = pick(is_negative(bits) | below(kInfinityBits, magnitude), kCanonicalNan, out);
  return float_of(pick(below(magnitude, 0x0080'0000), bits & kSignMask, out));
}

// Computes log2(x). The sum with the exponent is kept to 2^-36, and a negative sum is complemented bit by
// bit.
[[gnu::always_inline]] inline float unit_lg2(float x) {
  const uint32_t bits = float_bits(x), magnitude = bits & kMagnitudeMask, mantissa = bits & kMantissaMask;
  const int64_t sum = kLg2.sum(mantissa >> 17, mantissa & 0x1ffff);
  // Only the logarithm of 1 is exact.
  const uint32_t is_one = below(kOneBits - 1, magnitude) & below(magnitude, kOneBits + 1);
  // The value is in units of 2^-36 and is 128 too large, so that the shift is one of positive numbers.
  const uint64_t shifted = uint64_t(sum + ((int64_t(magnitude >> 23) + 1) << 41)) >> 5;
  const int64_t total = int64_t(shifted) - (int64_t(128) << 36);
  const uint32_t positive = cut_to_float(total, -36);
  const uint32_t negative = cut_to_float(~total, -36) | kSignMask;
  uint32_t out = pick(is_negative(uint32_t(total >> 32)), negative, positive) & ~is_one;
  out = pick(below(kInfinityBits - 1, magnitude), kInfinityBits, out);
  out = pick(is_negative(bits) | below(kInfinityBits, magnitude), kCanonicalNan, out);
  return float_of(pick(below(magnitude, 0x0080'0000), kSignMask | kInfinityBits, out));
}

// Computes 2^x. The argument is cut to 23 bits after the point, and the fraction of a negative argument is
// complemented bit by bit.
[[gnu::always_inline]] inline float unit_ex2(float x) {
  const uint32_t bits = float_bits(x), magnitude = bits & kMagnitudeMask;
  const int32_t exponent = int32_t(magnitude >> 23) - 127;
  const uint32_t significand = (magnitude & kMantissaMask) | 0x0080'0000;
  const uint32_t right = pick(is_negative(uint32_t(exponent + 31)), 31, uint32_t(-exponent) & 31u);
  const uint32_t fixed =
      pick(is_negative(uint32_t(exponent)), significand >> right, significand << (uint32_t(exponent) & 7u));
  const uint32_t sign = is_negative(bits);
  const uint32_t is_complemented = sign & ~below(fixed & kMantissaMask, 1);
  const uint32_t fraction = (fixed ^ is_complemented) & kMantissaMask;
  const int32_t whole = int32_t(((fixed >> 23) ^ sign) - sign);
  const int32_t scale = whole + int32_t(is_complemented);
  const int64_t sum = kEx2.sum(fraction >> 17, fraction & 0x1ffff);
  const uint32_t is_large = below(0x42ff'ffff, magnitude) | is_negative(uint32_t(scale + 126));  // 128
  uint32_t out = cut_to_float(sum, scale - 40);
  out = pick(is_large, ~sign & kInfinityBits, out);
  return float_of(pick(below(kInfinityBits, magnitude), kCanonicalNan, out));
}

// Computes the sine (quarter = 0) or the cosine (1) of radians. The product with 1 / (2 pi) is rounded toward
// zero to 24 bits, then cut to 25 bits after the point. There is no other range reduction.
[[gnu::always_inline]] inline float unit_sine(float x, uint32_t quarter) {
  const uint32_t bits = float_bits(x), magnitude = bits & kMagnitudeMask;
  const uint32_t is_seen = below(0x007f'ffff, magnitude) & below(magnitude, kInfinityBits);
  // The product has 48 bits, which a double holds exactly.
  const double exact = double(float_of(pick(is_seen, magnitude, 0))) * double(float_of(0x3e22'f983));
  const uint64_t product = double_bits(exact) & 0xffff'ffff'e000'0000ull;
  // From 2^24 turns on, nothing is left after the point.
  const uint32_t is_near = below(uint32_t(product >> 32), 0x4170'0000);
  const double units = double_of(pick64(is_near, product, 0)) * 33554432.0;
  constexpr double kTwo52 = 4503599627370496.0;
  const double nearest = (units + kTwo52) - kTwo52;
  const uint32_t is_above = is_negative(uint32_t(double_bits(units - nearest) >> 32));
  const double floor = nearest - double_of(pick64(is_above, double_bits(1.0), 0));
  const uint32_t turn = uint32_t(double_bits(floor + kTwo52)) + (quarter << 23);
  const uint32_t fraction = (turn ^ (0u - (turn >> 23 & 1u))) & kMantissaMask;
  const int64_t sum = kSin.sum(fraction >> 17, fraction & 0x1ffff);
  const uint32_t sign = (turn << 7 & kSignMask) ^ (quarter == 0 ? bits & kSignMask : 0u);
  return float_of(pick(below(kInfinityBits - 1, magnitude), kCanonicalNan, cut_to_float(sum, -41) ^ sign));
}

// Computes the hyperbolic tangent: x itself below 2^-8, and 1 from 8 on. Each octave between has a table of
// its own.
[[gnu::always_inline]] inline float unit_tanh(float x) {
  const uint32_t bits = float_bits(x), sign = bits & kSignMask, magnitude = bits & kMagnitudeMask;
  struct Octave {
    uint32_t first, segment_bits;
  };
  static constexpr Octave kOctaves[16] = {{0, 0},  {1, 0},  {2, 0},  {3, 1}, {5, 1}, {7, 2}, {11, 2}, {15, 2},
                                          {19, 3}, {27, 4}, {43, 3}, {0, 0}, {0, 0}, {0, 0}, {0, 0},  {0, 0}};
  const Octave* const octaves = &kOctaves[0];
  const Octave octave = octaves[((magnitude >> 23) - 119u) & 15u];
  const uint32_t mantissa = (bits & kMantissaMask) << octave.segment_bits;
  const int64_t sum = kTanh.sum(octave.first + (mantissa >> 23), (mantissa & kMantissaMask) >> 6);
  uint32_t out = cut_to_float(sum, -41);
  out = pick(below(magnitude, 0x3b80'0000), magnitude, out);
  out = pick(below(0x40ff'ffff, magnitude), kOneBits, out);
  return float_of(pick(below(kInfinityBits, magnitude), kCanonicalNan, out | sign));
}

// Returns v * 2^exponent as a double, cut to its high 32 bits, which hold 20 bits of mantissa.
[[gnu::always_inline]] inline uint64_t cut_to_high_word(int64_t v, int32_t exponent) {
  return (as_double_bits(v) & 0xffff'ffff'0000'0000ull) + (uint64_t(uint32_t(exponent)) << 52);
}

inline constexpr uint64_t kSignMask64 = 0x8000'0000'0000'0000ull;
inline constexpr uint64_t kInfinityBits64 = 0x7ff0'0000'0000'0000ull;
inline constexpr uint64_t kUnitNan64 = 0x7fff'ffff'0000'0000ull;

// Computes 1 / x of doubles. Only the high words take part, so a NaN without bits in its high word is an
// infinity.
[[gnu::always_inline]] inline double unit_rcp64(double x) {
  const uint32_t high = uint32_t(double_bits(x) >> 32), magnitude = high & kMagnitudeMask;
  const uint32_t mantissa = magnitude & 0xfffff;
  const int64_t sum = kRcp.sum(mantissa >> 13, (mantissa & 0x1fff) << 4);
  uint64_t out = cut_to_high_word(sum, 1023 - 41 - int32_t(magnitude >> 20));
  out = pick64(below(0x7fd0'0000, magnitude), 0, out);
  out = pick64(below(magnitude, 0x0010'0000), kInfinityBits64, out);
  out |= uint64_t(high & kSignMask) << 32;
  return double_of(pick64(below(0x7ff0'0000, magnitude), kUnitNan64, out));
}

// Computes 1 / sqrt(x) of doubles from the high words.
[[gnu::always_inline]] inline double unit_rsqrt64(double x) {
  const uint32_t high = uint32_t(double_bits(x) >> 32), magnitude = high & kMagnitudeMask;
  const uint32_t mantissa = magnitude & 0xfffff, exponent = magnitude >> 20;
  const uint32_t odd = ~exponent & 1u;
  const int32_t half = (int32_t(exponent - odd) - 1023) >> 1;
  const int64_t sum = kRsqrt.sum((mantissa >> 14) + (odd << 6), (mantissa & 0x3fff) << 3);
  uint64_t out = cut_to_high_word(sum, -41 - half);
  out += uint64_t(below(mantissa | odd, 1) & 1) << 32;  // the correction of unit_rsqrt()
  out = pick64(below(0x7fef'ffff, magnitude), 0, out);
  out = pick64(is_negative(high) | below(0x7ff0'0000, magnitude), kUnitNan64, out);
  return double_of(
      pick64(below(magnitude, 0x0010'0000), kInfinityBits64 | uint64_t(high & kSignMask) << 32, out));
}

// Halves and bfloats go through the unit as floats. Results are cut, not rounded.
[[gnu::always_inline]] inline uint32_t cut_to_half(float x) {
  const uint32_t bits = float_bits(x), magnitude = bits & kMagnitudeMask, exponent = magnitude >> 23;
  const uint32_t normal = (magnitude >> 13) - (112u << 10);
  const uint32_t shift = pick(below(exponent, 95), 31, (126u - exponent) & 31u);
  const uint32_t subnormal = ((magnitude & kMantissaMask) | 0x0080'0000) >> shift;
  uint32_t out = pick(below(magnitude, 0x3880'0000), subnormal, normal);  // 2^-14
  out = pick(below(0x477f'ffff, magnitude), 0x7c00u, out);                // 2^16
  return pick(below(kInfinityBits, magnitude), 0x7fff, out | (bits & kSignMask) >> 16);
}
[[gnu::always_inline]] inline uint32_t cut_to_bfloat(float x) {
  return float_bits(x) >> 16;  // the unit's NaN becomes 0x7fff
}

}  // namespace glint::isa::GLINT_ISA_PATH

// Computes the special functions, branch-free and with the same bits on every SIMD path and machine.
// SPDX-License-Identifier: Apache-2.0
//
// The functions use only +, -, *, /, fma and integer operations. They work in double and round once, so
// results are nearly correctly rounded. Model: the results are more accurate than those of the hardware's
// tables (2 ulp in the ptxas manuals); timing does not depend on them. Only files of isa/ops include this
// file (see op_makers.h).
#pragma once
#include <cstdint>

namespace glint::isa::GLINT_ISA_PATH {

inline constexpr uint32_t kCanonicalNan = 0x7fffffff;  // PTX ISA: the NaN of all results

[[gnu::always_inline]] inline uint32_t float_bits(float x) {
  return __builtin_bit_cast(uint32_t, x);
}
[[gnu::always_inline]] inline float float_of(uint32_t x) {
  return __builtin_bit_cast(float, x);
}
[[gnu::always_inline]] inline uint64_t double_bits(double x) {
  return __builtin_bit_cast(uint64_t, x);
}
[[gnu::always_inline]] inline double double_of(uint64_t x) {
  return __builtin_bit_cast(double, x);
}
[[gnu::always_inline]] inline bool is_nan(float x) {
  return x != x;
}
[[gnu::always_inline]] inline float canonical(float x) {
  return is_nan(x) ? float_of(kCanonicalNan) : x;
}

// Adding and subtracting 1.5 * 2^52 rounds a double of magnitude < 2^51 to an integer. Between both steps,
// the low mantissa bits hold that integer.
inline constexpr double kRoundMagic = 6755399441055744.0;

// Returns x rounded to an integer, with ties to even and the sign of zero kept. Floats from 2^23 on are
// integers.
[[gnu::always_inline]] inline float round_even(float x) {
  const float magnitude = float_of(float_bits(x) & 0x7fff'ffffu);
  const float rounded = (magnitude + 8388608.0f) - 8388608.0f;
  const float kept = magnitude < 8388608.0f ? rounded : magnitude;
  return canonical(float_of(float_bits(kept) | (float_bits(x) & 0x8000'0000u)));
}

// Uses the Taylor coefficients of sin and cos. The truncation error for |r| <= pi/4 is below 1e-11 and 1e-12.
[[gnu::always_inline]] inline double sin_of_reduced(double r) {
  const double s = r * r;
  const double p =
      -1.0 / 6 + s * (1.0 / 120 + s * (-1.0 / 5040 + s * (1.0 / 362880 + s * (-1.0 / 39916800))));
  return r * (1.0 + s * p);  // a product, because r + ... would lose the sign of -0
}
[[gnu::always_inline]] inline double cos_of_reduced(double r) {
  const double s = r * r;
  return 1.0 +
         s * (-0.5 + s * (1.0 / 24 + s * (-1.0 / 720 +
                                          s * (1.0 / 40320 + s * (-1.0 / 3628800 + s * (1.0 / 479001600))))));
}

// Computes sin(x + quarter * pi/2). Measured against libm's double, the error is at most 0.51 ulp for all |x|
// < 2^48 tried. With pi/2 in two doubles (106 bits) and fma, the reduced argument is accurate to about 2^-50
// up to 2^48. Choice: at and beyond 2^48, where neighbouring floats are 2^24 radians apart, x counts as 0
// (PTX promises nothing).
[[gnu::always_inline]] inline float sin_quarter(float x, uint64_t quarter) {
  const bool in_range = x > -281474976710656.0f && x < 281474976710656.0f;
  const double d = in_range ? double(x) : 0.0;
  const double shifted = d * 0.63661977236758134308 + kRoundMagic;  // 2/pi
  const uint64_t k = double_bits(shifted) + quarter;
  const double n = shifted - kRoundMagic;
  double r = __builtin_fma(-n, 0x1.921fb54442d18p+0, d);  // pi/2: leading 53 bits
  r = __builtin_fma(-n, 0x1.1a62633145c07p-54, r);        // pi/2: next 53 bits
  const double s = sin_of_reduced(r);
  const double c = cos_of_reduced(r);
  const double chosen = (k & 1) != 0 ? c : s;
  const float result = float(double_of(double_bits(chosen) ^ ((k & 2) << 62)));
  return x - x == 0.0f ? result : float_of(kCanonicalNan);  // infinities and NaN
}
[[gnu::always_inline]] inline float exact_sin(float x) {
  return sin_quarter(x, 0);
}
[[gnu::always_inline]] inline float exact_cos(float x) {
  return sin_quarter(x, 1);
}

// Computes 2^x with gradual underflow. The measured error is at most 0.51 ulp. The argument is clamped to
// 200, which is beyond overflow and underflow.
[[gnu::always_inline]] inline float exact_ex2(float x) {
  const double high = x < 200.0f ? double(x) : 200.0;
  const double d = high > -200.0 ? high : -200.0;
  const double shifted = d + kRoundMagic;
  const double t = (d - (shifted - kRoundMagic)) * 0.69314718055994530942;  // ln 2
  // e^t for |t| <= ln(2)/2 is a Taylor series with a truncation error below 1e-11.
  const double p =
      1.0 +
      t * (1.0 +
           t * (1.0 / 2 +
                t * (1.0 / 6 +
                     t * (1.0 / 24 +
                          t * (1.0 / 120 + t * (1.0 / 720 + t * (1.0 / 5040 + t * (1.0 / 40320 +
                                                                                   t * (1.0 / 362880)))))))));
  const double scale = double_of((double_bits(shifted) + 1023) << 52);  // the mantissa's low bits hold k
  return is_nan(x) ? float_of(kCanonicalNan) : float(p * scale);
}

// Computes the base-2 logarithm. The measured error is at most 0.51 ulp. A subnormal float is a normal
// double, so it needs no special case.
[[gnu::always_inline]] inline float exact_lg2(float x) {
  const double d = double(x);
  // d is split into 2^e * m with m in [sqrt(1/2), sqrt(2)); subtracting sqrt(1/2)'s mantissa moves the cut
  // there.
  const uint64_t biased = double_bits(d) - 0x3fe6'a09e'667f'3bcdull;
  const uint64_t exponent_bits = biased & 0xfff0'0000'0000'0000ull;
  const double m = double_of(double_bits(d) - exponent_bits);
  // e becomes a double without a 64-bit conversion: e + 2^11 is put into the mantissa of 2^52.
  const double e = double_of(((biased + 0x8000'0000'0000'0000ull) >> 52) | 0x4330'0000'0000'0000ull) -
                   (4503599627370496.0 + 2048.0);
  // The series is ln m = 2 atanh(s) with s = (m - 1) / (m + 1), |s| < 0.172.
  const double s = (m - 1.0) / (m + 1.0);
  const double q = s * s;
  const double p =
      1.0 + q * (1.0 / 3 + q * (1.0 / 5 + q * (1.0 / 7 + q * (1.0 / 9 + q * (1.0 / 11 + q * (1.0 / 13))))));
  const float finite = float(e + s * p * 2.88539008177792681472);  // 2 / ln 2
  const float positive = x - x == 0.0f ? finite : x;               // infinity
  const float other = x == 0.0f ? -__builtin_inff() : float_of(kCanonicalNan);
  return x > 0.0f ? positive : other;
}

// Computes 1 / sqrt(x) in double arithmetic and rounds once; the measured error is 0.5 ulp. rsqrt(-0) is
// -inf, as in PTX.
[[gnu::always_inline]] inline float exact_rsqrt(float x) {
  const float root = float(1.0 / __builtin_sqrt(double(x)));
  return canonical(root);
}

}  // namespace glint::isa::GLINT_ISA_PATH

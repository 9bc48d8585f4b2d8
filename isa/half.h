// Converts floats of 16 bits to single precision exactly, and back with one rounding to nearest even.
// SPDX-License-Identifier: Apache-2.0
//
// The functions are branch-free, so that loops over lanes become vectors. They use integer operations and one
// addition, so that every path gives the same bits. Only files of isa/ops include this file (see
// op_makers.h).
#pragma once
#include <cstdint>

#include "isa/op_makers.h"

namespace glint::isa::GLINT_ISA_PATH {

inline constexpr uint32_t kCanonicalNan16 = 0x7fff;  // PTX's NaN result for f16 and bf16

[[gnu::always_inline]] inline bool is_nan(Half x) {
  return (x.bits & 0x7fffu) > 0x7c00u;
}
[[gnu::always_inline]] inline bool is_nan(Bfloat x) {
  return (x.bits & 0x7fffu) > 0x7f80u;
}

// Converts the f16 in the upper half of a word exactly. A NaN stays a NaN. No step produces a subnormal
// float, with which hosts are slow. The exponent is raised so far that infinities and NaNs become those of a
// float, and is multiplied back. Subnormals thereby get a leading 1 that they do not have, which is
// subtracted again; with kFtz they become zeros.
template <bool kFtz = false>
[[gnu::always_inline]] inline float float_of_upper_half(uint32_t word) {
  const float raised = float_of((word >> 3 & 0x0fff'e000u) | 0x7000'0000u);
  const uint32_t normal = float_bits(raised * 0x1p-112f);
  const uint32_t subnormal = kFtz ? 0u : float_bits(raised * 0x1p-111f - 0x1p-14f);
  const uint32_t magnitude = (word & 0x7c00'0000u) == 0 ? subnormal : normal;
  return float_of((magnitude & 0x7fff'ffffu) | (word & 0x8000'0000u));
}

[[gnu::always_inline]] inline float to_float(Half x) {
  return float_of_upper_half(uint32_t(x.bits) << 16);
}
// The conversion is exact, because the bits of a bf16 are the upper half of a float's.
[[gnu::always_inline]] inline float to_float(Bfloat x) {
  return float_of(uint32_t(x.bits) << 16);
}

// Rounds once to nearest even, also to subnormal results. From 65520 on the result is infinity, and NaN gives
// 0x7fff. The host must round to nearest meanwhile. With kFtz, results below 2^-14 - 2^-26 become zeros of
// their sign. These are the results that f16 with an unbounded exponent would round to less than 2^-14.
//
// When a float is added to 2^13 times its own power of two (2^-14 at least, where f16 becomes subnormal), it
// is rounded to the steps of an f16, and the low bits of the sum count these steps.
template <bool kFtz = false>
[[gnu::always_inline]] inline uint32_t half_bits(float x) {
  const uint32_t bits = float_bits(x) & 0x7fff'ffffu;
  // Larger values become 65536, whose exponent is that of infinity.
  const uint32_t magnitude = bits < 0x4780'0000u ? bits : 0x4780'0000u;
  const uint32_t own = magnitude & 0x7f80'0000u;
  const uint32_t power = own > 0x3880'0000u ? own : 0x3880'0000u;
  const uint32_t step = power + (13u << 23);
  const uint32_t steps = float_bits(float_of(magnitude) + float_of(step)) - step;
  const uint32_t rounded = steps + ((power - 0x3880'0000u) >> 13);
  const uint32_t kept = kFtz && bits < 0x387f'f000u ? 0u : rounded;
  const uint32_t number = kept | (float_bits(x) >> 16 & 0x8000u);
  return bits > 0x7f80'0000u ? kCanonicalNan16 : number;
}
// The exponents of a bf16 are those of a float, so a carry makes infinity, and subnormals need no care.
[[gnu::always_inline]] inline uint32_t bfloat_bits(float x) {
  const uint32_t bits = float_bits(x);
  const uint32_t rounded = (bits + 0x7fffu + ((bits >> 16) & 1u)) >> 16;
  return (bits & 0x7fff'ffffu) > 0x7f80'0000u ? kCanonicalNan16 : rounded;
}

[[gnu::always_inline]] inline Half to_half(float x) {
  return {uint16_t(half_bits(x))};
}
[[gnu::always_inline]] inline Bfloat to_bfloat(float x) {
  return {uint16_t(bfloat_bits(x))};
}

}  // namespace glint::isa::GLINT_ISA_PATH

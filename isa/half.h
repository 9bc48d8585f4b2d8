// Floats of 16 bits to and from single precision: exact one way, rounded once to nearest even the other.
//
// Branch-free, so that loops over lanes become vectors; integer work and one addition, so that every path
// gives the same bits. Included only by isa/ops/*.cpp (see op_makers.h).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "isa/op_makers.h"

namespace glint::isa::GLINT_ISA_PATH {

inline constexpr uint16_t kCanonicalNan16 = 0x7fff;  // of f16 and bf16: PTX's NaN results

[[gnu::always_inline]] inline bool is_nan(Half x) {
  return (x.bits & 0x7fffu) > 0x7c00u;
}
[[gnu::always_inline]] inline bool is_nan(Bfloat x) {
  return (x.bits & 0x7fffu) > 0x7f80u;
}

// Exact. Infinities stay; a NaN keeps sign and payload (its bits moved up by 13) and is not quieted.
[[gnu::always_inline]] inline float to_float(Half x) {
  const uint32_t bits = x.bits;
  const uint32_t shifted = (bits & 0x7fffu) << 13;
  // The exponent moves from bias 15 to 127. Subnormals: 2^-14 more makes them normal floats, and is taken
  // off again; rounding down that leaves a -0.
  const uint32_t normal = shifted + 0x3800'0000u;
  const uint32_t subnormal =
      float_bits(float_of(shifted + 0x3880'0000u) - float_of(0x3880'0000u)) & 0x7fff'ffffu;
  const uint32_t finite = shifted < 0x0080'0000u ? subnormal : normal;
  const uint32_t magnitude = shifted >= 0x0f80'0000u ? shifted + 0x7000'0000u : finite;
  return float_of(magnitude | (bits & 0x8000u) << 16);
}
// Exact; the bits of a bf16 are the upper half of a float's.
[[gnu::always_inline]] inline float to_float(Bfloat x) {
  return float_of(uint32_t(x.bits) << 16);
}

// Rounds to nearest even, once, subnormal results too; from 65520 on infinity; NaN gives 0x7fff. The host
// must round to nearest meanwhile.
[[gnu::always_inline]] inline Half to_half(float x) {
  const uint32_t magnitude = float_bits(x) & 0x7fff'ffffu;
  const uint32_t sign = (float_bits(x) >> 16) & 0x8000u;
  // Half an f16 step less one, and one more where the last bit is odd: ties go to even. A carry moves into
  // the exponent.
  const uint32_t normal = (magnitude - 0x3800'0000u + 0x0fffu + ((magnitude >> 13) & 1u)) >> 13;
  // Floats from 0.5 to 1 are 2^-24 apart, as subnormal f16 are: the addition rounds.
  const uint32_t subnormal = float_bits(float_of(magnitude) + 0.5f) - 0x3f00'0000u;
  const uint32_t finite = magnitude < 0x3880'0000u ? subnormal : normal;
  const uint32_t number = (magnitude >= 0x4780'0000u ? 0x7c00u : finite) | sign;
  return {uint16_t(magnitude > 0x7f80'0000u ? kCanonicalNan16 : number)};
}
// The same; a bf16's exponents are a float's, so a carry makes infinity and subnormals need no care.
[[gnu::always_inline]] inline Bfloat to_bfloat(float x) {
  const uint32_t bits = float_bits(x);
  const uint32_t rounded = (bits + 0x7fffu + ((bits >> 16) & 1u)) >> 16;
  return {uint16_t((bits & 0x7fff'ffffu) > 0x7f80'0000u ? kCanonicalNan16 : rounded)};
}

}  // namespace glint::isa::GLINT_ISA_PATH

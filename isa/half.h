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

inline constexpr uint32_t kCanonicalNan16 = 0x7fff;  // of f16 and bf16: PTX's NaN results

[[gnu::always_inline]] inline bool is_nan(Half x) {
  return (x.bits & 0x7fffu) > 0x7c00u;
}
[[gnu::always_inline]] inline bool is_nan(Bfloat x) {
  return (x.bits & 0x7fffu) > 0x7f80u;
}

// The f16 in the upper half of a word, exactly: a multiplication moves the exponent from bias 15 to 127 and
// makes subnormals normal (with flush to zero, zeros). A NaN keeps sign and payload and is not quieted.
[[gnu::always_inline]] inline float float_of_upper_half(uint32_t word) {
  const float moved = float_of(uint32_t(int32_t(word) >> 3) & 0x8fff'e000u) * 0x1p112f;
  return float_of(float_bits(moved) | ((word & 0x7c00'0000u) == 0x7c00'0000u ? 0x7f80'0000u : 0u));
}

[[gnu::always_inline]] inline float to_float(Half x) {
  return float_of_upper_half(uint32_t(x.bits) << 16);
}
// Exact; the bits of a bf16 are the upper half of a float's.
[[gnu::always_inline]] inline float to_float(Bfloat x) {
  return float_of(uint32_t(x.bits) << 16);
}

// Rounds to nearest even, once, subnormal results too; from 65520 on infinity; NaN gives 0x7fff. The host
// must round to nearest meanwhile.
//
// 2^13 of the float's own power of two (2^-14 at least, where f16 becomes subnormal) is added and taken off:
// the sum's steps are an f16's. What is left is an f16 in all but exponent bias; 65536 has the exponent of
// infinity.
[[gnu::always_inline]] inline uint32_t half_bits(float x) {
  const float magnitude = float_of(float_bits(x) & 0x7fff'ffffu);
  const uint32_t power = float_bits(x) & 0x7f80'0000u;
  const float step = float_of((power > 0x3880'0000u ? power : 0x3880'0000u) + (13u << 23));
  const float rounded = (magnitude + step) - step;
  const float finite = rounded < 65536.0f ? rounded : 65536.0f;
  const uint32_t number = float_bits(finite * 0x1p-112f) >> 13 | (float_bits(x) >> 16 & 0x8000u);
  return is_nan(x) ? kCanonicalNan16 : number;
}
// The same with subnormal results flushed: those below 2^-14 - 2^-26, which f16 with an unbounded exponent
// would round to less than 2^-14.
[[gnu::always_inline]] inline uint32_t flushed_half_bits(float x) {
  const uint32_t magnitude = float_bits(x) & 0x7fff'ffffu;
  return half_bits(float_of(magnitude < 0x387f'f000u ? float_bits(x) & 0x8000'0000u : float_bits(x)));
}
// A bf16's exponents are a float's, so a carry makes infinity, and subnormals need no care.
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

// Adds products of floats as tensor cores of an H200 do: all at once, with bits below the largest cut off.
// SPDX-License-Identifier: Apache-2.0
//
// The rule: the products of all k and the summand are exact numbers, each with an exponent, which is the sum
// of its factors' exponents (a product may be 2 or more; a subnormal factor has the least exponent). All are
// cut off, toward zero, 25 bits below the units of the largest exponent, and added exactly. A
// single-precision result is cut off, and a half is rounded to nearest even. NaN results are 0x7fffffff or
// 0x7fff. Factors in tf32 lose their low 13 bits first.
//
// Source: an H200 gave the same bits for 2.1 million sums of eight forms (a part of them is in
// tests/isa/golden/tensor). Fasi, Higham, Mikaitis and Pranesh, "Numerical behavior of NVIDIA tensor cores"
// (2021), found the same way of adding on earlier parts, with fewer bits and shorter sums. Model: Glint adds
// as the H200 does on every preset.
//
// Only files of isa/ops include this file (see op_makers.h).
#pragma once
#include <cstdint>

#include "isa/half.h"
#include "isa/matrix_fragments.h"

namespace glint::isa::GLINT_ISA_PATH {

// Describes a float: `kDropped` low bits of its word mean nothing.
template <int kExponent, int kFraction, int kDrop = 0>
struct FloatFormat {
  static constexpr int kExponentBits = kExponent, kFractionBits = kFraction, kDropped = kDrop;
  static constexpr int kBits = 1 + kExponent + kFraction + kDrop;
  static constexpr uint32_t kInfinity = ((1u << kExponent) - 1) << kFraction;
  static constexpr int kBias = (1 << (kExponent - 1)) - 1;
};
using FormatF16 = FloatFormat<5, 10>;
using FormatBf16 = FloatFormat<8, 7>;
using FormatTf32 = FloatFormat<8, 10, 13>;
using FormatF32 = FloatFormat<8, 23>;

inline constexpr int kKeptBits = 25;    // below the units of the largest exponent
inline constexpr int kNothing = -4096;  // the exponent of zeros: no sum of two finite exponents is as low

// Holds kCount numbers (-1)^sign * fraction * 2^(exponent - kFractionBits); `sign` is 0 or all ones.
template <int kCount>
struct FloatParts {
  alignas(64) uint32_t fraction[kCount];
  alignas(64) int32_t exponent[kCount];
  alignas(64) uint32_t sign[kCount];
};

// Takes words apart. Returns whether one of them is an infinity or a NaN.
template <class F, int kCount>
[[gnu::always_inline]] inline bool take_apart(const uint32_t* words, FloatParts<kCount>& out) {
  uint32_t special = 0;
  for (int i = 0; i < kCount; ++i) {
    const uint32_t word = words[i] >> F::kDropped;
    const uint32_t field = (word & F::kInfinity) >> F::kFractionBits,
                   low = word & ((1u << F::kFractionBits) - 1);
    const uint32_t fraction = low | (field != 0 ? 1u << F::kFractionBits : 0u);
    const int32_t exponent = int32_t(field != 0 ? field : 1u) - F::kBias;
    out.fraction[i] = fraction;
    out.exponent[i] = fraction != 0 ? exponent : kNothing;
    out.sign[i] = 0u - (word >> (F::kExponentBits + F::kFractionBits));
    special |= field == F::kInfinity >> F::kFractionBits ? 1u : 0u;
  }
  return special != 0;
}

// Returns the float whose magnitude is magnitude * 2^(exponent - kKeptBits), cut off to 24 bits. With
// kSticky, its last bit is also set when something was cut off, so that it can be rounded again to a half.
template <bool kSticky>
[[gnu::always_inline]] inline uint32_t cut_off(uint32_t magnitude, int32_t exponent, uint32_t sign) {
  const uint64_t exact = double_bits(double(magnitude));
  const int32_t own = int32_t(exact >> 52) - 1023 + exponent - kKeptBits;
  const uint32_t low = uint32_t(exact >> 29) & 0x7f'ffffu,
                 sticky = kSticky && (exact & 0x1fff'ffffu) != 0 ? 1u : 0u;
  const uint32_t whole = low | 0x80'0000u, below = uint32_t(-126 - own);
  const uint32_t subnormal = below < 32 ? whole >> (below & 31) : 0u;
  const uint32_t normal = uint32_t(own + 127) << 23 | low | sticky;
  const uint32_t finite = own < -126 ? subnormal : normal;
  const uint32_t bits = own > 127 ? 0x7f80'0000u : finite;
  return magnitude != 0 ? bits | (sign & 0x8000'0000u) : 0u;
}

// Adds up for the kM rows of one column: the summands of C, and kK products.
template <class F, class FC, class S>
[[gnu::always_inline]] inline void add_column(const FloatParts<S::kA>& a, const FloatParts<S::kB>& b,
                                              const FloatParts<S::kC>& c, int column, uint32_t* out) {
  constexpr int kM = S::kM, kUp = kKeptBits - 2 * F::kFractionBits, kUpC = kKeptBits - FC::kFractionBits;
  alignas(64) uint32_t product[S::kK][kM], sign[S::kK][kM];
  alignas(64) int32_t exponent[S::kK][kM], largest[kM];
  const int first = column * kM;
  for (int m = 0; m < kM; ++m) largest[m] = c.exponent[first + m];
  for (int k = 0; k < S::kK; ++k) {
    const uint32_t fraction = b.fraction[k * S::kN + column], its_sign = b.sign[k * S::kN + column];
    const int32_t its_exponent = b.exponent[k * S::kN + column];
    for (int m = 0; m < kM; ++m) {
      const int32_t e = a.exponent[k * kM + m] + its_exponent;
      product[k][m] = (a.fraction[k * kM + m] * fraction) << kUp;
      sign[k][m] = a.sign[k * kM + m] ^ its_sign;
      exponent[k][m] = e;
      largest[m] = e > largest[m] ? e : largest[m];
    }
  }
  // The sums of each sign stay below 2^32: 16 products are below 2^27, and the summand is below 2^26.
  alignas(64) uint32_t positive[kM] = {}, negative[kM] = {};
  const auto add = [&](int m, uint32_t magnitude, int32_t its_exponent, uint32_t its_sign) {
    const auto below = uint32_t(largest[m] - its_exponent);
    const uint32_t kept = below < 32 ? magnitude >> (below & 31) : 0u;
    positive[m] += kept & ~its_sign;
    negative[m] += kept & its_sign;
  };
  for (int m = 0; m < kM; ++m)
    add(m, c.fraction[first + m] << kUpC, c.exponent[first + m], c.sign[first + m]);
  for (int k = 0; k < S::kK; ++k)
    for (int m = 0; m < kM; ++m) add(m, product[k][m], exponent[k][m], sign[k][m]);
  constexpr bool kHalf = FC::kBits == 16;
  for (int m = 0; m < kM; ++m) {
    const bool minus = negative[m] > positive[m];
    const uint32_t bits = cut_off<kHalf>(minus ? negative[m] - positive[m] : positive[m] - negative[m],
                                         largest[m], minus ? ~0u : 0u);
    out[first + m] = kHalf ? half_bits(float_of(bits)) : bits;
  }
  // A sum of zeros is negative when all of them are.
  for (int m = 0; m < kM; ++m) {
    if (largest[m] > kNothing / 2) continue;
    uint32_t all = c.sign[first + m];
    for (int k = 0; k < S::kK; ++k) all &= sign[k][m];
    out[first + m] = all & (1u << (FC::kBits - 1));
  }
}

// Returns the result of a sum with infinities or NaNs, or `otherwise`.
template <class F, class FC, class S>
inline uint32_t special_sum(const uint32_t* a, const uint32_t* b, uint32_t c, int row, int column,
                            uint32_t otherwise) {
  const auto is_nan = [](uint32_t magnitude) { return magnitude > F::kInfinity; };
  constexpr uint32_t kSignC = 1u << (FC::kBits - 1), kSign = 1u << (F::kExponentBits + F::kFractionBits);
  bool nan = (c & ~kSignC) > FC::kInfinity, plus = false, minus = false;
  if ((c & ~kSignC) == FC::kInfinity) ((c & kSignC) != 0 ? minus : plus) = true;
  for (int k = 0; k < S::kK; ++k) {
    const uint32_t x = a[k * S::kM + row] >> F::kDropped, y = b[k * S::kN + column] >> F::kDropped;
    const uint32_t size_x = x & ~kSign, size_y = y & ~kSign;
    if (size_x < F::kInfinity && size_y < F::kInfinity) continue;
    nan |= is_nan(size_x) || is_nan(size_y) || size_x == 0 || size_y == 0;
    (((x ^ y) & kSign) != 0 ? minus : plus) = true;
  }
  if (nan || (plus && minus)) return FC::kBits == 16 ? kCanonicalNan16 : kCanonicalNan;
  return plus || minus ? FC::kInfinity | (minus ? kSignC : 0u) : otherwise;
}

// Handles D = A * B + C, with factors in the format F and sums in the format FC.
template <class F, class FC, class S>
[[gnu::flatten]] void multiply_floats(Warp& warp, const Inst& inst, const OpRow&) {
  constexpr int kSums = FC::kBits == 16 ? S::kHalves : 2 * S::kHalves;  // registers of C
  const Slot *const d = &inst.operand.front(), *const at_a = d + kSums, *const at_b = at_a + S::kRegistersA,
                    *const at_c = at_b + S::kRegistersB;
  alignas(64) uint32_t a[S::kA], b[S::kB], c[S::kC], out[S::kC];
  read_a<S>(warp, at_a, a);
  read_b<S>(warp, at_b, b);
  read_c<S, FC::kBits>(warp, at_c, c);
  FloatParts<S::kA> of_a;
  FloatParts<S::kB> of_b;
  FloatParts<S::kC> of_c;
  bool special = take_apart<F>(a, of_a);
  special |= take_apart<F>(b, of_b);
  special |= take_apart<FC>(c, of_c);
  for (int column = 0; column < S::kN; ++column) add_column<F, FC, S>(of_a, of_b, of_c, column, out);
  if (special)
    for (int i = 0; i < S::kC; ++i) out[i] = special_sum<F, FC, S>(a, b, c[i], i % S::kM, i / S::kM, out[i]);
  write_d<S, FC::kBits>(warp, d, out);
}

}  // namespace glint::isa::GLINT_ISA_PATH

// Converts between integers and floats, rounded once in any direction.
// SPDX-License-Identifier: Apache-2.0
//
// The functions are branch-free, so that loops over lanes become vectors. They use only +, -, comparisons and
// bits, so that every path gives the same result. The host must round to nearest, except where a function
// says otherwise. Only files of isa/ops include this file.
#pragma once
#include <cstdint>
#include <type_traits>

#include "isa/half.h"
#include "isa/integer_kernels.h"
#include "isa/rounding.h"

namespace glint::isa::GLINT_ISA_PATH {

inline constexpr uint64_t kSign64 = 1ull << 63;

// Returns the integer that a rounding direction selects, from the nearest integer to x. A zero may lose its
// sign.
template <Round kRound>
[[gnu::always_inline]] inline double directed(double nearest, double x) {
  if constexpr (kRound == Round::Nearest) return nearest;
  const double below = nearest > x ? nearest - 1.0 : nearest;
  const double above = nearest < x ? nearest + 1.0 : nearest;
  if constexpr (kRound == Round::Down) return below;
  if constexpr (kRound == Round::Up) return above;
  return x < 0.0 ? above : below;
}
// Returns x rounded to an integer, for |x| < 2^51. NaN stays NaN.
template <Round kRound>
[[gnu::always_inline]] inline double to_integral(double x) {
  return directed<kRound>((x + kRoundMagic) - kRoundMagic, x);
}
// Rounds any double to an integer; from 2^52 on, doubles are integers. It keeps the sign of zero. A NaN keeps
// its payload and becomes quiet.
template <Round kRound>
[[gnu::always_inline]] inline double to_any_integral(double x) {
  const double magnitude = double_of(double_bits(x) & ~kSign64);
  const bool is_small = magnitude < kTwo52;
  const uint64_t nearest = double_bits((magnitude + kTwo52) - kTwo52) | (double_bits(x) & kSign64);
  const double rounded = directed<kRound>(double_of(nearest), x);
  const uint64_t kept =
      is_small ? (double_bits(rounded) & ~kSign64) | (double_bits(x) & kSign64) : double_bits(x);
  const uint64_t quiet = magnitude != magnitude ? 0x0008'0000'0000'0000ull : 0;
  return double_of(kept | quiet);
}

// Gives the result for a NaN, as recorded: 0 for sources of 32 and 16 bits and results of at most 32 bits;
// otherwise only the sign bit of the result is set.
template <class D, bool kFromDouble>
inline constexpr D kFromNan = kFromDouble || sizeof(D) == 8 ? D(Unsigned<D>(1) << (kBits<D> - 1)) : D(0);

// Rounds and clamps to D. For up to 32 bits, it returns the bits of a register, extended by the sign. The
// clamp comes first; its bounds are integers, so rounding stays within them.
template <class D, Round kRound, bool kFromDouble>
[[gnu::always_inline]] inline auto to_integer(double x) {
  constexpr D kLow = std::is_signed_v<D> ? D(Unsigned<D>(1) << (kBits<D> - 1)) : D(0), kHigh = D(~kLow);
  if constexpr (sizeof(D) < 8) {
    const double above = x < double(kLow) ? double(kLow) : x;
    const double inside = above > double(kHigh) ? double(kHigh) : above;
    // The low end holds the integer in two's complement.
    const uint64_t bits = double_bits(to_integral<kRound>(inside) + kRoundMagic);
    return uint32_t(x != x ? uint64_t(int64_t(kFromNan<D, kFromDouble>)) : bits);
  } else {
    constexpr double kLimit = std::is_signed_v<D> ? 0x1p63 : 0x1p64,
                     kFloor = std::is_signed_v<D> ? -0x1p63 : 0.0;
    const double whole = to_any_integral<kRound>(x);
    const bool is_inside = whole >= kFloor && whole < kLimit;
    const D inside = D(is_inside ? whole : 0.0);
    const D clamped = whole >= kLimit ? kHigh : whole < kFloor ? kLow : inside;
    return x != x ? kFromNan<D, kFromDouble> : clamped;
  }
}

[[gnu::always_inline]] inline float flushed(float x) {
  return (float_bits(x) & 0x7f80'0000u) == 0 ? float_of(float_bits(x) & 0x8000'0000u) : x;
}
// Returns x clamped to [0, 1]. NaN and -0 give +0.
[[gnu::always_inline]] inline float saturated(float x) {
  const float positive = x > 0.0f ? x : 0.0f;
  return positive < 1.0f ? positive : 1.0f;
}
[[gnu::always_inline]] inline double saturated(double x) {
  const double positive = x > 0.0 ? x : 0.0;
  return positive < 1.0 ? positive : 1.0;
}

// These return sign and magnitude of an integer of up to 64 bits.
template <class S>
[[gnu::always_inline]] inline uint64_t magnitude_of(S x) {
  const uint64_t wide = uint64_t(x);  // sign-extended
  return std::is_signed_v<S> && x < 0 ? 0 - wide : wide;
}
template <class S>
[[gnu::always_inline]] inline uint64_t sign_of(S x) {
  return std::is_signed_v<S> && x < 0 ? kSign64 : 0;
}

// Holds an integer as a double. If the integer is large, its low bits are gathered in one bit that says
// whether they were zero. The double is then exact, and rounding it to less than 40 bits gives the same
// result as rounding the integer. `scale` makes up for the removed bits.
struct Reduced {
  double value;
  float scale;
};
template <class S>
[[gnu::always_inline]] inline Reduced reduced(S x) {
  const uint64_t m = magnitude_of(x);
  const bool is_large = sizeof(S) == 8 && m >= (1ull << 52);
  const uint64_t kept = is_large ? (m >> 12) | uint64_t((m & 0xfff) != 0) : m;
  // The sign is set by bits, because rounding down makes a -0 of 0.
  const uint64_t bits = (double_bits(small_double(kept)) & ~kSign64) | sign_of(x);
  return {double_of(bits), is_large ? 4096.0f : 1.0f};
}
// Rounds in the host's present rounding direction.
template <class S>
[[gnu::always_inline]] inline float rounded_float(S x) {
  if constexpr (sizeof(S) <= 2) return float(int32_t(x));
  const Reduced r = reduced(x);
  return (x == 0 ? 0.0f : float(r.value)) * r.scale;
}
template <class S>
[[gnu::always_inline]] inline double rounded_double(S x) {
  if constexpr (sizeof(S) <= 2 || std::is_same_v<S, int32_t>) {
    return double(int32_t(x));
  } else if constexpr (sizeof(S) < 8) {
    return x == 0 ? 0.0 : double_of(double_bits(small_double(magnitude_of(x))) | sign_of(x));
  } else {
    const uint64_t m = magnitude_of(x), sign = sign_of(x);
    constexpr double kTwo84 = 0x1p84;  // its last mantissa bit counts 2^32
    const double high = double_of(0x4530'0000'0000'0000ull | m >> 32) - kTwo84;
    const double low = small_double(uint32_t(m));
    const double sum = double_of(double_bits(high) ^ sign) + double_of(double_bits(low) ^ sign);
    return x == 0 ? 0.0 : sum;
  }
}

// Rounds a double to odd: towards zero, with the last bit set if the result was not exact. Rounding it again
// to fewer bits gives the same result as rounding the double (Boldo and Melquiond 2008).
[[gnu::always_inline]] inline float odd_float(double x) {
  const float nearest = float(x);
  const double back = double(nearest);
  const double magnitude = double_of(double_bits(x) & ~kSign64),
               taken = double_of(double_bits(back) & ~kSign64);
  const uint32_t toward_zero = float_bits(nearest) - (taken > magnitude ? 1u : 0u);
  const bool is_off = taken > magnitude || taken < magnitude;
  return float_of(toward_zero | (is_off ? 1u : 0u));
}

// Returns 1 if a directed rounding of an inexact number goes away from zero. `sign` and `is_inexact` are 0 or
// 1.
template <Round kRound>
[[gnu::always_inline]] inline uint32_t goes_away(uint32_t sign, uint32_t is_inexact) {
  if constexpr (kRound == Round::Zero) return 0;
  return (kRound == Round::Down ? sign : sign ^ 1) & is_inexact;
}
// Rounds once. Beyond the range, the direction decides between infinity and the largest number. NaN gives
// 0x7fff.
template <Round kRound>
[[gnu::always_inline]] inline Half rounded_half(float x) {
  if constexpr (kRound == Round::Nearest) return to_half(x);
  const uint32_t bits = float_bits(x), magnitude = bits & 0x7fff'ffffu, sign = bits >> 31;
  // A subnormal result has units of 2^-24: a float below 2^-14 is shifted by 14 or more.
  const uint32_t exponent = magnitude >> 23, gap = 126 - exponent > 31 ? 31 : 126 - exponent;
  const uint32_t mantissa = (magnitude & 0x007f'ffffu) | (exponent != 0 ? 0x0080'0000u : 0u);
  const bool is_small = magnitude < 0x3880'0000u;
  const uint32_t shift = is_small ? gap : 13;
  const uint32_t whole = is_small ? mantissa : magnitude - 0x3800'0000u;
  const uint32_t kept = whole >> shift;
  const uint32_t away = goes_away<kRound>(sign, (kept << shift) != whole ? 1u : 0u);
  const uint32_t finite = magnitude >= 0x4780'0000u ? 0x7bffu + goes_away<kRound>(sign, 1) : kept + away;
  const uint32_t number = (magnitude == 0x7f80'0000u ? 0x7c00u : finite) | sign << 15;
  return {uint16_t(magnitude > 0x7f80'0000u ? kCanonicalNan16 : number)};
}
template <Round kRound>
[[gnu::always_inline]] inline Bfloat rounded_bfloat(float x) {
  if constexpr (kRound == Round::Nearest) return to_bfloat(x);
  const uint32_t bits = float_bits(x), magnitude = bits & 0x7fff'ffffu;
  const uint32_t number = (bits >> 16) + goes_away<kRound>(bits >> 31, (bits & 0xffff) != 0 ? 1u : 0u);
  return {uint16_t(magnitude > 0x7f80'0000u ? kCanonicalNan16 : number)};
}

}  // namespace glint::isa::GLINT_ISA_PATH

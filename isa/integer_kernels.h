// Builds integer parts of the ops: counts, fields, wide products, quotients without division instructions.
// SPDX-License-Identifier: Apache-2.0
//
// The functions are branch-free, so that loops over lanes become vectors. Only files of isa/ops include this
// file (see op_makers.h).
#pragma once
#include <cstdint>
#include <type_traits>

#include "isa/kernels.h"

namespace glint::isa::GLINT_ISA_PATH {

// Names the type in which arithmetic modulo 2^bits of T is done: unsigned, and no narrower than int.
template <class T>
using Wrapping = std::conditional_t<sizeof(T) == 8, uint64_t, uint32_t>;
template <class T>
using Unsigned = std::make_unsigned_t<T>;
template <class T>
inline constexpr int kBits = int(sizeof(T)) * 8;

// Adds neighbouring fields of 1, 2, 4 ... bits. It does not use the product that adds all bytes at once:
// compilers recognise that as a population count, which has no vector form on most machines.
template <class T>
[[gnu::always_inline]] inline uint32_t count_ones(T x) {
  x -= (x >> 1) & T(0x5555'5555'5555'5555ull);
  x = (x & T(0x3333'3333'3333'3333ull)) + ((x >> 2) & T(0x3333'3333'3333'3333ull));
  x = (x + (x >> 4)) & T(0x0f0f'0f0f'0f0f'0f0full);
  x += x >> 8;
  x += x >> 16;
  if constexpr (sizeof(T) == 8) x += x >> 32;
  return uint32_t(x & 0xff);
}

inline constexpr double kTwo52 = 4503599627370496.0;
inline constexpr uint64_t kTwo52Bits = 0x4330'0000'0000'0000;
// Converts exactly below 2^52: the number is the mantissa of a double from 2^52 on. The host must round to
// nearest, up or to zero; rounding down makes a -0 of 0.
[[gnu::always_inline]] inline double small_double(uint64_t x) {
  return double_of(kTwo52Bits | x) - kTwo52;
}

// Returns the position of the highest one, which is the exponent of the number as a double, or ~0 for 0.
[[gnu::always_inline]] inline uint32_t highest_one(uint32_t x) {
  const uint32_t at = uint32_t(double_bits(small_double(x)) >> 52) - 1023;
  return x == 0 ? ~0u : at;
}
[[gnu::always_inline]] inline uint32_t highest_one(uint64_t x) {
  const uint64_t high = x >> 32;
  const uint64_t exponent = double_bits(small_double(high != 0 ? high : x)) >> 52;
  const uint64_t at = exponent - (high != 0 ? 1023 - 32 : 1023);
  return uint32_t(x == 0 ? ~0ull : at);
}

[[gnu::always_inline]] inline uint32_t reversed(uint32_t x) {
  x = ((x >> 1) & 0x5555'5555u) | ((x & 0x5555'5555u) << 1);
  x = ((x >> 2) & 0x3333'3333u) | ((x & 0x3333'3333u) << 2);
  x = ((x >> 4) & 0x0f0f'0f0fu) | ((x & 0x0f0f'0f0fu) << 4);
  x = ((x >> 8) & 0x00ff'00ffu) | ((x & 0x00ff'00ffu) << 8);
  return (x >> 16) | (x << 16);
}
[[gnu::always_inline]] inline uint64_t reversed(uint64_t x) {
  return uint64_t(reversed(uint32_t(x))) << 32 | reversed(uint32_t(x >> 32));
}

// These shift by any count. A count of the width or more gives 0, or copies of the sign.
template <class T>
[[gnu::always_inline]] inline T shifted_left(T x, Wrapping<T> n) {
  return n >= Wrapping<T>(kBits<T>) ? T(0) : T(Wrapping<T>(x) << (n & (kBits<T> - 1)));
}
template <class T>
[[gnu::always_inline]] inline T shifted_right(T x, Wrapping<T> n) {
  if constexpr (std::is_signed_v<T>)
    return T(x >> (n >= Wrapping<T>(kBits<T>) ? Wrapping<T>(kBits<T> - 1) : n));
  else
    return n >= Wrapping<T>(kBits<T>) ? T(0) : T(x >> (n & (kBits<T> - 1)));
}

// Returns n ones at the low end, or all ones for an n of the width or more.
template <class T>
[[gnu::always_inline]] inline T low_ones(Wrapping<T> n) {
  return T(shifted_left<T>(1, n) - 1);
}

// Returns the position or length of a field. The PTX ISA says that bfe and bfi use the low 8 bits. Recordings
// show that this holds for 32 bits, while the 64-bit forms use the whole number. All values from 64 on mean
// the same.
template <class T>
[[gnu::always_inline]] inline Wrapping<T> field_count(uint32_t n) {
  const Wrapping<T> count = n;
  if constexpr (sizeof(T) == 8) return count > 255 ? Wrapping<T>(255) : count;
  return count & 0xff;
}
// Extracts a field by shifting it to the top and back, so that its sign or zeros fill the rest. A signed
// field that reaches past the last bit has that bit as its sign.
template <class T>
[[gnu::always_inline]] inline T field(T a, uint32_t position, uint32_t length) {
  using W = Wrapping<T>;
  constexpr W kWidth = kBits<T>, kLast = kWidth - 1;
  const W p = field_count<T>(position), n = field_count<T>(length);
  const W above = p + n < kWidth ? kWidth - (p + n) : W(0);  // bits above the field
  const W back = above + p < kLast ? above + p : kLast;
  const T bits = T(T(W(a) << (above & kLast)) >> back);
  const bool is_empty = n == 0 || (std::is_unsigned_v<T> && p > kLast);
  return is_empty ? T(0) : bits;
}
// Inserts a field: it differs from the background by the field's bits of a ^ (b >> position). The neighbours
// above the field are removed by two shifts and not by a mask of ones, because compilers do not vectorise a
// constant shifted by 64-bit counts.
template <class T>
[[gnu::always_inline]] inline T inserted(T a, T b, uint32_t position, uint32_t length) {
  using W = Wrapping<T>;
  constexpr W kWidth = kBits<T>, kLast = kWidth - 1;
  const W p = field_count<T>(position), n = field_count<T>(length);
  const W above = (n < kWidth ? kWidth - n : W(0)) & kLast;
  const W change = ((((b >> (p & kLast)) ^ a) << above) >> above) << (p & kLast);
  return n == 0 || p > kLast ? b : T(b ^ change);
}

// Returns the high 64 bits of a product, computed from products of halves.
[[gnu::always_inline]] inline uint64_t high_product(uint64_t a, uint64_t b) {
  const uint64_t al = uint32_t(a), ah = a >> 32, bl = uint32_t(b), bh = b >> 32;
  const uint64_t middle = ah * bl + (al * bl >> 32);  // below 2^64: (2^32 - 1)^2 + 2^32 - 1
  const uint64_t carry = al * bh + uint32_t(middle);
  return ah * bh + (middle >> 32) + (carry >> 32);
}
template <class T>
[[gnu::always_inline]] inline T product_high(T a, T b) {
  if constexpr (sizeof(T) == 8) {
    const uint64_t high = high_product(uint64_t(a), uint64_t(b));
    if constexpr (std::is_unsigned_v<T>) return high;
    // A negative factor adds 2^64 times the other factor too much.
    const uint64_t of_a = a < 0 ? uint64_t(b) : 0, of_b = b < 0 ? uint64_t(a) : 0;
    return T(high - of_a - of_b);
  } else {
    using Wide = std::conditional_t<std::is_signed_v<T>, int64_t, uint64_t>;
    return T(Wide(a) * Wide(b) >> kBits<T>);
  }
}

template <class T>
struct Division {
  T quotient, remainder;
};
// Divides by b > 0. The rounded quotient of doubles never reaches the integer above the true quotient: that
// integer is at least 1/b away, and the rounding error is below 2^-21 / b. The sum leaves the integer in the
// low mantissa bits.
[[gnu::always_inline]] inline Division<uint32_t> divided(uint32_t a, uint32_t b) {
  const double q = small_double(a) / small_double(b);
  const double n = q + kTwo52;
  const uint32_t quotient = uint32_t(double_bits(n)) - (n - kTwo52 > q ? 1u : 0u);
  return {quotient, a - quotient * b};
}
// Divides 16 bits in single precision. The same argument holds with an error below 2^-8 / b.
[[gnu::always_inline]] inline Division<uint16_t> divided(uint16_t a, uint16_t b) {
  const uint32_t quotient = uint32_t(int32_t(float(int32_t(a)) / float(int32_t(b))));
  return {uint16_t(quotient), uint16_t(a - quotient * b)};
}
// Divides in two steps with a reciprocal that is slightly too small, so that no step goes too far. The first
// step leaves a quotient below 2^17, and the second leaves 0 or 1.
[[gnu::always_inline]] inline Division<uint64_t> divided(uint64_t a, uint64_t b) {
  const double reciprocal = (1.0 - 0x1p-49) / double(b);
  const uint64_t first = uint64_t(double(a) * reciprocal);
  const uint64_t rest = a - first * b;
  const uint64_t second = uint64_t(int64_t(double(rest) * reciprocal));
  const uint64_t last = rest - second * b;
  return {first + second + (last >= b ? 1u : 0u), last >= b ? last - b : last};
}

// PTX leaves these cases open; the results are recorded from hardware. A division by 0 gives all ones, as
// quotient and as remainder. For the lowest number divided by -1, the quotient is that number and the
// remainder is 0.
template <class T>
[[gnu::always_inline]] inline Division<T> division(T a, T b) {
  using U = Unsigned<T>;
  const U sign_a = a < 0 ? U(~U(0)) : U(0), sign_b = b < 0 ? U(~U(0)) : U(0);
  const U x = U((U(a) ^ sign_a) - sign_a), y = U((U(b) ^ sign_b) - sign_b);
  const Division<U> d = divided(x, b == 0 ? U(1) : y);
  const U sign = sign_a ^ sign_b;
  const T q = T(U((d.quotient ^ sign) - sign)), r = T(U((d.remainder ^ sign_a) - sign_a));
  return {b == 0 ? T(~U(0)) : q, b == 0 ? T(~U(0)) : r};
}

}  // namespace glint::isa::GLINT_ISA_PATH

// Integer building blocks of the ops: counts, fields, wide products, quotients without division instructions.
//
// Branch-free, so that loops over lanes become vectors. Included only by isa/ops/*.cpp (see op_makers.h).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <type_traits>

#include "isa/kernels.h"

namespace glint::isa::GLINT_ISA_PATH {

// The type that arithmetic modulo 2^bits of T is done in: unsigned, and no narrower than int.
template <class T>
using Wrapping = std::conditional_t<sizeof(T) == 8, uint64_t, uint32_t>;
template <class T>
using Unsigned = std::make_unsigned_t<T>;
template <class T>
inline constexpr int kBits = int(sizeof(T)) * 8;

// Sums of neighbouring fields of 1, 2, 4 bits, then all bytes by a product: no branch, no table.
[[gnu::always_inline]] inline uint32_t count_ones(uint32_t x) {
  x -= (x >> 1) & 0x5555'5555u;
  x = (x & 0x3333'3333u) + ((x >> 2) & 0x3333'3333u);
  x = (x + (x >> 4)) & 0x0f0f'0f0fu;
  return (x * 0x0101'0101u) >> 24;
}
[[gnu::always_inline]] inline uint32_t count_ones(uint64_t x) {
  return count_ones(uint32_t(x)) + count_ones(uint32_t(x >> 32));
}

// Position of the highest one, ~0 for 0: fill with ones below it, then count.
[[gnu::always_inline]] inline uint32_t highest_one(uint32_t x) {
  x |= x >> 1;
  x |= x >> 2;
  x |= x >> 4;
  x |= x >> 8;
  x |= x >> 16;
  return count_ones(x) - 1;
}
[[gnu::always_inline]] inline uint32_t highest_one(uint64_t x) {
  const uint32_t high = uint32_t(x >> 32);
  const uint32_t found = highest_one(high != 0 ? high : uint32_t(x));
  return high != 0 ? found + 32 : found;
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

// Shifts by any count: from the width on, 0 (or copies of the sign).
template <class T>
[[gnu::always_inline]] inline T shifted_left(T x, uint32_t n) {
  return n >= uint32_t(kBits<T>) ? T(0) : T(Wrapping<T>(x) << (n & (kBits<T> - 1)));
}
template <class T>
[[gnu::always_inline]] inline T shifted_right(T x, uint32_t n) {
  if constexpr (std::is_signed_v<T>)
    return T(x >> (n >= uint32_t(kBits<T>) ? kBits<T> - 1 : int(n)));
  else
    return n >= uint32_t(kBits<T>) ? T(0) : T(x >> (n & (kBits<T> - 1)));
}

// n ones at the low end; n of the width or more: all.
template <class T>
[[gnu::always_inline]] inline T low_ones(uint32_t n) {
  return T(shifted_left<T>(1, n) - 1);
}

// Position or length of a field. PTX ISA, bfe and bfi: the low 8 bits. As recorded that holds for 32 bits, while the
// 64-bit forms take the whole number; all from 64 on mean the same.
template <class T>
[[gnu::always_inline]] inline uint32_t field_count(uint32_t n) {
  if constexpr (sizeof(T) == 8) return n > 255 ? 255 : n;
  return n & 0xff;
}
template <class T>
[[gnu::always_inline]] inline T field(T a, uint32_t position, uint32_t length) {
  return T(shifted_right(a, field_count<T>(position)) & low_ones<T>(field_count<T>(length)));
}
// The sign of a field that reaches past the last bit is that bit.
template <class T>
[[gnu::always_inline]] inline T signed_field(T a, uint32_t position, uint32_t length) {
  using U = Unsigned<T>;
  constexpr uint32_t kLast = kBits<T> - 1;
  const uint32_t p = field_count<T>(position), n = field_count<T>(length);
  const uint32_t last = p + n - 1 > kLast ? kLast : p + n - 1;  // n = 0: no bit remains of it, below
  const U sign = U(0) - ((U(a) >> (last & kLast)) & 1);
  const U from_a = low_ones<U>(n) & shifted_right(U(~U(0)), p);
  const U bits = (shifted_right(U(a), p) & from_a) | (sign & ~from_a);
  return n == 0 ? T(0) : T(bits);
}
template <class T>
[[gnu::always_inline]] inline T inserted(T a, T b, uint32_t position, uint32_t length) {
  const uint32_t p = field_count<T>(position);
  const T mask = shifted_left(low_ones<T>(field_count<T>(length)), p);
  return T((b & ~mask) | (shifted_left(a, p) & mask));
}

// High 64 bits of a product, from products of halves.
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
    // A negative factor counts 2^64 too much, times the other one.
    const uint64_t of_a = a < 0 ? uint64_t(b) : 0, of_b = b < 0 ? uint64_t(a) : 0;
    return T(high - of_a - of_b);
  } else {
    using Wide = std::conditional_t<std::is_signed_v<T>, int64_t, uint64_t>;
    return T(Wide(a) * Wide(b) >> kBits<T>);
  }
}

// Quotient of b > 0. The rounded quotient of doubles never reaches the integer above the true one: that lies 1/b or
// more away, the rounding error is below 2^-21 / b. The magic number leaves the integer in the low mantissa bits.
[[gnu::always_inline]] inline uint32_t quotient_of(uint32_t a, uint32_t b) {
  constexpr double kTwo52 = 4503599627370496.0;
  const double x = double_of(0x4330'0000'0000'0000ull | a) - kTwo52;
  const double y = double_of(0x4330'0000'0000'0000ull | b) - kTwo52;
  const double q = x / y;
  const double n = q + kTwo52;
  return uint32_t(double_bits(n)) - (n - kTwo52 > q ? 1u : 0u);
}
// 16 bits in single precision: the same argument with an error below 2^-8 / b.
[[gnu::always_inline]] inline uint16_t quotient_of(uint16_t a, uint16_t b) {
  return uint16_t(int32_t(float(int32_t(a)) / float(int32_t(b))));
}
// Two steps with a reciprocal that is a little too small, so that no step goes too far: the first leaves a quotient
// below 2^17, the second one of 0 or 1.
[[gnu::always_inline]] inline uint64_t quotient_of(uint64_t a, uint64_t b) {
  constexpr double kTwo52 = 4503599627370496.0;
  const double reciprocal = 1.0 / double(b) * (1.0 - 0x1p-49);
  const uint64_t first = uint64_t(double(a) * reciprocal);
  const uint64_t rest = a - first * b;
  const double q = double(rest) * reciprocal;
  const double n = q + kTwo52;
  const uint64_t second = (double_bits(n) & 0xf'ffffu) - (n - kTwo52 > q ? 1u : 0u);
  return first + second + (rest - second * b >= b ? 1u : 0u);
}

// As recorded on hardware, since PTX leaves it open: a division by 0 gives all ones, as quotient and as remainder; of
// the lowest number by -1 the quotient is that number and the remainder 0.
template <class T>
[[gnu::always_inline]] inline T quotient(T a, T b) {
  using U = Unsigned<T>;
  const U sign = std::is_signed_v<T> && ((a < 0) != (b < 0)) ? U(~U(0)) : U(0);
  const U x = a < 0 ? U(U(0) - U(a)) : U(a), y = b < 0 ? U(U(0) - U(b)) : U(b);
  const U q = quotient_of(x, b == 0 ? U(1) : y);
  return b == 0 ? T(~U(0)) : T(U((q ^ sign) - sign));
}
template <class T>
[[gnu::always_inline]] inline T remainder_of(T a, T b) {
  using U = Unsigned<T>;
  const U x = a < 0 ? U(U(0) - U(a)) : U(a), y = b < 0 ? U(U(0) - U(b)) : U(b);
  const U q = quotient_of(x, b == 0 ? U(1) : y);
  const U r = U(Wrapping<T>(x) - Wrapping<T>(q) * Wrapping<T>(y));
  return b == 0 ? T(~U(0)) : a < 0 ? T(U(U(0) - r)) : T(r);
}

}  // namespace glint::isa::GLINT_ISA_PATH

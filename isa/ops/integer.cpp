// Defines integer arithmetic of 16, 32 and 64 bits, logic and shifts.
// SPDX-License-Identifier: Apache-2.0
#include "isa/integer_kernels.h"
#include "isa/ops/families.h"
#include "isa/ops/row_tables.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

template <class T>
inline constexpr T kLowest = T(std::is_signed_v<T> ? Unsigned<T>(1) << (kBits<T> - 1) : 0);
// Names the type twice as wide as T.
template <class T>
using Wide = std::conditional_t<std::is_signed_v<T>, std::conditional_t<sizeof(T) == 2, int32_t, int64_t>,
                                std::conditional_t<sizeof(T) == 2, uint32_t, uint64_t>>;

struct Add {
  template <class T>
  T operator()(T a, T b) const {
    return T(Wrapping<T>(a) + Wrapping<T>(b));
  }
};
struct Sub {
  template <class T>
  T operator()(T a, T b) const {
    return T(Wrapping<T>(a) - Wrapping<T>(b));
  }
};
struct MulLow {
  template <class T>
  T operator()(T a, T b) const {
    return T(Wrapping<T>(a) * Wrapping<T>(b));
  }
};
struct MadLow {
  template <class T>
  T operator()(T a, T b, T c) const {
    return Add{}(MulLow{}(a, b), c);
  }
};
struct ShiftRight {
  template <class T>
  T operator()(T a, uint32_t n) const {
    return shifted_right(a, n);
  }
};
struct MulHigh {
  template <class T>
  T operator()(T a, T b) const {
    return product_high(a, b);
  }
};

inline int32_t clamped(int64_t x) {
  const int64_t low = x < -0x8000'0000ll ? -0x8000'0000ll : x;
  return int32_t(low > 0x7fff'ffffll ? 0x7fff'ffffll : low);
}

// Makes sums and products of one type. The examples hold for all widths.
template <class N>
constexpr auto sum_rows() {
  using T = typename N::Type;
  using U = Unsigned<T>;  // where signed and unsigned numbers give the same bits, they share a handler
  constexpr uint64_t kOnes = word(T(-1)), kHigh = word(Unsigned<T>(Unsigned<T>(1) << (kBits<T> - 1)));
  return joined_rows(
      binary<U>(joined<"add", N::kName>, Unit::Int, "Adds. The carry is lost.", Add{},
                {{{1, 2}, 3}, {{7, word(T(-7))}, 0}, {{kHigh, kHigh}, 0}}),
      binary<U>(joined<"sub", N::kName>, Unit::Int, "Subtracts. The borrow is lost.", Sub{},
                {{{3, 2}, 1}, {{0, 1}, kOnes}}),
      binary<U>(joined<"mul.lo", N::kName>, Unit::Int, "Returns the low half of the product.", MulLow{},
                {{{3, 5}, 15}, {{kOnes, kOnes}, 1}}),
      binary<T>(joined<"mul.hi", N::kName>, Unit::Int, "Returns the high half of the product.", MulHigh{},
                {{{3, 5}, 0},
                 {{kOnes, kOnes}, std::is_signed_v<T> ? 0 : kOnes - 1},
                 {{kHigh, 2}, kHigh == word(kLowest<T>) ? kOnes : 1}}),
      ternary<U>(joined<"mad.lo", N::kName>, Unit::Int,
                 "Adds the low half of the product and the third source.", MadLow{},
                 {{{3, 5, 1}, 16}, {{kHigh, 2, 7}, 7}}),
      ternary<T>(joined<"mad.hi", N::kName>, Unit::Int,
                 "Adds the high half of the product and the third source.",
                 [](T a, T b, T c) { return Add{}(product_high(a, b), c); },
                 {{{3, 5, 1}, 1}, {{kHigh, 4, 5}, std::is_signed_v<T> ? 3 : 7}}));
}

template <class N>
constexpr auto quotient_rows() {
  using T = typename N::Type;
  constexpr uint64_t kOnes = word(T(-1)), kHigh = word(kLowest<T>);
  return joined_rows(
      binary<T>(joined<"div", N::kName>, Unit::IntDiv,
                std::is_signed_v<T> ? "Divides and rounds towards 0. By 0 gives all ones, and the lowest "
                                      "number by -1 gives that number."
                                    : "Divides. A division by 0 gives all ones.",
                [](T a, T b) { return division(a, b).quotient; },
                {{{7, 2}, 3}, {{7, 0}, kOnes}, {{word(T(-7)), word(T(-7))}, 1}, {{kHigh, kOnes}, kHigh}}),
      binary<T>(joined<"rem", N::kName>, Unit::IntDiv,
                std::is_signed_v<T>
                    ? "Returns the remainder with the sign of the dividend. A division by 0 gives all ones."
                    : "Returns the remainder. A division by 0 gives all ones.",
                [](T a, T b) { return division(a, b).remainder; },
                {{{7, 2}, 1}, {{7, 0}, kOnes}, {{word(T(-7)), word(T(-7))}, 0}, {{kHigh, kOnes}, 0}}));
}

template <class N>
constexpr auto order_rows() {
  using T = typename N::Type;
  constexpr uint64_t kOnes = word(T(-1));
  return joined_rows(binary<T>(joined<"min", N::kName>, Unit::Int, "Returns the smaller source.",
                               [](T a, T b) { return a < b ? a : b; },
                               {{{1, kOnes}, std::is_signed_v<T> ? kOnes : 1}, {{3, 2}, 2}}),
                     binary<T>(joined<"max", N::kName>, Unit::Int, "Returns the larger source.",
                               [](T a, T b) { return a > b ? a : b; },
                               {{{1, kOnes}, std::is_signed_v<T> ? 1 : kOnes}, {{3, 2}, 3}}),
                     ternary<T>(joined<"sad", N::kName>, Unit::Int,
                                "Adds the distance of the first two sources and the third source.",
                                [](T a, T b, T c) { return Add{}(a < b ? Sub{}(b, a) : Sub{}(a, b), c); },
                                {{{3, 5, 1}, 3}, {{5, 3, kOnes}, 1}}));
}

template <class N>
constexpr auto sign_rows() {
  using T = typename N::Type;
  constexpr uint64_t kHigh = word(kLowest<T>);
  return joined_rows(unary<T>(joined<"abs", N::kName>, Unit::Int,
                              "Returns the magnitude. That of the lowest number is itself.",
                              [](T a) { return a < 0 ? Sub{}(T(0), a) : a; },
                              {{{word(T(-1))}, 1}, {{5}, 5}, {{kHigh}, kHigh}}),
                     unary<T>(joined<"neg", N::kName>, Unit::Int, "Negates. The lowest number stays.",
                              [](T a) { return Sub{}(T(0), a); }, {{{1}, word(T(-1))}, {{kHigh}, kHigh}}));
}

template <class N>
constexpr auto wide_rows() {
  using T = typename N::Type;
  using W = Wide<T>;
  constexpr uint64_t kOnes = word(T(-1)), kTwice = word(W(W(T(-1)) * 2));
  return joined_rows(
      binary<T>(joined<"mul.wide", N::kName>, Unit::Int,
                "Multiplies. The product is twice as wide as the sources.",
                [](T a, T b) { return W(W(a) * W(b)); }, {{{kOnes, 2}, kTwice}, {{3, 5}, 15}}),
      value_op<T, T, W>(joined<"mad.wide", N::kName>, Unit::Int,
                        "Adds a product twice as wide as the sources and a third source of that width.",
                        [](T a, T b, W c) { return Add{}(W(W(a) * W(b)), c); },
                        {{{kOnes, 2, 3}, word(W(kTwice + 3))}, {{3, 5, word(W(-1))}, 14}}));
}

// The factors are the low 24 bits, and the product has 48 bits.
template <class T>
inline T factor24(T x) {
  return T(Wrapping<T>(x) << 8) >> 8;
}
template <class T>
inline T product24_high(T a, T b) {
  return T(uint64_t(Wide<T>(factor24(a)) * Wide<T>(factor24(b))) >> 16);
}
template <class N>
constexpr auto mul24_rows() {
  using T = typename N::Type;
  return joined_rows(
      binary<T>(joined<"mul24.lo", N::kName>, Unit::Int,
                "Returns the low 32 bits of the product of the low 24 bits.",
                [](T a, T b) { return MulLow{}(factor24(a), factor24(b)); },
                {{{3, 5}, 15}, {{0x0100'0003, 5}, 15}}),
      binary<T>(joined<"mul24.hi", N::kName>, Unit::Int,
                "Returns bits 16 to 47 of the product of the low 24 bits.",
                [](T a, T b) { return product24_high(a, b); }, {{{0x1'0000, 5}, 5}, {{0x0101'0000, 5}, 5}}),
      ternary<T>(joined<"mad24.lo", N::kName>, Unit::Int,
                 "Adds the low 32 bits of the product of the low 24 bits and the third source.",
                 [](T a, T b, T c) { return Add{}(MulLow{}(factor24(a), factor24(b)), c); },
                 {{{3, 5, 1}, 16}, {{0x0100'0003, 5, 0xffff'fff1}, 0}}),
      ternary<T>(joined<"mad24.hi", N::kName>, Unit::Int,
                 "Adds bits 16 to 47 of the product of the low 24 bits and the third source.",
                 [](T a, T b, T c) { return Add{}(product24_high(a, b), c); },
                 {{{0x1'0000, 5, 1}, 6}, {{0x0101'0000, 5, 0xffff'fffb}, 0}}));
}

constexpr auto saturating_rows() {
  return joined_rows(
      binary<int32_t>(
          "add.sat.s32", Unit::Int, "Adds and clamps to the range of s32.",
          [](int32_t a, int32_t b) { return clamped(int64_t(a) + b); },
          {{{1, 2}, 3}, {{0x7fff'ffff, 1}, 0x7fff'ffff}, {{0x8000'0000, 0xffff'ffff}, 0x8000'0000}}),
      binary<int32_t>(
          "sub.sat.s32", Unit::Int, "Subtracts and clamps to the range of s32.",
          [](int32_t a, int32_t b) { return clamped(int64_t(a) - b); },
          {{{3, 2}, 1}, {{0x7fff'ffff, 0xffff'ffff}, 0x7fff'ffff}, {{0x8000'0000, 1}, 0x8000'0000}}),
      ternary<int32_t>(
          "mad.hi.sat.s32", Unit::Int,
          "Adds the high half of the product and the third source, and clamps to the range of s32.",
          [](int32_t a, int32_t b, int32_t c) { return clamped(int64_t(product_high(a, b)) + c); },
          {{{3, 5, 1}, 1}, {{0x8000'0000, 0x8000'0000, 0x7fff'ffff}, 0x7fff'ffff}}),
      ternary<int32_t>(
          "mad24.hi.sat.s32", Unit::Int,
          "Adds bits 16 to 47 of the product of the low 24 bits and the third source, and clamps to s32.",
          [](int32_t a, int32_t b, int32_t c) { return clamped(int64_t(product24_high(a, b)) + c); },
          {{{0x1'0000, 5, 1}, 6}, {{0x7f'0000, 0x7f'0000, 0x7fff'ffff}, 0x7fff'ffff}}),
      binary<int32_t>("min.relu.s32", Unit::Int, "Returns the smaller source, but at least 0.",
                      [](int32_t a, int32_t b) {
                        const int32_t smaller = a < b ? a : b;
                        return smaller > 0 ? smaller : 0;
                      },
                      {{{3, 2}, 2}, {{3, 0xffff'ffff}, 0}}),
      binary<int32_t>("max.relu.s32", Unit::Int, "Returns the larger source, but at least 0.",
                      [](int32_t a, int32_t b) {
                        const int32_t larger = a > b ? a : b;
                        return larger > 0 ? larger : 0;
                      },
                      {{{3, 2}, 3}, {{0xffff'fffe, 0xffff'ffff}, 0}}));
}

template <class N>
constexpr auto logic_rows() {
  using T = typename N::Type;
  constexpr uint64_t kOnes = word(T(-1));
  return joined_rows(
      binary<T>(joined<"and", N::kName>, Unit::Int, "Computes the bitwise and.",
                [](T a, T b) { return T(a & b); }, {{{0xff00, 0x0ff0}, 0x0f00}, {{kOnes, 0x8000}, 0x8000}}),
      binary<T>(joined<"or", N::kName>, Unit::Int, "Computes the bitwise or.",
                [](T a, T b) { return T(a | b); }, {{{0xff00, 0x0ff0}, 0xfff0}, {{0, 0x8000}, 0x8000}}),
      binary<T>(joined<"xor", N::kName>, Unit::Int, "Computes the bitwise exclusive or.",
                [](T a, T b) { return T(a ^ b); }, {{{0xff00, 0x0ff0}, 0xf0f0}, {{kOnes, kOnes}, 0}}),
      unary<T>(joined<"not", N::kName>, Unit::Int, "Computes the bitwise complement.",
               [](T a) { return T(~a); }, {{{0}, kOnes}, {{kOnes}, 0}}),
      unary<T>(joined<"cnot", N::kName>, Unit::Int, "Gives 1 for 0, and 0 for every other value.",
               [](T a) { return T(a == 0); }, {{{0}, 1}, {{1}, 0}, {{kOnes}, 0}}),
      value_op<T, uint32_t>(joined<"shl", N::kName>, Unit::Int,
                            "Shifts left. A count of the width or more gives 0.",
                            [](T a, uint32_t n) { return shifted_left(a, n); },
                            {{{3, 2}, 12}, {{kOnes, kBits<T>}, 0}, {{kOnes, 0xffff'ffff}, 0}}));
}
template <class N>
constexpr auto shift_rows() {
  using T = typename N::Type;
  constexpr uint64_t kOnes = word(T(-1));
  return joined_rows(value_op<T, uint32_t>(
      joined<"shr", N::kName>, Unit::Int,
      std::is_signed_v<T>
          ? "Shifts right, and copies of the sign enter. A count of the width or more gives the sign."
          : "Shifts right, and zeros enter. A count of the width or more gives 0.",
      ShiftRight{},
      {{{13, 2}, 3},
       {{kOnes, kBits<T>}, std::is_signed_v<T> ? kOnes : 0},
       {{kOnes, 0xffff'ffff}, std::is_signed_v<T> ? kOnes : 0}}));
}

template <class N>
constexpr auto arithmetic_rows() {
  return joined_rows(sum_rows<N>(), quotient_rows<N>(), order_rows<N>());
}

constexpr auto kRows = joined_rows(
    rows_of_types<TypeS16, TypeU16, TypeS32, TypeU32, TypeS64, TypeU64>(
        []<class N>() { return arithmetic_rows<N>(); }),
    rows_of_types<TypeS16, TypeS32, TypeS64>([]<class N>() { return sign_rows<N>(); }),
    rows_of_types<TypeS16, TypeU16, TypeS32, TypeU32>([]<class N>() { return wide_rows<N>(); }),
    rows_of_types<TypeS32, TypeU32>([]<class N>() { return mul24_rows<N>(); }), saturating_rows(),
    rows_of_types<TypeB16, TypeB32, TypeB64>([]<class N>() { return logic_rows<N>(); }),
    // shr.b* is the unsigned shift under another name; PTX has both.
    rows_of_types<TypeS16, TypeU16, TypeS32, TypeU32, TypeS64, TypeU64, TypeB16, TypeB32, TypeB64>(
        []<class N>() { return shift_rows<N>(); }));

}  // namespace

RowList integer_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH

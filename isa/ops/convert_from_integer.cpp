// Defines conversions of integers to floats, rounded in any direction.
// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include "isa/ops/conversion_types.h"
#include "isa/ops/families.h"
#include "isa/rounding.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

// Converts to f32 and f64. The host rounds, in a direction that the row sets.
template <class To, class From>
struct FromInteger {
  [[gnu::always_inline]] static To of(Register<From> x) {
    if constexpr (std::is_same_v<To, float>)
      return rounded_float(From(x));
    else
      return rounded_double(From(x));
  }
#if defined(__AVX512F__)
  template <Round kRound>
  [[gnu::always_inline]] static auto rounded(__m512i x) {
    constexpr int kDirection = kStaticRound<kRound>;
    constexpr bool kIsSigned = std::is_signed_v<From>;
    if constexpr (std::is_same_v<To, double>)
      return kIsSigned ? _mm512_cvt_roundepi64_pd(x, kDirection) : _mm512_cvt_roundepu64_pd(x, kDirection);
    else if constexpr (sizeof(From) == 8)
      return kIsSigned ? _mm512_cvt_roundepi64_ps(x, kDirection) : _mm512_cvt_roundepu64_ps(x, kDirection);
    else
      return kIsSigned ? _mm512_cvt_roundepi32_ps(x, kDirection) : _mm512_cvt_roundepu32_ps(x, kDirection);
  }
#endif
};

// Converts to 16 bits with integer operations. D is the float's type, as conversion rows know it.
template <class D, class From, Round kRound, bool kSat>
struct Convert {
  using To = typename D::Type;
  using Bits =
      std::conditional_t<sizeof(To) == 8, uint64_t, std::conditional_t<sizeof(To) == 4, uint32_t, uint16_t>>;
  To operator()(Register<From> source) const {
    const From x = From(source);
    if constexpr (kSat)  // only the integers 0 and 1 are in [0, 1]
      return __builtin_bit_cast(To, Bits(x > 0 ? Bits(D::kOne) : Bits(0)));
    else if constexpr (std::is_same_v<To, float>)
      return rounded_float(x);
    else if constexpr (std::is_same_v<To, double>)
      return rounded_double(x);
    else
      return short_float(x);
  }
  static To short_float(From x) {
    if constexpr (sizeof(From) <= 2) {
      return narrowed(float(int32_t(x)));
    } else if constexpr (std::is_same_v<To, Half>) {
      // 2^17 is beyond the range of f16, and all larger numbers round as 2^17 does.
      const Unsigned<From> m = Unsigned<From>(magnitude_of(x)),
                           limited = m > 0x2'0000 ? Unsigned<From>(0x2'0000) : m;
      const uint32_t exact = float_bits(float(int32_t(limited)));
      return narrowed(float_of(x < 0 ? exact | 0x8000'0000u : exact));
    } else {
      // The number is rounded to odd by bits. An integer is not a subnormal float, so the 29 bits that a
      // float lacks may be gathered in one bit.
      const Reduced r = reduced(x);
      const uint64_t bits = double_bits(r.value), low = bits & 0x1fff'ffff;
      return narrowed(float(double_of((bits ^ low) | (low != 0 ? 0x2000'0000u : 0u))) * r.scale);
    }
  }
  static To narrowed(float x) {
    if constexpr (std::is_same_v<To, Half>)
      return rounded_half<kRound>(x);
    else
      return rounded_bfloat<kRound>(x);
  }
};

// Tells whether the float can hold every value of the integer, so that no direction matters.
template <class To, class From>
inline constexpr bool kIsExact = (std::is_same_v<To, double> && sizeof(From) < 8) ||
                                 (std::is_same_v<To, float> && sizeof(From) < 4) ||
                                 (std::is_same_v<To, Half> && sizeof(From) < 2) ||
                                 (std::is_same_v<To, Bfloat> && sizeof(From) < 2);

template <class D, class S, Round kRound, bool kSat>
constexpr OpRow row() {
  using To = typename D::Type;
  using From = typename S::Type;
  constexpr bool kIsRounded = !kSat && !kIsExact<To, From>;
  constexpr uint64_t kMinusOne = register_word<From>(From(-1));
  constexpr Examples kExamples{{{0}, 0},
                               {{1}, D::kOne},
                               {{std::is_signed_v<From> ? kMinusOne : 1},
                                std::is_signed_v<From> ? (kSat ? 0 : D::kMinusOne) : D::kOne}};
  constexpr std::string_view kName =
      joined<"cvt", round_name<kRound>, when<kSat, ".sat">, D::kName, S::kName>;
  constexpr std::string_view kDoc =
      kSat ? "Converts an integer, rounds as the name says, and clamps to [0, 1]."
           : "Converts an integer and rounds as the name says.";
  constexpr Unit kUnit = sizeof(To) == 8 || sizeof(From) == 8 ? Unit::Sfu : Unit::Int;
  if constexpr (kIsRounded && sizeof(To) > 2)
    return rounded_op<kRound, FromInteger<To, From>, Register<From>>(
        kName, kUnit, kDoc, [](To x, Register<From>) { return x; }, kExamples);
  else
    return value_op<Register<From>>(kName, kUnit, kDoc, Convert < D, From,
                                    kIsRounded ? kRound : Round::Nearest, kSat > {}, kExamples);
}
template <class D, class S>
constexpr auto pair_rows() {
  return rows_of_rounds(
      []<Round kRound>() { return joined_rows(row<D, S, kRound, false>(), row<D, S, kRound, true>()); });
}
template <class D>
constexpr auto result_rows() {
  return rows_of_types<TypeS8, TypeU8, TypeS16, TypeU16, TypeS32, TypeU32, TypeS64, TypeU64>(
      []<class S>() { return pair_rows<D, S>(); });
}

constexpr auto kToSingle = result_rows<TypeF32>();
constexpr auto kToDouble = result_rows<TypeF64>();
constexpr auto kToHalf = result_rows<TypeF16>();
constexpr auto kToBfloat = result_rows<TypeBf16>();
constexpr auto kRows = joined_rows(kToSingle, kToDouble, kToHalf, kToBfloat);

}  // namespace

RowList convert_from_integer_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH

// Conversions of floats to integers: rounded, then clamped to the range.
// SPDX-License-Identifier: Apache-2.0
#include "isa/ops/conversion_types.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

// The work of a row; the same with .sat and without: hardware clamps always.
template <class To, class S, Round kRound, bool kFtz>
struct Convert {
  Register<To> operator()(typename S::Type x) const {
    constexpr bool kFromDouble = std::is_same_v<typename S::Type, double>;
    if constexpr (kFtz)
      return Register<To>(to_integer<To, kRound, false>(double(flushed(x))));
    else
      return Register<To>(to_integer<To, kRound, kFromDouble>(double(S::value(x))));
  }
};

template <class D, class S, Round kRound, bool kFtz, bool kSat>
constexpr OpRow row() {
  using To = typename D::Type;
  constexpr bool kFromDouble = std::is_same_v<typename S::Type, double>;
  // Subnormals matter to the directed roundings only: the others share a handler.
  constexpr bool kFlush = kFtz && (kRound == Round::Down || kRound == Round::Up);
  constexpr To kHigh = To(std::is_signed_v<To> ? Unsigned<To>(-1) >> 1 : Unsigned<To>(-1));
  return value_op<typename S::Type>(
      joined<"cvt", integer_round_name<kRound>, when<kFtz, ".ftz">, when<kSat, ".sat">, D::kName, S::kName>,
      Unit::Sfu, "Rounds to an integer and clamps it to the range of the result.",
      Convert<To, S, kRound, kFlush>{},
      {{{S::kOne}, 1},
       {{S::kMinusOne}, register_word<To>(std::is_signed_v<To> ? To(-1) : To(0))},
       {{S::kTwoAndHalf}, kRound == Round::Up ? 3 : 2},
       {{S::kInfinity}, register_word<To>(kHigh)},
       {{S::kNan}, register_word<To>(kFromNan<To, kFromDouble>)}});
}

template <class D, class S>
constexpr auto pair_rows() {
  return rows_of_rounds([]<Round kRound>() {
    const auto plain = joined_rows(row<D, S, kRound, false, false>(), row<D, S, kRound, false, true>());
    if constexpr (std::is_same_v<S, TypeF32>)
      return joined_rows(plain, row<D, S, kRound, true, false>(), row<D, S, kRound, true, true>());
    else
      return plain;
  });
}
template <class S>
constexpr auto source_rows() {
  return rows_of_types<TypeS8, TypeU8, TypeS16, TypeU16, TypeS32, TypeU32, TypeS64, TypeU64>(
      []<class D>() { return pair_rows<D, S>(); });
}

constexpr auto kFromSingle = source_rows<TypeF32>();
constexpr auto kFromDouble = source_rows<TypeF64>();
constexpr auto kFromHalf = source_rows<TypeF16>();
constexpr auto kFromBfloat = source_rows<TypeBf16>();
constexpr auto kRows = joined_rows(kFromSingle, kFromDouble, kFromHalf, kFromBfloat);

}  // namespace

RowList convert_to_integer_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH

// Defines conversions between integers of 8 to 64 bits.
// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include "isa/ops/conversion_types.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

template <class D, class S>
inline constexpr bool kContains = std::is_signed_v<D> == std::is_signed_v<S> ? sizeof(D) >= sizeof(S)
                                  : std::is_signed_v<D>                      ? sizeof(D) > sizeof(S)
                                                                             : false;

// Returns the nearest value of D. Bounds that S cannot reach are left out, because they do not fit its type.
template <class D, class S>
[[gnu::always_inline]] inline D clamped(S x) {
  constexpr D kLow = std::is_signed_v<D> ? D(Unsigned<D>(1) << (kBits<D> - 1)) : D(0), kHigh = D(~kLow);
  S inside = x;
  if constexpr (std::is_signed_v<S> && (std::is_unsigned_v<D> || sizeof(D) < sizeof(S)))
    inside = inside < S(kLow) ? S(kLow) : inside;
  if constexpr (sizeof(D) < sizeof(S) || (sizeof(D) == sizeof(S) && std::is_unsigned_v<S>))
    inside = inside > S(kHigh) ? S(kHigh) : inside;
  return D(inside);
}

// Extends the low bits of a register, which T counts, by T's sign or zeros.
template <class T, class R>
struct Extended {
  R operator()(auto word) const { return R(T(word)); }
};
// Converts an integer without clamping. The narrower of the types says which bits stay and how they are
// extended, so few functions serve all pairs of types.
template <class To, class From>
struct Plain {
  using Source = std::conditional_t<sizeof(From) == 8, uint64_t, uint32_t>;
  using Result = Unsigned<Register<To>>;
  using Narrow = std::conditional_t<sizeof(From) < sizeof(To), From, To>;
  using Work = Extended<std::conditional_t<sizeof(Narrow) == sizeof(Result), Result, Narrow>, Result>;
};

template <class D, class S>
constexpr auto pair_rows() {
  using To = typename D::Type;
  using From = typename S::Type;
  constexpr uint64_t kMinusOne = register_word<From>(From(-1));
  constexpr bool kIsLong = sizeof(To) == 8 || sizeof(From) == 8;
  constexpr std::string_view kDoc =
      sizeof(To) > sizeof(From)
          ? std::is_signed_v<From> ? "Widens with copies of the sign." : "Widens with zeros."
      : sizeof(To) < sizeof(From) ? "Keeps the low bits."
                                  : "Keeps the bits.";
  constexpr OpRow kPlain = value_op<typename Plain<To, From>::Source>(
      joined<"cvt", D::kName, S::kName>, Unit::Int, kDoc, typename Plain<To, From>::Work{},
      {{{7}, 7},
       {{kMinusOne}, register_word<To>(To(From(-1)))},
       {{0x1'0000'0044 & register_word<From>(From(-1))},
        0x44 + (kIsLong && sizeof(To) == 8 && sizeof(From) == 8 ? 0x1'0000'0000 : 0)}});
  if constexpr (kContains<To, From>) {
    return joined_rows(kPlain);
  } else {
    constexpr uint64_t kClamped =
        std::is_signed_v<From> ? register_word<To>(std::is_signed_v<To> ? To(-1) : To(0))
                               : register_word<To>(To(std::is_signed_v<To> ? Unsigned<To>(-1) >> 1 : To(-1)));
    return joined_rows(
        kPlain, value_op<Register<From>>(joined<"cvt.sat", D::kName, S::kName>, Unit::Int,
                                         "Clamps to the range of the result.",
                                         [](Register<From> x) { return Register<To>(clamped<To>(From(x))); },
                                         {{{7}, 7}, {{kMinusOne}, kClamped}, {{0}, 0}}));
  }
}

template <class S>
constexpr auto source_rows() {
  return rows_of_types<TypeS8, TypeU8, TypeS16, TypeU16, TypeS32, TypeU32, TypeS64, TypeU64>(
      []<class D>() { return pair_rows<D, S>(); });
}
constexpr auto kRows = rows_of_types<TypeS8, TypeU8, TypeS16, TypeU16, TypeS32, TypeU32, TypeS64, TypeU64>(
    []<class S>() { return source_rows<S>(); });

}  // namespace

RowList convert_rows() {
  return {kRows.data(), kRows.size()};
}

}  // namespace glint::isa::GLINT_ISA_PATH

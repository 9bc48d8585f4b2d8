// Defines conversions of floats to integers, which are rounded and then clamped to the range.
// SPDX-License-Identifier: Apache-2.0
#include "isa/half_rows.h"
#include "isa/ops/conversion_types.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

// Does the work of a row. It is the same with and without .sat, because hardware always clamps.
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

#if defined(__AVX512F__)

// Rounds and clamps eight doubles; narrower integers are 32-bit words. The instructions return the lowest
// number for everything that a signed type cannot hold, and the highest for an unsigned type.
template <class To, Round kRound, bool kFromDouble>
[[gnu::always_inline]] inline auto to_integer_part(__m512d x) {
  constexpr int kDirection = kStaticRound<kRound>;
  constexpr bool kIsSigned = std::is_signed_v<To>;
  constexpr To kLow = kIsSigned ? To(Unsigned<To>(1) << (kBits<To> - 1)) : To(0), kHigh = To(~kLow);
  constexpr To kNan = kFromNan<To, kFromDouble>;
  const __mmask8 is_nan = _mm512_cmp_pd_mask(x, x, _CMP_UNORD_Q);
  const __m512d above = _mm512_max_pd(x, _mm512_set1_pd(double(kLow)));
  if constexpr (sizeof(To) < 8) {
    const __m512d inside = _mm512_min_pd(above, _mm512_set1_pd(double(kHigh)));
    const __m256i number = std::is_same_v<To, uint32_t> ? _mm512_cvt_roundpd_epu32(inside, kDirection)
                                                        : _mm512_cvt_roundpd_epi32(inside, kDirection);
    const __m256i kept = _mm256_mask_set1_epi32(number, is_nan, int(kNan));
    // A result of 16 bits leaves the upper half 0.
    return sizeof(To) == 2 ? _mm256_and_si256(kept, _mm256_set1_epi32(0xffff)) : kept;
  } else {
    const __m512i number =
        kIsSigned ? _mm512_cvt_roundpd_epi64(above, kDirection) : _mm512_cvt_roundpd_epu64(above, kDirection);
    const __mmask8 is_high = _mm512_cmp_pd_mask(x, _mm512_set1_pd(kIsSigned ? 0x1p63 : 0x1p64), _CMP_GE_OQ);
    return _mm512_mask_set1_epi64(_mm512_mask_set1_epi64(number, is_high, int64_t(kHigh)), is_nan,
                                  int64_t(kNan));
  }
}
// Reads a row of S as doubles, eight lanes at a time, and calls `take(i, doubles)` for the lanes from i on.
template <class S, bool kFtz, class Take>
[[gnu::always_inline]] inline void each_doubles(const Source<typename S::Type>& source, Take&& take) {
  if constexpr (std::is_same_v<S, TypeF64>) {
    for (int i = 0; i < kLanes; i += 8) take(i, load_part(source, i));
  } else {
    alignas(64) float x[kLanes];
    if constexpr (std::is_same_v<S, TypeF16>)
      widen_halves<false>(source.low, x);
    else
      all_lanes([&](int i) { x[i] = kFtz ? flushed(S::value(source.at(i))) : S::value(source.at(i)); });
    for (int i = 0; i < kLanes; i += 8) take(i, _mm512_cvtps_pd(_mm256_load_ps(x + i)));
  }
}
// Handles a whole row in place of the work of a lane, which is ten times as fast.
template <class To, class S, Round kRound, bool kFtz>
[[gnu::flatten]] void run_convert(Warp& warp, const Inst& inst) {
  if (ran_some_lanes<Register<To>>(warp, inst, &run_convert<To, S, kRound, kFtz>)) return;
  const Slot* const slot = &inst.operand.front();
  const Source<typename S::Type> source(warp, slot[1]);
  uint32_t* const out = warp.bank[0] + slot[0] * kLanes;
  each_doubles<S, kFtz>(source, [&](int i, __m512d x) {
    store_part(out + i, to_integer_part<To, kRound, std::is_same_v<S, TypeF64>>(x));
  });
}

#endif

template <class D, class S, Round kRound, bool kFtz, bool kSat>
constexpr OpRow row() {
  using To = typename D::Type;
  constexpr bool kFromDouble = std::is_same_v<typename S::Type, double>;
  // Subnormals matter only to the directed roundings, so the other roundings share a handler.
  constexpr bool kFlush = kFtz && (kRound == Round::Down || kRound == Round::Up);
  constexpr To kHigh = To(std::is_signed_v<To> ? Unsigned<To>(-1) >> 1 : Unsigned<To>(-1));
  OpRow row = value_op<typename S::Type>(
      joined<"cvt", integer_round_name<kRound>, when<kFtz, ".ftz">, when<kSat, ".sat">, D::kName, S::kName>,
      Unit::Sfu, "Rounds to an integer and clamps it to the range of the result.",
      Convert<To, S, kRound, kFlush>{},
      {{{S::kOne}, 1},
       {{S::kMinusOne}, register_word<To>(std::is_signed_v<To> ? To(-1) : To(0))},
       {{S::kTwoAndHalf}, kRound == Round::Up ? 3 : 2},
       {{S::kInfinity}, register_word<To>(kHigh)},
       {{S::kNan}, register_word<To>(kFromNan<To, kFromDouble>)}});
#if defined(__AVX512F__)
  row.run = &run_convert<To, S, kRound, kFlush>;
#endif
  return row;
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

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

// Holds the range of a result of up to 32 bits, the result for a NaN, and which bits of a register it fills.
// The detail of a row is an index of kRanges, so the types of results share a handler. .sat makes no
// difference, because hardware always clamps.
struct Range {
  double low, high;
  uint32_t nan, kept;
};
template <class To, bool kFromDouble>
constexpr Range range_of() {
  constexpr To kLow = std::is_signed_v<To> ? To(Unsigned<To>(1) << (kBits<To> - 1)) : To(0);
  return {double(kLow), double(To(~kLow)), uint32_t(int64_t(kFromNan<To, kFromDouble>)),
          sizeof(To) == 2 ? 0xffffu : ~0u};
}
constexpr Range kRanges[] = {
    range_of<int8_t, false>(),   range_of<uint8_t, false>(), range_of<int16_t, false>(),
    range_of<uint16_t, false>(), range_of<int32_t, false>(), range_of<uint32_t, false>(),
    range_of<int8_t, true>(),    range_of<uint8_t, true>(),  range_of<int16_t, true>(),
    range_of<uint16_t, true>(),  range_of<int32_t, true>(),  range_of<uint32_t, true>()};
template <class To, bool kFromDouble>
constexpr uint16_t range_index() {
  const int size = sizeof(To) == 1 ? 0 : sizeof(To) == 2 ? 2 : 4;
  return uint16_t(size + std::is_unsigned_v<To> + (kFromDouble ? 6 : 0));
}

// Rounds and clamps eight doubles. The instructions return the lowest number for everything that a signed
// type cannot hold, and the highest for an unsigned type.
template <Round kRound, bool kIsU32>
[[gnu::always_inline]] inline __m256i words_of(__m512d x, const Range& range) {
  const __mmask8 is_nan = _mm512_cmp_pd_mask(x, x, _CMP_UNORD_Q);
  const __m512d above = _mm512_max_pd(x, _mm512_set1_pd(range.low));
  const __m512d inside = _mm512_min_pd(above, _mm512_set1_pd(range.high));
  const __m256i number = kIsU32 ? _mm512_cvt_roundpd_epu32(inside, kStaticRound<kRound>)
                                : _mm512_cvt_roundpd_epi32(inside, kStaticRound<kRound>);
  const __m256i all = _mm256_mask_set1_epi32(number, is_nan, int(range.nan));
  return _mm256_and_si256(all, _mm256_set1_epi32(int(range.kept)));
}
template <class To, Round kRound, bool kFromDouble>
[[gnu::always_inline]] inline __m512i longs_of(__m512d x) {
  constexpr int kDirection = kStaticRound<kRound>;
  constexpr bool kIsSigned = std::is_signed_v<To>;
  constexpr To kLow = kIsSigned ? To(Unsigned<To>(1) << (kBits<To> - 1)) : To(0), kHigh = To(~kLow);
  const __mmask8 is_nan = _mm512_cmp_pd_mask(x, x, _CMP_UNORD_Q);
  const __m512d above = _mm512_max_pd(x, _mm512_set1_pd(double(kLow)));
  const __m512i number =
      kIsSigned ? _mm512_cvt_roundpd_epi64(above, kDirection) : _mm512_cvt_roundpd_epu64(above, kDirection);
  const __mmask8 is_high = _mm512_cmp_pd_mask(x, _mm512_set1_pd(kIsSigned ? 0x1p63 : 0x1p64), _CMP_GE_OQ);
  return _mm512_mask_set1_epi64(_mm512_mask_set1_epi64(number, is_high, int64_t(kHigh)), is_nan,
                                int64_t(kFromNan<To, kFromDouble>));
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
[[gnu::flatten]] void run_to_long(Warp& warp, const Inst& inst, const OpRow& row) {
  if (ran_some_lanes<To>(warp, inst, row, &run_to_long<To, S, kRound, kFtz>)) return;
  const Slot* const slot = &inst.operand.front();
  uint32_t* const out = warp.bank[0] + slot[0] * kLanes;
  each_doubles<S, kFtz>(Source<typename S::Type>(warp, slot[1]), [&](int i, __m512d x) {
    store_part(out + i, longs_of<To, kRound, std::is_same_v<S, TypeF64>>(x));
  });
}

// Does the same for results of up to 32 bits. kIsU32 says whether they are u32.
template <class S, Round kRound, bool kFtz, bool kIsU32>
[[gnu::flatten]] void run_to_word(Warp& warp, const Inst& inst, const OpRow& row) {
  if (ran_some_lanes<uint32_t>(warp, inst, row, &run_to_word<S, kRound, kFtz, kIsU32>)) return;
  const Slot* const slot = &inst.operand.front();
  uint32_t* const out = warp.bank[0] + slot[0] * kLanes;
  const Range range = kRanges[row.detail];
  each_doubles<S, kFtz>(Source<typename S::Type>(warp, slot[1]),
                        [&](int i, __m512d x) { store_part(out + i, words_of<kRound, kIsU32>(x, range)); });
}

#endif

template <class D, class S, Round kRound, bool kFtz, bool kSat>
constexpr OpRow row() {
  using To = typename D::Type;
  constexpr bool kFromDouble = std::is_same_v<typename S::Type, double>;
  // Subnormals matter only to the directed roundings, so the other roundings share a handler.
  constexpr bool kFlush = kFtz && (kRound == Round::Down || kRound == Round::Up);
  constexpr To kHigh = To(std::is_signed_v<To> ? Unsigned<To>(-1) >> 1 : Unsigned<To>(-1));
  OpRow row;
  row.name =
      joined<"cvt", integer_round_name<kRound>, when<kFtz, ".ftz">, when<kSat, ".sat">, D::kName, S::kName>;
  row.klass = Class::Sfu;
  row.unit = Unit::Sfu;
  row.operands = {destination_kind<To>(), source_kind<typename S::Type>()};
  row.doc = "Rounds to an integer and clamps it to the range of the result.";
  row.examples = {{{S::kOne}, 1},
                  {{S::kMinusOne}, register_word<To>(std::is_signed_v<To> ? To(-1) : To(0))},
                  {{S::kTwoAndHalf}, kRound == Round::Up ? 3 : 2},
                  {{S::kInfinity}, register_word<To>(kHigh)},
                  {{S::kNan}, register_word<To>(kFromNan<To, kFromDouble>)}};
#if defined(__AVX512F__)
  if constexpr (sizeof(To) < 8) {
    row.detail = range_index<To, kFromDouble>();
    row.run = &run_to_word<S, kRound, kFlush, std::is_same_v<To, uint32_t>>;
  } else {
    row.run = &run_to_long<To, S, kRound, kFlush>;
  }
#else
  row.run = &run_value<Convert<To, S, kRound, kFlush>, typename S::Type>;
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

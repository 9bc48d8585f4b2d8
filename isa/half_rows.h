// Converts rows of 16-bit floats to rows of floats and back, and rounds sums to odd on the way, with vector
// instructions where the path has them.
// SPDX-License-Identifier: Apache-2.0
//
// One intrinsic replaces ten steps of isa/half.h, which every compiler vectorises. The bits are the same
// (test "every value op gives the same bits on every path"). Rows of floats and words are 64-byte aligned.
// Only files of isa/ops include this file (see op_makers.h).
#pragma once
#include <cstdint>

#include "isa/conversions.h"
#include "isa/half.h"

namespace glint::isa::GLINT_ISA_PATH {

// Converts the lower (or upper) halves of a row of words to floats, exactly.
template <bool kUpper>
[[gnu::always_inline]] inline void widen_halves(const uint32_t* words, float* out) {
#if defined(__AVX512F__)
  for (int i = 0; i < kLanes; i += 16) {
    const __m512i word = _mm512_loadu_si512(words + i);
    const __m512i half = kUpper ? _mm512_srli_epi32(word, 16) : word;
    _mm512_store_ps(out + i, _mm512_cvtph_ps(_mm512_cvtepi32_epi16(half)));
  }
#elif defined(__F16C__)
  for (int i = 0; i < kLanes; i += 8) {
    const __m256i word = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(words + i));
    const __m256i half =
        kUpper ? _mm256_srli_epi32(word, 16) : _mm256_and_si256(word, _mm256_set1_epi32(0xffff));
    const __m128i packed = _mm_packus_epi32(_mm256_castsi256_si128(half), _mm256_extracti128_si256(half, 1));
    _mm256_store_ps(out + i, _mm256_cvtph_ps(packed));
  }
#else
  all_lanes([&](int i) { out[i] = float_of_upper_half(kUpper ? words[i] : words[i] << 16); });
#endif
}

// Rounds floats once to halves, which become the lower halves of words; the upper halves are 0. A NaN gives
// 0x7fff.
template <Round kRound>
[[gnu::always_inline]] inline void narrow_to_halves(const float* x, uint32_t* out) {
#if defined(__AVX512F__)
  for (int i = 0; i < kLanes; i += 16) {
    const __m512 value = _mm512_load_ps(x + i);
    const __m512i number = _mm512_cvtepu16_epi32(_mm512_cvtps_ph(value, kStaticRound<kRound>));
    const __mmask16 is_nan = _mm512_cmp_ps_mask(value, value, _CMP_UNORD_Q);
    _mm512_store_si512(out + i, _mm512_mask_set1_epi32(number, is_nan, int(kCanonicalNan16)));
  }
#elif defined(__F16C__)
  for (int i = 0; i < kLanes; i += 8) {
    const __m256 value = _mm256_load_ps(x + i);
    const __m256i number = _mm256_cvtepu16_epi32(_mm256_cvtps_ph(value, kStaticRound<kRound>));
    const __m256i is_nan = _mm256_castps_si256(_mm256_cmp_ps(value, value, _CMP_UNORD_Q));
    const __m256i kept = _mm256_blendv_epi8(number, _mm256_set1_epi32(int(kCanonicalNan16)), is_nan);
    _mm256_store_si256(reinterpret_cast<__m256i*>(out + i), kept);
  }
#else
  all_lanes([&](int i) { out[i] = rounded_half<kRound>(x[i]).bits; });
#endif
}

#if defined(__AVX512F__)
// Takes a number rounded down and rounded up. If both are equal it returns them; otherwise it returns the odd
// one of the two neighbours.
[[gnu::always_inline]] inline __m512 odd_of(__m512 down, __m512 up) {
  return _mm512_mask_mov_ps(up, _mm512_test_epi32_mask(_mm512_castps_si512(down), _mm512_set1_epi32(1)),
                            down);
}
#endif

// Computes a * b + c rounded to odd (see odd_float). `fma_to_odd(a, b, c)` does so for one lane.
template <class FmaToOdd>
[[gnu::always_inline]] inline void fma_rows_to_odd(const float* a, const float* b, const float* c, float* out,
                                                   [[maybe_unused]] FmaToOdd&& fma_to_odd) {
#if defined(__AVX512F__)
  for (int i = 0; i < kLanes; i += 16) {
    const __m512 x = _mm512_load_ps(a + i), y = _mm512_load_ps(b + i), z = _mm512_load_ps(c + i);
    _mm512_store_ps(out + i, odd_of(_mm512_fmadd_round_ps(x, y, z, kStaticRound<Round::Down>),
                                    _mm512_fmadd_round_ps(x, y, z, kStaticRound<Round::Up>)));
  }
#else
  all_lanes([&](int i) { out[i] = fma_to_odd(a[i], b[i], c[i]); });
#endif
}

// Rounds doubles to odd floats; two rows of words become one.
[[gnu::always_inline]] inline void odd_floats(const Source<double>& x, float* out) {
#if defined(__AVX512F__)
  const __m512i even = _mm512_setr_epi32(0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
  const __m512i odd = _mm512_add_epi32(even, _mm512_set1_epi32(8));
  for (int i = 0; i < kLanes; i += 16) {
    const __m512i low = _mm512_loadu_si512(x.low + i), high = _mm512_loadu_si512(x.high + i);
    const __m512d first = _mm512_castsi512_pd(_mm512_permutex2var_epi32(low, even, high));
    const __m512d second = _mm512_castsi512_pd(_mm512_permutex2var_epi32(low, odd, high));
    _mm512_store_ps(out + i, odd_of(joined_parts(_mm512_cvt_roundpd_ps(first, kStaticRound<Round::Down>),
                                                 _mm512_cvt_roundpd_ps(second, kStaticRound<Round::Down>)),
                                    joined_parts(_mm512_cvt_roundpd_ps(first, kStaticRound<Round::Up>),
                                                 _mm512_cvt_roundpd_ps(second, kStaticRound<Round::Up>))));
  }
#else
  all_lanes([&](int i) { out[i] = odd_float(x.at(i)); });
#endif
}

}  // namespace glint::isa::GLINT_ISA_PATH

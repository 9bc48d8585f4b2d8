// Handles parts of rows as 512-bit vectors: 16 words, or 8 of the doubles and long integers that lie in two
// rows.
// SPDX-License-Identifier: Apache-2.0
//
// It is used where no compiler finds the instruction: conversions, and rounding with a direction in the
// instruction. Only files of isa/ops include this file (see op_makers.h). It is empty on paths without
// AVX-512.
#pragma once
#include <cstdint>
#include <type_traits>

#include "isa/op_makers.h"

namespace glint::isa::GLINT_ISA_PATH {

#if defined(__AVX512F__)

// Loads the lanes from `i` on; `i` is a multiple of their number.
template <class T>
[[gnu::always_inline]] inline auto load_part(const Source<T>& source, int i) {
  static_assert(sizeof(T) >= 4);
  if constexpr (sizeof(T) == 4) {
    const __m512i words = _mm512_loadu_si512(source.low + i);
    if constexpr (std::is_same_v<T, float>)
      return _mm512_castsi512_ps(words);
    else
      return words;
  } else {
    const auto half = [i](const uint32_t* row) {
      return _mm512_cvtepu32_epi64(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(row + i)));
    };
    const __m512i words = _mm512_or_si512(half(source.low), _mm512_slli_epi64(half(source.high), 32));
    if constexpr (std::is_same_v<T, double>)
      return _mm512_castsi512_pd(words);
    else
      return words;
  }
}

[[gnu::always_inline]] inline void store_part(float* out, __m512 x) {
  _mm512_store_ps(out, x);
}
[[gnu::always_inline]] inline void store_part(double* out, __m512d x) {
  _mm512_store_pd(out, x);
}
[[gnu::always_inline]] inline void store_part(uint32_t* row, __m256i words) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(row), words);
}
// Stores long integers to a row and the next one.
[[gnu::always_inline]] inline void store_part(uint32_t* row, __m512i longs) {
  store_part(row, _mm512_cvtepi64_epi32(longs));
  store_part(row + kLanes, _mm512_cvtepi64_epi32(_mm512_srli_epi64(longs, 32)));
}

// Joins two vectors, so that they are stored as one: a load of both would wait for two stores.
[[gnu::always_inline]] inline __m512 joined_parts(__m256 low, __m256 high) {
  return _mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1);
}

#endif

}  // namespace glint::isa::GLINT_ISA_PATH

// Defines the arithmetic that rows round in a direction: of a lane in the host's words, and of vectors that
// say how to round.
// SPDX-License-Identifier: Apache-2.0
//
// `of` rounds as MXCSR says, and `rounded` as its argument says. `rounded_times_2_to_32` gives 2^32 times the
// result of sources that are zero or normal. Only files of isa/ops include this file (see rounding.h).
#pragma once
#include "isa/rounding.h"

namespace glint::isa::GLINT_ISA_PATH {

struct Sum {
  static constexpr bool kIsExactWhenSmall = true;  // the result is a multiple of the least subnormal
  template <class T>
  [[gnu::always_inline]] static T of(T a, T b) {
    return a + b;
  }
#if defined(__AVX512F__)
  template <Round kRound>
  [[gnu::always_inline]] static __m512 rounded(__m512 a, __m512 b) {
    return _mm512_add_round_ps(a, b, kStaticRound<kRound>);
  }
  template <Round kRound>
  [[gnu::always_inline]] static __m512d rounded(__m512d a, __m512d b) {
    return _mm512_add_round_pd(a, b, kStaticRound<kRound>);
  }
#endif
};

struct Difference {
  static constexpr bool kIsExactWhenSmall = true;
  template <class T>
  [[gnu::always_inline]] static T of(T a, T b) {
    return a - b;
  }
#if defined(__AVX512F__)
  template <Round kRound>
  [[gnu::always_inline]] static __m512 rounded(__m512 a, __m512 b) {
    return _mm512_sub_round_ps(a, b, kStaticRound<kRound>);
  }
  template <Round kRound>
  [[gnu::always_inline]] static __m512d rounded(__m512d a, __m512d b) {
    return _mm512_sub_round_pd(a, b, kStaticRound<kRound>);
  }
#endif
};

struct Product {
  static constexpr bool kIsExactWhenSmall = false;
  template <class T>
  [[gnu::always_inline]] static T of(T a, T b) {
    return a * b;
  }
#if defined(__AVX512F__)
  template <Round kRound>
  [[gnu::always_inline]] static __m512 rounded(__m512 a, __m512 b) {
    return _mm512_mul_round_ps(a, b, kStaticRound<kRound>);
  }
  template <Round kRound>
  [[gnu::always_inline]] static __m512d rounded(__m512d a, __m512d b) {
    return _mm512_mul_round_pd(a, b, kStaticRound<kRound>);
  }
  template <Round kRound>
  [[gnu::always_inline]] static __m512 rounded_times_2_to_32(__m512 a, __m512 b) {
    return rounded<kRound>(scaled(a), b);
  }
#endif
};

// Computes a * b + c, rounded once.
struct ProductSum {
  static constexpr bool kIsExactWhenSmall = false;
  [[gnu::always_inline]] static float of(float a, float b, float c) { return __builtin_fmaf(a, b, c); }
  [[gnu::always_inline]] static double of(double a, double b, double c) { return __builtin_fma(a, b, c); }
#if defined(__AVX512F__)
  template <Round kRound>
  [[gnu::always_inline]] static __m512 rounded(__m512 a, __m512 b, __m512 c) {
    return _mm512_fmadd_round_ps(a, b, c, kStaticRound<kRound>);
  }
  template <Round kRound>
  [[gnu::always_inline]] static __m512d rounded(__m512d a, __m512d b, __m512d c) {
    return _mm512_fmadd_round_pd(a, b, c, kStaticRound<kRound>);
  }
  template <Round kRound>
  [[gnu::always_inline]] static __m512 rounded_times_2_to_32(__m512 a, __m512 b, __m512 c) {
    return rounded<kRound>(scaled(a), b, scaled(c));
  }
#endif
};

struct Quotient {
  static constexpr bool kIsExactWhenSmall = false;
  template <class T>
  [[gnu::always_inline]] static T of(T a, T b) {
    return a / b;
  }
#if defined(__AVX512F__)
  template <Round kRound>
  [[gnu::always_inline]] static __m512 rounded(__m512 a, __m512 b) {
    return _mm512_div_round_ps(a, b, kStaticRound<kRound>);
  }
  template <Round kRound>
  [[gnu::always_inline]] static __m512d rounded(__m512d a, __m512d b) {
    return _mm512_div_round_pd(a, b, kStaticRound<kRound>);
  }
  template <Round kRound>
  [[gnu::always_inline]] static __m512 rounded_times_2_to_32(__m512 a, __m512 b) {
    return rounded<kRound>(scaled(a), b);
  }
#endif
};

// Computes 1 / a.
struct Inverse {
  static constexpr bool kIsExactWhenSmall = false;
  template <class T>
  [[gnu::always_inline]] static T of(T a) {
    return T(1) / a;
  }
#if defined(__AVX512F__)
  template <Round kRound>
  [[gnu::always_inline]] static __m512 rounded(__m512 a) {
    return _mm512_div_round_ps(_mm512_set1_ps(1.0f), a, kStaticRound<kRound>);
  }
  template <Round kRound>
  [[gnu::always_inline]] static __m512d rounded(__m512d a) {
    return _mm512_div_round_pd(_mm512_set1_pd(1.0), a, kStaticRound<kRound>);
  }
  template <Round kRound>
  [[gnu::always_inline]] static __m512 rounded_times_2_to_32(__m512 a) {
    return _mm512_div_round_ps(_mm512_set1_ps(0x1p32f), a, kStaticRound<kRound>);
  }
#endif
};

struct Root {
  static constexpr bool kIsExactWhenSmall = true;  // the result is never subnormal
  [[gnu::always_inline]] static float of(float a) { return __builtin_sqrtf(a); }
  [[gnu::always_inline]] static double of(double a) { return __builtin_sqrt(a); }
#if defined(__AVX512F__)
  template <Round kRound>
  [[gnu::always_inline]] static __m512 rounded(__m512 a) {
    return _mm512_sqrt_round_ps(a, kStaticRound<kRound>);
  }
  template <Round kRound>
  [[gnu::always_inline]] static __m512d rounded(__m512d a) {
    return _mm512_sqrt_round_pd(a, kStaticRound<kRound>);
  }
#endif
};

struct Narrowing {
  [[gnu::always_inline]] static float of(double a) { return float(a); }
#if defined(__AVX512F__)
  template <Round kRound>
  [[gnu::always_inline]] static __m256 rounded(__m512d a) {
    return _mm512_cvt_roundpd_ps(a, kStaticRound<kRound>);
  }
#endif
};

}  // namespace glint::isa::GLINT_ISA_PATH

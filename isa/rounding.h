// Rounds arithmetic in any direction, and flushes subnormals where a row says so, a warp at a time.
// SPDX-License-Identifier: Apache-2.0
//
// AVX-512 rounds by a field of the instruction and flushes by comparisons. Other paths set the host's MXCSR
// meanwhile. This is correct but not always fast: on some processors a pair of its loads takes 50 ns. Only
// files of isa/ops include this file.
#pragma once
#include <cstdint>
#include <string_view>
#include <tuple>
#include <xmmintrin.h>

#include "isa/op_makers.h"
#include "isa/row_vectors.h"

namespace glint::isa::GLINT_ISA_PATH {

// Names PTX's .rn .rz .rm .rp. The values are those of MXCSR's RC field (Intel SDM volume 1, 10.2.3.1).
enum class Round : uint8_t { Nearest = 0, Down = 1, Up = 2, Zero = 3 };

// Gives the direction in the form of vector instructions, which then ignore MXCSR.
template <Round kRound>
inline constexpr int kStaticRound = int(kRound) | 8;  // _MM_FROUND_NO_EXC

// Returns the mode of a row, which is its detail, as MXCSR has it. Flushing means that single and double
// subnormals of sources and results become zeros of their sign (MXCSR's DAZ and FTZ; a result counts as
// subnormal by its size after rounding with an unbounded exponent, as with PTX's .ftz).
constexpr uint16_t mode_bits(Round round, bool ftz) {
  return uint16_t(uint32_t(round) << 13 | (ftz ? 0x8040u : 0u));
}

// Does the arithmetic of a lane and finishes it.
template <class Work, class F>
struct Finished {
  template <class... A>
  [[gnu::always_inline]] auto operator()(A... a) const {
    return F{}(Work::of(a...), a...);
  }
};

#if defined(__AVX512F__)

// Returns the vector with subnormals replaced by zeros of their sign.
[[gnu::always_inline]] inline __m512 without_subnormals(__m512 x) {
  const __m512i bits = _mm512_castps_si512(x);
  const __mmask16 is_small = _mm512_testn_epi32_mask(bits, _mm512_set1_epi32(0x7f80'0000));
  return _mm512_castsi512_ps(
      _mm512_mask_and_epi32(bits, is_small, bits, _mm512_set1_epi32(int(0x8000'0000))));
}
[[gnu::always_inline]] inline __m512 scaled(__m512 x) {
  return _mm512_mul_ps(x, _mm512_set1_ps(0x1p32f));
}

// Performs the arithmetic of Work with .ftz. As in MXCSR's FTZ and in PTX, a result counts as subnormal by
// its size after rounding with an unbounded exponent: a result below 2^-126 may still round up to 2^-126
// where subnormals have fewer bits. Such a result is computed again, with all bits, from sources times 2^32.
// Where these sources overflow, the true result is either exact or not small, because it can be small and
// inexact only if the sources of a product or quotient are below 2^24.
template <class Work, Round kRound, class... Vector>
[[gnu::always_inline]] inline __m512 flushed_part(Vector... x) {
  const __m512 result = without_subnormals(Work::template rounded<kRound>(without_subnormals(x)...));
  if constexpr (Work::kIsExactWhenSmall) {
    return result;
  } else {
    const __m512 larger = Work::template rounded_times_2_to_32<kRound>(without_subnormals(x)...);
    const __mmask16 is_small =
        _mm512_cmp_ps_mask(_mm512_abs_ps(larger), _mm512_set1_ps(0x1p-94f), _CMP_LT_OQ);
    const __m512i bits = _mm512_castps_si512(result), sign = _mm512_set1_epi32(int(0x8000'0000));
    return _mm512_castsi512_ps(_mm512_mask_and_epi32(bits, is_small, bits, sign));
  }
}

template <Round kRound, bool kFtz, class Work, class F, class... A>
[[gnu::flatten]] void run_rounded(Warp& warp, const Inst& inst, const OpRow& row) {
  using R = decltype(F{}(Work::of(A{}...), A{}...));
  if (ran_some_lanes<R>(warp, inst, row, &run_rounded<kRound, kFtz, Work, F, A...>)) return;
  [&]<size_t... N>(std::index_sequence<N...>) {
    const Slot* const slot = &inst.operand.front();
    const std::tuple<Source<A>...> source{Source<A>(warp, slot[N + 1])...};
    using Raw = decltype(Work::of(A{}...));
    alignas(64) Raw raw[kLanes];
    const auto part = [&](int i) {
      if constexpr (kFtz)
        return flushed_part<Work, kRound>(load_part(std::get<N>(source), i)...);
      else
        return Work::template rounded<kRound>(load_part(std::get<N>(source), i)...);
    };
    constexpr int kStep = ((sizeof(A) == 8) || ...) ? 8 : 16;
    for (int i = 0; i < kLanes; i += 64 / int(sizeof(Raw)))
      if constexpr (kStep * sizeof(Raw) < 64)
        store_part(raw + i, joined_parts(part(i), part(i + kStep)));
      else
        store_part(raw + i, part(i));
    write_all_lanes<R>(warp, slot[0], [&](int i) { return F{}(raw[i], std::get<N>(source).at(i)...); });
  }
  (std::index_sequence_for<A...>{});
}

#else

// Calls the handler kRun while the host rounds and flushes as the row's mode says. The hardware does so for
// all lanes at once. The compiler does not know of the mode, but it moves no arithmetic across the call of a
// function that is not inlined. Every thread that runs Glint has MXCSR's state of process start. Therefore
// the state is set and not saved, because reading it takes longer than the arithmetic.
template <Handler kRun>
void run_in_mode(Warp& warp, const Inst& inst, const OpRow& row) {
  // Rounds to nearest, flushes nothing and traps nothing (System V ABI, 3.4.1).
  constexpr uint32_t kProcessStart = 0x1f80;
  _mm_setcsr(kProcessStart | row.detail);
  kRun(warp, inst, row);
  _mm_setcsr(kProcessStart);
}

#endif

// Makes a row whose result is `finish(x, a...)` of x = Work::of(a...), the arithmetic of a lane
// (isa/rounded_arithmetic.h), rounded in a direction and flushed. `finish` itself must depend on neither.
template <Round kRound, bool kFtz, class Work, class... A, class F>
constexpr OpRow flushed_op(std::string_view name, Unit unit, std::string_view doc, F, Examples examples) {
  OpRow row = value_op<A...>(name, unit, doc, Finished<Work, F>{}, examples);
  if constexpr (kRound != Round::Nearest || kFtz) {
    row.detail = mode_bits(kRound, kFtz);
#if defined(__AVX512F__)
    row.run = &run_rounded<kRound, kFtz, Work, F, A...>;
#else
    row.run = &run_in_mode<&run_value<Finished<Work, F>, A...>>;
#endif
  }
  return row;
}
// Makes a row like flushed_op(), but keeps subnormals.
template <Round kRound, class Work, class... A, class F>
constexpr OpRow rounded_op(std::string_view name, Unit unit, std::string_view doc, F finish,
                           Examples examples) {
  return flushed_op<kRound, false, Work, A...>(name, unit, doc, finish, examples);
}

}  // namespace glint::isa::GLINT_ISA_PATH

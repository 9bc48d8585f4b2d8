// Arithmetic rounded in any direction, with subnormals flushed where a row says so, a warp's worth at a time.
//
// AVX-512 rounds by a field of the instruction, and flushes by comparisons. Other paths set the host's MXCSR
// meanwhile, which is right and not always fast: on some processors a pair of its loads takes 50 ns. Included
// only by isa/ops/*.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <xmmintrin.h>

#include "isa/op_makers.h"
#include "isa/row_vectors.h"

namespace glint::isa::GLINT_ISA_PATH {

// PTX's .rn .rz .rm .rp; the values are those of MXCSR's RC field (Intel SDM volume 1, 10.2.3.1).
enum class Round : uint8_t { Nearest = 0, Down = 1, Up = 2, Zero = 3 };

// The direction as vector instructions take it, without a look at MXCSR.
template <Round kRound>
inline constexpr int kStaticRound = int(kRound) | 8;  // _MM_FROUND_NO_EXC

#if defined(__AVX512F__)

// Subnormals become zeros of their sign.
[[gnu::always_inline]] inline __m512 without_subnormals(__m512 x) {
  const __m512i bits = _mm512_castps_si512(x);
  const __mmask16 is_small = _mm512_testn_epi32_mask(bits, _mm512_set1_epi32(0x7f80'0000));
  return _mm512_castsi512_ps(
      _mm512_mask_and_epi32(bits, is_small, bits, _mm512_set1_epi32(int(0x8000'0000))));
}
[[gnu::always_inline]] inline __m512 scaled(__m512 x) {
  return _mm512_mul_ps(x, _mm512_set1_ps(0x1p32f));
}

// The arithmetic of Work with .ftz. A result counts as subnormal by its size once rounded with an unbounded
// exponent (as MXCSR's FTZ and PTX have it): less than 2^-126 may still round to 2^-126 where subnormals have
// fewer bits. Such a result comes again from sources times 2^32, with all bits. Where those overflow, the
// true result is either exact or not small: it is small and inexact only if a product's or quotient's sources
// are below 2^24.
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
[[gnu::flatten]] void run_rounded(Warp& warp, const Inst& inst) {
  [&]<size_t... N>(std::index_sequence<N...>) {
    const Slot* const slot = &inst.operand.front();
    const std::tuple<Source<A>...> source{Source<A>(warp, slot[N + 1])...};
    using Raw = decltype(Work::of(A{}...));
    alignas(64) Raw raw[kLanes];
    constexpr int kStep = ((sizeof(A) == 8) || ...) ? 8 : 16;
    for (int i = 0; i < kLanes; i += kStep)
      if constexpr (kFtz)
        store_part(raw + i, flushed_part<Work, kRound>(load_part(std::get<N>(source), i)...));
      else
        store_part(raw + i, Work::template rounded<kRound>(load_part(std::get<N>(source), i)...));
    const auto value = [&](int i) { return F{}(raw[i], std::get<N>(source).at(i)...); };
    write_result<decltype(value(0))>(warp, slot[0], value);
  }
  (std::index_sequence_for<A...>{});
}

#else

// Rounds that way while it lives, and with kFtz takes subnormal single and double sources and results as
// zeros of their sign (MXCSR's DAZ and FTZ; a result counts as subnormal by its size once rounded with an
// unbounded exponent, as PTX's .ftz has it). The host's arithmetic does it in hardware, all lanes at once;
// the fences keep the compiler, which knows nothing of it, from moving loads and stores (and so what lies
// between) across. Every thread that runs Glint has MXCSR's state of process start, so it is set, not saved:
// reading it takes longer than the arithmetic.
template <Round kRound, bool kFtz>
class RoundingScope {
 public:
  [[gnu::always_inline]] RoundingScope() {
    _mm_setcsr(kProcessStart | uint32_t(kRound) << 13 | (kFtz ? 0x8040u : 0));
    asm volatile("" ::: "memory");
  }
  [[gnu::always_inline]] ~RoundingScope() {
    asm volatile("" ::: "memory");
    _mm_setcsr(kProcessStart);
  }
  RoundingScope(const RoundingScope&) = delete;
  RoundingScope& operator=(const RoundingScope&) = delete;

 private:
  static constexpr uint32_t kProcessStart =
      0x1f80;  // nearest, nothing flushed, no traps (System V ABI, 3.4.1)
};

template <class Work, class F>
struct Finished {
  template <class... A>
  [[gnu::always_inline]] auto operator()(A... a) const {
    return F{}(Work::of(a...), a...);
  }
};
template <Round kRound, bool kFtz, class Work, class F, class... A>
[[gnu::flatten]] void run_rounded(Warp& warp, const Inst& inst) {
  const RoundingScope<kRound, kFtz> scope;
  run_value<Finished<Work, F>, A...>(warp, inst);
}

#endif

// A row whose result is `finish(x, a...)` of x = Work::of(a...), the arithmetic of a lane
// (isa/rounded_arithmetic.h), rounded in a direction and flushed. `finish` itself must not depend on either.
template <Round kRound, bool kFtz, class Work, class... A, class F>
constexpr OpRow flushed_op(std::string_view name, Unit unit, std::string_view doc, F, Examples examples) {
  OpRow row = value_op<A...>(
      name, unit, doc, [](A... a) { return F{}(Work::of(a...), a...); }, examples);
  if constexpr (kRound != Round::Nearest || kFtz) row.run = &run_rounded<kRound, kFtz, Work, F, A...>;
  return row;
}
// The same, subnormals kept.
template <Round kRound, class Work, class... A, class F>
constexpr OpRow rounded_op(std::string_view name, Unit unit, std::string_view doc, F finish,
                           Examples examples) {
  return flushed_op<kRound, false, Work, A...>(name, unit, doc, finish, examples);
}

}  // namespace glint::isa::GLINT_ISA_PATH

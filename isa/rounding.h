// The host's rounding direction while a warp's worth of floats is computed.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cfenv>
#include <cstdint>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include "isa/op_makers.h"

namespace glint::isa::GLINT_ISA_PATH {

// PTX's .rn .rz .rm .rp; the values are those of MXCSR's RC field (Intel SDM volume 1, 10.2.3.1).
enum class Round : uint8_t { Nearest = 0, Down = 1, Up = 2, Zero = 3 };

// Rounds that way while it lives. The host's arithmetic does it in hardware, all lanes at once; the fences keep the
// compiler, which knows nothing of the direction, from moving loads and stores (and so what lies between) across.
template <Round kRound>
class RoundingScope {
 public:
  [[gnu::always_inline]] RoundingScope() {
    if constexpr (kRound == Round::Nearest) return;
#if defined(__SSE__)
    saved_ = _mm_getcsr();
    _mm_setcsr((saved_ & ~0x6000u) | uint32_t(kRound) << 13);
#else
    saved_ = std::fegetround();
    std::fesetround(kRound == Round::Down ? FE_DOWNWARD : kRound == Round::Up ? FE_UPWARD : FE_TOWARDZERO);
#endif
    asm volatile("" ::: "memory");
  }
  [[gnu::always_inline]] ~RoundingScope() {
    if constexpr (kRound == Round::Nearest) return;
    asm volatile("" ::: "memory");
#if defined(__SSE__)
    _mm_setcsr(saved_);
#else
    std::fesetround(saved_);
#endif
  }
  RoundingScope(const RoundingScope&) = delete;
  RoundingScope& operator=(const RoundingScope&) = delete;

 private:
#if defined(__SSE__)
  uint32_t saved_ = 0;
#else
  int saved_ = 0;
#endif
};

template <Round kRound, class F, class... A>
[[gnu::flatten]] void run_rounded(Warp& warp, const Inst& inst) {
  const RoundingScope<kRound> scope;
  run_value<F, A...>(warp, inst);
}

// As value_op, with the arithmetic of `f` (+, -, *, /, fma, sqrt, conversions) rounded in a direction.
template <Round kRound, class... A, class F>
constexpr OpRow rounded_op(std::string_view name, Unit unit, std::string_view doc, F f, Examples examples) {
  OpRow row = value_op<A...>(name, unit, doc, f, examples);
  if constexpr (kRound != Round::Nearest) row.run = &run_rounded<kRound, F, A...>;
  return row;
}

}  // namespace glint::isa::GLINT_ISA_PATH

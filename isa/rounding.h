// The host's rounding direction and flushing of subnormals while a warp's worth of floats is computed.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <xmmintrin.h>

#include "isa/op_makers.h"

namespace glint::isa::GLINT_ISA_PATH {

// PTX's .rn .rz .rm .rp; the values are those of MXCSR's RC field (Intel SDM volume 1, 10.2.3.1).
enum class Round : uint8_t { Nearest = 0, Down = 1, Up = 2, Zero = 3 };

// Rounds that way while it lives, and with kFtz takes subnormal single and double sources and results as
// zeros of their sign (MXCSR's DAZ and FTZ; a result counts as subnormal by its size once rounded with an
// unbounded exponent, as PTX's .ftz has it). The host's arithmetic does it in hardware, all lanes at once;
// the fences keep the compiler, which knows nothing of it, from moving loads and stores (and so what lies
// between) across. Every thread that runs Glint has MXCSR's state of process start, so it is set, not saved: reading
// it takes longer than the arithmetic.
template <Round kRound, bool kFtz = false>
class RoundingScope {
 public:
  [[gnu::always_inline]] RoundingScope() {
    if constexpr (kIsDefault) return;
    _mm_setcsr(kProcessStart | uint32_t(kRound) << 13 | (kFtz ? 0x8040u : 0));
    asm volatile("" ::: "memory");
  }
  [[gnu::always_inline]] ~RoundingScope() {
    if constexpr (kIsDefault) return;
    asm volatile("" ::: "memory");
    _mm_setcsr(kProcessStart);
  }
  RoundingScope(const RoundingScope&) = delete;
  RoundingScope& operator=(const RoundingScope&) = delete;

 private:
  static constexpr bool kIsDefault = kRound == Round::Nearest && !kFtz;
  static constexpr uint32_t kProcessStart = 0x1f80;  // nearest, nothing flushed, no traps (System V ABI, 3.4.1)
};

template <Round kRound, bool kFtz, class F, class... A>
[[gnu::flatten]] void run_rounded(Warp& warp, const Inst& inst) {
  const RoundingScope<kRound, kFtz> scope;
  run_value<F, A...>(warp, inst);
}

// As value_op, with the arithmetic of `f` (+, -, *, /, fma, sqrt, conversions) rounded in a direction, and
// flushed.
template <Round kRound, bool kFtz, class... A, class F>
constexpr OpRow flushed_op(std::string_view name, Unit unit, std::string_view doc, F f, Examples examples) {
  OpRow row = value_op<A...>(name, unit, doc, f, examples);
  if constexpr (kRound != Round::Nearest || kFtz) row.run = &run_rounded<kRound, kFtz, F, A...>;
  return row;
}
// The same, subnormals kept.
template <Round kRound, class... A, class F>
constexpr OpRow rounded_op(std::string_view name, Unit unit, std::string_view doc, F f, Examples examples) {
  return flushed_op<kRound, false, A...>(name, unit, doc, f, examples);
}

}  // namespace glint::isa::GLINT_ISA_PATH

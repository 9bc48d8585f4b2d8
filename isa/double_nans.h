// Says which NaN a double-precision result is.
// SPDX-License-Identifier: Apache-2.0
//
// Only files of isa/ops include this file (see op_makers.h).
#pragma once
#include <cstdint>

#include "isa/kernels.h"

namespace glint::isa::GLINT_ISA_PATH {

inline constexpr uint64_t kQuietBit = 1ull << 51, kDefaultDoubleNan = 0xfff8'0000'0000'0000;

[[gnu::always_inline]] inline bool is_nan(double x) {
  return x != x;
}
[[gnu::always_inline]] inline double quiet(double nan) {
  return double_of(double_bits(nan) | kQuietBit);
}
// Returns the result. If it is a NaN, returns the NaN source that wins, with sign and payload, or
// 0xfff8000000000000 without a NaN source. Hosts differ in which NaN they return, so the choice is made here.
[[gnu::always_inline]] inline double with_nan(double result, double only) {
  const double nan = is_nan(only) ? quiet(only) : double_of(kDefaultDoubleNan);
  return is_nan(result) ? nan : result;
}
[[gnu::always_inline]] inline double with_nan(double result, double strong, double weak) {
  return with_nan(result, is_nan(strong) ? strong : weak);
}
[[gnu::always_inline]] inline double with_nan(double result, double strongest, double strong, double weak) {
  return with_nan(result, strongest, is_nan(strong) ? strong : weak);
}

}  // namespace glint::isa::GLINT_ISA_PATH

// Finds products and sums that may become one fused operation.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>

#include "frontend/ptx/draft.h"

namespace glint::frontend::ptx {

// Describes the results of a register that mul, add or sub writes without a rounding modifier. The map's keys
// are registers.
inline constexpr char kNotFree = 0;  // several of these ops write it, or one with a modifier or a guard
struct FreeResult {
  char op = 'm';       // first letter of mul, add or sub, or kNotFree
  std::string suffix;  // ".f32", ".ftz.f32"
};
using FreeArithmetic = std::map<VirtualRegister, FreeResult>;

// Fuses each such sum with a product of the same block and kind that only such sums read, if the product's
// factors still have their values. Where both operands are products the left one is fused, as measured: on
// the hardware, `mul x, a, b; mul y, c, d; sub z, x, y` is fma(a, b, -y).
void contract(Draft& draft, const FreeArithmetic& free, VirtualProgram& program);

}  // namespace glint::frontend::ptx

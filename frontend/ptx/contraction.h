// Products and sums that may become one fused operation.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>

#include "frontend/ptx/draft.h"

namespace glint::frontend::ptx {

// Results of mul, add and sub that were written without a rounding modifier, by their registers.
struct FreeResult {
  char op = 'm';       // of mul, add, sub
  std::string suffix;  // ".f32", ".ftz.f32"
};
using FreeArithmetic = std::map<VirtualRegister, FreeResult>;

// Fuses each such sum with a product that nothing else reads, of the same block and kind. Where both operands
// are products the left one is fused, as measured: `mul x, a, b; mul y, c, d; sub z, x, y` is fma(a, b, -y)
// on the hardware.
void contract(Draft& draft, const FreeArithmetic& free, VirtualProgram& program);

}  // namespace glint::frontend::ptx

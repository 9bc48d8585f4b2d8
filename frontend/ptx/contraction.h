// Finds products and sums that may become one fused operation.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>

#include "frontend/ptx/draft.h"

namespace glint::frontend::ptx {

// Describes a result of mul, add or sub that was written without a rounding modifier. The map's keys are
// registers.
struct FreeResult {
  char op = 'm';       // first letter of mul, add or sub
  std::string suffix;  // ".f32", ".ftz.f32"
};
using FreeArithmetic = std::map<VirtualRegister, FreeResult>;

// Fuses each such sum with a product of the same block and kind that nothing else reads. Where both operands
// are products the left one is fused, as measured: on the hardware, `mul x, a, b; mul y, c, d; sub z, x, y`
// is fma(a, b, -y).
void contract(Draft& draft, const FreeArithmetic& free, VirtualProgram& program);

}  // namespace glint::frontend::ptx

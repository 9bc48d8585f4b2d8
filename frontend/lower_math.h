// Elementary functions as sequences of ISA ops, with their errors.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/lower_emitter.h"

namespace glint::frontend::math {

// Products added left to right, each rounded.
Operand dot(Emitter& e, const Operands& a, const Operands& b);

// Polynomials in fma form; the errors were measured over the ranges against 128-bit arithmetic.
Operand asin(Emitter& e, Operand x);              // |x| <= 1: within 4 ulp
Operand acos(Emitter& e, Operand x);              // |x| <= 1: within 4 ulp, but absolute 2e-7 near x = 0
Operand atan(Emitter& e, Operand x);              // within 4 ulp
Operand atan2(Emitter& e, Operand y, Operand x);  // as atan; atan2(0, 0) = 0 or pi by the sign of x

// By ex2 and lg2; errors are theirs times the argument's size (Vulkan allows 3 + 2|x| ulp for exp).
Operand exp(Emitter& e, Operand x);
Operand log(Emitter& e, Operand x);
Operand pow(Emitter& e, Operand x, Operand y);  // pow(x, 0) = 1 for every x; undefined for x < 0

// Square matrices of 2, 3 or 4 columns, by cofactors.
Operands determinant(Emitter& e, const std::vector<Operands>& arguments);
Operands inverse(Emitter& e, const std::vector<Operands>& arguments);

}  // namespace glint::frontend::math

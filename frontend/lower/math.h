// Elementary functions as sequences of ISA ops, with their errors.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/lower/typed.h"

namespace glint::frontend::math {

// Products added left to right, each rounded.
Operand dot(Arithmetic& a, const Operands& x, const Operands& y);

// Single precision. Polynomials in fma form; errors are those that the test of built-ins measures
// (tests/shaders).
Operand asin(Emitter& e, Operand x);              // |x| <= 1: within 2 ulp
Operand acos(Emitter& e, Operand x);              // |x| <= 1: within 2 ulp
Operand atan(Emitter& e, Operand x);              // within 2 ulp
Operand atan2(Emitter& e, Operand y, Operand x);  // within 3 ulp; atan2(0, 0) = 0 or pi by the sign of x

// By ex2 and lg2; errors are theirs times the argument's size (Vulkan allows 3 + 2|x| ulp for exp).
Operand exp(Emitter& e, Operand x);
Operand log(Emitter& e, Operand x);
Operand pow(Emitter& e, Operand x, Operand y);  // pow(x, 0) = 1 for every x; undefined for x < 0

// As exp where the exponential rules, within 3 ulp elsewhere, near 0 too.
Operand sinh(Emitter& e, Operand x);
Operand cosh(Emitter& e, Operand x);
Operand tanh(Emitter& e, Operand x);
Operand asinh(Emitter& e, Operand x);
Operand acosh(Emitter& e, Operand x);  // NaN for x < 1
Operand atanh(Emitter& e, Operand x);  // infinite at -1 and 1, NaN beyond

// x * 2^n, rounded once; any n.
Operand ldexp(Arithmetic& a, Operand x, Operand n);
// x = fraction * 2^exponent with 1/2 <= |fraction| < 1; zeros, infinities and NaN are their own fraction,
// exponent 0.
struct Split {
  Operand fraction, exponent;
};
Split frexp(Arithmetic& a, Operand x);
// Fraction and whole part, both with the sign of x; an infinity has the fraction 0.
Split modf(Arithmetic& a, Operand x);  // `exponent` is the whole part

// Square matrices of 2, 3 or 4 columns, by cofactors.
Operands determinant(Arithmetic& a, const std::vector<Operands>& arguments);
Operands inverse(Arithmetic& a, const std::vector<Operands>& arguments);

}  // namespace glint::frontend::math

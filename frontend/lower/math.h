// Builds elementary functions as sequences of ISA ops, and states their errors.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "frontend/lower/typed.h"

namespace glint::frontend::math {

inline constexpr float kLog2E = 1.44269504088896f;
inline constexpr float kLn2 = 0.693147180559945f;

inline Operand abs(Emitter& e, Operand x) {
  return e.value("abs.f32", {x});
}
inline Operand with_sign(Emitter& e, Operand magnitude, Operand sign) {
  return e.value("copysign.f32", {sign, magnitude});
}
// Returns x + x * z * P(z), where z = x^2.
Operand odd(Emitter& e, Operand x, Operand z, std::span<const float> coefficients);

// Adds the products from the last to the first by fma. The order is the one in which a driver's reflect()
// adds.
Operand dot(Arithmetic& a, const Operands& x, const Operands& y);

// These functions work in single precision with polynomials in fma form. The stated errors are those that the
// test of built-ins measures (tests/shaders).
Operand asin(Emitter& e, Operand x);              // |x| <= 1: within 2 ulp
Operand acos(Emitter& e, Operand x);              // |x| <= 1: within 2 ulp
Operand atan(Emitter& e, Operand x);              // within 2 ulp
Operand atan2(Emitter& e, Operand y, Operand x);  // within 3 ulp; atan2(0, 0) = 0 or pi by the sign of x

// These functions use ex2 and lg2. Their errors are those of ex2 and lg2 times the argument's size (Vulkan
// allows 3 + 2|x| ulp for exp).
Operand exp(Emitter& e, Operand x);
Operand log(Emitter& e, Operand x);
Operand pow(Emitter& e, Operand x, Operand y);  // pow(x, 0) = 1 for every x; undefined for x < 0

// These functions have the errors of exp where the exponential dominates, and at most 3 ulp elsewhere, also
// near 0.
Operand sinh(Emitter& e, Operand x);
Operand cosh(Emitter& e, Operand x);
Operand tanh(Emitter& e, Operand x);
Operand asinh(Emitter& e, Operand x);
Operand acosh(Emitter& e, Operand x);  // NaN for x < 1
Operand atanh(Emitter& e, Operand x);  // infinite at -1 and 1, NaN beyond

// Returns x * 2^n, rounded once, for any n.
Operand ldexp(Arithmetic& a, Operand x, Operand n);
// Splits x into fraction * 2^exponent with 1/2 <= |fraction| < 1. A zero, an infinity or a NaN is its own
// fraction and has exponent 0.
struct Split {
  Operand fraction, exponent;
};
Split frexp(Arithmetic& a, Operand x);
// Returns the fraction and the whole part, both with the sign of x. An infinity has the fraction 0.
Split modf(Arithmetic& a, Operand x);  // `exponent` is the whole part

// Handle square matrices of 2, 3 or 4 columns by cofactors.
Operands determinant(Arithmetic& a, const std::vector<Operands>& arguments);
Operands inverse(Arithmetic& a, const std::vector<Operands>& arguments);

}  // namespace glint::frontend::math

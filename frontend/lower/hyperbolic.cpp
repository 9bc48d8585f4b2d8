// Computes hyperbolic functions and their inverses. The coefficients are minimax fits made for this project
// by Remez exchange; the comments give the largest error of the exact polynomial.
// SPDX-License-Identifier: Apache-2.0
#include <span>

#include "frontend/lower/math.h"

namespace glint::frontend::math {
namespace {

// The polynomials approximate f(x) = x + x z P(z) with z = x^2. Their relative errors are 5.3e-9 for |x| <=
// 1, 2.6e-9 for |x| <= 0.6 and 1.1e-9 for |x| <= 0.5.
constexpr float kSinh[] = {0.1666666716337204f, 0.008333349600434303f, 0.0001983615948120132f,
                           2.8169511097075883e-06f};
constexpr float kTanh[] = {-0.3333333134651184f,  0.13333246111869812f,  -0.0539521686732769f,
                           0.021732721477746964f, -0.00826274510473013f, 0.0022269748151302338f};
constexpr float kAsinh[] = {-0.1666666567325592f, 0.0749988928437233f,   -0.044613249599933624f,
                            0.0300129521638155f,  -0.01997998356819153f, 0.009167712181806564f};
constexpr float kTanhReach = 0.6f, kAsinhReach = 0.5f;

Operand odd_series(Emitter& e, Operand x, std::span<const float> coefficients) {
  return math::odd(e, x, e.mul(x, x), coefficients);
}

Operand less(Emitter& e, Operand a, float b) {
  return e.value("setp.lt.f32", {a, constant_f32(b)});
}

// Returns e^x / 2, which overflows where sinh and cosh do, and not before.
Operand half_exp(Emitter& e, Operand x) {
  return e.value("ex2.f32", {e.fma(x, constant_f32(kLog2E), constant_f32(-1))});
}

// Returns ln(1 + u) + shift ln 2. The bits that 1 + u loses, c, come back as c / (1 + u).
Operand log1p(Emitter& e, Operand u, Operand shift) {
  const Operand w = e.add(u, constant_f32(1));
  const Operand lost = e.sub(u, e.sub(w, constant_f32(1)));
  // At 2^24 and at infinity nothing has to be corrected.
  const Operand exact = e.value("setp.ge.f32", {u, constant_f32(16777216.0f)});
  const Operand correction = e.select(exact, constant_f32(0), e.div(lost, w));
  return e.fma(e.add(e.value("lg2.f32", {w}), shift), constant_f32(kLn2), correction);
}

// Above this value 1 is negligible next to x^2, and x^2 soon overflows.
constexpr float kHuge = 1048576.0f;  // 2^20

}  // namespace

Operand sinh(Emitter& e, Operand x) {
  const Operand magnitude = abs(e, x);
  const Operand half = half_exp(e, magnitude);
  const Operand large = e.sub(half, e.div(constant_f32(0.25f), half));
  return e.select(less(e, magnitude, 1), odd_series(e, x, kSinh), with_sign(e, large, x));
}

Operand cosh(Emitter& e, Operand x) {
  const Operand half = half_exp(e, abs(e, x));
  return e.add(half, e.div(constant_f32(0.25f), half));
}

// Returns 1 - 2 / (e^2x + 1) away from 0.
Operand tanh(Emitter& e, Operand x) {
  const Operand magnitude = abs(e, x);
  const Operand power = e.value("ex2.f32", {e.mul(magnitude, constant_f32(2 * kLog2E))});
  const Operand large = e.sub(constant_f32(1), e.div(constant_f32(2), e.add(power, constant_f32(1))));
  return e.select(less(e, magnitude, kTanhReach), odd_series(e, x, kTanh), with_sign(e, large, x));
}

// Uses ln(x + sqrt(x^2 + 1)) = log1p(x + x^2 / (1 + sqrt(x^2 + 1))).
Operand asinh(Emitter& e, Operand x) {
  const Operand magnitude = abs(e, x);
  const Operand square = e.mul(magnitude, magnitude);
  const Operand root = e.value("sqrt.rn.f32", {e.add(square, constant_f32(1))});
  const Operand u = e.add(magnitude, e.div(square, e.add(root, constant_f32(1))));
  const Operand is_huge = e.value("setp.gt.f32", {magnitude, constant_f32(kHuge)});
  const Operand large =
      log1p(e, e.select(is_huge, magnitude, u), e.select(is_huge, constant_f32(1), constant_f32(0)));
  return e.select(less(e, magnitude, kAsinhReach), odd_series(e, x, kAsinh), with_sign(e, large, x));
}

// With t = x - 1, uses ln(x + sqrt(x^2 - 1)) = log1p(t + sqrt(t (t + 2))).
Operand acosh(Emitter& e, Operand x) {
  const Operand t = e.sub(x, constant_f32(1));
  const Operand u = e.add(t, e.value("sqrt.rn.f32", {e.mul(t, e.add(t, constant_f32(2)))}));
  const Operand is_huge = e.value("setp.gt.f32", {x, constant_f32(kHuge)});
  const Operand result =
      log1p(e, e.select(is_huge, x, u), e.select(is_huge, constant_f32(1), constant_f32(0)));
  return e.select(less(e, x, 1), Operand::value(0x7fff'ffff), result);
}

// Uses ln((1 + x) / (1 - x)) / 2 = log1p(2 x / (1 - x)) / 2.
Operand atanh(Emitter& e, Operand x) {
  const Operand magnitude = abs(e, x);
  const Operand u = e.div(e.add(magnitude, magnitude), e.sub(constant_f32(1), magnitude));
  return with_sign(e, e.mul(log1p(e, u, constant_f32(0)), constant_f32(0.5f)), x);
}

}  // namespace glint::frontend::math

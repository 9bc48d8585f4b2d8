// Computes inverse circular functions, exponentials and logarithms. The coefficients are minimax fits made
// for this project by Remez exchange; the comments give the largest error of the exact polynomial.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/lower/math.h"

#include <span>

namespace glint::frontend::math {
namespace {

constexpr float kPi = 3.14159265358979f;
constexpr float kPiRest = -8.74227800037e-8f;  // pi - kPi
constexpr float kHalfPi = 1.57079632679490f;
constexpr float kHalfPiRest = -4.37113900019e-8f;

// These are the coefficients of asin(x) = x + x z P(z) with z = x^2 <= 1/4; the relative error is below
// 5.1e-9.
constexpr float kAsin[] = {0.16666750609874725f, 0.07495343685150146f, 0.04546626657247543f,
                           0.02419474720954895f, 0.04214620217680931f};
// These are the coefficients of atan(x) = x + x z P(z) with z = x^2 <= 1; the relative error is below 2.7e-9.
constexpr float kAtan[] = {-0.33333301544189453f, 0.19998574256896973f,  -0.14264485239982605f,
                           0.10953346639871597f,  -0.08406593650579453f, 0.05800812318921089f,
                           -0.03122559003531933f, 0.01093909703195095f,  -0.0017988847102969885f};

Operand greater(Emitter& e, Operand a, Operand b) {
  return e.value("setp.gt.f32", {a, b});
}

// For |x| > 1/2, asin(x) = pi/2 - 2 asin(sqrt((1 - |x|) / 2)). `value` is the asin of |x| or of this root.
struct Reduced {
  Operand is_large, value;
};
Reduced reduced_asin(Emitter& e, Operand magnitude) {
  const Operand is_large = greater(e, magnitude, constant_f32(0.5f));
  const Operand half = e.fma(magnitude, constant_f32(-0.5f), constant_f32(0.5f));
  const Operand z = e.select(is_large, half, e.mul(magnitude, magnitude));
  const Operand x = e.select(is_large, e.value("sqrt.rn.f32", {half}), magnitude);
  return {is_large, odd(e, x, z, kAsin)};
}

// Returns the arctangent for 0 <= x <= 1.
Operand atan_of_unit(Emitter& e, Operand x) {
  return odd(e, x, e.mul(x, x), kAtan);
}

}  // namespace

Operand odd(Emitter& e, Operand x, Operand z, std::span<const float> coefficients) {
  Operand p = constant_f32(coefficients.back());
  for (size_t i = coefficients.size() - 1; i-- > 0;) p = e.fma(p, z, constant_f32(coefficients[i]));
  return e.fma(e.mul(x, z), p, x);
}

Operand dot(Arithmetic& a, const Operands& x, const Operands& y) {
  Operand sum = a.mul(x.back(), y.back());
  for (size_t i = x.size() - 1; i-- > 0;) sum = a.fma(x[i], y[i], sum);
  return sum;
}

// Computes pi/2 - r as kHalfPi - (r - kHalfPiRest), which rounds once more but keeps the bits that the
// constant lost.
Operand asin(Emitter& e, Operand x) {
  const Reduced r = reduced_asin(e, abs(e, x));
  const Operand twice = e.fma(r.value, constant_f32(2), constant_f32(-kHalfPiRest));
  return with_sign(e, e.select(r.is_large, e.sub(constant_f32(kHalfPi), twice), r.value), x);
}

Operand acos(Emitter& e, Operand x) {
  const Reduced r = reduced_asin(e, abs(e, x));
  const Operand is_negative = e.value("setp.lt.f32", {x, constant_f32(0)});
  const Operand twice = e.add(r.value, r.value);
  const Operand from_pi = e.sub(constant_f32(kPi), e.add(twice, constant_f32(-kPiRest)));
  const Operand large = e.select(is_negative, from_pi, twice);
  const Operand small =
      e.sub(constant_f32(kHalfPi), e.add(with_sign(e, r.value, x), constant_f32(-kHalfPiRest)));
  return e.select(r.is_large, large, small);
}

Operand atan(Emitter& e, Operand x) {
  const Operand magnitude = abs(e, x);
  const Operand is_large = greater(e, magnitude, constant_f32(1));
  const Operand t = atan_of_unit(e, e.select(is_large, e.div(constant_f32(1), magnitude), magnitude));
  const Operand large = e.sub(constant_f32(kHalfPi), e.add(t, constant_f32(-kHalfPiRest)));
  return with_sign(e, e.select(is_large, large, t), x);
}

// Computes t, the arctangent of the smaller magnitude divided by the larger. Depending on the octant the
// result is t, pi/2 - t, pi/2 + t or pi - t, which is a constant in two parts plus t or -t.
Operand atan2(Emitter& e, Operand y, Operand x) {
  const Operand ax = abs(e, x), ay = abs(e, y);
  const Operand larger = e.value("max.f32", {ax, ay}), smaller = e.value("min.f32", {ax, ay});
  // The ratio is 0 for 0/0 and 1 for inf/inf, where both magnitudes are equal.
  const Operand is_zero = e.value("setp.eq.f32", {larger, constant_f32(0)});
  const Operand ratio =
      e.select(is_zero, constant_f32(0),
               e.select(e.value("setp.eq.f32", {ax, ay}), constant_f32(1), e.div(smaller, larger)));
  const Operand t = atan_of_unit(e, ratio);
  const Operand is_left = e.value("setp.lt.s32", {x, Operand::value(0)});  // tests the sign bit, so -0 counts
  const Operand is_steep = greater(e, ay, ax);
  const auto by_octant = [&](float steep, float left) {
    return e.select(is_steep, constant_f32(steep), e.select(is_left, constant_f32(left), constant_f32(0)));
  };
  const Operand falls = e.value("xor.pred", {is_steep, is_left});
  const Operand turned = e.select(falls, e.value("neg.f32", {t}), t);
  const Operand sum = e.add(by_octant(kHalfPi, kPi), e.add(turned, by_octant(kHalfPiRest, kPiRest)));
  const Operand both = e.add(ax, ay);  // NaN if either is NaN; min and max drop a NaN
  return e.select(e.value("testp.notanumber.f32", {both}), both, with_sign(e, sum, y));
}

Operand exp(Emitter& e, Operand x) {
  return e.value("ex2.f32", {e.mul(x, constant_f32(kLog2E))});
}
Operand log(Emitter& e, Operand x) {
  return e.mul(e.value("lg2.f32", {x}), constant_f32(kLn2));
}

Operand pow(Emitter& e, Operand x, Operand y) {
  if (is_constant(y, 0) || is_constant(y, 0x8000'0000)) return constant_f32(1);  // both zeros
  const Operand power = e.value("ex2.f32", {e.mul(y, e.value("lg2.f32", {x}))});
  if (y.kind == Operand::Kind::Constant) return power;
  // Without the selection, a zero y could give 0 * lg2(0), which is NaN.
  return e.select(e.value("setp.eq.f32", {y, constant_f32(0)}), constant_f32(1), power);
}

}  // namespace glint::frontend::math

// Elementary functions and small matrices. The coefficients are minimax fits made for this project by Remez
// exchange; the comments give the largest error of the exact polynomial.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/lower_math.h"

#include <span>

namespace glint::frontend::math {
namespace {

constexpr float kPi = 3.14159265358979f;
constexpr float kHalfPi = 1.57079632679490f;
constexpr float kLog2E = 1.44269504088896f;
constexpr float kLn2 = 0.693147180559945f;

// asin(x) = x + x z P(z), z = x^2 <= 1/4; relative error below 5.1e-9.
constexpr float kAsin[] = {0.16666750609874725f, 0.07495343685150146f, 0.04546626657247543f,
                           0.02419474720954895f, 0.04214620217680931f};
// atan(x) = x + x z P(z), z = x^2 <= 1; relative error below 2.7e-9.
constexpr float kAtan[] = {-0.33333301544189453f, 0.19998574256896973f,  -0.14264485239982605f,
                           0.10953346639871597f,  -0.08406593650579453f, 0.05800812318921089f,
                           -0.03122559003531933f, 0.01093909703195095f,  -0.0017988847102969885f};

// x + x * z * P(z) with z = x^2
Operand odd(Emitter& e, Operand x, Operand z, std::span<const float> coefficients) {
  Operand p = constant_f32(coefficients.back());
  for (size_t i = coefficients.size() - 1; i-- > 0;) p = e.fma(p, z, constant_f32(coefficients[i]));
  return e.fma(e.mul(x, z), p, x);
}

Operand greater(Emitter& e, Operand a, Operand b) {
  return e.value("setp.gt.f32", {a, b});
}
Operand abs(Emitter& e, Operand x) {
  return e.value("abs.f32", {x});
}
Operand with_sign(Emitter& e, Operand magnitude, Operand sign) {
  return e.value("copysign.f32", {sign, magnitude});
}

// For |x| > 1/2: asin(x) = pi/2 - 2 asin(sqrt((1 - |x|) / 2)). Returns asin of |x| or of the root.
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

// Of 0 <= x <= 1.
Operand atan_of_unit(Emitter& e, Operand x) {
  return odd(e, x, e.mul(x, x), kAtan);
}

}  // namespace

Operand dot(Emitter& e, const Operands& a, const Operands& b) {
  Operand sum = e.mul(a[0], b[0]);
  for (size_t i = 1; i < a.size(); ++i) sum = e.add(sum, e.mul(a[i], b[i]));
  return sum;
}

Operand asin(Emitter& e, Operand x) {
  const Reduced r = reduced_asin(e, abs(e, x));
  const Operand large = e.fma(r.value, constant_f32(-2), constant_f32(kHalfPi));
  return with_sign(e, e.select(r.is_large, large, r.value), x);
}

Operand acos(Emitter& e, Operand x) {
  const Reduced r = reduced_asin(e, abs(e, x));
  const Operand is_negative = e.value("setp.lt.f32", {x, constant_f32(0)});
  const Operand twice = e.add(r.value, r.value);
  const Operand large = e.select(is_negative, e.sub(constant_f32(kPi), twice), twice);
  const Operand small = e.sub(constant_f32(kHalfPi), with_sign(e, r.value, x));
  return e.select(r.is_large, large, small);
}

Operand atan(Emitter& e, Operand x) {
  const Operand magnitude = abs(e, x);
  const Operand is_large = greater(e, magnitude, constant_f32(1));
  const Operand t = atan_of_unit(e, e.select(is_large, e.div(constant_f32(1), magnitude), magnitude));
  return with_sign(e, e.select(is_large, e.sub(constant_f32(kHalfPi), t), t), x);
}

Operand atan2(Emitter& e, Operand y, Operand x) {
  const Operand ax = abs(e, x), ay = abs(e, y);
  const Operand larger = e.value("max.f32", {ax, ay}), smaller = e.value("min.f32", {ax, ay});
  // 0/0 and inf/inf: equal magnitudes stand for 0 and for 1.
  const Operand is_zero = e.value("setp.eq.f32", {larger, constant_f32(0)});
  const Operand ratio =
      e.select(is_zero, constant_f32(0),
               e.select(e.value("setp.eq.f32", {ax, ay}), constant_f32(1), e.div(smaller, larger)));
  const Operand t = atan_of_unit(e, ratio);
  const Operand right = e.select(greater(e, ay, ax), e.sub(constant_f32(kHalfPi), t), t);
  const Operand is_left = e.value("setp.lt.s32", {x, Operand::value(0)});  // the sign bit, also of -0
  return with_sign(e, e.select(is_left, e.sub(constant_f32(kPi), right), right), y);
}

Operand exp(Emitter& e, Operand x) {
  return e.value("ex2.f32", {e.mul(x, constant_f32(kLog2E))});
}
Operand log(Emitter& e, Operand x) {
  return e.mul(e.value("lg2.f32", {x}), constant_f32(kLn2));
}

Operand pow(Emitter& e, Operand x, Operand y) {
  if (is_constant(y, 0)) return constant_f32(1);
  const Operand power = e.value("ex2.f32", {e.mul(y, e.value("lg2.f32", {x}))});
  if (y.kind == Operand::Kind::Constant) return power;
  return e.select(e.value("setp.eq.f32", {y, constant_f32(0)}), constant_f32(1), power);  // 0 * lg2(0) is NaN
}

namespace {

// The determinant of the rows and columns named; m is n x n by columns.
Operand minor_of(Emitter& e, const Operands& m, size_t n, const std::vector<size_t>& rows,
                 const std::vector<size_t>& columns) {
  if (rows.size() == 1) return m[columns[0] * n + rows[0]];
  Operand sum;
  for (size_t c = 0; c < columns.size(); ++c) {
    std::vector<size_t> rest = columns;
    rest.erase(rest.begin() + long(c));
    const Operand term =
        e.mul(m[columns[c] * n + rows[0]], minor_of(e, m, n, {rows.begin() + 1, rows.end()}, rest));
    sum = c == 0 ? term : c % 2 ? e.sub(sum, term) : e.add(sum, term);
  }
  return sum;
}

size_t order_of(const Operands& matrix) {
  return matrix.size() == 4 ? 2 : matrix.size() == 9 ? 3 : 4;
}

std::vector<size_t> all_but(size_t n, size_t left_out) {
  std::vector<size_t> result;
  for (size_t i = 0; i < n; ++i)
    if (i != left_out) result.push_back(i);
  return result;
}

}  // namespace

Operands determinant(Emitter& e, const std::vector<Operands>& arguments) {
  const size_t n = order_of(arguments[0]);
  return {minor_of(e, arguments[0], n, all_but(n, n), all_but(n, n))};
}

Operands inverse(Emitter& e, const std::vector<Operands>& arguments) {
  const Operands& m = arguments[0];
  const size_t n = order_of(m);
  const Operand scale = e.div(constant_f32(1), determinant(e, arguments)[0]);
  Operands result;
  for (size_t column = 0; column < n; ++column)
    for (size_t row = 0; row < n; ++row) {  // the transposed cofactor: of row `column`, column `row`
      const Operand cofactor = e.mul(minor_of(e, m, n, all_but(n, column), all_but(n, row)), scale);
      result.push_back((row + column) % 2 ? e.value("neg.f32", {cofactor}) : cofactor);
    }
  return result;
}

}  // namespace glint::frontend::math

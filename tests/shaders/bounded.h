// Pairs a number with the distance that a conforming implementation may have from it: Vulkan's table of
// precision as arithmetic.
// SPDX-License-Identifier: Apache-2.0
//
// In the Vulkan specification, "Precision and Operation of SPIR-V Instructions", some operations have an
// error of their own, and others inherit the error of a formula. A Bounded computes the formula and adds up
// the errors. Subnormal results may be flushed.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace glint::test {

inline constexpr double kSmallestNormal = 0x1p-126, kLargest = 0x1.fffffep127;
inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

// Returns the distance of neighbouring floats around x.
inline double ulp(double x) {
  if (!std::isfinite(x)) return kUnbounded;
  return std::ldexp(1.0, std::max(x == 0 ? -149 : std::ilogb(x) - 23, -149));
}

struct Bounded {
  double v = 0, e = 0;
  Bounded() = default;
  // NOLINTNEXTLINE: implicit, because numbers mix with Bounded
  Bounded(double value, double error = 0) : v(value), e(error) {}
};

// Returns a result with the error of its operands, rounded to within `ulps`.
inline Bounded rounded(double v, double e, double ulps) {
  if (std::isnan(v) || std::isnan(e) || std::abs(v) + e > kLargest) return {v, kUnbounded};
  const double largest = std::abs(v) + e;
  const double flushed = largest - 2 * e < kSmallestNormal && largest > 0 ? kSmallestNormal : 0;
  return {v, e + ulps * ulp(largest) + flushed};
}
// Returns the largest change of f over the interval of x.
template <class F>
double spread(const Bounded& x, F&& f) {
  const double middle = f(x.v),
               change = std::max(std::abs(f(x.v - x.e) - middle), std::abs(f(x.v + x.e) - middle));
  return std::isnan(change) ? kUnbounded : change;
}

inline Bounded operator-(const Bounded& x) {
  return {-x.v, x.e};
}
inline Bounded operator+(const Bounded& x, const Bounded& y) {
  return rounded(x.v + y.v, x.e + y.e, 0.5);
}
inline Bounded operator-(const Bounded& x, const Bounded& y) {
  return x + -y;
}
inline Bounded operator*(const Bounded& x, const Bounded& y) {
  return rounded(x.v * y.v, std::abs(x.v) * y.e + std::abs(y.v) * x.e + x.e * y.e, 0.5);
}
inline Bounded operator/(const Bounded& x, const Bounded& y) {
  const double nearest = std::abs(y.v) - y.e;
  if (nearest < 0x1p-126 || std::abs(y.v) > 0x1p126)
    return {x.v / y.v, kUnbounded};  // the table gives no bound
  return rounded(x.v / y.v, (x.e + std::abs(x.v / y.v) * y.e) / nearest, 2.5);
}

inline Bounded abs(const Bounded& x) {
  return {std::abs(x.v), x.e};
}
inline Bounded min(const Bounded& x, const Bounded& y) {
  return {std::min(x.v, y.v), std::max(x.e, y.e)};
}
inline Bounded max(const Bounded& x, const Bounded& y) {
  return {std::max(x.v, y.v), std::max(x.e, y.e)};
}
inline Bounded floor(const Bounded& x) {
  if (std::floor(x.v - x.e) == std::floor(x.v + x.e)) return {std::floor(x.v)};
  return {std::floor(x.v), std::ceil(x.e)};
}

inline Bounded inversesqrt(const Bounded& x) {
  const auto f = [](double t) { return 1 / std::sqrt(t); };
  return rounded(f(x.v), spread(x, f), 2);
}
inline Bounded sqrt(const Bounded& x) {  // computed as 1 / inversesqrt
  if (x.v == 0 && x.e == 0) return {0};
  const auto f = [](double t) { return std::sqrt(t); };
  const double smallest = std::max(x.v - x.e, 0.0);
  const double e = std::isfinite(x.e) ? std::max(f(x.v + x.e) - f(x.v), f(x.v) - f(smallest)) : kUnbounded;
  return rounded(f(x.v), e, 2 + 2.5);
}
inline Bounded exp2(const Bounded& x) {
  const auto f = [](double t) { return std::exp2(t); };
  return rounded(f(x.v), spread(x, f), 3 + 2 * std::abs(x.v));
}
inline Bounded exp(const Bounded& x) {
  const auto f = [](double t) { return std::exp(t); };
  return rounded(f(x.v), spread(x, f), 3 + 2 * std::abs(x.v));
}
inline Bounded log_of(const Bounded& x, double (*f)(double)) {
  const double near_one = x.v >= 0.5 && x.v <= 2 ? 0x1p-21 : 0;
  Bounded result = rounded(f(x.v), spread(x, f), near_one != 0 ? 0.5 : 3);
  result.e += near_one;
  if (x.v - x.e < kSmallestNormal) result.e = kUnbounded;  // a flushed operand is 0
  return result;
}
inline Bounded log2(const Bounded& x) {
  return log_of(x, [](double t) { return std::log2(t); });
}
inline Bounded log(const Bounded& x) {
  return log_of(x, [](double t) { return std::log(t); });
}
inline Bounded pow(const Bounded& x, const Bounded& y) {
  return exp2(y * log2(x));
}

// The error is 2^-11 within [-pi, pi]; beyond, the table gives no bound.
inline Bounded circular(const Bounded& x, double value) {
  return {value, std::abs(x.v) <= std::numbers::pi ? 0x1p-11 + x.e : kUnbounded};
}
inline Bounded sin(const Bounded& x) {
  return circular(x, std::sin(x.v));
}
inline Bounded cos(const Bounded& x) {
  return circular(x, std::cos(x.v));
}
inline Bounded tan(const Bounded& x) {
  return sin(x) / cos(x);
}
inline Bounded atan(const Bounded& x) {
  return rounded(std::atan(x.v), x.e, 4096);
}
inline Bounded atan(const Bounded& y, const Bounded& x) {
  const double r = std::max(std::hypot(y.v, x.v) - y.e - x.e, 0.0);
  return rounded(std::atan2(y.v, x.v), y.e + x.e == 0 ? 0 : r == 0 ? kUnbounded : (y.e + x.e) / r, 4096);
}
inline Bounded asin(const Bounded& x) {
  return atan(x, sqrt(1.0 - x * x));
}
inline Bounded acos(const Bounded& x) {
  return atan(sqrt(1.0 - x * x), x);
}
inline Bounded sinh(const Bounded& x) {
  return (exp(x) - exp(-x)) * 0.5;
}
inline Bounded cosh(const Bounded& x) {
  return (exp(x) + exp(-x)) * 0.5;
}
inline Bounded tanh(const Bounded& x) {
  return sinh(x) / cosh(x);
}
inline Bounded asinh(const Bounded& x) {
  return log(x + sqrt(x * x + 1.0));
}
inline Bounded acosh(const Bounded& x) {
  return log(x + sqrt(x * x - 1.0));
}
inline Bounded atanh(const Bounded& x) {
  return log((1.0 + x) / (1.0 - x)) * 0.5;
}

// Returns `then` where x < y, else `other`, or a value that covers both when the errors leave it open.
inline Bounded if_less(const Bounded& x, const Bounded& y, const Bounded& then, const Bounded& other) {
  const Bounded& chosen = x.v < y.v ? then : other;
  const bool is_open = x.e + y.e > 0 && std::abs(x.v - y.v) <= x.e + y.e;
  return {chosen.v, is_open ? std::max(then.e, other.e) + std::abs(then.v - other.v) : chosen.e};
}

// These names work on plain numbers, with the exactness of a double.
using std::abs, std::floor, std::sqrt, std::exp2, std::exp, std::log2, std::log, std::pow, std::sin, std::cos,
    std::tan, std::asin, std::acos, std::sinh, std::cosh, std::tanh, std::asinh, std::acosh, std::atanh;
inline double min(double x, double y) {
  return y < x ? y : x;
}
inline double max(double x, double y) {
  return x < y ? y : x;
}
inline double inversesqrt(double x) {
  return 1 / std::sqrt(x);
}
inline double atan(double x) {
  return std::atan(x);
}
inline double atan(double y, double x) {
  return std::atan2(y, x);
}
inline double if_less(double x, double y, double then, double other) {
  return x < y ? then : other;
}

}  // namespace glint::test

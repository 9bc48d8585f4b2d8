// Holds the references of the float expressions, one line each. The same formula gives the value and its
// bound.
// SPDX-License-Identifier: Apache-2.0
#include "tests/shaders/builtin_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace glint::test {
namespace {

template <class F>
constexpr BuiltinReference of_floats(std::string_view expression, F,
                                     bool (*is_defined)(const Inputs&) = nullptr) {
  return {expression, [](const Inputs& x) { return F{}(double(x.a), double(x.b), double(x.c)); },
          [](const Inputs& x) { return Bounded(F{}(Bounded(x.a), Bounded(x.b), Bounded(x.c))); }, is_defined};
}
template <class F>
constexpr BuiltinReference in_order(std::string_view expression, F f) {
  BuiltinReference reference = of_floats(expression, f);
  reference.in_order = [](const Inputs& x) { return F{}(x.a, x.b, x.c); };
  return reference;
}
// Marks an expression for which Glint and the driver do the same operations.
template <class F>
constexpr BuiltinReference same_form(std::string_view expression, F f) {
  BuiltinReference reference = of_floats(expression, f);
  reference.is_same_form = true;
  return reference;
}
// Computes a function of the bits, correctly rounded.
template <class F>
constexpr BuiltinReference of_bits(std::string_view expression, F,
                                   bool (*is_defined)(const Inputs&) = nullptr) {
  return {expression, [](const Inputs& x) { return double(F{}(x)); },
          [](const Inputs& x) { return rounded(F{}(x), 0, 0.5); }, is_defined};
}

template <class T, size_t kSize>
using Vector = std::array<T, kSize>;
template <class T, size_t kSize>
T dot(const Vector<T, kSize>& x, const Vector<T, kSize>& y) {
  T sum = x[0] * y[0];
  for (size_t i = 1; i < kSize; ++i) sum = sum + x[i] * y[i];
  return sum;
}
template <class T, size_t kSize>
T length(const Vector<T, kSize>& x) {
  return sqrt(dot(x, x));
}
template <class T>
Vector<T, 3> vec3(T a, T b, T c) {
  return {a, b, c};
}
template <class T>
Vector<T, 3> fixed() {  // vec3(0.6, 0.0, 0.8)
  return {T(double(0.6f)), T(0.0), T(double(0.8f))};
}
template <class T>
T reflected(T a, T b, T c, size_t i) {
  const auto n = fixed<T>();
  const auto x = vec3(a, b, c);
  return x[i] - T(2.0) * dot(n, x) * n[i];
}
template <class T>
T refracted(T a, T b, T c) {
  const auto n = fixed<T>();
  const T size = length(vec3(a, b, c)), eta = T(double(0.7f));
  const auto x = vec3(a / size, b / size, c / size);
  const T d = dot(n, x), k = T(1.0) - eta * eta * (T(1.0) - d * d);
  return if_less(k, T(0.0), T(0.0), eta * x[0] - (eta * d + sqrt(k)) * n[0]);
}
// Computes the determinant of a matrix stored by columns, by cofactors along the first row.
template <class T>
T det2(T a, T b, T c, T d) {
  return a * d - b * c;
}
template <class T>
T det3(const Vector<T, 9>& m) {
  return m[0] * det2(m[4], m[5], m[7], m[8]) - m[3] * det2(m[1], m[2], m[7], m[8]) +
         m[6] * det2(m[1], m[2], m[4], m[5]);
}
template <class T>
T det4(const Vector<T, 16>& m) {
  T sum = T(0.0);
  for (size_t left_out = 0; left_out < 4; ++left_out) {
    Vector<T, 9> minor;
    for (size_t column = 0, to = 0; column < 4; ++column) {
      if (column == left_out) continue;
      for (size_t row = 1; row < 4; ++row) minor[to++] = m[4 * column + row];
    }
    const T term = m[4 * left_out] * det3(minor);
    sum = left_out % 2 ? sum - term : sum + term;
  }
  return sum;
}
template <class T>
Vector<T, 9> matrix3(T a, T b, T c) {
  return {a, b, c, b, c, a, c, a, T(1.0)};
}
double mod(double x, double y) {
  const double rest = std::fmod(x, y);
  return rest != 0 && (rest < 0) != (y < 0) ? rest + y : rest;
}
Bounded mod(const Bounded& x, const Bounded& y) {
  return {mod(x.v, y.v), (x - y * floor(x / y)).e};
}
double smoothstep(double low, double high, double x) {
  const double t = min(max((x - low) / (high - low), 0.0), 1.0);
  return t * t * (3 - 2 * t);
}
Bounded smoothstep(const Bounded& low, const Bounded& high, const Bounded& x) {
  const Bounded t = min(max((x - low) / (high - low), Bounded(0)), Bounded(1));
  return t * t * (3.0 - 2.0 * t);
}
// Vulkan defines x (1 - a) + y a, and its conformance tests take x + a (y - x), too.
double mix(double x, double y, double a) {
  return x * (1 - a) + y * a;
}
Bounded mix(const Bounded& x, const Bounded& y, const Bounded& a) {
  const Bounded defined = x * (1.0 - a) + y * a;
  return {defined.v, std::max(defined.e, (x + a * (y - x)).e)};
}
double half(uint32_t h) {
  const uint32_t exponent = h >> 10 & 31, fraction = h & 1023;
  const double sign = h & 0x8000 ? -1 : 1;
  if (exponent == 31) return fraction ? std::nan("") : sign * kUnbounded;
  return sign * (exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, int(exponent) - 25));
}
double signed_ratio(int value, int most) {
  return std::max(double(value) / most, -1.0);
}

bool no_nan(const Inputs& x) {
  return !std::isnan(x.a) && !std::isnan(x.b) && !std::isnan(x.c);
}
bool a_is_number(const Inputs& x) {
  return !std::isnan(x.a);
}
bool clamps(const Inputs& x) {
  return no_nan(x) && x.b <= x.c;
}

constexpr BuiltinReference kReferences[] = {
    of_floats("sin(a)", [](auto a, auto, auto) { return sin(a); }),
    of_floats("cos(a)", [](auto a, auto, auto) { return cos(a); }),
    of_floats("tan(a)", [](auto a, auto, auto) { return tan(a); }),
    of_floats(
        "asin(a)", [](auto a, auto, auto) { return asin(a); },
        [](const Inputs& x) { return std::abs(x.a) <= 1; }),
    of_floats(
        "acos(a)", [](auto a, auto, auto) { return acos(a); },
        [](const Inputs& x) { return std::abs(x.a) <= 1; }),
    of_floats("atan(a)", [](auto a, auto, auto) { return atan(a); }),
    of_floats(
        "atan(a,b)", [](auto a, auto b, auto) { return atan(a, b); },
        [](const Inputs& x) { return x.a != 0 || x.b != 0; }),
    of_floats("sinh(a)", [](auto a, auto, auto) { return sinh(a); }),
    of_floats("cosh(a)", [](auto a, auto, auto) { return cosh(a); }),
    of_floats("tanh(a)", [](auto a, auto, auto) { return tanh(a); }),
    of_floats("asinh(a)", [](auto a, auto, auto) { return asinh(a); }),
    of_floats(
        "acosh(a)", [](auto a, auto, auto) { return acosh(a); }, [](const Inputs& x) { return x.a >= 1; }),
    of_floats(
        "atanh(a)", [](auto a, auto, auto) { return atanh(a); },
        [](const Inputs& x) { return std::abs(x.a) < 1; }),
    of_floats(
        "pow(a,b)", [](auto a, auto b, auto) { return pow(a, b); },
        [](const Inputs& x) { return x.a > 0 || (x.a == 0 && x.b > 0); }),
    of_floats(
        "pow(abs(a),b)", [](auto a, auto b, auto) { return pow(abs(a), b); },
        [](const Inputs& x) { return x.a != 0 || x.b > 0; }),
    of_floats("exp(a)", [](auto a, auto, auto) { return exp(a); }),
    of_floats(
        "log(a)", [](auto a, auto, auto) { return log(a); }, [](const Inputs& x) { return x.a > 0; }),
    of_floats("exp2(a)", [](auto a, auto, auto) { return exp2(a); }),
    of_floats(
        "log2(a)", [](auto a, auto, auto) { return log2(a); }, [](const Inputs& x) { return x.a > 0; }),
    of_floats(
        "sqrt(a)", [](auto a, auto, auto) { return sqrt(a); }, [](const Inputs& x) { return x.a >= 0; }),
    of_floats(
        "inversesqrt(a)", [](auto a, auto, auto) { return inversesqrt(a); },
        [](const Inputs& x) { return x.a > 0; }),
    of_floats("abs(a)", [](auto a, auto, auto) { return abs(a); }),
    of_floats("-a", [](auto a, auto, auto) { return -a; }),
    of_bits(
        "sign(a)", [](const Inputs& x) { return double((x.a > 0) - (x.a < 0)); }, a_is_number),
    of_bits("floor(a)", [](const Inputs& x) { return std::floor(double(x.a)); }),
    of_bits("trunc(a)", [](const Inputs& x) { return std::trunc(double(x.a)); }),
    of_bits("round(a)", [](const Inputs& x) { return std::nearbyint(double(x.a)); }),
    of_bits("roundEven(a)", [](const Inputs& x) { return std::nearbyint(double(x.a)); }),
    of_bits("ceil(a)", [](const Inputs& x) { return std::ceil(double(x.a)); }),
    of_floats("fract(a)", [](auto a, auto, auto) { return a - floor(a); }),
    of_floats(
        "mod(a,b)", [](auto a, auto b, auto) { return mod(a, b); }, [](const Inputs& x) { return x.b != 0; }),
    of_floats(
        "min(a,b)", [](auto a, auto b, auto) { return min(a, b); }, no_nan),
    of_floats(
        "max(a,b)", [](auto a, auto b, auto) { return max(a, b); }, no_nan),
    of_floats(
        "clamp(a,b,c)", [](auto a, auto b, auto c) { return min(max(a, b), c); }, clamps),
    of_floats(
        "clamp(a,0.0,1.0)",
        [](auto a, auto, auto) { return min(max(a, decltype(a)(0.0)), decltype(a)(1.0)); }, a_is_number),
    same_form("mix(a,b,c)", [](auto a, auto b, auto c) { return mix(a, b, c); }),
    of_bits(
        "step(a,b)", [](const Inputs& x) { return x.b < x.a ? 0.0 : 1.0; }, no_nan),
    of_floats(
        "smoothstep(a,b,c)", [](auto a, auto b, auto c) { return smoothstep(a, b, c); },
        [](const Inputs& x) { return no_nan(x) && x.a < x.b; }),
    of_floats("fma(a,b,c)", [](auto a, auto b, auto c) { return a * b + c; }),
    in_order("a*b+c", [](auto a, auto b, auto c) { return a * b + c; }),
    of_floats("a+b", [](auto a, auto b, auto) { return a + b; }),
    of_floats("a-b", [](auto a, auto b, auto) { return a - b; }),
    of_floats("a*b", [](auto a, auto b, auto) { return a * b; }),
    of_floats(
        "a/b", [](auto a, auto b, auto) { return a / b; }, [](const Inputs& x) { return x.b != 0; }),
    of_floats(
        "1.0/a", [](auto a, auto, auto) { return decltype(a)(1.0) / a; },
        [](const Inputs& x) { return x.a != 0; }),
    of_floats("radians(a)",
              [](auto a, auto, auto) { return a * decltype(a)(std::numbers::pi) / decltype(a)(180.0); }),
    of_floats("degrees(a)",
              [](auto a, auto, auto) { return a * decltype(a)(180.0) / decltype(a)(std::numbers::pi); }),
    of_floats("length(vec3(a,b,c))", [](auto a, auto b, auto c) { return length(vec3(a, b, c)); }),
    of_floats("distance(vec3(a,b,c),vec3(c,a,b))",
              [](auto a, auto b, auto c) { return length(vec3(a - c, b - a, c - b)); }),
    of_floats("dot(vec3(a,b,c),vec3(b,c,a))",
              [](auto a, auto b, auto c) { return dot(vec3(a, b, c), vec3(b, c, a)); }),
    in_order("dot(vec2(a,b),vec2(b,c))", [](auto a, auto b, auto c) { return a * b + b * c; }),
    of_floats("dot(vec4(a,b,c,a),vec4(b,c,a,c))",
              [](auto a, auto b, auto c) { return a * b + b * c + c * a + a * c; }),
    same_form("cross(vec3(a,b,c),vec3(b,c,a)).x", [](auto a, auto b, auto c) { return b * a - c * c; }),
    same_form("cross(vec3(a,b,c),vec3(b,c,a)).y", [](auto a, auto b, auto c) { return c * b - a * a; }),
    of_floats("normalize(vec3(a,b,c)).x", [](auto a, auto b, auto c) { return a / length(vec3(a, b, c)); }),
    of_floats("normalize(vec3(a,b,c)).z", [](auto a, auto b, auto c) { return c / length(vec3(a, b, c)); }),
    of_floats("normalize(a)", [](auto a, auto, auto) { return a / abs(a); }),
    of_floats("length(a)", [](auto a, auto, auto) { return abs(a); }),
    of_floats("faceforward(a,b,c)",
              [](auto a, auto b, auto c) { return if_less(c * b, decltype(a)(0.0), a, -a); }),
    same_form("reflect(vec3(a,b,c),vec3(0.6,0.0,0.8)).y",
              [](auto a, auto b, auto c) { return reflected(a, b, c, 1); }),
    same_form("reflect(vec3(a,b,c),vec3(0.6,0.0,0.8)).x",
              [](auto a, auto b, auto c) { return reflected(a, b, c, 0); }),
    of_floats("refract(normalize(vec3(a,b,c)),vec3(0.6,0.0,0.8),0.7).x",
              [](auto a, auto b, auto c) { return refracted(a, b, c); }),
    of_floats("(mat3(a,b,c,b,c,a,c,a,1.0)*vec3(a,b,c)).x",
              [](auto a, auto b, auto c) { return a * a + b * b + c * c; }),
    of_floats("(vec3(a,b,c)*mat3(a,b,c,b,c,a,c,a,1.0)).y",
              [](auto a, auto b, auto c) { return a * b + b * c + c * a; }),
    of_floats("determinant(mat3(a,b,c,b,c,a,c,a,1.0))",
              [](auto a, auto b, auto c) { return det3(matrix3(a, b, c)); }),
    of_floats("determinant(mat4(a,b,c,1,b,c,a,2,c,a,1,3,1,2,a,b))",
              [](auto a, auto b, auto c) {
                using T = decltype(a);
                return det4(Vector<T, 16>{a, b, c, T(1.0), b, c, a, T(2.0), c, a, T(1.0), T(3.0), T(1.0),
                                          T(2.0), a, b});
              }),
    of_floats("inverse(mat2(a,b,c,1.0))[0].x",
              [](auto a, auto b, auto c) { return decltype(a)(1.0) / (a * decltype(a)(1.0) - b * c); }),
    of_floats(
        "inverse(mat3(a,b,c,b,c,a,c,a,1.0))[1].y",
        [](auto a, auto b, auto c) { return det2(a, c, c, decltype(a)(1.0)) / det3(matrix3(a, b, c)); }),
    of_floats("outerProduct(vec2(a,b),vec2(b,c))[1].x", [](auto a, auto, auto c) { return a * c; }),
    of_bits("unpackHalf2x16(ua).x", [](const Inputs& x) { return half(x.ua & 0xffff); }),
    of_bits("unpackHalf2x16(ua).y", [](const Inputs& x) { return half(x.ua >> 16); }),
    of_bits("unpackSnorm2x16(ua).x", [](const Inputs& x) { return signed_ratio(int16_t(x.ua), 32767); }),
    of_bits("unpackUnorm2x16(ua).y", [](const Inputs& x) { return double(x.ua >> 16) / 65535; }),
    of_bits("unpackSnorm4x8(ua).z", [](const Inputs& x) { return signed_ratio(int8_t(x.ua >> 16), 127); }),
    of_bits("unpackUnorm4x8(ua).w", [](const Inputs& x) { return double(x.ua >> 24) / 255; }),
    of_bits("float(ia)", [](const Inputs& x) { return double(int32_t(x.ua)); }),
    of_bits("float(ua)", [](const Inputs& x) { return double(x.ua); }),
    of_bits("ldexp(a,ib)",
            [](const Inputs& x) { return std::ldexp(double(x.a), std::clamp(int32_t(x.ub), -999, 999)); }),
    of_bits("ldexp(a,(ib&63)-32)",
            [](const Inputs& x) { return std::ldexp(double(x.a), int(x.ub & 63) - 32); }),
    of_bits("frexp_s(a)",
            [](const Inputs& x) {
              int e;
              return double(std::frexp(x.a, &e));
            }),
    of_bits("modf_f(a)",
            [](const Inputs& x) {
              double whole;
              return std::modf(double(x.a), &whole);
            }),
    of_bits("modf_i(a)", [](const Inputs& x) { return std::trunc(double(x.a)); }),
    of_bits("float(double(a)*double(b))", [](const Inputs& x) { return double(x.a) * double(x.b); }),
};

}  // namespace

const BuiltinReference* find_reference(std::string_view expression) {
  const auto it = std::find_if(std::begin(kReferences), std::end(kReferences),
                               [&](const BuiltinReference& r) { return r.expression == expression; });
  return it == std::end(kReferences) ? nullptr : it;
}

}  // namespace glint::test

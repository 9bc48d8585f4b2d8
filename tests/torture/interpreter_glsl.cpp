// Computes the exact functions of GLSL.std.450, without transcendental ones.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <spirv/unified1/GLSL.std.450.h>

#include "tests/torture/interpreter.h"

namespace glint::test::torture {
namespace {

// Returns the smaller of two numbers, with -0 before 0; of a number and a NaN it returns the number.
float smaller(float a, float b) {
  if (std::isnan(a)) return b;
  if (std::isnan(b)) return a;
  if (a == b) return std::signbit(a) ? a : b;
  return a < b ? a : b;
}
float larger(float a, float b) {
  if (std::isnan(a)) return b;
  if (std::isnan(b)) return a;
  if (a == b) return std::signbit(a) ? b : a;
  return a < b ? b : a;
}
float sign_of(float a) {
  return a > 0 ? 1.0f : a < 0 ? -1.0f : 0.0f;
}

float smooth_step(float low, float high, float x) {
  const float t = smaller(larger((x - low) / (high - low), 0), 1);
  return t * t * (3 - 2 * t);
}

// Scales by parts, of which the last rounds. std::ldexp rounds once as well.
float scaled(float x, int64_t n) {
  return std::ldexp(x, int(std::clamp<int64_t>(n, -1000, 1000)));
}

bool float_function(uint32_t function, const std::array<uint64_t, 3>& bits, uint64_t* r) {
  const float a = float_of(bits[0]), b = float_of(bits[1]), c = float_of(bits[2]);
  float result = 0;
  switch (function) {
    case GLSLstd450Round:  // ties to even (Choice)
    case GLSLstd450RoundEven:
      result = std::nearbyint(a);
      break;
    case GLSLstd450Trunc:
      result = std::trunc(a);
      break;
    case GLSLstd450Floor:
      result = std::floor(a);
      break;
    case GLSLstd450Ceil:
      result = std::ceil(a);
      break;
    case GLSLstd450Fract:
      result = a - std::floor(a);
      break;
    case GLSLstd450FAbs:
      *r = bits[0] & 0x7fff'ffff;
      return true;
    case GLSLstd450FSign:
      result = sign_of(a);
      break;
    case GLSLstd450Radians:
      result = a * 0.017453292519943295f;
      break;
    case GLSLstd450Degrees:
      result = a * 57.29577951308232f;
      break;
    case GLSLstd450Sqrt:
      result = std::sqrt(a);
      break;
    case GLSLstd450FMin:
    case GLSLstd450NMin:
      result = smaller(a, b);
      break;
    case GLSLstd450FMax:
    case GLSLstd450NMax:
      result = larger(a, b);
      break;
    case GLSLstd450FClamp:
    case GLSLstd450NClamp:
      result = smaller(larger(a, b), c);
      break;
    case GLSLstd450FMix:
      result = std::fma(c, b - a, a);
      break;
    case GLSLstd450Step:
      result = b < a ? 0.0f : 1.0f;
      break;
    case GLSLstd450SmoothStep:
      result = smooth_step(a, b, c);
      break;
    case GLSLstd450Fma:
      result = std::fma(a, b, c);
      break;
    case GLSLstd450Ldexp:
      result = scaled(a, extended(bits[1], 32));
      break;
    default:
      return false;
  }
  *r = bits_of(result);
  return true;
}

bool integer_function(uint32_t function, const std::array<uint64_t, 3>& bits, uint32_t width, uint64_t* r) {
  const int64_t a = extended(bits[0], width), b = extended(bits[1], width), c = extended(bits[2], width);
  const auto word = uint32_t(bits[0]);
  switch (function) {
    case GLSLstd450SAbs:
      *r = a < 0 ? 0 - uint64_t(a) : uint64_t(a);
      return true;
    case GLSLstd450SSign:
      *r = uint64_t(int64_t(a > 0) - int64_t(a < 0));
      return true;
    case GLSLstd450SMin:
      *r = uint64_t(std::min(a, b));
      return true;
    case GLSLstd450SMax:
      *r = uint64_t(std::max(a, b));
      return true;
    case GLSLstd450SClamp:
      *r = uint64_t(std::min(std::max(a, b), c));
      return true;
    case GLSLstd450UMin:
      *r = std::min(bits[0], bits[1]);
      return true;
    case GLSLstd450UMax:
      *r = std::max(bits[0], bits[1]);
      return true;
    case GLSLstd450UClamp:
      *r = std::min(std::max(bits[0], bits[1]), bits[2]);
      return true;
    case GLSLstd450FindILsb:
      *r = word ? uint64_t(std::countr_zero(word)) : ~0ull;
      return true;
    case GLSLstd450FindUMsb:
      *r = uint64_t(31 - std::countl_zero(word));
      return true;
    case GLSLstd450FindSMsb:
      *r = uint64_t(31 - std::countl_zero(a < 0 ? ~word : word));
      return true;
    default:
      return false;
  }
}

}  // namespace

bool compute_glsl(uint32_t function, Scalar to, const std::vector<const Value*>& x, Value* result) {
  result->count = x[0]->count;
  for (uint32_t i = 0; i < result->count; ++i) {
    std::array<uint64_t, 3> bits{};
    for (size_t n = 0; n < x.size() && n < bits.size(); ++n) bits[n] = x[n]->part[x[n]->count == 1 ? 0 : i];
    uint64_t& r = result->part[i];
    const bool known = to.kind == Scalar::Kind::Float ? to.width == 32 && float_function(function, bits, &r)
                                                      : integer_function(function, bits, to.width, &r);
    if (!known) return false;
    r = cut(r, to.width);
  }
  return true;
}

}  // namespace glint::test::torture

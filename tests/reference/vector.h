// Names GLM's vectors for the reference, and adds what Glint rounds otherwise than GLM.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace glint::reference {

using Vec = glm::vec3;
using glm::dot;

// GLSL's functions add products by fma (frontend/lower/glsl_std.cpp), and `dot` does not.
inline Vec fused(const Vec& a, const Vec& b, const Vec& c) {
  return {std::fma(a.x, b.x, c.x), std::fma(a.y, b.y, c.y), std::fma(a.z, b.z, c.z)};
}
inline float fused_dot(const Vec& a, const Vec& b) {
  return std::fma(a.x, b.x, std::fma(a.y, b.y, a.z * b.z));
}

inline float length(const Vec& v) {
  return std::sqrt(fused_dot(v, v));
}
// Divides by the length. glm::normalize() multiplies by the reciprocal of the length, which rounds twice.
inline Vec normalize(const Vec& v) {
  return v / length(v);
}
inline Vec mix(const Vec& x, const Vec& y, float a) {
  return fused(Vec(a), y - x, x);
}
inline Vec reflect(const Vec& i, const Vec& n) {
  return fused(Vec(-2 * fused_dot(n, i)), n, i);
}
inline Vec refract(const Vec& i, const Vec& n, float eta) {
  const float d = fused_dot(n, i), k = std::fma(-(eta * eta), std::fma(-d, d, 1.0f), 1.0f);
  if (k < 0) return Vec(0);
  return fused(Vec(-std::fma(eta, d, std::sqrt(k))), n, eta * i);
}

}  // namespace glint::reference

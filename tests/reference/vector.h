// Holds three floats with GLSL's operations, each rounded once and in GLSL's order, for the reference.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>

namespace glint::reference {

struct Vec {
  float x = 0, y = 0, z = 0;
  Vec() = default;
  Vec(float all) : x(all), y(all), z(all) {}  // as GLSL mixes scalars and vectors
  Vec(float x_, float y_, float z_) : x(x_), y(y_), z(z_) {}
  Vec(const std::array<float, 3>& v) : x(v[0]), y(v[1]), z(v[2]) {}
};

inline Vec operator+(const Vec& a, const Vec& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec operator-(const Vec& a, const Vec& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec operator*(const Vec& a, const Vec& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
inline Vec operator/(const Vec& a, const Vec& b) {
  return {a.x / b.x, a.y / b.y, a.z / b.z};
}
inline Vec operator-(const Vec& a) {
  return {-a.x, -a.y, -a.z};
}

inline float dot(const Vec& a, const Vec& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline float length(const Vec& v) {
  return std::sqrt(dot(v, v));
}
inline Vec normalize(const Vec& v) {
  return v / length(v);
}
inline Vec mix(const Vec& a, const Vec& b, float t) {
  return a * (1.0f - t) + b * t;
}
inline Vec reflect(const Vec& d, const Vec& n) {
  return d - n * (2.0f * dot(n, d));
}

// Returns the zero vector on total reflection (GLSL specification, 8.5).
inline Vec refract(const Vec& d, const Vec& n, float eta) {
  const float projection = dot(n, d);
  const float k = 1.0f - eta * eta * (1.0f - projection * projection);
  if (k < 0.0f) return {};
  return d * eta - n * (eta * projection + std::sqrt(k));
}

}  // namespace glint::reference

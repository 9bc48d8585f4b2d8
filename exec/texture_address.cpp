// Turns coordinates into texels, after the Vulkan specification's chapter "Image Operations".
// SPDX-License-Identifier: Apache-2.0
#include "exec/texture_address.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace glint::exec {
namespace {

int64_t modulo(int64_t a, int64_t n) {
  return ((a % n) + n) % n;
}
int64_t mirror(int64_t a) {
  return a >= 0 ? a : -(1 + a);
}

// Holds the axes of a face: which component of a direction is s, t and r, and its sign there (Vulkan, table
// "Cube map face and coordinate selection").
struct Face {
  uint8_t s, t, r;
  float sign_s, sign_t, sign_r;
};
constexpr Face kFaces[6] = {{2, 1, 0, -1, -1, 1}, {2, 1, 0, 1, -1, -1}, {0, 2, 1, 1, 1, 1},
                            {0, 2, 1, 1, -1, -1}, {0, 1, 2, 1, -1, 1},  {0, 1, 2, -1, -1, -1}};

// Returns the face that a direction meets. Ties go to z, then y.
uint32_t face_of(const std::array<float, 3>& direction) {
  const float x = std::fabs(direction[0]), y = std::fabs(direction[1]), z = std::fabs(direction[2]);
  if (z >= x && z >= y) return direction[2] < 0.0f ? 5 : 4;
  if (y >= x) return direction[1] < 0.0f ? 3 : 2;
  return direction[0] < 0.0f ? 1 : 0;
}

// Computes log2 by the series of atanh, which gives the same bits with every C library. x is positive and
// finite.
double log2_of(double x) {
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);  // in [0.5, 1)
  if (mantissa < 0.70710678118654752) mantissa *= 2, --exponent;
  const double z = (mantissa - 1) / (mantissa + 1), zz = z * z;  // |z| < 0.172: ten terms leave 2^-55
  double sum = 0;
  for (int n = 21; n >= 1; n -= 2) sum = sum * zz + 1.0 / n;
  constexpr double kTwoOverLn2 = 2.8853900817779268;
  return exponent + kTwoOverLn2 * z * sum;
}

}  // namespace

int64_t wrap(Wrap mode, int64_t i, int64_t size) {
  switch (mode) {
    case Wrap::Repeat:
      return modulo(i, size);
    case Wrap::MirroredRepeat:
      return size - 1 - mirror(modulo(i, 2 * size) - size);
    case Wrap::ClampToEdge:
      return std::clamp<int64_t>(i, 0, size - 1);
    case Wrap::ClampToBorder:
      return i < 0 || i >= size ? kBorder : i;
    case Wrap::MirrorClampToEdge:
      return std::min(mirror(i), size - 1);
  }
  return kBorder;
}

double tame(Wrap mode, float x, uint32_t size) {
  constexpr float kFar = 1099511627776.0f;  // 2^40: past every image, and float - 0.5 is exact in a double
  if (std::isnan(x)) return 0.0;
  if (std::fabs(x) < kFar) return x;
  if (std::isinf(x) || (mode != Wrap::Repeat && mode != Wrap::MirroredRepeat)) return std::copysign(kFar, x);
  return std::fmod(double(x), 2.0 * size);  // This is exact.
}

CubePoint cube_point(const std::array<float, 3>& direction) {
  const uint32_t face = face_of(direction);
  const Face& f = kFaces[face];
  const float r = std::fabs(direction[f.r]);
  return {face, 0.5f * (f.sign_s * direction[f.s] / r) + 0.5f, 0.5f * (f.sign_t * direction[f.t] / r) + 0.5f};
}

CubeTexel across_edge(uint32_t face, int64_t x, int64_t y, int64_t size) {
  const Face& f = kFaces[face];
  // The direction to a point just past the edge meets the neighbour's row at that edge, next to the same
  // texel.
  const auto middle = [&](int64_t i) {
    if (i < 0 || i >= size) return std::copysign(1.0f + 0x1p-20f, float(i));
    return float(2 * i + 1) / float(size) - 1.0f;
  };
  std::array<float, 3> direction{};
  direction[f.s] = f.sign_s * middle(x);
  direction[f.t] = f.sign_t * middle(y);
  direction[f.r] = f.sign_r;
  const CubePoint point = cube_point(direction);
  const auto texel = [&](float s) {
    return std::clamp<int64_t>(int64_t(std::floor(s * float(size))), 0, size - 1);
  };
  return {point.face, texel(point.s), texel(point.t)};
}

Footprint footprint_of(const ImageView& image, int count, const Gradient& dx, const Gradient& dy,
                       float max_anisotropy) {
  double x = 0, y = 0;
  for (int axis = 0; axis < count; ++axis) {
    const double size = image.extent(axis, 0);
    x += size * dx[size_t(axis)] * size * dx[size_t(axis)];
    y += size * dy[size_t(axis)] * size * dy[size_t(axis)];
  }
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const double squared = std::max(x, y);
  if (std::isinf(squared)) return {kInfinity, 1, false};
  if (!(squared > 0.0)) return {-kInfinity, 1, false};  // There is no footprint, or it is not a number.
  if (!(max_anisotropy > 1.0f)) return {float(0.5 * log2_of(squared)), 1, false};
  // These are squares, like the lengths of the sides.
  const double shorter = std::max(std::min(x, y), std::numeric_limits<double>::min());
  const double most = std::min(double(max_anisotropy) * max_anisotropy, std::max(squared, 1.0));
  const double ratio = std::min(squared / shorter, most);
  return {float(0.5 * log2_of(squared / ratio)), uint32_t(std::ceil(std::sqrt(ratio))), y > x};
}

Gradient cube_gradient(const std::array<float, 3>& direction, const Gradient& change) {
  const Face& f = kFaces[face_of(direction)];
  const double r = std::fabs(direction[f.r]);
  const double dr = std::signbit(direction[f.r]) ? -change[f.r] : change[f.r];
  const auto quotient = [&](double value, double d) { return float(0.5 * (r * d - value * dr) / (r * r)); };
  return {quotient(f.sign_s * direction[f.s], f.sign_s * change[f.s]),
          quotient(f.sign_t * direction[f.t], f.sign_t * change[f.t]), 0.0f};
}

}  // namespace glint::exec

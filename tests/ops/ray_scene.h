// Builds a small acceleration structure and aims rays at chosen points of its primitives.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "memsys/address_space.h"
#include "tests/ops/op_lab.h"

namespace glint::test {

using Point = std::array<double, 3>;

// Holds a ray, and what it meets: that is known because it was aimed there. A ray meets one primitive or
// none.
struct Aim {
  Point origin{}, direction{};
  double tmin = 0.25, tmax = 0;
  bool hits = false, is_box = false, is_opaque = false, is_front = false;
  uint32_t instance = 0, custom = 0, sbt_offset = 0, geometry = 0, primitive = 0;
  double t = 0, u = 0, v = 0;         // of a triangle
  std::array<Point, 3> corner{};      // of a triangle, in object space
  std::array<double, 12> to_world{};  // of the instance, row-major 3x4
};

// Holds three instances of two bottom levels with rotations, scales, shears and a mirror. Triangles are not
// opaque, and boxes of geometry 0 are.
class RayScene {
 public:
  explicit RayScene(mem::AddressSpace& memory);
  Address address() const { return address_; }
  // Aims at a primitive, or past all of them in one of eight cases unless `must_hit`.
  Aim aim(Random& random, bool must_hit) const;

  static constexpr uint32_t kInstances = 3, kGeometries = 2, kPrimitives = 3;
  static bool has_boxes(uint32_t instance) { return instance == 1; }

 private:
  std::array<std::array<std::array<Point, 3>, kPrimitives>, kGeometries> triangles_{};
  Address address_ = 0;
};

Point transformed(const std::array<double, 12>& matrix, const Point& point, double w);
// Returns the inverse of an affine matrix, row-major 3x4.
std::array<double, 12> inverse_of(const std::array<double, 12>& matrix);

}  // namespace glint::test

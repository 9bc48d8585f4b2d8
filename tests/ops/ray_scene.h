// Builds a small acceleration structure and aims rays at chosen points of its primitives.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "memsys/address_space.h"
#include "tests/ops/numbers.h"
#include "tests/ops/op_lab.h"

namespace glint::test {

using Point = std::array<double, 3>;

// Holds what an op or a shader should see: a number of single precision, or an integer.
struct Value {
  bool is_float = false;
  double number = 0;
  // Floats need to be near only, because the machines round.
  bool is(uint32_t word) const;
};
inline Value integer(uint32_t x) {
  return {false, double(x)};
}
inline Value real(double x) {
  return {true, x};
}
// Returns the bits of the number in single precision.
inline uint32_t word_of(double x) {
  return uint32_t(bits_of(kSingle, x));
}

// Holds a ray, and what it meets: that is known because it was aimed there. A ray meets one primitive or
// none.
struct Aim {
  Point origin{}, direction{};
  double tmin = 0.25, tmax = 0;
  bool hits = false, is_box = false, is_opaque = false, is_front = false;
  uint32_t instance = 0, custom = 0, mask = 0, sbt_offset = 0, geometry = 0, primitive = 0;
  double t = 0, u = 0, v = 0;         // of a triangle
  std::array<Point, 3> corner{};      // of a triangle, in object space
  std::array<double, 12> to_world{};  // of the instance, row-major 3x4
};

// Holds three instances of two bottom levels with rotations, scales, shears and a mirror. Triangles are not
// opaque, and boxes of geometry 0 are.
class RayScene {
 public:
  // The offset into the binding table of the last instance may be made small, so that a table fits.
  explicit RayScene(mem::AddressSpace& memory, uint32_t last_sbt_offset = 0x123456);
  Address address() const { return address_; }
  // Aims at a primitive, or past all of them in one of eight cases unless `must_hit`.
  Aim aim(Random& random, bool must_hit) const;

  static constexpr uint32_t kInstances = 3, kGeometries = 2, kPrimitives = 3;
  static bool has_boxes(uint32_t instance) { return instance == 1; }

 private:
  std::array<std::array<std::array<Point, 3>, kPrimitives>, kGeometries> triangles_{};
  Address address_ = 0;
  const uint32_t last_sbt_offset_;
  uint32_t sbt_offset_of(uint32_t instance) const;
};

// Return what belongs to the ray itself, and to the instance and the primitive that it met. The words are
// those of names: {"origin", "x"}, {"object_to_world", "7"}, {"object", "direction", "z"}, {"primitive"}.
std::optional<Value> value_of_ray(std::span<const std::string_view> words, const Aim& aim);
std::optional<Value> value_of_instance(std::span<const std::string_view> words, const Aim& aim);
// Returns a coordinate of a corner by its number, 0 to 8.
Value value_of_corner(std::string_view number, const Aim& aim);

Point transformed(const std::array<double, 12>& matrix, const Point& point, double w);
// Returns the inverse of an affine matrix, row-major 3x4.
std::array<double, 12> inverse_of(const std::array<double, 12>& matrix);

}  // namespace glint::test

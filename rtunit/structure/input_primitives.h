// Reads the triangles and boxes of a bottom level's input, and says which of them are active.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "rtunit/structure/build.h"
#include "rtunit/structure/build_tree.h"

namespace glint::rt {

using Position = std::array<float, 3>;
using Triangle = std::array<Position, 3>;

inline Bounds bounds_of(const Triangle& triangle) {
  Bounds out{triangle[0], triangle[0]};
  for (const Position& p : triangle) extend(out, {p, p});
  return out;
}
bool is_finite(const Bounds& bounds);

// Return the number of triangles of a geometry without boxes, and the number of its primitives of either
// kind.
uint64_t num_triangles(const Geometry& geometry);
uint64_t num_primitives(const Geometry& geometry);

// Returns the corners of a triangle, or nothing when one of them is not finite. Throws UserError when an
// index is out of range.
std::optional<Triangle> corners_at(const Geometry& geometry, uint64_t index);

// Returns the corners of a triangle, or nothing when the triangle is inactive. Throws as corners_at() does.
std::optional<Triangle> triangle_at(const Geometry& geometry, uint64_t index);

// In Vulkan a box is inactive when its first coordinate is not a number. Choice: it is also inactive when any
// coordinate is infinite or the box is inside out.
bool is_active(const Bounds& box);

}  // namespace glint::rt

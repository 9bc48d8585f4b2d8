// Simple solids for built-in scenes: boxes, turned bodies, ropes and cloth, with normals.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <span>

#include "scenes/mesh.h"

namespace glint::scenes {

struct Ring {
  float position = 0;  // along the axis, 0 = start, 1 = end
  float radius = 0;    // world units
};

// A body turned about the axis from `start` to `end`, with `sides` facets and flat caps at both ends when
// `closed`: 2 * sides * (rings - 1) triangles and sides - 2 a cap.
void add_turned_body(Model& model, const Vec3& start, const Vec3& end, std::span<const Ring> rings,
                     uint32_t sides, bool closed, int32_t material);

// An open prism of three sides, 6 triangles: a rope.
void add_rope(Model& model, const Vec3& start, const Vec3& end, float radius, int32_t material);

// An axis-aligned box, 12 triangles.
void add_box(Model& model, const Vec3& lower, const Vec3& upper, int32_t material);

// A sheet over (u, v) in [0, 1]^2, 2 * columns * rows triangles, with the normals of its triangles smoothed.
void add_sheet(Model& model, uint32_t columns, uint32_t rows, int32_t material,
               const std::function<Vec3(float, float)>& position);

}  // namespace glint::scenes

// Builds simple solids for built-in scenes: boxes, turned bodies, ropes and cloth, with normals.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <span>

#include "scenes/mesh.h"

namespace glint::scenes {

struct Ring {
  float position = 0;  // along the axis, from 0 (start) to 1 (end)
  float radius = 0;    // world units
};

// Adds a body turned about the axis from `start` to `end`, with `sides` facets. It has flat caps at both ends
// when `closed` is set. The body has 2 * sides * (rings - 1) triangles, and each cap has sides - 2.
void add_turned_body(Model& model, const Vec3& start, const Vec3& end, std::span<const Ring> rings,
                     uint32_t sides, bool closed, int32_t material);

// Adds a rope, which is an open prism of three sides with 6 triangles.
void add_rope(Model& model, const Vec3& start, const Vec3& end, float radius, int32_t material);

// Adds an axis-aligned box of 12 triangles.
void add_box(Model& model, const Vec3& lower, const Vec3& upper, int32_t material);

// Adds a sheet over (u, v) in [0, 1]^2 of 2 * columns * rows triangles. The normals of its triangles are
// smoothed.
void add_sheet(Model& model, uint32_t columns, uint32_t rows, int32_t material,
               const std::function<Vec3(float, float)>& position);

}  // namespace glint::scenes

// Describes solids as signed distances (negative inside) and turns their surfaces into triangles.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>

#include "scenes/mesh.h"

namespace glint::scenes {

// Returns the distance to an ellipsoid. It is exact on the surface and a bound elsewhere. Distances are in
// the units of the points. They use only +, *, / and sqrt, so every machine sculpts the same bits.
float ellipsoid_distance(const Vec3& p, const Vec3& center, const Vec3& radii);
// Returns the distance to a capsule whose radius goes linearly from `start_radius` at `start` to `end_radius`
// at `end`.
float limb_distance(const Vec3& p, const Vec3& start, float start_radius, const Vec3& end, float end_radius);
// Returns the distance to the union of two solids, rounded where they meet within `blend`.
float blended_union(float a, float b, float blend);

// Returns smooth noise in [-1, 1] with a period of one cell.
float noise(const Vec3& p);
// Returns a smooth wave in [-1, 1] with period 1.
float wave(float x);

using DistanceField = std::function<float(const Vec3&)>;

// Returns the zero surface as a closed mesh by surface nets (Gibson 1998), with smooth normals that point
// outward. It has one vertex for each cell that the surface crosses and two triangles for each crossed
// lattice edge; all are about the same size. `box` must hold the solid with one cell to spare, and `cell` is
// the lattice spacing. The field must not change faster than 1.5 times the distance, so that far blocks can
// be skipped. Up to `threads` threads of the host call the field, and the mesh is the same with any number.
Model surface_of(const DistanceField& field, const Bounds& box, float cell, int32_t material,
                 uint32_t threads = 1);

}  // namespace glint::scenes

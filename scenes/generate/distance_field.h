// Solids as signed distances (negative inside), and their surfaces as triangles: the clay of the stand-ins.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>

#include "scenes/mesh.h"

namespace glint::scenes {

// Distances in the units of the points; only +, *, / and sqrt, so that every machine sculpts the same bits.
float ellipsoid_distance(const Vec3& p, const Vec3& center,
                         const Vec3& radii);  // a bound, exact on the surface
// A capsule whose radius goes linearly from `start_radius` at `start` to `end_radius` at `end`.
float limb_distance(const Vec3& p, const Vec3& start, float start_radius, const Vec3& end, float end_radius);
// The union of two solids, rounded where they meet within `blend`.
float blended_union(float a, float b, float blend);

// Smooth noise of period one cell, in [-1, 1].
float noise(const Vec3& p);
// A smooth wave of period 1 in [-1, 1].
float wave(float x);

using DistanceField = std::function<float(const Vec3&)>;

// The zero surface as a closed mesh by surface nets (Gibson 1998): one vertex a cell that the surface
// crosses, two triangles a crossed lattice edge, about the same size everywhere; smooth normals, outward.
// `box` must hold the solid with a cell to spare; `cell` is the lattice spacing. The field must not change
// faster than 1.5 times the distance, so that far blocks can be skipped.
Model surface_of(const DistanceField& field, const Bounds& box, float cell, int32_t material);

}  // namespace glint::scenes

// Builds triangle meshes: transforms, smooth normals, and pieces that are appended into one model.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/geometric.hpp>
#include <string>

#include "scenes/scene.h"

namespace glint::scenes {

using glm::cross;
using glm::dot;
using glm::length;

// Returns v / |v|, and (0,0,0) for (0,0,0). glm::normalize() multiplies by 1 / |v| instead, which rounds
// twice.
Vec3 normalized(const Vec3& v);

// Return the sine and the cosine of an angle in radians, rounded from double. They are the same floats with
// every libm.
float sine(double radians);
float cosine(double radians);

// Says how the application places a model: translation * uniform scale * rotation about +y (right-handed).
struct Placement {
  Vec3 translation{};    // world units
  float scale = 1;       // factor
  float rotation_y = 0;  // degrees
};

// Moves every vertex. Normals turn and shrink by the inverse transpose and are not renormalised, as in the
// application, whose shader normalises them.
void place(Model& model, const Placement& placement);

// Sets each normal to the normalised sum of the unit normals of the faces around it. The OBJ loader does this
// for files without normals. Up to `threads` threads of the host work; they do not show in the normals.
void compute_smooth_normals(Model& model, uint32_t threads = 1);

// Holds the smallest and the largest coordinates of the vertices. An empty model has lower > upper.
struct Bounds {
  Vec3 lower{}, upper{};
};
Bounds bounds(const Model& model);

// Adds one vertex and returns its index.
uint32_t add_vertex(Model& model, const Vec3& position, const Vec3& normal, int32_t material,
                    const Vec2& texture_coordinate = {0, 0});
void add_triangle(Model& model, uint32_t a, uint32_t b, uint32_t c);

// Returns a procedural sphere as the application keeps it. Centre and radius are for the intersection shader.
// A tessellation of 32 slices and 16 stacks (561 vertices, 3,072 indices) lies in the vertex and index
// buffers. It is in no acceleration structure, and it gives the hit shader the sphere's material index.
Model make_sphere(std::string name, const Vec3& center, float radius, int32_t material);

}  // namespace glint::scenes

// Triangle meshes under construction: transforms, smooth normals, and pieces appended into one model.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "scenes/scene.h"

namespace glint::scenes {

// Vector arithmetic in float, components in order.
inline Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vec3 operator*(const Vec3& a, float s) {
  return {a[0] * s, a[1] * s, a[2] * s};
}
inline float dot(const Vec3& a, const Vec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vec3 cross(const Vec3& a, const Vec3& b);
float length(const Vec3& v);
Vec3 normalized(const Vec3& v);  // (0,0,0) stays (0,0,0)

// Sine and cosine of an angle in radians, rounded from double: the same floats with every libm.
float sine(double radians);
float cosine(double radians);

// Translation * uniform scale * rotation about +y (right-handed): how the application places a model.
struct Placement {
  Vec3 translation{};    // world units
  float scale = 1;       // factor
  float rotation_y = 0;  // degrees
};

// Moves every vertex; normals turn and shrink by the inverse transpose and are not renormalised, as in the
// application (its shader normalises them).
void place(Model& model, const Placement& placement);

// Unit face normals summed in every corner they share, then normalised: what the loader does for OBJ files
// without normals.
void compute_smooth_normals(Model& model);

// Corner positions over every vertex. An empty model gives lower > upper.
struct Bounds {
  Vec3 lower{}, upper{};
};
Bounds bounds(const Model& model);

// Adds one vertex and returns its index.
uint32_t add_vertex(Model& model, const Vec3& position, const Vec3& normal, int32_t material,
                    const Vec2& texture_coordinate = {0, 0});
void add_triangle(Model& model, uint32_t a, uint32_t b, uint32_t c);

// A procedural sphere as the application keeps it: centre and radius for the intersection shader, and a
// tessellation of 32 slices and 16 stacks (561 vertices, 3,072 indices) that lies in the vertex and index
// buffers, is in no acceleration structure, and gives the hit shader its material index.
Model make_sphere(std::string name, const Vec3& center, float radius, int32_t material);

}  // namespace glint::scenes

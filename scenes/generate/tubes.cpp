// Builds simple solids for built-in scenes: boxes, turned bodies, ropes and cloth, with normals.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/tubes.h"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace glint::scenes {
namespace {

void add_cap(Model& model, uint32_t ring, uint32_t sides, const Vec3& normal, bool reverse,
             int32_t material) {
  const uint32_t first = uint32_t(model.vertices.size());
  for (uint32_t i = 0; i < sides; ++i) add_vertex(model, model.vertices[ring + i].position, normal, material);
  for (uint32_t i = 1; i + 1 < sides; ++i)
    add_triangle(model, first, first + (reverse ? i + 1 : i), first + (reverse ? i : i + 1));
}

}  // namespace

void add_turned_body(Model& model, const Vec3& start, const Vec3& end, std::span<const Ring> rings,
                     uint32_t sides, bool closed, int32_t material) {
  const Vec3 axis = end - start, along = normalized(axis);
  const Vec3 helper = std::abs(along[1]) < 0.9f ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
  const Vec3 right = normalized(cross(helper, along)), up = cross(along, right);
  const uint32_t first = uint32_t(model.vertices.size());
  for (const Ring& ring : rings)
    for (uint32_t i = 0; i < sides; ++i) {
      const double angle = 2 * std::numbers::pi * i / sides;
      const Vec3 outward = right * cosine(angle) + up * sine(angle);
      add_vertex(model, start + axis * ring.position + outward * ring.radius, outward, material);
    }
  const auto last = uint32_t(rings.size() - 1);
  for (uint32_t r = 0; r < last; ++r)
    for (uint32_t i = 0; i < sides; ++i) {
      const uint32_t a = first + r * sides + i, b = first + r * sides + (i + 1) % sides;
      add_triangle(model, a, b, b + sides);
      add_triangle(model, a, b + sides, a + sides);
    }
  if (!closed) return;
  add_cap(model, first, sides, along * -1.0f, true, material);
  add_cap(model, first + last * sides, sides, along, false, material);
}

void add_rope(Model& model, const Vec3& start, const Vec3& end, float radius, int32_t material) {
  const Ring rings[] = {{0, radius}, {1, radius}};
  add_turned_body(model, start, end, rings, 3, false, material);
}

void add_box(Model& model, const Vec3& lower, const Vec3& upper, int32_t material) {
  for (size_t axis = 0; axis < 3; ++axis)
    for (const bool high : {false, true}) {
      const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
      Vec3 normal{};
      normal[axis] = high ? 1.0f : -1.0f;
      const uint32_t first = uint32_t(model.vertices.size());
      for (int k = 0; k < 4; ++k) {
        Vec3 corner = lower;
        corner[axis] = high ? upper[axis] : lower[axis];
        if (k == 1 || k == 2) corner[u] = upper[u];
        if (k >= 2) corner[v] = upper[v];
        add_vertex(model, corner, normal, material);
      }
      add_triangle(model, first, first + (high ? 1 : 2), first + (high ? 2 : 1));
      add_triangle(model, first, first + (high ? 2 : 3), first + (high ? 3 : 2));
    }
}

void add_sheet(Model& model, uint32_t columns, uint32_t rows, int32_t material,
               const std::function<Vec3(float, float)>& position) {
  Model sheet;
  for (uint32_t j = 0; j <= rows; ++j)
    for (uint32_t i = 0; i <= columns; ++i) {
      const Vec2 uv{float(i) / float(columns), float(j) / float(rows)};
      add_vertex(sheet, position(uv[0], uv[1]), {}, material, uv);
    }
  for (uint32_t j = 0; j < rows; ++j)
    for (uint32_t i = 0; i < columns; ++i) {
      const uint32_t a = j * (columns + 1) + i, b = a + columns + 1;
      add_triangle(sheet, a, a + 1, b + 1);
      add_triangle(sheet, a, b + 1, b);
    }
  compute_smooth_normals(sheet);
  const uint32_t first = uint32_t(model.vertices.size());
  model.vertices.insert(model.vertices.end(), sheet.vertices.begin(), sheet.vertices.end());
  for (const uint32_t index : sheet.indices) model.indices.push_back(first + index);
}

}  // namespace glint::scenes

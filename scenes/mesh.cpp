// Builds triangle meshes: transforms, smooth normals, and pieces that are appended into one model.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "base/parallel_ranges.h"

namespace glint::scenes {
namespace {

constexpr uint32_t kSphereSlices = 32;  // slices of a sphere in LumiBench's application
constexpr uint32_t kSphereStacks = 16;

// Returns the triangles of a sphere with all of its vertices but their positions.
Model unit_sphere() {
  Model model;
  for (uint32_t j = 0; j <= kSphereStacks; ++j) {
    const double polar = std::numbers::pi * j / kSphereStacks;
    for (uint32_t i = 0; i <= kSphereSlices; ++i) {
      const double azimuth = 2 * std::numbers::pi * i / kSphereSlices;
      const Vec3 normal{sine(polar) * sine(azimuth), cosine(polar), sine(polar) * cosine(azimuth)};
      add_vertex(model, {}, normal, 0, {float(i) / kSphereSlices, float(j) / kSphereStacks});
    }
  }
  for (uint32_t j = 0; j < kSphereStacks; ++j)
    for (uint32_t i = 0; i < kSphereSlices; ++i) {
      const uint32_t a = j * (kSphereSlices + 1) + i, b = a + kSphereSlices + 1;
      add_triangle(model, a, b, b + 1);
      add_triangle(model, a, b + 1, a + 1);
    }
  return model;
}

}  // namespace

Vec3 normalized(const Vec3& v) {
  const float l = length(v);
  return l > 0 ? v / l : v;
}

float sine(double radians) {
  return float(std::sin(radians));
}
float cosine(double radians) {
  return float(std::cos(radians));
}

void place(Model& model, const Placement& placement) {
  const double angle = double(placement.rotation_y) * std::numbers::pi / 180;
  const float c = cosine(angle), s = sine(angle);
  const auto rotate = [c, s](const Vec3& v) -> Vec3 {
    return {c * v[0] + s * v[2], v[1], c * v[2] - s * v[0]};
  };
  for (Vertex& vertex : model.vertices) {
    vertex.position = rotate(vertex.position) * placement.scale + placement.translation;
    vertex.normal = rotate(vertex.normal) * (1 / placement.scale);
  }
}

void compute_smooth_normals(Model& model, uint32_t threads) {
  // Each range of vertices takes all triangles in their order, so that a sum is the same at any number of
  // threads.
  const size_t vertices = model.vertices.size();
  const size_t range = (vertices + std::max(threads, 1u) - 1) / std::max(threads, 1u);
  parallel_ranges(vertices, std::max<size_t>(range, 1), threads, [&model](size_t begin, size_t end) {
    for (size_t v = begin; v < end; ++v) model.vertices[v].normal = {};
    for (size_t i = 0; i + 2 < model.indices.size(); i += 3) {
      const uint32_t* corner = &model.indices[i];
      const auto is_here = [begin, end](size_t v) { return v - begin < end - begin; };
      if (!is_here(corner[0]) && !is_here(corner[1]) && !is_here(corner[2])) continue;
      const auto position = [&model, corner](size_t k) { return model.vertices[corner[k]].position; };
      const Vec3 normal = normalized(cross(position(1) - position(0), position(2) - position(0)));
      for (size_t k = 0; k < 3; ++k)
        if (is_here(corner[k])) model.vertices[corner[k]].normal = model.vertices[corner[k]].normal + normal;
    }
    for (size_t v = begin; v < end; ++v) model.vertices[v].normal = normalized(model.vertices[v].normal);
  });
}

Bounds bounds(const Model& model) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  Bounds box{{inf, inf, inf}, {-inf, -inf, -inf}};
  for (const Vertex& vertex : model.vertices)
    for (size_t axis = 0; axis < 3; ++axis) {
      box.lower[axis] = std::min(box.lower[axis], vertex.position[axis]);
      box.upper[axis] = std::max(box.upper[axis], vertex.position[axis]);
    }
  return box;
}

uint32_t add_vertex(Model& model, const Vec3& position, const Vec3& normal, int32_t material,
                    const Vec2& texture_coordinate) {
  model.vertices.push_back({position, normal, texture_coordinate, material});
  return uint32_t(model.vertices.size() - 1);
}

void add_triangle(Model& model, uint32_t a, uint32_t b, uint32_t c) {
  model.indices.insert(model.indices.end(), {a, b, c});
}

Model make_sphere(std::string name, const Vec3& center, float radius, int32_t material) {
  static const Model unit = unit_sphere();
  Model model;
  model.name = std::move(name);
  model.center = center;
  model.radius = radius;
  model.indices = unit.indices;
  model.vertices = unit.vertices;
  for (Vertex& vertex : model.vertices) {
    vertex.position = center + vertex.normal * radius;
    vertex.material = material;
  }
  return model;
}

}  // namespace glint::scenes

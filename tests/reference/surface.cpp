// Computes what the shaders see of a triangle that a ray met, and whether its texture lets the ray pass.
// SPDX-License-Identifier: Apache-2.0
#include "tests/reference/surface.h"

#include <array>
#include <cmath>

#include "tests/reference/texture.h"

namespace glint::reference {

Surface surface_of(const scenes::Scene& scene, const Hit& hit) {
  const scenes::Model& model = scene.models[hit.model];
  const scenes::Vertex* corner[3];
  for (size_t k = 0; k < 3; ++k) corner[k] = &model.vertices[model.indices[3 * hit.primitive + k]];
  const float weight[3] = {1.0f - hit.u - hit.v, hit.u, hit.v};
  Surface out;
  Vec place(0);
  for (size_t k = 0; k < 3; ++k) {
    const scenes::Vec2& coordinate = corner[k]->texture_coordinate;
    out.normal = out.normal + Vec(corner[k]->normal) * weight[k];
    place = place + Vec(coordinate, 0) * weight[k];
  }
  out.normal = normalize(out.normal);
  out.u = place.x;
  out.v = place.y;
  out.material = &scene.materials[size_t(corner[0]->material)];
  return out;
}

Vec texture_color(const scenes::Scene& scene, const scenes::Material& material, float u, float v) {
  if (material.texture < 0) return Vec(1);
  const scenes::Vec4 color = sample(scene.textures[size_t(material.texture)], u, v);
  return Vec(color);
}

bool is_hole(const scenes::Scene& scene, const Hit& hit) {
  const Surface surface = surface_of(scene, hit);
  if (surface.material->texture < 0) return false;
  return sample(scene.textures[size_t(surface.material->texture)], surface.u, surface.v)[3] == 0;
}

namespace {

// Moves a model in double, with one rounding at the end.
void move(scenes::Model& model, const scenes::Affine& m) {
  const auto at = [&m](size_t row, size_t column) { return double(m[row][column]); };
  for (scenes::Vertex& vertex : model.vertices) {
    const scenes::Vec3 p = vertex.position, n = vertex.normal;
    std::array<double, 3> normal;
    double square = 0;
    for (size_t r = 0; r < 3; ++r) {
      double sum = at(r, 3);
      for (size_t c = 0; c < 3; ++c) sum += at(r, c) * double(p[c]);
      vertex.position[r] = float(sum);
      // A row of cofactors is that of the inverse transpose times the determinant.
      const size_t r1 = (r + 1) % 3, r2 = (r + 2) % 3;
      normal[r] = 0;
      for (size_t c = 0; c < 3; ++c) {
        const size_t c1 = (c + 1) % 3, c2 = (c + 2) % 3;
        normal[r] += (at(r1, c1) * at(r2, c2) - at(r1, c2) * at(r2, c1)) * double(n[c]);
      }
      square += normal[r] * normal[r];
    }
    double determinant = 0;
    for (size_t c = 0; c < 3; ++c)
      determinant +=
          at(0, c) * (at(1, (c + 1) % 3) * at(2, (c + 2) % 3) - at(1, (c + 2) % 3) * at(2, (c + 1) % 3));
    const double length = std::sqrt(square) * (determinant < 0 ? -1 : 1);
    for (size_t r = 0; r < 3; ++r) vertex.normal[r] = length != 0 ? float(normal[r] / length) : 0.0f;
  }
}

}  // namespace

scenes::Scene flattened(const scenes::Scene& scene) {
  scenes::Scene out = scene;
  out.models.clear();
  out.instances.clear();
  for (const scenes::Instance& instance : instances_of(scene)) {
    out.models.push_back(scene.models[instance.model]);
    if (!out.models.back().is_procedural()) move(out.models.back(), instance.to_world);
  }
  return out;
}

}  // namespace glint::reference

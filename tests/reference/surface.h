// Computes what the shaders see of a triangle that a ray met, and whether its texture lets the ray pass.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "tests/reference/intersector.h"

namespace glint::reference {

struct Surface {
  Vec normal{};
  float u = 0, v = 0;                          // texture coordinates
  const scenes::Material* material = nullptr;  // of the first corner
};
Surface surface_of(const scenes::Scene& scene, const Hit& hit);

// Returns red, green and blue of the material's texture, or white without one.
Vec texture_color(const scenes::Scene& scene, const scenes::Material& material, float u, float v);

// Returns what the any-hit shader decides: whether the texture's alpha is exactly zero there.
bool is_hole(const scenes::Scene& scene, const Hit& hit);

// Returns the scene with every instance as a model of its own in world coordinates, in the order of the
// instances.
scenes::Scene flattened(const scenes::Scene& scene);

}  // namespace glint::reference

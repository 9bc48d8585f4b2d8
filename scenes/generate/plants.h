// Grows trees, bushes, grass, flowers and hair with a budget of triangles, for generated scenes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>

#include "scenes/generate/solids.h"

namespace glint::scenes {

struct TreeShape {
  Vec3 foot{};  // where the trunk leaves the ground
  Vec3 up{0, 1, 0};
  float height = 1;              // world units
  float spread = 0.6f;           // half width of the crown over the height
  float leaf = 0.05f;            // edge of a leaf over the height
  float wood = 0.35f;            // part of the triangles that are trunk and branches
  int32_t bark = 0, leaves = 0;  // materials
  uint32_t seed = 1;
};
// Adds a tree. Its branches fork down to twigs; its leaves are squares of two triangles around the twigs,
// with texture coordinates 0 to 1. `wood_model` and `leaf_model` may be the same.
void add_tree(Model& wood_model, Model& leaf_model, const TreeShape& shape, uint64_t triangles);

// Adds a ball of leaves of two triangles each.
void add_bush(Model& model, const Frame& frame, uint64_t triangles, int32_t material, float leaf,
              uint32_t seed);

using Height = std::function<float(float x, float z)>;
// Adds bent blades of three triangles over a rectangle. `blade` is their height, and their width is a
// twentieth of it.
void add_grass(Model& model, const Vec2& lower, const Vec2& upper, const Height& ground, float blade,
               uint64_t triangles, int32_t material, uint32_t seed);
// Adds a stem with a blossom of bent petals; y is up.
void add_flower(Model& model, const Frame& frame, uint64_t triangles, int32_t stem, int32_t petals,
                uint32_t seed);
// Adds hair on a ball of the frame's size. Each hair is a tube of three sides and six segments that bends
// towards `fall`; it is `hair` long and a hundredth of that thick.
void add_hair(Model& model, const Frame& frame, float hair, const Vec3& fall, uint64_t triangles,
              int32_t material, uint32_t seed);
// Adds a rectangle of ground.
void add_ground(Model& model, const Vec2& lower, const Vec2& upper, const Height& height, uint64_t triangles,
                int32_t material);

}  // namespace glint::scenes

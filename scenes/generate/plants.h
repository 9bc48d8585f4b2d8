// Trees, bushes, grass, flowers and hair with a budget of triangles, for scenes that are generated.
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
// Branches fork down to twigs; leaves are squares of two triangles with texture coordinates 0 to 1, around
// the twigs. `wood_model` and `leaf_model` may be the same.
void add_tree(Model& wood_model, Model& leaf_model, const TreeShape& shape, uint64_t triangles);

// Leaves of two triangles in a ball.
void add_bush(Model& model, const Frame& frame, uint64_t triangles, int32_t material, float leaf,
              uint32_t seed);

using Height = std::function<float(float x, float z)>;
// Bent blades of three triangles over a rectangle; `blade` is their height, a twentieth of it their width.
void add_grass(Model& model, const Vec2& lower, const Vec2& upper, const Height& ground, float blade,
               uint64_t triangles, int32_t material, uint32_t seed);
// A stem with a blossom of bent petals; y is up.
void add_flower(Model& model, const Frame& frame, uint64_t triangles, int32_t stem, int32_t petals,
                uint32_t seed);
// Tubes of three sides and six segments, `hair` long and a hundredth of it thick, on a ball of the frame's
// size; they bend towards `fall`.
void add_hair(Model& model, const Frame& frame, float hair, const Vec3& fall, uint64_t triangles,
              int32_t material, uint32_t seed);
// A rectangle of ground.
void add_ground(Model& model, const Vec2& lower, const Vec2& upper, const Height& height, uint64_t triangles,
                int32_t material);

}  // namespace glint::scenes

// Grows trees, bushes, grass, flowers and hair with a budget of triangles.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/plants.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "scenes/generate/distance_field.h"

namespace glint::scenes {
namespace {

struct Branch {
  Vec3 start{}, direction{};
  float length = 1, radius = 1;
};

constexpr uint32_t kSegments = 4;  // segments of a branch
constexpr uint32_t kSides = 6;
constexpr uint64_t kBranchTriangles = 2 * kSegments * kSides;

// Grows branch after branch, the thickest first, until the wood is used up. `tips` are places for leaves.
void grow(Model& model, const TreeShape& shape, uint64_t triangles, Random& random, std::vector<Vec3>& tips) {
  std::vector<Branch> branches{{shape.foot, shape.up, shape.height * 0.45f, shape.height * 0.035f}};
  const uint64_t count = std::max<uint64_t>(triangles / kBranchTriangles, 12);
  for (size_t k = 0; k < branches.size() && k < count; ++k) {
    const Branch branch = branches[k];
    std::vector<Vec3> path{branch.start};
    Vec3 direction = branch.direction;
    for (uint32_t s = 0; s < kSegments; ++s) {
      direction = normalized(direction + random.direction() * (k == 0 ? 0.06f : 0.25f) + shape.up * 0.06f);
      path.push_back(path.back() + direction * (branch.length / kSegments));
    }
    add_tube(model, path, branch.radius, branch.radius * 0.55f, kSides, shape.bark);
    if (k > 0) tips.insert(tips.end(), path.begin() + 2, path.end());
    const uint32_t forks = k == 0 ? 7 : 3;
    for (uint32_t f = 0; f < forks && branches.size() < count; ++f) {
      const Vec3& start = path[f == 0 ? kSegments : 2 + random.below(kSegments - 1)];
      const Vec3 side = random.direction();
      const float lift = k == 0 ? 0.5f : 0.25f;
      const Vec3 out = normalized(direction * 0.5f + side * (0.5f + shape.spread) + shape.up * lift);
      branches.push_back({start, out, branch.length * random.between(0.55f, 0.8f), branch.radius * 0.5f});
    }
  }
}

void add_leaf(Model& model, const Vec3& place, float size, int32_t material, Random& random) {
  const Vec3 side = random.direction();
  const Vec3 other = normalized(cross(side, random.direction()));
  add_quad(model, place, side * size, other * size, material);
}

void add_blade(Model& model, const Vec3& foot, const Vec3& tip, float width, float turn, int32_t material) {
  const Vec3 side{width * cosine(double(turn)), 0, width * sine(double(turn))};
  const Vec3 middle = foot + (tip - foot) * 0.5f + Vec3{0, 0.12f * (tip[1] - foot[1]), 0};
  const Vec3 normal = normalized(cross(side, tip - foot));
  const uint32_t a = add_vertex(model, foot - side, normal, material, {0, 1});
  add_vertex(model, foot + side, normal, material, {1, 1});
  add_vertex(model, middle - side * 0.7f, normal, material, {0.15f, 0.5f});
  add_vertex(model, middle + side * 0.7f, normal, material, {0.85f, 0.5f});
  add_vertex(model, tip, normal, material, {0.5f, 0});
  add_triangle(model, a, a + 1, a + 3);
  add_triangle(model, a, a + 3, a + 2);
  add_triangle(model, a + 2, a + 3, a + 4);
}

}  // namespace

void add_tree(Model& wood_model, Model& leaf_model, const TreeShape& shape, uint64_t triangles) {
  Random random(shape.seed);
  std::vector<Vec3> tips;
  const auto wood = uint64_t(double(triangles) * double(shape.wood));
  grow(wood_model, shape, wood, random, tips);
  const float leaf = shape.leaf * shape.height;
  for (uint64_t k = 0; k < (triangles - wood) / 2; ++k) {
    // The last tips are the thinnest twigs, so they get more of the leaves.
    const float late = random.next();
    const Vec3& tip = tips[size_t((1 - late * late) * float(tips.size() - 1))];
    const Vec3 away = random.direction();
    const Vec3 place = tip + away * (leaf * 1.5f * random.next());
    add_leaf(leaf_model, place, leaf * random.between(0.6f, 1.2f), shape.leaves, random);
  }
}

void add_bush(Model& model, const Frame& frame, uint64_t triangles, int32_t material, float leaf,
              uint32_t seed) {
  Random random(seed);
  for (uint64_t k = 0; k < triangles / 2; ++k) {
    const Vec3 direction = random.direction();
    const float radius = 0.75f + 0.2f * noise(direction * 3.0f + frame.origin), depth = random.next();
    add_leaf(model, frame.at(direction * (radius * (1 - 0.5f * depth * depth))),
             leaf * random.between(0.6f, 1.2f), material, random);
  }
}

void add_grass(Model& model, const Vec2& lower, const Vec2& upper, const Height& ground, float blade,
               uint64_t triangles, int32_t material, uint32_t seed) {
  Random random(seed);
  for (uint64_t k = 0; k < triangles / 3; ++k) {
    const float x = random.between(lower[0], upper[0]), z = random.between(lower[1], upper[1]);
    const Vec3 foot{x, ground(x, z), z};
    const float tall = blade * random.between(0.5f, 1);
    const float lean = 0.45f * tall * random.next(), turn = random.between(0, 6.2831853f);
    const Vec3 tip = foot + Vec3{lean * sine(double(turn)), tall, lean * cosine(double(turn))};
    add_blade(model, foot, tip, blade * 0.025f, turn, material);
  }
}

void add_flower(Model& model, const Frame& frame, uint64_t triangles, int32_t stem, int32_t petals,
                uint32_t seed) {
  Random random(seed);
  std::vector<Vec3> path;
  const float lean = random.between(-0.3f, 0.3f);
  for (int k = 0; k <= 8; ++k)
    path.push_back(frame.at(lean * float(k * k) / 64, -1 + 1.5f * float(k) / 8, 0));
  const float thick = length(frame.x) * 0.05f;
  add_tube(model, path, thick, thick * 0.6f, 6, stem);
  constexpr uint32_t kPetals = 9;
  const uint64_t share = triangles / (kPetals + 1);
  for (uint32_t k = 0; k < kPetals; ++k) {
    const double angle = 6.283185307 * k / kPetals;
    const Vec3 out{cosine(angle), 0, sine(angle)}, side{-out[2], 0, out[0]};
    add_patch(model, share, 1, petals, [&](float u, float v) {
      const float wide = 1.4f * v * (1 - v) + 0.05f;
      const Vec3 p = out * (0.1f + 0.8f * v) + side * ((u - 0.5f) * wide) +
                     Vec3{lean, 0.5f + 0.45f * v - 0.35f * v * v + 0.3f * (u - 0.5f) * (u - 0.5f), 0};
      return frame.at(p);
    });
  }
  add_ball(model, frame.inner({lean, 0.55f, 0}, {0.18f, 0.12f, 0.18f}), share, stem, 0.1f);
}

void add_hair(Model& model, const Frame& frame, float hair, const Vec3& fall, uint64_t triangles,
              int32_t material, uint32_t seed) {
  constexpr uint32_t kHairSegments = 6, kHairSides = 3;
  Random random(seed);
  std::vector<Vec3> path(kHairSegments + 1);
  for (uint64_t k = 0; k < triangles / (2 * kHairSegments * kHairSides); ++k) {
    const Vec3 root = random.direction();
    path[0] = frame.at(root);
    Vec3 direction = normalized(path[0] - frame.origin + random.direction() * (0.2f * hair));
    const Vec3 bend = fall * 0.35f + random.direction() * 0.12f;
    for (uint32_t s = 1; s <= kHairSegments; ++s) {
      path[s] = path[s - 1] + direction * (hair / kHairSegments);
      direction = normalized(direction + bend);
    }
    add_tube(model, path, hair * 0.01f, hair * 0.002f, kHairSides, material);
  }
}

void add_ground(Model& model, const Vec2& lower, const Vec2& upper, const Height& height, uint64_t triangles,
                int32_t material) {
  const float wide = upper[0] - lower[0], deep = upper[1] - lower[1];
  add_patch(model, triangles, wide / deep, material, [&](float u, float v) -> Vec3 {
    const float x = lower[0] + wide * u, z = upper[1] - deep * v;  // z falls with v, so that normals point up
    return {x, height(x, z), z};
  });
}

}  // namespace glint::scenes

// Sculpts the bunny stand-in, a sitting rabbit of ellipsoids of the original mesh's size and density.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "scenes/generate/distance_field.h"
#include "scenes/lumibench/builders.h"

namespace glint::scenes {
namespace {

constexpr float kCell = 0.01018f;  // chosen for about 144,046 triangles

// Returns the distance to an ear. `mirrored` has z = |z|, because the rabbit is symmetric; it looks along -x.
float ear_distance(const Vec3& mirrored) {
  constexpr Vec3 kRoot{-0.50f, 1.12f, 0.08f}, kTip{-0.16f, 1.47f, 0.17f};
  const Vec3 axis = kTip - kRoot;
  const float t = std::clamp(dot(mirrored - kRoot, axis) / dot(axis, axis), 0.0f, 1.0f);
  const float width = 0.035f + 0.34f * t * (1 - t);  // slim at both ends
  const Vec3 q = mirrored - (kRoot + axis * t);
  // The ear is flatter than wide: its thin direction is across its axis, in the rabbit's plane of symmetry.
  const Vec3 thin = normalized({-axis[1], axis[0], 0.02f});
  const float across = dot(q, thin), rest = std::max(dot(q, q) - across * across, 0.0f);
  const float outer = std::sqrt(across * across * 3.2f + rest) - width;
  const float groove =
      ellipsoid_distance(mirrored, kRoot + axis * 0.55f + thin * 0.075f, {0.14f, 0.15f, 0.055f});
  return std::max(outer * 0.6f, -groove);
}

float head_distance(const Vec3& m) {
  float d = ellipsoid_distance(m, {-0.56f, 0.99f, 0}, {0.28f, 0.23f, 0.22f});
  d = blended_union(d, ellipsoid_distance(m, {-0.76f, 0.92f, 0}, {0.15f, 0.13f, 0.13f}), 0.12f);
  d = blended_union(d, ellipsoid_distance(m, {-0.70f, 0.88f, 0.10f}, {0.12f, 0.10f, 0.09f}), 0.08f);
  d = blended_union(d, ellipsoid_distance(m, {-0.905f, 0.955f, 0}, {0.03f, 0.025f, 0.035f}), 0.02f);
  d = blended_union(d, ear_distance(m), 0.06f);
  // The eye lies in a shallow socket.
  d = std::max(d, -ellipsoid_distance(m, {-0.71f, 1.05f, 0.20f}, {0.06f, 0.055f, 0.05f}));
  return std::min(d, ellipsoid_distance(m, {-0.70f, 1.05f, 0.165f}, {0.042f, 0.042f, 0.035f}));
}

float rabbit_distance(const Vec3& p) {
  const Vec3 m{p[0], p[1], std::abs(p[2])};
  float d = ellipsoid_distance(m, {0.08f, 0.48f, 0}, {0.50f, 0.43f, 0.40f});
  d = blended_union(d, ellipsoid_distance(m, {-0.32f, 0.55f, 0}, {0.28f, 0.42f, 0.29f}), 0.2f);
  d = blended_union(d, ellipsoid_distance(m, {0.20f, 0.33f, 0.26f}, {0.29f, 0.31f, 0.17f}), 0.06f);
  d = blended_union(d, ellipsoid_distance(m, {-0.05f, 0.07f, 0.33f}, {0.27f, 0.08f, 0.10f}), 0.06f);
  d = blended_union(d, limb_distance(m, {-0.42f, 0.45f, 0.15f}, 0.12f, {-0.53f, 0.09f, 0.15f}, 0.075f),
                    0.07f);
  d = blended_union(d, ellipsoid_distance(m, {-0.60f, 0.06f, 0.15f}, {0.14f, 0.07f, 0.08f}), 0.05f);
  d = blended_union(d, ellipsoid_distance(m, {0.60f, 0.27f, 0}, {0.14f, 0.15f, 0.14f}), 0.05f);
  d = blended_union(d, head_distance(m), 0.10f);
  // The fur, as on the clay original, is low bumps that only light shows.
  d += 0.006f * noise(p * 9.0f) + 0.003f * noise(p * 24.0f);
  return std::max(d, -p[1]);  // The rabbit stands on the floor.
}

}  // namespace

Model make_bunny_stand_in(int32_t material, uint32_t threads) {
  Model model = surface_of(rabbit_distance, {{-1.05f, -0.05f, -0.60f}, {0.85f, 1.65f, 0.60f}}, kCell,
                           material, threads);
  model.name = "bunny_stand_in";
  return model;
}

}  // namespace glint::scenes

// Sculpts the statue stand-in of REF, a winged, robed figure with a torch, of the original's size and
// density.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "scenes/generate/distance_field.h"
#include "scenes/lumibench/builders.h"

namespace glint::scenes {
namespace {

constexpr float kCell = 1.602f;  // chosen for about 448.9K triangles
constexpr int kFeathers = 9;     // feathers of a wing

constexpr Vec3 kRoot{16, 405, -34}, kWrist{105, 500, -66};  // where a wing begins and bends

struct Feather {
  Vec3 base, direction, tip;
};
std::array<Feather, kFeathers> make_feathers() {
  std::array<Feather, kFeathers> out;
  for (int i = 0; i < kFeathers; ++i) {
    const float t = float(i) / (kFeathers - 1);
    const Vec3 direction = normalized({0.10f + 0.62f * t, -1 + 0.25f * t, -0.10f});
    const float reach = 110 + 150 * t - 40 * t * t;
    out[size_t(i)] = {
        kRoot + (kWrist - kRoot) * t, direction, {direction[0] * reach, direction[1] * reach, 0}};
  }
  return out;
}

// Returns the distance to a wing. The figure looks along +z with its right hand at +x; `m` has x = |x|.
float wing_distance(const Vec3& m) {
  static const std::array<Feather, kFeathers> kAll = make_feathers();
  float d = limb_distance(m, kRoot, 15, kWrist, 11);
  for (size_t i = 0; i < kAll.size(); ++i) {
    const auto& [base, direction, tip] = kAll[i];
    // A feather is a flat limb, squeezed along z and stepped so that each feather lies over the next.
    const Vec3 q = m - base;
    const Vec3 flat{q[0], q[1], (q[2] - direction[2] * dot(q, direction) + (i % 2 ? 3.0f : -3.0f)) * 2.6f};
    d = blended_union(d, limb_distance(flat, {0, 0, 0}, 13, tip, 8) * 0.45f, 3);
  }
  return d;
}

float robe_distance(const Vec3& p) {
  // The angle around the axis is a diamond angle from 0 to 4. It takes the place of an arc tangent, because
  // it is the same on every machine.
  const float ax = std::abs(p[0]) + std::abs(p[2]) + 1e-6f;
  const float quarter = p[2] / ax;
  const float angle = p[0] >= 0 ? 1 + quarter : 3 - quarter;
  const float fall = std::clamp((340 - p[1]) / 240, 0.0f, 1.0f);  // 0 at the belt, 1 at the hem
  const float fold = wave(angle * 3.5f + 0.25f * noise({p[0] * 0.02f, p[1] * 0.012f, p[2] * 0.02f}));
  const float skirt = limb_distance({p[0] * 0.92f, p[1], p[2] * 1.1f}, {0, 95, 0}, 82, {0, 330, 0}, 36);
  float d = skirt + fall * (5.5f * fold + 2.5f * noise(p * 0.03f));
  d = std::max(d * 0.75f, 62 - p[1]);  // the hem touches the pedestal
  const float torso =
      ellipsoid_distance(p, {0, 385, 0}, {50, 72, 35}) + 1.5f * wave(p[1] * 0.05f + p[0] * 0.02f);
  d = blended_union(d, torso * 0.8f, 18);
  const float belt = std::max(std::abs(p[1] - 333) - 5, length(Vec3(p[0], 0, p[2] * 1.15f)) - 41);
  return blended_union(d, belt * 0.8f, 4);
}

float body_distance(const Vec3& p) {
  float d = robe_distance(p);
  d = blended_union(d, limb_distance(p, {-42, 430, 0}, 20, {42, 430, 0}, 20), 16);
  d = blended_union(d, limb_distance(p, {0, 440, 0}, 15, {0, 482, 3}, 13), 10);
  // The right arm lifts a torch, and the left one rests on the belt.
  d = blended_union(d, limb_distance(p, {48, 432, 0}, 18, {92, 458, 12}, 13), 8);
  d = blended_union(d, limb_distance(p, {92, 458, 12}, 13, {99, 532, 30}, 9), 6);
  d = blended_union(d, limb_distance(p, {-48, 432, 0}, 18, {-76, 362, 22}, 13), 8);
  d = blended_union(d, limb_distance(p, {-76, 362, 22}, 14, {-28, 340, 50}, 9), 6);
  d = blended_union(d, limb_distance(p, {97, 508, 31}, 4.5f, {104, 566, 31}, 8.5f), 2);
  const Vec3 flame{105, 582, 31};
  return blended_union(d, ellipsoid_distance(p, flame, {12, 23, 12}) + 2 * noise(p * 0.09f), 4);
}

float head_distance(const Vec3& p) {
  float d = ellipsoid_distance(p, {0, 508, 7}, {22, 30, 25});
  d = blended_union(d, limb_distance(p, {0, 512, 30}, 3.5f, {0, 501, 34}, 4.5f), 5);  // nose
  d = blended_union(d, ellipsoid_distance(p, {0, 484, 24}, {8, 6, 7}), 6);            // chin
  d = std::max(d, -ellipsoid_distance(p, {9, 514, 33}, {5, 4, 5}));
  d = std::max(d, -ellipsoid_distance(p, {-9, 514, 33}, {5, 4, 5}));
  const float hair =
      ellipsoid_distance(p, {0, 516, -3}, {28, 30, 28}) + 2.2f * wave(p[0] * 0.11f + p[1] * 0.05f);
  d = blended_union(d, hair * 0.8f, 3);
  return blended_union(d, ellipsoid_distance(p, {0, 520, -30}, {13, 13, 13}), 6);  // knot of hair
}

float pedestal_distance(const Vec3& p) {
  const float radius = length(Vec3(p[0], 0, p[2]));
  const auto disc = [&](float low, float high, float r) {
    return std::max({low - p[1], p[1] - high, radius - r});
  };
  const float flutes = 3 * wave(4 * p[2] / (std::abs(p[0]) + std::abs(p[2]) + 1e-6f));
  float d = std::min(disc(15, 30, 105), disc(52, 64, 100));
  return std::min(d, std::max(disc(28, 54, 93), (radius - 90 + flutes * 0.6f) * 0.7f));
}

// Returns the distance to the whole statue. The placed figure looks towards the camera when the mesh looks
// along -x.
float statue_distance(const Vec3& p) {
  const Vec3 q{p[2], p[1], -p[0]};
  float d = blended_union(body_distance(q), head_distance(q), 5);
  // Nine feathers take long to compute, so they are left out where a ball around the wing is too far away to
  // matter.
  const Vec3 m{std::abs(q[0]), q[1], q[2]};
  if (length(m - Vec3{105, 380, -60}) - 190 < d + 6) d = blended_union(d, wing_distance(m), 6);
  return std::min(d, pedestal_distance(q));
}

}  // namespace

Model make_statue_stand_in(int32_t material, uint32_t threads) {
  Model model = surface_of(statue_distance, {{-125, 8, -270}, {160, 620, 270}}, kCell, material, threads);
  model.name = "statue_stand_in";
  return model;
}

}  // namespace glint::scenes

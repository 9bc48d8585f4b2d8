// Sculpts clothed people of limbs and ellipsoids: head, hair, trunk, arms, legs and shoes.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/figures.h"

#include <algorithm>
#include <cmath>

#include "scenes/generate/distance_field.h"

namespace glint::scenes {
namespace {

constexpr Vec3 kHead{0, 0.925f, 0};
constexpr float kArm = 0.36f;  // from the shoulder to the hand, stretched

// Holds the joints of one arm. `side` is -1 at -x and 1 at +x.
struct Arm {
  Vec3 shoulder{}, elbow{}, hand{};

  Arm(const Figure& figure, float side) : shoulder{0.115f * figure.girth * side, 0.775f, 0} {
    Vec3 reach = figure.hands[side < 0 ? 0 : 1] - shoulder;
    if (length(reach) > kArm) reach = normalized(reach) * kArm;
    hand = shoulder + reach;
    // The elbow lies on the circle that both halves of the arm reach, outwards, down and back.
    const Vec3 along = normalized(reach), wish{0.5f * side, -0.7f, -0.5f};
    const Vec3 out = normalized(wish - along * dot(wish, along));
    elbow =
        shoulder + reach * 0.5f + out * std::sqrt(std::max(0.0f, 0.25f * (kArm * kArm - dot(reach, reach))));
  }
};

// Returns p with x >= 0, for what both sides have alike.
Vec3 mirrored(const Vec3& p) {
  return {std::abs(p[0]), p[1], p[2]};
}

float skin_distance(const Figure& figure, const Vec3& p) {
  const Vec3 m = mirrored(p);
  float d = ellipsoid_distance(p, kHead, {0.056f, 0.074f, 0.066f});
  d = blended_union(d, ellipsoid_distance(p, {0, 0.887f, 0.02f}, {0.04f, 0.04f, 0.045f}), 0.02f);
  d = blended_union(d, limb_distance(p, {0, 0.928f, 0.062f}, 0.006f, {0, 0.905f, 0.072f}, 0.010f), 0.008f);
  d = blended_union(d, ellipsoid_distance(m, {0.058f, 0.92f, -0.004f}, {0.01f, 0.019f, 0.013f}), 0.006f);
  d = blended_union(d, limb_distance(p, {0, 0.79f, -0.01f}, 0.031f, {0, 0.87f, 0}, 0.028f), 0.02f);
  for (const float side : {-1.0f, 1.0f}) {
    const Arm arm(figure, side);
    const Vec3 beyond = arm.hand + normalized(arm.hand - arm.elbow) * 0.035f;
    d = std::min(d, limb_distance(p, arm.hand, 0.020f, beyond, 0.024f));
  }
  if (figure.skirt)
    d = std::min(d, limb_distance(m, {0.05f, 0.36f, 0}, 0.042f, {0.055f, 0.04f, -0.005f}, 0.026f));
  return d;
}

float hair_distance(const Figure& figure, const Vec3& p) {
  float d = ellipsoid_distance(p, {0, 0.938f, -0.006f}, {0.065f, 0.076f, 0.076f}) +
            0.004f * wave(p[0] * 45 + p[1] * 12);
  // The face is free: hair ends at a plane that rises towards the front.
  d = std::max(d * 0.8f, 0.6f * (p[2] - 0.012f) - 0.8f * (p[1] - 0.945f));
  if (figure.long_hair) {
    const float fall = limb_distance(p, {0, 0.92f, -0.035f}, 0.055f, {0, 0.74f, -0.075f}, 0.045f) +
                       0.004f * wave(p[0] * 45 + p[1] * 6);
    d = blended_union(d, fall * 0.8f, 0.02f);
  }
  return d;
}

float top_distance(const Figure& figure, const Vec3& p) {
  const float wide = figure.girth;
  const Vec3 m = mirrored(p);
  float d = ellipsoid_distance(p, {0, 0.69f, 0}, {0.105f * wide, 0.125f, 0.066f * wide});
  d = blended_union(d, ellipsoid_distance(p, {0, 0.57f, 0.004f}, {0.09f * wide, 0.10f, 0.064f * wide}),
                    0.04f);
  d = blended_union(d, limb_distance(m, {0, 0.785f, -0.005f}, 0.042f, {0.1f * wide, 0.778f, 0}, 0.038f),
                    0.03f);
  for (const float side : {-1.0f, 1.0f}) {
    const Arm arm(figure, side);
    d = blended_union(d, limb_distance(p, arm.shoulder, 0.039f * wide, arm.elbow, 0.031f), 0.02f);
    d = blended_union(d, limb_distance(p, arm.elbow, 0.031f, arm.hand, 0.025f), 0.012f);
  }
  d += 0.0012f * wave(p[1] * 21 + 1.2f * noise(p * 9.0f));  // creases
  return d * 0.85f;
}

float legs_distance(const Figure& figure, const Vec3& p) {
  const float wide = figure.girth;
  const Vec3 m = mirrored(p);
  float d = ellipsoid_distance(p, {0, 0.51f, 0}, {0.095f * wide, 0.07f, 0.07f * wide});
  if (figure.skirt) {
    const float bell = limb_distance(p, {0, 0.55f, 0}, 0.07f * wide, {0, 0.36f, 0}, 0.15f * wide);
    const float folds = 0.007f * wave(p[0] * 14) + 0.005f * wave(p[2] * 14);
    return std::max(blended_union(d, bell + folds, 0.03f) * 0.8f, 0.33f - p[1]);
  }
  d = blended_union(
      d, limb_distance(m, {0.05f * wide, 0.49f, 0}, 0.056f * wide, {0.058f, 0.27f, 0.012f}, 0.043f), 0.02f);
  d = blended_union(d, limb_distance(m, {0.058f, 0.27f, 0.012f}, 0.043f, {0.06f, 0.05f, -0.005f}, 0.036f),
                    0.02f);
  return (d + 0.001f * wave(p[1] * 17 + 1.2f * noise(p * 8.0f))) * 0.85f;
}

float part_distance(const Figure& figure, FigurePart part, const Vec3& p) {
  switch (part) {
    case FigurePart::Skin:
      return skin_distance(figure, p);
    case FigurePart::Eyes:
      break;  // They are balls.
    case FigurePart::Hair:
      return hair_distance(figure, p);
    case FigurePart::Top:
      return top_distance(figure, p);
    case FigurePart::Legs:
      return legs_distance(figure, p);
    case FigurePart::Shoes:
      return std::max(ellipsoid_distance(mirrored(p), {0.061f, 0.025f, 0.028f}, {0.036f, 0.042f, 0.078f}),
                      -p[1]);
  }
  return 1;
}

// Returns the surface of a part, estimated for a figure of height 1.
float surface(const Figure& figure, FigurePart part) {
  static constexpr std::array kSurfaces = {0.085f, 0.002f, 0.055f, 0.24f, 0.21f, 0.045f};
  return kSurfaces[size_t(part)] + (part == FigurePart::Skin && figure.skirt ? 0.12f : 0.0f) +
         (part == FigurePart::Hair && figure.long_hair ? 0.05f : 0.0f);
}

// Returns a box that holds a part.
Bounds box_of(const Figure& figure, FigurePart part) {
  float wide = 0.2f * figure.girth, high = 0.83f, front = 0.14f;
  for (const float side : {-1.0f, 1.0f}) {
    const Arm arm(figure, side);
    for (const Vec3& joint : {arm.elbow, arm.hand}) {
      wide = std::max(wide, std::abs(joint[0]) + 0.08f);
      high = std::max(high, joint[1] + 0.08f);
      front = std::max(front, joint[2] + 0.08f);
    }
  }
  switch (part) {
    case FigurePart::Skin:
      return {{-wide, figure.skirt ? 0.0f : 0.3f, -0.2f}, {wide, std::max(high, 1.01f), front}};
    case FigurePart::Hair:
      return {{-0.1f, 0.65f, -0.16f}, {0.1f, 1.03f, 0.1f}};
    case FigurePart::Top:
      return {{-wide, 0.35f, -0.2f}, {wide, high, front}};
    case FigurePart::Legs:
      return {{-0.22f * figure.girth, 0, -0.2f}, {0.22f * figure.girth, 0.65f, 0.2f}};
    default:
      return {{-0.12f, -0.01f, -0.08f}, {0.12f, 0.08f, 0.13f}};
  }
}

}  // namespace

void add_figure_part(Model& model, const Frame& frame, const Figure& figure, FigurePart part,
                     uint64_t triangles, int32_t material, uint32_t threads) {
  if (part == FigurePart::Eyes) {
    for (const float side : {-1.0f, 1.0f})
      add_ball(model, frame.inner({0.022f * side, 0.932f, 0.058f}, {0.009f, 0.011f, 0.009f}), triangles / 2,
               material);
    return;
  }
  // A lattice of edge c gives about three triangles for each c * c of a surface.
  const float cell = std::sqrt(3 * surface(figure, part) / float(std::max<uint64_t>(triangles, 12)));
  const Vec3 spare = Vec3{1, 1, 1} * (2 * cell);
  const Bounds box = box_of(figure, part);
  const Model shape = surface_of([&](const Vec3& p) { return part_distance(figure, part, p); },
                                 {box.lower - spare, box.upper + spare}, cell, material, threads);
  const auto first = uint32_t(model.vertices.size());
  for (const Vertex& v : shape.vertices) {
    const Vec3 normal = normalized(frame.x * v.normal[0] + frame.y * v.normal[1] + frame.z * v.normal[2]);
    add_vertex(model, frame.at(v.position), normal, material, {v.position[0] + 0.5f, v.position[1]});
  }
  for (const uint32_t index : shape.indices) model.indices.push_back(first + index);
}

void add_figure(Model& model, const Frame& frame, const Figure& figure, uint64_t triangles,
                const std::array<int32_t, kFigureParts.size()>& materials) {
  float all = 0;
  for (const FigurePart part : kFigureParts) all += surface(figure, part);
  for (const FigurePart part : kFigureParts)
    add_figure_part(model, frame, figure, part,
                    uint64_t(double(triangles) * double(surface(figure, part) / all)),
                    materials[size_t(part)]);
}

}  // namespace glint::scenes

// Builds solids with a budget of triangles, for generated scenes.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/solids.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "scenes/generate/distance_field.h"
#include "scenes/generate/tubes.h"

namespace glint::scenes {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

uint32_t at_least(uint32_t least, double value) {
  return std::max(least, uint32_t(std::lround(value)));
}

// Returns a point of a box's surface, pulled onto the box's rounded edges.
Vec3 rounded(const Vec3& p, float roundness) {
  Vec3 core{};
  for (size_t k = 0; k < 3; ++k) core[k] = std::clamp(p[k], roundness - 1, 1 - roundness);
  const Vec3 out = p - core;
  return length(out) > 0 ? core + normalized(out) * roundness : p;
}

// Adds one part of a machine, in a frame of its own.
void add_part(Model& model, const Frame& frame, uint64_t triangles, int32_t material, uint32_t kind) {
  static constexpr Vec2 kPiston[] = {{-1, 0},      {-1, 0.9f},    {-0.3f, 0.9f}, {-0.25f, 0.5f},
                                     {0.5f, 0.5f}, {0.55f, 0.8f}, {1, 0.8f},     {1, 0}};
  static constexpr Vec2 kKnob[] = {{-1, 0}, {-0.9f, 1}, {0, 1}, {0.2f, 0.7f}, {0.8f, 0.6f}, {1, 0}};
  switch (kind) {
    case 0:
      return add_lathe(model, frame, kPiston, triangles, material);
    case 1:
      return add_lathe(model, frame, kKnob, triangles, material);
    case 2:
      return add_ring(model, frame, triangles, material, 0.3f);
    case 3:
      return add_ball(model, frame, triangles, material);
    default:
      return add_rounded_box(model, frame, triangles, material, 0.25f);
  }
}

}  // namespace

Vec3 Random::direction() {
  for (;;) {
    const float x = between(-1, 1), y = between(-1, 1), z = between(-1, 1);
    const Vec3 v{x, y, z};
    const float l = dot(v, v);
    if (l > 0.01f && l < 1) return normalized(v);
  }
}

Frame Frame::inner(const Vec3& center, const Vec3& size, float degrees) const {
  const double angle = double(degrees) * kTurn / 360;
  const float c = cosine(angle), s = sine(angle);
  return {(x * c - z * s) * size[0], y * size[1], (x * s + z * c) * size[2], at(center)};
}

Frame upright(const Vec3& origin, const Vec3& size, float degrees) {
  return Frame{.origin = origin}.inner({0, 0, 0}, size, degrees);
}

Frame in_view(const Camera& camera, float depth) {
  const Vec3 forward = normalized(camera.target - camera.eye), right = normalized(cross(forward, camera.up));
  return {right, cross(right, forward), forward * -1.0f, camera.eye + forward * depth};
}

Frame in_view_upright(const Camera& camera, float depth) {
  Frame frame = in_view(camera, depth);
  frame.y = camera.up;
  frame.z = normalized(cross(frame.x, frame.y));
  return frame;
}

void add_patch(Model& model, uint64_t triangles, float aspect, int32_t material,
               const std::function<Vec3(float, float)>& position) {
  const double rows = std::sqrt(double(triangles) / 2 / double(aspect));
  const uint32_t height = at_least(1, rows);
  add_sheet(model, at_least(1, double(triangles) / 2 / height), height, material, position);
}

void add_ball(Model& model, const Frame& frame, uint64_t triangles, int32_t material, float bumps,
              float frequency) {
  add_patch(model, triangles, 2, material, [&](float u, float v) {
    const double around = kTurn * double(u), down = kTurn / 2 * double(v);
    const Vec3 p{sine(down) * sine(around), cosine(down), sine(down) * cosine(around)};
    return frame.at(bumps == 0 ? p : p * (1 - bumps + bumps * fractal(p * frequency + frame.origin, 3)));
  });
}

void add_rounded_box(Model& model, const Frame& frame, uint64_t triangles, int32_t material,
                     float roundness) {
  for (size_t axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f})
      add_patch(model, triangles / 6, 1, material, [&](float u, float v) {
        Vec3 p{};
        p[axis] = side;
        p[(axis + 1) % 3] = (2 * u - 1) * side;
        p[(axis + 2) % 3] = 2 * v - 1;
        return frame.at(rounded(p, roundness));
      });
}

void add_ring(Model& model, const Frame& frame, uint64_t triangles, int32_t material, float thickness) {
  const float middle = 1 / (1 + thickness), tube = thickness * middle;
  add_patch(model, triangles, 3, material, [&](float u, float v) {
    const double around = kTurn * double(u), across = -kTurn * double(v);
    const float radius = middle + tube * cosine(across);
    return frame.at(radius * cosine(around), sine(across), radius * sine(around));
  });
}

void add_lathe(Model& model, const Frame& frame, std::span<const Vec2> profile, uint64_t triangles,
               int32_t material) {
  const auto pieces = uint64_t(profile.size() - 1);
  // Each piece has its own vertices, so the edges between pieces are sharp.
  for (size_t k = 0; k < pieces; ++k)
    add_patch(model, triangles / pieces, 4, material, [&](float u, float v) {
      const double around = -kTurn * double(u);
      const float height = profile[k][0] + (profile[k + 1][0] - profile[k][0]) * v;
      const float radius = profile[k][1] + (profile[k + 1][1] - profile[k][1]) * v;
      return frame.at(radius * cosine(around), height, radius * sine(around));
    });
}

void add_tube(Model& model, std::span<const Vec3> path, float start, float end, uint32_t sides,
              int32_t material) {
  const auto first = uint32_t(model.vertices.size());
  Vec3 right{};
  for (size_t k = 0; k < path.size(); ++k) {
    const Vec3 along = normalized(path[std::min(k + 1, path.size() - 1)] - path[k == 0 ? 0 : k - 1]);
    // The axis is carried along the path, so that the tube does not twist.
    const Vec3 helper = k > 0 ? right : std::abs(along[1]) < 0.9f ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
    right = normalized(helper - along * dot(helper, along));
    const Vec3 up = cross(along, right);
    const float t = float(k) / float(path.size() - 1), radius = start + (end - start) * t;
    for (uint32_t i = 0; i < sides; ++i) {
      const double angle = kTurn * i / sides;
      const Vec3 outward = right * cosine(angle) + up * sine(angle);
      add_vertex(model, path[k] + outward * radius, outward, material, {float(i) / float(sides), t});
    }
  }
  for (uint32_t k = 0; k + 1 < uint32_t(path.size()); ++k)
    for (uint32_t i = 0; i < sides; ++i) {
      const uint32_t a = first + k * sides + i, b = first + k * sides + (i + 1) % sides;
      add_triangle(model, a, b, b + sides);
      add_triangle(model, a, b + sides, a + sides);
    }
}

void add_cable(Model& model, const Vec3& start, const Vec3& end, float sag, float radius, uint64_t triangles,
               int32_t material) {
  const uint32_t sides = triangles > 4000 ? 16 : 8;
  const uint32_t segments = at_least(1, double(triangles) / (2 * sides));
  std::vector<Vec3> path;
  for (uint32_t k = 0; k <= segments; ++k) {
    const float t = float(k) / float(segments);
    path.push_back(start + (end - start) * t - Vec3{0, 4 * sag * t * (1 - t), 0});
  }
  add_tube(model, path, radius, radius, sides, material);
}

void add_machine(Model& model, const Frame& frame, uint64_t triangles, std::span<const int32_t> materials,
                 uint32_t seed) {
  constexpr uint32_t kKinds = 7;  // of which three are boxes
  Random random(seed);
  const auto parts = uint32_t(std::clamp<uint64_t>(triangles / 600, 2, 90));
  const uint64_t share = triangles / parts;
  add_rounded_box(model, frame.inner({0, 0, 0}, {0.7f, 0.75f, 0.7f}), share, materials[0], 0.3f);
  for (uint32_t k = 1; k < parts; ++k) {
    const float size = random.between(0.1f, 0.4f);
    Vec3 center = random.direction();
    center *= 0.95f - size;
    const float wide = size * random.between(0.6f, 1.3f), quarters = float(random.below(4));
    const float turn = 90 * quarters + random.between(-8, 8);
    Frame part = frame.inner(center, {wide, size, size}, turn);
    if (random.next() < 0.5f) std::swap(part.x, part.y);
    if (random.next() < 0.5f) std::swap(part.y, part.z);
    const int32_t material = materials[random.below(uint32_t(materials.size()))];
    add_part(model, part, share, material, random.below(kKinds));
  }
}

void add_cloth(Model& model, const Frame& frame, uint64_t triangles, int32_t material, float folds,
               uint32_t seed) {
  const auto shift = float(seed) * 7.31f;
  add_patch(model, triangles, 1, material, [&](float u, float v) {
    const float deep = 0.35f * wave(u * folds + 0.3f * noise({u * 2, v * 2, shift})) * (0.4f + 0.6f * v);
    return frame.at(2 * u - 1, 1 - 2 * v, deep + 0.6f * noise({u * 1.7f, v * 1.3f, shift}));
  });
}

void add_quad(Model& model, const Vec3& corner, const Vec3& side, const Vec3& other, int32_t material) {
  const Vec3 normal = normalized(cross(side, other));
  const uint32_t a = add_vertex(model, corner, normal, material, {0, 1});
  add_vertex(model, corner + side, normal, material, {1, 1});
  add_vertex(model, corner + side + other, normal, material, {1, 0});
  add_vertex(model, corner + other, normal, material, {0, 0});
  add_triangle(model, a, a + 1, a + 2);
  add_triangle(model, a, a + 2, a + 3);
}

float fractal(const Vec3& p, int octaves) {
  float sum = 0, strength = 0.5f;
  Vec3 q = p;
  for (int k = 0; k < octaves; ++k) {
    sum += strength * noise(q);
    q = q * 2.03f + Vec3{17.1f, 3.7f, 9.2f};
    strength *= 0.5f;
  }
  return sum;
}

}  // namespace glint::scenes

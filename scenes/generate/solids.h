// Solids with a budget of triangles, for scenes that are generated: what they look like at any density.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <random>
#include <span>

#include "scenes/generate/uniform_float.h"
#include "scenes/mesh.h"

namespace glint::scenes {

// Draws of a generated scene; the same seed gives the same scene everywhere.
class Random {
 public:
  explicit Random(uint32_t seed) : engine_(seed) {}
  float next() { return uniform_float(engine_); }  // 0 to 1
  float between(float low, float high) { return low + (high - low) * next(); }
  uint32_t below(uint32_t count) { return uint32_t(next() * float(count)); }
  Vec3 direction();  // of length 1

 private:
  std::mt19937 engine_;
};

// Axes and origin of a body's own coordinates; the axes' lengths are its half sizes.
struct Frame {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin{};
  Vec3 at(float a, float b, float c) const { return origin + x * a + y * b + z * c; }
  Vec3 at(const Vec3& p) const { return at(p[0], p[1], p[2]); }
  // The frame of half sizes `size` around `center`, both in this one's coordinates, turned about its y axis.
  Frame inner(const Vec3& center, const Vec3& size, float degrees = 0) const;
};

// Upright at `origin`, turned about +y (degrees), with half sizes `size`.
Frame upright(const Vec3& origin, const Vec3& size, float degrees = 0);
// In front of a camera: x to the right, y up, z towards the camera, of length 1, at `depth` along the view.
Frame in_view(const Camera& camera, float depth);
// The same with y upright and z level.
Frame in_view_upright(const Camera& camera, float depth);

// Every body takes its number of triangles, met within a few per cent from some hundred on, and fills [-1,
// 1]^3 of its frame. Smooth normals, except where edges are sharp.

// A ball whose radius varies by up to `bumps`, with `frequency` bumps along its width.
void add_ball(Model& model, const Frame& frame, uint64_t triangles, int32_t material, float bumps = 0,
              float frequency = 3);
// A box with edges rounded by `roundness`, a part of its half size.
void add_rounded_box(Model& model, const Frame& frame, uint64_t triangles, int32_t material,
                     float roundness = 0.2f);
// A ring about y; `thickness` is a part of its radius.
void add_ring(Model& model, const Frame& frame, uint64_t triangles, int32_t material,
              float thickness = 0.25f);
// A body turned about y from (height, radius) points, both -1 to 1 and 0 to 1, from below upwards.
void add_lathe(Model& model, const Frame& frame, std::span<const Vec2> profile, uint64_t triangles,
               int32_t material);
// A tube along a path, from radius `start` to radius `end`.
void add_tube(Model& model, std::span<const Vec3> path, float start, float end, uint32_t sides,
              int32_t material);
// A hanging cable.
void add_cable(Model& model, const Vec3& start, const Vec3& end, float sag, float radius, uint64_t triangles,
               int32_t material);
// Many boxes, turned parts, rings and pipes that fill the frame, as a machine does; materials are drawn from
// the list.
void add_machine(Model& model, const Frame& frame, uint64_t triangles, std::span<const int32_t> materials,
                 uint32_t seed);
// A hanging cloth over x and y with folds along z.
void add_cloth(Model& model, const Frame& frame, uint64_t triangles, int32_t material, float folds,
               uint32_t seed);
// A sheet over [0, 1]^2 of about as many triangles, `aspect` times as many columns as rows.
void add_patch(Model& model, uint64_t triangles, float aspect, int32_t material,
               const std::function<Vec3(float, float)>& position);
// A flat rectangle from `corner` along two sides: two triangles, texture coordinates 0 to 1.
void add_quad(Model& model, const Vec3& corner, const Vec3& side, const Vec3& other, int32_t material);

// Noise of several octaves, each of half the size and strength, in about [-1, 1].
float fractal(const Vec3& p, int octaves);

}  // namespace glint::scenes

// Builds solids with a budget of triangles, for generated scenes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <random>
#include <span>

#include "scenes/generate/uniform_float.h"
#include "scenes/mesh.h"

namespace glint::scenes {

// Draws the random numbers of a generated scene. The same seed gives the same scene everywhere.
class Random {
 public:
  explicit Random(uint32_t seed) : engine_(seed) {}
  float next() { return uniform_float(engine_); }  // between 0 and 1
  float between(float low, float high) { return low + (high - low) * next(); }
  uint32_t below(uint32_t count) { return uint32_t(next() * float(count)); }
  Vec3 direction();  // of length 1

 private:
  std::mt19937 engine_;
};

// Holds the axes and the origin of a body's own coordinates. The lengths of the axes are the body's half
// sizes.
struct Frame {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin{};
  Vec3 at(float a, float b, float c) const { return origin + x * a + y * b + z * c; }
  Vec3 at(const Vec3& p) const { return at(p[0], p[1], p[2]); }
  // Returns the frame of half sizes `size` around `center`, turned about its y axis. `center` and `size` are
  // in the coordinates of this frame.
  Frame inner(const Vec3& center, const Vec3& size, float degrees = 0) const;
};

// Returns an upright frame at `origin` with half sizes `size`, turned about +y by `degrees`.
Frame upright(const Vec3& origin, const Vec3& size, float degrees = 0);
// Returns a frame with axes of length 1 in front of a camera, at `depth` along the view: x to the right, y
// up, z towards the camera.
Frame in_view(const Camera& camera, float depth);
// Does the same with y upright and z level.
Frame in_view_upright(const Camera& camera, float depth);

// Each function below adds a body. It meets the given number of triangles within a few per cent, from some
// hundred triangles on. The body fills [-1, 1]^3 of its frame and has smooth normals except where its edges
// are sharp.

// Adds a ball whose radius varies by up to `bumps`, with `frequency` bumps along its width.
void add_ball(Model& model, const Frame& frame, uint64_t triangles, int32_t material, float bumps = 0,
              float frequency = 3);
// Adds a box with edges rounded by `roundness`, a part of its half size.
void add_rounded_box(Model& model, const Frame& frame, uint64_t triangles, int32_t material,
                     float roundness = 0.2f);
// Adds a ring about y; `thickness` is a part of its radius.
void add_ring(Model& model, const Frame& frame, uint64_t triangles, int32_t material,
              float thickness = 0.25f);
// Adds a body turned about y. `profile` holds points (height, radius) from below upwards, with heights from
// -1 to 1 and radii from 0 to 1.
void add_lathe(Model& model, const Frame& frame, std::span<const Vec2> profile, uint64_t triangles,
               int32_t material);
// Adds a tube along a path. Its radius goes from `start` to `end`.
void add_tube(Model& model, std::span<const Vec3> path, float start, float end, uint32_t sides,
              int32_t material);
// Adds a hanging cable.
void add_cable(Model& model, const Vec3& start, const Vec3& end, float sag, float radius, uint64_t triangles,
               int32_t material);
// Adds many boxes, turned parts, rings and pipes that fill the frame, as those of a machine do. Their
// materials are drawn from the list.
void add_machine(Model& model, const Frame& frame, uint64_t triangles, std::span<const int32_t> materials,
                 uint32_t seed);
// Adds a hanging cloth over x and y with folds along z.
void add_cloth(Model& model, const Frame& frame, uint64_t triangles, int32_t material, float folds,
               uint32_t seed);
// Adds a sheet over [0, 1]^2 of about `triangles` triangles. It has `aspect` times as many columns as rows.
void add_patch(Model& model, uint64_t triangles, float aspect, int32_t material,
               const std::function<Vec3(float, float)>& position);
// Adds a flat rectangle of two triangles that goes from `corner` along two sides, with texture coordinates 0
// to 1.
void add_quad(Model& model, const Vec3& corner, const Vec3& side, const Vec3& other, int32_t material);

// Returns noise of several octaves in about [-1, 1]. Each octave has half the size and half the strength of
// the one before.
float fractal(const Vec3& p, int octaves);

}  // namespace glint::scenes

// Tests the sampling of cubes: faces, filters across their edges, and levels by gradients.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <utility>

#include "exec/texture_address.h"
#include "tests/support/catch.h"
#include "tests/unit/exec/image_lab.h"

namespace glint::exec {

using isa::ImageShape;

TEST_CASE("the axes of a cube meet its six faces, turned as Vulkan's table says") {
  ImageLab lab;
  ImageView image = view_of(ImageShape::Cube, 2, 2);
  image.layers = 6;
  const uint32_t handle = add_pattern(lab, image);
  struct {
    float x, y, z;
    uint32_t face, s, t;
  } const cases[] = {{1, 0.5f, 0.5f, 0, 0, 0}, {1, -0.5f, 0.5f, 0, 0, 1}, {-1, 0.5f, 0.5f, 1, 1, 0},
                     {0.5f, 1, 0.5f, 2, 1, 1}, {-0.5f, 1, 0.5f, 2, 0, 1}, {0.5f, -1, 0.5f, 3, 1, 0},
                     {0.5f, 0.5f, 1, 4, 1, 0}, {0.5f, 0.5f, -1, 5, 0, 0}};
  for (const auto& c : cases)
    CHECK(number(lab.run_one("tex.cube.v4.f32.f32", {handle, bits(c.x), bits(c.y), bits(c.z)})[0]) ==
          pattern({c.s, c.t, 0, c.face, 0}));
}

TEST_CASE("a linear filter crosses the edges of a cube, and a corner is the average of its three faces") {
  ImageLab lab;
  ImageView image = view_of(ImageShape::Acube, 2, 2);
  image.layers = 12;
  image.sampler.mag = Filter::Linear;
  const uint32_t handle = lab.add(image);
  for (TexelIndex at{0, 0, 0, 0, 0}; at.layer < 12; ++at.layer)
    for (at.y = 0; at.y < 2; ++at.y)
      for (at.x = 0; at.x < 2; ++at.x) lab.put(handle, at, floats(float(1u << at.layer), 0, 0, 0));
  const auto sample = [&](uint32_t cube, float x, float y, float z) {
    return number(lab.run_one("tex.acube.v4.f32.f32", {handle, cube, bits(x), bits(y), bits(z)})[0]);
  };
  CHECK(sample(0, 1, 0, 1) == (16 + 1) / 2.0f);
  CHECK(sample(0, -1, 0, 1) == (16 + 2) / 2.0f);
  CHECK(sample(0, 0, -1, -1) == (32 + 8) / 2.0f);
  CHECK(sample(1, 1, 1, 0) == 64 * (1 + 4) / 2.0f);
  CHECK(sample(0, 1, 1, 1) == Catch::Approx((16 + 1 + 4) / 3.0f));
}

TEST_CASE("the texel across an edge of a cube is the nearest one of the other faces") {
  constexpr int64_t kSize = 5;
  // Returns the direction to the middle of a texel, face by face, as OpenGL's manuals define it.
  const auto direction = [&](uint32_t face, int64_t x, int64_t y) {
    const double s = double(2 * x + 1) / kSize - 1, t = double(2 * y + 1) / kSize - 1;
    switch (face) {
      case 0:
        return std::array{1.0, -t, -s};
      case 1:
        return std::array{-1.0, -t, s};
      case 2:
        return std::array{s, 1.0, t};
      case 3:
        return std::array{s, -1.0, -t};
      case 4:
        return std::array{s, -t, 1.0};
      default:
        return std::array{-s, -t, -1.0};
    }
  };
  const auto closeness = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
    const auto dot = [](const auto& p, const auto& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; };
    return dot(a, b) / std::sqrt(dot(a, a) * dot(b, b));
  };
  for (uint32_t face = 0; face < 6; ++face)
    for (int64_t i = 1; i + 1 < kSize; ++i)
      for (const auto& [inside, outside] : {std::pair{std::pair{int64_t{0}, i}, std::pair{int64_t{-1}, i}},
                                            {{kSize - 1, i}, {kSize, i}},
                                            {{i, int64_t{0}}, {i, int64_t{-1}}},
                                            {{i, kSize - 1}, {i, kSize}}}) {
        const auto from = direction(face, inside.first, inside.second);
        std::array<int64_t, 3> best{};
        double best_closeness = -2;
        for (uint32_t other = 0; other < 6; ++other)
          for (int64_t y = 0; y < kSize; ++y)
            for (int64_t x = 0; x < kSize; ++x)
              if (const double c = closeness(from, direction(other, x, y));
                  other != face && c > best_closeness) {
                best_closeness = c;
                best = {other, x, y};
              }
        const CubeTexel found = across_edge(face, outside.first, outside.second, kSize);
        CHECK(std::array<int64_t, 3>{found.face, found.x, found.y} == best);
      }
}

TEST_CASE("the texel across an edge keeps its place along the edge, in large cubes too") {
  constexpr int64_t kSize = 16384;
  for (int64_t i : {int64_t{0}, int64_t{1}, int64_t{8191}, int64_t{8192}, kSize - 2, kSize - 1}) {
    const CubeTexel found = across_edge(4, kSize, i, kSize);  // +z and +x share t
    CHECK(found.face == 0);
    CHECK(found.x == 0);
    CHECK(found.y == i);
  }
}

TEST_CASE("gradients of cubes choose the level of the face") {
  ImageLab lab;
  ImageView image = view_of(ImageShape::Cube, 8, 8);
  image.layers = 6;
  image.levels = 4;
  image.sampler.mip = Filter::Linear;
  const uint32_t handle = lab.add(image);
  for (TexelIndex at; at.level < 4; ++at.level)
    for (at.layer = 0; at.layer < 6; ++at.layer)
      for (at.y = 0; at.y < image.extent(1, at.level); ++at.y)
        for (at.x = 0; at.x < image.extent(0, at.level); ++at.x)
          lab.put(handle, at, floats(float(at.level), 0, 0, 0));
  // By s = 0.5 x / z + 0.5, a step of 1 in x is half of the face: 4 texels at z = 1, and 2 texels at z = 2.
  const auto level = [&](float z) {
    return number(lab.run_one("tex.grad.cube.v4.f32.f32",
                              {handle, bits(0.1f), bits(0.2f), bits(z), bits(1.0f), 0, 0, 0, 0, 0})[0]);
  };
  CHECK(level(1) == Catch::Approx(2));
  CHECK(level(-2) == Catch::Approx(1));
}

}  // namespace glint::exec

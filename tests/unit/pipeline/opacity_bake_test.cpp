// Tests that baked micromaps say of every sample what the alpha test says, or that they do not know.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/opacity_bake.h"

#include <array>
#include <cstring>
#include <vector>

#include "exec/texture_filter.h"
#include "tests/support/catch.h"
#include "tests/support/rt_scenes.h"

namespace glint::pipeline {
namespace {

using rt::MicroState;
using rt::test::Random;

// Holds a texture of patches that are clear or solid, in memory, with the triangle that it covers.
struct Sheet {
  mem::AddressSpace memory;
  exec::ImageView image;
  AlphaTexture texture;
  std::vector<scenes::Vertex> vertices{3};
  std::vector<uint32_t> indices{0, 1, 2};
  std::vector<scenes::Material> materials{1};

  Sheet(Random& random, uint32_t width, uint32_t height, exec::Wrap wrap) {
    std::vector<uint8_t> rgba(size_t{width} * height * 4);
    const uint32_t patch = 1 + random.below(12);
    const uint64_t key = random.bits();
    for (uint32_t y = 0; y < height; ++y)
      for (uint32_t x = 0; x < width; ++x) {
        Random of_patch{key + x / patch * 977 + y / patch * 131};
        of_patch.bits();
        rgba[(size_t{y} * width + x) * 4 + 3] = of_patch.below(2) ? 0 : uint8_t(1 + of_patch.below(255));
      }
    image.format = exec::ImageView::Format::Rgba8Unorm;
    image.width = width, image.height = height;
    image.base = memory.allocate("texture", rgba.size());
    image.sampler.wrap.fill(wrap);
    memory.write(image.base, rgba.data(), rgba.size());
    texture = {memory.view<uint8_t>(image.base, rgba.size()), width, height, wrap};
    materials[0].texture = 0;
  }
  void place(Random& random, float low, float high) {
    for (scenes::Vertex& vertex : vertices)
      vertex.texture_coordinate = {random.uniform(low, high), random.uniform(low, high)};
  }
  rt::Micromaps bake(const rt::MicromapFormat& format) const {
    return bake_opacity({vertices, indices, materials, {&texture, 1}}, format);
  }
  // Does what shaders/include/alpha_hit.glsl does.
  bool is_clear(float u, float v) const {
    const float w = 1.0f - u - v;
    exec::SampleRequest request;
    for (int axis = 0; axis < 2; ++axis)
      request.at[size_t(axis)] = vertices[0].texture_coordinate[axis] * w +
                                 vertices[1].texture_coordinate[axis] * u +
                                 vertices[2].texture_coordinate[axis] * v;
    float alpha = 0;
    const uint32_t bits = exec::TexelReader(image, image.sampler, memory).sample(request)[3];
    std::memcpy(&alpha, &bits, sizeof alpha);
    return alpha == 0.0f;
  }
};

MicroState state_at(const rt::Micromaps& maps, float u, float v) {
  const int32_t index = maps.index.at(0);
  if (index < 0) return MicroState(-1 - index);
  const rt::MicromapFormat& format = maps.format;
  return rt::micro_state(format, maps.states.data() + size_t(index) * format.bytes(),
                         rt::number_of(rt::micro_triangle_at(u, v, format.level), format.level));
}

TEST_CASE("no sample within a transparent part is solid, and none within an opaque part is clear") {
  Random random{17};
  std::array<uint64_t, 4> met{};
  for (int trial = 0; trial < 300; ++trial) {
    const exec::Wrap wrap = trial % 2 ? exec::Wrap::Repeat : exec::Wrap::ClampToEdge;
    Sheet sheet(random, 1 + random.below(64), 1 + random.below(64), wrap);
    const float size = std::array{0.05f, 1.0f, 3.0f}[size_t(trial % 3)];
    sheet.place(random, -size, size);
    const rt::Micromaps maps = sheet.bake({false, uint32_t(trial % 7)});
    for (int i = 0; i < 400; ++i) {
      float u = random.uniform(0, 1), v = random.uniform(0, 1);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      if (i % 8 == 0) v = 0;
      if (i % 8 == 1) v = 1 - u;
      const MicroState state = state_at(maps, u, v);
      ++met[size_t(state)];
      if (state == MicroState::Transparent) REQUIRE(sheet.is_clear(u, v));
      if (state == MicroState::Opaque) REQUIRE_FALSE(sheet.is_clear(u, v));
    }
  }
  for (const uint64_t count : met) CHECK(count > 1000);
}

TEST_CASE("with 2 states a part has what the alpha test says at its centre") {
  Random random{18};
  for (int trial = 0; trial < 50; ++trial) {
    Sheet sheet(random, 64, 64, exec::Wrap::Repeat);
    sheet.place(random, 0, 1);
    const uint32_t level = uint32_t(trial % 5);
    const rt::Micromaps maps = sheet.bake({true, level});
    const uint32_t size = 1u << level;
    for (uint32_t u = 0; u < size; ++u)
      for (uint32_t v = 0; u + v < size; ++v) {
        const float at_u = (float(u) + 1.0f / 3) / float(size), at_v = (float(v) + 1.0f / 3) / float(size);
        REQUIRE((state_at(maps, at_u, at_v) == MicroState::Transparent) == sheet.is_clear(at_u, at_v));
      }
  }
}

TEST_CASE("a triangle without a texture is opaque, and one far outside of its texture is not looked at") {
  Random random{19};
  Sheet sheet(random, 8, 8, exec::Wrap::Repeat);
  sheet.place(random, 0, 1e30f);
  CHECK(sheet.bake({false, 2}).index == std::vector{rt::Micromaps::uniform(MicroState::UnknownOpaque)});
  sheet.vertices[1].texture_coordinate[0] = NAN;
  CHECK(sheet.bake({false, 2}).index == std::vector{rt::Micromaps::uniform(MicroState::UnknownOpaque)});
  sheet.materials[0].texture = -1;
  CHECK(sheet.bake({false, 2}).index == std::vector{rt::Micromaps::uniform(MicroState::Opaque)});
}

TEST_CASE("triangles with the same texture coordinates have one map") {
  Random random{20};
  Sheet sheet(random, 64, 64, exec::Wrap::ClampToEdge);
  sheet.place(random, 0, 1);
  sheet.indices = {0, 1, 2, 0, 1, 2, 0, 2, 1};
  const rt::Micromaps maps = sheet.bake({false, 4});
  REQUIRE(maps.index.size() == 3);
  CHECK(maps.index[0] == maps.index[1]);
  CHECK(maps.index[0] != maps.index[2]);
  CHECK(maps.states.size() == 2 * maps.format.bytes());
}

}  // namespace
}  // namespace glint::pipeline

// Tests textures and any-hit shaders, end to end: rays pass where the texture's alpha is exactly zero.
// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "pipeline/render.h"
#include "tests/support/catch.h"
#include "tests/support/small_jobs.h"

using namespace glint;

namespace {

constexpr uint32_t kSize = 64;

// Returns a quad of x, y in [-1, 1] that faces the camera under the sky. Its texture has two texels side by
// side, the left one with alpha 0; between their centres, u = 1/4 and 3/4, alpha is filtered and not zero.
scenes::Scene quad_scene(bool with_quad) {
  scenes::Scene scene;
  scene.name = "QUAD";
  scene.alpha_test = true;
  scene.camera.eye = {0, 0, 5};
  scene.camera.field_of_view = 40;
  scene.materials.resize(1);
  scene.materials[0].diffuse = {1, 1, 1, 1};
  scene.materials[0].texture = 0;
  scene.textures.push_back({"half", 2, 1, {255, 0, 0, 0, 0, 255, 0, 255}});
  scenes::Model model;
  model.name = "quad";
  const float shift = with_quad ? 0.0f : 1000.0f;  // out of sight
  for (const auto& [x, y] : {std::pair{-1.0f, -1.0f}, {1.0f, -1.0f}, {1.0f, 1.0f}, {-1.0f, 1.0f}})
    model.vertices.push_back({{x, y, -shift}, {0, 0, 1}, {(x + 1) / 2, (y + 1) / 2}, 0});
  model.indices = {0, 1, 2, 0, 2, 3};
  if (!with_quad)
    for (scenes::Vertex& vertex : model.vertices) vertex.position[0] += 5000;
  scene.models.push_back(std::move(model));
  return scene;
}

pipeline::RenderResult picture(bool with_quad, bool timing, const char* any_hit = "immediate") {
  pipeline::RenderJob job = test::small_job("CORNELL", pipeline::Workload::PathTracing, kSize, 1);
  job.scene = quad_scene(with_quad);
  job.timing = timing;
  job.gpu.rt.any_hit.name = any_hit;
  return pipeline::render(job);
}

// Returns the column of the pixels that see `x` on the quad's plane, which is 5 away; half the picture is
// tan(20 deg) * 5 wide.
uint32_t column(float x) {
  return uint32_t((x / 1.8199f * 0.5f + 0.5f) * kSize);
}

const float* pixel(const pipeline::RenderResult& result, uint32_t x, uint32_t y) {
  return &result.rgba[4 * (y * kSize + x)];
}

}  // namespace

TEST_CASE("rays pass a texture's transparent texels and meet its opaque ones") {
  const bool timing = GENERATE(false, true);
  const pipeline::RenderResult with = picture(true, timing), without = picture(false, timing);

  for (uint32_t y : {kSize / 2 - 8, kSize / 2, kSize / 2 + 8}) {
    for (uint32_t x = column(-0.9f); x < column(-0.6f); ++x)  // u < 1/4: alpha is 0
      for (int c = 0; c < 3; ++c) CHECK(pixel(with, x, y)[c] == pixel(without, x, y)[c]);
    for (uint32_t x = column(0.6f); x < column(0.9f); ++x) {  // u > 3/4: pure green
      CHECK(pixel(with, x, y)[0] == 0.0f);
      CHECK(pixel(with, x, y)[2] == 0.0f);
    }
  }
}

TEST_CASE("a picture that needs textures and any-hit shaders is the same from both machines") {
  CHECK(picture(true, false).rgba == picture(true, true).rgba);
}

TEST_CASE("a picture with any-hit shaders is the same when they run after the traversal, on both machines") {
  const std::vector<float> immediate = picture(true, false).rgba;
  CHECK(picture(true, false, "deferred").rgba == immediate);
  CHECK(picture(true, true, "deferred").rgba == immediate);
}

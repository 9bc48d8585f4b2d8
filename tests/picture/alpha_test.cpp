// Tests textures and any-hit shaders, end to end: rays pass where the texture's alpha is exactly zero.
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <unistd.h>
#include <utility>

#include "base/config.h"
#include "base/diagnostics.h"
#include "pipeline/render.h"
#include "tests/support/catch.h"
#include "tests/support/small_jobs.h"

using namespace glint;

namespace {

constexpr uint32_t kAlphaSize = 64;

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

struct Choices {
  const char* any_hit = "immediate";
  const char* leaf_filter = "none";
  const char* micromaps = "";  // parameters of that filter
  std::string shader_dir = {};
};
pipeline::RenderResult picture(bool with_quad, bool timing, const Choices& choices = {}) {
  pipeline::RenderJob job = test::small_job("CORNELL", pipeline::Workload::PathTracing, kAlphaSize, 1);
  job.scene = quad_scene(with_quad);
  job.timing = timing;
  job.gpu.rt.any_hit.name = choices.any_hit;
  job.gpu.rt.leaf_filter.name = choices.leaf_filter;
  if (*choices.micromaps) {
    Config config;
    config.add_text("test", choices.micromaps);
    Diagnostics diagnostics;
    ConfigTable table = config.root(diagnostics);
    Registry<rt::LeafFilter>::instance().entry(choices.leaf_filter).read(table, &job.gpu.rt.leaf_filter);
    REQUIRE_FALSE(diagnostics.has_errors());
  }
  if (!choices.shader_dir.empty()) job.shader_dir = choices.shader_dir;
  return pipeline::render(job);
}

// Returns the column of the pixels that see `x` on the quad's plane, which is 5 away; half the picture is
// tan(20 deg) * 5 wide.
uint32_t column(float x) {
  return uint32_t((x / 1.8199f * 0.5f + 0.5f) * kAlphaSize);
}

const float* pixel(const pipeline::RenderResult& result, uint32_t x, uint32_t y) {
  return &result.rgba[4 * (y * kAlphaSize + x)];
}

}  // namespace

TEST_CASE("rays pass a texture's transparent texels and meet its opaque ones") {
  const bool timing = GENERATE(false, true);
  const pipeline::RenderResult with = picture(true, timing), without = picture(false, timing);

  for (uint32_t y : {kAlphaSize / 2 - 8, kAlphaSize / 2, kAlphaSize / 2 + 8}) {
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
  CHECK(picture(true, false, {"deferred"}).rgba == immediate);
  CHECK(picture(true, true, {"deferred"}).rgba == immediate);
}

TEST_CASE("micromaps with 4 states change no pixel, on both machines and in both any-hit modes") {
  const std::vector<float> plain = picture(true, false).rgba;
  for (const bool timing : {false, true})
    for (const char* any_hit : {"immediate", "deferred"})
      CHECK(picture(true, timing, {any_hit, "micromaps"}).rgba == plain);
}

// Holds the shaders of path tracing, changed so that rays ask micromaps for 2 states.
struct TwoStateShaders {
  std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("glint_two_states_" + std::to_string(getpid()));
  TwoStateShaders() {
    namespace fs = std::filesystem;
    const fs::path from = fs::path(GLINT_SOURCE_DIR) / "shaders";
    fs::remove_all(folder);
    fs::create_directories(folder);
    fs::copy(from / "path_tracing", folder / "path_tracing");
    fs::create_directory_symlink(from / "include", folder / "include");
    replace("#extension GL_EXT_ray_tracing : require",
            "#extension GL_EXT_ray_tracing : require\n#extension GL_EXT_opacity_micromap : require");
    replace("gl_RayFlagsNoneEXT", "gl_RayFlagsForceOpacityMicromap2StateEXT");
  }
  ~TwoStateShaders() { std::filesystem::remove_all(folder); }

 private:
  void replace(const std::string& old, const std::string& by) const {
    const std::filesystem::path raygen = folder / "path_tracing/raygen.rgen";
    std::stringstream text;
    text << std::ifstream(raygen).rdbuf();
    std::string changed = text.str();
    REQUIRE(changed.find(old) != std::string::npos);
    changed.replace(changed.find(old), old.size(), by);
    std::ofstream(raygen) << changed;
  }
};

TEST_CASE("a ray that forces 2 states sees maps with 4 states as maps with 2 states") {
  const TwoStateShaders shaders;
  const std::vector<float> plain = picture(true, false).rgba;
  for (const bool timing : {false, true}) {
    const std::vector<float> two =
        picture(true, timing, {"immediate", "micromaps", "two_states = true\nlevel = 1"}).rgba;
    CHECK(two != plain);
    CHECK(picture(true, timing,
                  {"immediate", "micromaps", "level = 1", (shaders.folder / "path_tracing").string()})
              .rgba == two);
  }
}

// Tests pictures of scenes whose copies are shared, and of a scene with instances, masks and textures of all
// kinds.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "tests/picture/agreement.h"
#include "tests/support/catch.h"
#include "tests/support/scene_data.h"
#include "tests/support/small_jobs.h"

using namespace glint;
using pipeline::Workload;
using test::Agreement;
using test::Oracle;

namespace {

constexpr uint32_t kInstancingSize = 32;

pipeline::RenderResult picture(pipeline::RenderJob job, Workload workload) {
  job.workload = workload;
  job.timing = false;
  job.frame.bounces = 2;
  job.shader_dir = std::string(GLINT_SOURCE_DIR) + "/shaders/" + test::shader_folder(workload);
  return pipeline::render(job);
}

// Returns the fraction of pixels whose channels agree within 1e-3 relative.
double equal_pixels(const std::vector<float>& a, const std::vector<float>& b) {
  size_t equal = 0;
  for (size_t i = 0; i < a.size(); i += 4) {
    bool all = true;
    for (size_t c = i; c < i + 3; ++c)
      all = all && std::abs(a[c] - b[c]) <= 1e-3f * std::max(std::abs(a[c]), 1e-3f);
    equal += all;
  }
  return 4 * double(equal) / double(a.size());
}

// Checks a scene with shared copies. Some pixels may differ. A copy's corners are rounded after its matrix,
// so a ray that grazes an edge or begins on a surface may meet another triangle.
void check_shared(const std::string& scene, const std::string& assets) {
  pipeline::RenderJob stored = test::small_job(scene, Workload::Shadow, kInstancingSize, 2, assets);
  test::KeptStructures structures;
  stored.structure_cache = structures.cache();
  pipeline::RenderJob shared = stored;
  shared.scene = scenes::load_scene(scene, {assets, true});
  REQUIRE(shared.scene.instances.size() == stored.scene.models.size());
  CHECK(shared.scene.stored_triangles() < stored.scene.stored_triangles());
  CHECK(shared.scene.triangles() == stored.scene.triangles());

  for (const Workload workload : {Workload::Shadow, Workload::AmbientOcclusion, Workload::PathTracing}) {
    const pipeline::RenderResult a = picture(stored, workload), b = picture(shared, workload);
    INFO(scene << ' ' << test::shader_folder(workload));
    CHECK(equal_pixels(a.accumulation, b.accumulation) >= 0.995);
    CHECK(std::abs(double(b.rays.rays) / double(a.rays.rays) - 1) <= 0.005);
  }
  // It agrees exactly with the picture of its instances moved into the world.
  const Agreement moved = test::agreements(shared, {{Workload::Shadow, 16, Oracle::Exact}}).front();
  CHECK(moved.pixels >= 0.995);
  CHECK(std::abs(moved.ray_ratio - 1) < 1e-3);
}

// Returns a floor of a coarse texture that repeats and is stored as sRGB. Above it are two copies of a leaf
// with holes, one of them stretched, turned and mirrored, and a ball with a texture of its own.
scenes::Scene garden() {
  scenes::Scene scene;
  scene.name = "GARDEN";
  scene.form = "of the test";
  scene.alpha_test = true;
  scene.camera.eye = {0, 2, 6};
  scene.camera.target = {0, 0.5f, 0};
  scene.textures.push_back(
      {"tiles", 2, 2, {250, 20, 60, 255, 20, 180, 60, 255, 90, 90, 200, 255, 240, 240, 10, 255}, true, true});
  scene.textures.push_back({"leaf", 3, 1, {0, 99, 0, 255, 0, 0, 0, 0, 200, 99, 0, 255}});
  scene.textures.push_back(
      {"stripes", 4, 1, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255}});
  for (int32_t k = 0; k < 3; ++k) {
    scenes::Material material;
    material.diffuse = {0.9f, 0.8f, 0.7f, 1};
    material.texture = k;
    scene.materials.push_back(material);
  }
  const auto quad = [&](int32_t material, std::array<scenes::Vec3, 4> corners, scenes::Vec3 normal,
                        float most) {
    scenes::Model model;
    model.name = "quad";
    const scenes::Vec2 at[4] = {{-most, -most}, {most, -most}, {most, most}, {-most, most}};
    for (size_t i = 0; i < 4; ++i) model.vertices.push_back({corners[i], normal, at[i], material});
    model.indices = {0, 1, 2, 0, 2, 3};
    scene.models.push_back(model);
  };
  quad(0, {{{-5, 0, 5}, {5, 0, 5}, {5, 0, -5}, {-5, 0, -5}}}, {0, 1, 0}, 3.3f);
  quad(1, {{{-1, 0.2f, 0}, {1, 0.2f, 0}, {1, 2, 0}, {-1, 2, 0}}}, {0, 0, 1}, 1.2f);
  scenes::Model ball;
  ball.name = "ball";
  ball.center = {2, 1, -1};
  ball.radius = 0.8f;
  ball.vertices.push_back({ball.center, {}, {}, 2});
  ball.indices = {0, 0, 0};
  scene.models.push_back(ball);
  scene.instances = {{0, scenes::kIdentity},
                     {1, scenes::kIdentity},
                     {1, {0, 0, 1.5f, -1.5f, 0, 0.8f, 0, 0.1f, 0.7f, 0.2f, 0, -0.5f}},
                     {2, scenes::kIdentity}};
  return scene;
}

}  // namespace

TEST_CASE("a generated scene whose copies are shared has the picture of one that stores them") {
  check_shared(GENERATE("BATH", "PARTY"), {});
}

TEST_CASE("the bathroom of files whose copies are shared has the picture of one that stores them") {
  const test::SceneData data("BATH");
  if (!data.path.empty()) check_shared("BATH", data.path);
}

TEST_CASE("the forest of files whose copies are shared has the picture of one that stores them") {
  if (std::getenv("GLINT_LARGE_SCENES") == nullptr) {
    WARN("SKIPPED: FRST from files is large; GLINT_LARGE_SCENES=1 compares it too");
    return;
  }
  const test::SceneData data("FRST");
  if (data.path.empty()) return;
  pipeline::RenderJob stored = test::small_job("FRST", Workload::Shadow, kInstancingSize, 2, data.path);
  test::KeptStructures structures;
  stored.structure_cache = structures.cache();
  pipeline::RenderJob shared = stored;
  shared.scene = scenes::load_scene("FRST", {data.path, true});
  CHECK(shared.scene.stored_triangles() * 10 < stored.scene.stored_triangles());
  // 1,016 of 1,024 pixels agree, because of grass and leaves whose tips are less than a pixel.
  for (const Workload workload : {Workload::AmbientOcclusion, Workload::PathTracing})
    CHECK(equal_pixels(picture(stored, workload).accumulation, picture(shared, workload).accumulation) >=
          0.985);
}

TEST_CASE(
    "instances, masks, repeated and sRGB textures and textured spheres give the exact reference's picture") {
  pipeline::RenderJob job = test::small_job("CORNELL", Workload::Shadow, 64, 2);
  job.scene = garden();
  for (const Agreement& a : test::agreements(job, {{Workload::Shadow, 16, Oracle::Exact},
                                                   {Workload::AmbientOcclusion, 16, Oracle::Exact},
                                                   {Workload::PathTracing, 2, Oracle::Exact},
                                                   {Workload::PathTracing, 16, Oracle::Exact}})) {
    CHECK(a.pixels >= 0.998);
    CHECK(std::abs(a.ray_ratio - 1) < 1e-3);
  }
}

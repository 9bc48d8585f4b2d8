// Builds CHSNT, a chestnut tree seen from below, whose leaves are squares with transparent texels.
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include "scenes/generate/generated.h"
#include "scenes/generate/paintings.h"
#include "scenes/generate/plants.h"
#include "scenes/import/asset_folder.h"
#include "scenes/import/obj_loader.h"

namespace glint::scenes {
namespace {

constexpr double kTilt = -75 * 3.14159265358979 / 180;  // about +x

void tilt(Model& model) {
  const float c = cosine(kTilt), s = sine(kTilt);
  const auto turn = [c, s](const Vec3& v) -> Vec3 {
    return {v[0], c * v[1] - s * v[2], s * v[1] + c * v[2]};
  };
  for (Vertex& vertex : model.vertices) {
    vertex.position = turn(vertex.position);
    vertex.normal = turn(vertex.normal);
  }
}

// Returns eight copies of the young tree, which have about as many triangles as the old one. Each is turned
// by a further eighth about the tree's axis (z).
Model grow_up(const Model& young) {
  Model model;
  for (int k = 0; k < 8; ++k) {
    const double angle = k * 0.78539816339744831;
    const float scale = 3 + 1.5f * float(k) / 7, c = scale * cosine(angle), s = scale * sine(angle);
    append_copy(model, young, {c, -s, 0, 0, s, c, 0, 0, 0, 0, scale, 0}, -1);
  }
  model.name = young.name;
  return model;
}

void load(Scene& scene, const std::string& path, uint32_t threads) {
  Model tree = load_obj(path, scene.materials, {.textures = &scene.textures, .threads = threads});
  scene.form = "original";
  scene.note = "The mesh is from the assets folder.";
  if (std::filesystem::path(path).filename() == "AL05y.obj") {  // a stand-in of another size
    tree = grow_up(tree);
    scene.form = "stand-in";
    scene.note = "Eight copies of the young tree (38,253 triangles) replace the original's old one (313K).";
  }
  tilt(tree);
  scene.models.push_back(std::move(tree));
}

// Builds the tree along the tilted axis. In the original's axes, z is up before the tilt.
void generate(Scene& scene, const LoadOptions& options) {
  constexpr uint64_t kTriangles = 313'000;
  constexpr uint64_t kGround = 2'000;
  Generator generator(scene, options, kTriangles);
  const int32_t bark =
      generator.textured("bark", paint_texture(Pattern::Bark, {0.45f, 0.38f, 0.31f}, 512, 512, 1));
  const int32_t leaves = generator.textured("leaves", paint_leaf({0.35f, 0.5f, 0.15f}, 512, 2));
  const int32_t ground = generator.color("ground", 0.8f, 0.8f, 0.8f);
  generator.model("chestnut", [&](Model& model) {
    add_tree(model, model,
             {.foot = {20, -12, -75},
              .up = {0, -sine(kTilt), cosine(kTilt)},
              .height = 150,
              .spread = 0.45f,
              .leaf = 0.035f,
              .wood = 0.3f,
              .bark = bark,
              .leaves = leaves,
              .seed = 11},
             kTriangles - kGround);
    add_ground(
        model, {-200, -200}, {240, 90},
        [](float x, float z) {
          return -12 - 4 * fractal({x * 0.02f, 0, z * 0.02f}, 2);
        },
        kGround, ground);
  });
  scene.note =
      "The scene is a procedural tree of about the original's triangle count (313K), with leaves cut out by "
      "their texture's alpha.";
}

}  // namespace

Scene build_chestnut(const LoadOptions& options, const std::string& original) {
  Scene scene;
  scene.name = "CHSNT";
  scene.camera = {.eye = {20, 0, 100}, .target = {20, 100, 0}, .field_of_view = 50};
  scene.alpha_test = true;
  original.empty() ? generate(scene, options) : load(scene, original, options.threads);
  return scene;
}

}  // namespace glint::scenes

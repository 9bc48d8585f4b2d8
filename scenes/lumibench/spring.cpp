// Builds SPRNG: a girl in knitted clothes close to the camera, grass around her, and a mountain behind her.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/generated.h"
#include "scenes/generate/plants.h"
#include "scenes/import/asset_folder.h"

namespace glint::scenes {
namespace {

constexpr uint64_t kTriangles = 1'900'000;

FolderRules rules() {
  return {.folders = {"Scenes/Blender_2.80", "assets/Scenes/Blender_2.80", "SPRNG"},
          .skip = "Dirt_grass",
          .colors = {{{"spring_body"}, paint(223, 175, 171)},
                     {{"stitches"}, paint(92, 64, 51)},
                     {{"spring_jacket"}, paint(163, 67, 42)},
                     {{"spring_pants"}, paint(92, 74, 101)},
                     {{"spring_boots"}, paint(150, 106, 86)},
                     {{"spring_hairband"}, paint(69, 23, 8)},
                     {{"spring_hair"}, paint(108, 86, 99)},
                     {{"spring_scarf", "spring_pullover"}, paint(114, 76, 64)}}};
}

// Adds the seams of a garment, which are rings of small tubes on a ball.
void stitches(Model& model, const Frame& frame, uint64_t triangles, int32_t material, uint32_t seed) {
  Random random(seed);
  const uint64_t count = triangles / 96;
  for (uint64_t k = 0; k < count; ++k) {
    const float row = float(k % 12) / 6 - 0.92f, level = row < 0 ? 1 + row : 1 - row;
    const double angle = 6.283185307 * double(k) / double(count) * 12;
    const float wide = 0.35f + 0.65f * level, jitter = random.between(0.98f, 1.02f);
    const auto at = [&](double turn, float lift) {
      return frame.at(wide * jitter * cosine(angle + turn), row + lift, wide * jitter * sine(angle + turn));
    };
    add_cable(model, at(0, 0), at(0.03, 0.02f), -0.004f, 0.003f, 96, material);
  }
}

void girl(Generator& generator, const Frame& view) {
  const auto part = [&](const char* name, const Vec3& center, const Vec3& size, uint64_t triangles,
                        int32_t material, float bumps) {
    generator.model(name,
                    [&](Model& m) { add_ball(m, view.inner(center, size), triangles, material, bumps, 4); });
  };
  const int32_t skin = generator.material("skin", paint(223, 175, 171)),
                jacket = generator.material("jacket", paint(163, 67, 42));
  const int32_t pants = generator.material("pants", paint(92, 74, 101)),
                boots = generator.material("boots", paint(150, 106, 86));
  const int32_t hair = generator.material("hair", paint(108, 86, 99)),
                scarf = generator.material("scarf", paint(114, 76, 64));
  const int32_t seam = generator.material("seam", paint(92, 64, 51)),
                band = generator.material("band", paint(69, 23, 8));
  part("spring_body", {0, 0.42f, 0}, {0.17f, 0.21f, 0.17f}, 95'000, skin, 0.08f);
  part("spring_jacket", {0, -0.15f, 0}, {0.3f, 0.36f, 0.2f}, 120'000, jacket, 0.2f);
  part("spring_scarf", {0, 0.19f, 0.02f}, {0.2f, 0.08f, 0.18f}, 40'000, scarf, 0.4f);
  part("spring_pants", {0, -0.6f, 0}, {0.22f, 0.3f, 0.18f}, 50'000, pants, 0.2f);
  for (const float side : {-1.0f, 1.0f}) {
    part("spring_boots", {0.13f * side, -0.95f, 0.05f}, {0.1f, 0.14f, 0.18f}, 30'000, boots, 0.2f);
    part("spring_sleeve", {0.34f * side, -0.15f, 0.08f}, {0.1f, 0.32f, 0.1f}, 40'000, jacket, 0.25f);
    generator.model("spring_boots_stitches", [&](Model& m) {
      stitches(m, view.inner({0.13f * side, -0.92f, 0.05f}, {0.11f, 0.15f, 0.19f}), 60'000, seam, 3);
    });
  }
  generator.model("spring_jacket_stitches", [&](Model& m) {
    stitches(m, view.inner({0, -0.15f, 0}, {0.31f, 0.37f, 0.21f}), 235'000, seam, 1);
  });
  generator.model("spring_pants_stitches", [&](Model& m) {
    stitches(m, view.inner({0, -0.6f, 0}, {0.23f, 0.31f, 0.19f}), 150'000, seam, 2);
  });
  generator.model("spring_hair", [&](Model& m) {
    add_hair(m, view.inner({0, 0.52f, -0.09f}, {0.17f, 0.17f, 0.14f}), 0.3f, view.y * -2.5f, 180'000, hair,
             7);
  });
  generator.model("spring_hairband", [&](Model& m) {
    add_ring(m, {view.x * 0.2f, view.y * 0.05f, view.z * 0.2f, view.at(0, 0.56f, -0.02f)}, 8'000, band,
             0.12f);
  });
}

// Returns the height of the ground: hills close by, then a mountain that rises over the whole picture.
float slope(float x, float z) {
  const float away = 4 - z, far = away < 12 ? 0.0f : away - 12;
  return -1.1f + 0.3f * fractal({x * 0.3f, 0, z * 0.3f}, 3) + 0.3f * away + 0.75f * far +
         0.12f * far * fractal({x * 0.02f, 5, z * 0.02f}, 4);
}

void generate(Scene& scene, const LoadOptions& options) {
  Generator generator(scene, options, kTriangles);
  const int32_t grass = generator.color("grass", 0.3f, 0.4f, 0.12f),
                dry = generator.color("dry", 0.55f, 0.45f, 0.2f);
  const int32_t rock = generator.color("rock", 0.45f, 0.47f, 0.42f);
  girl(generator, in_view_upright(scene.camera, 4.6f));
  Random random(28);
  constexpr uint32_t kPatches = 36;
  for (uint32_t k = 0; k < kPatches; ++k)
    generator.model("GEO-Grass_patch", [&](Model& m) {
      const float x = -5.5f + 0.8f * float(k % 8) + random.between(-0.2f, 0.2f),
                  z = 2.6f - 1.3f * float(k / 8);
      add_grass(m, {x - 0.6f, z - 0.8f}, {x + 0.6f, z + 0.8f}, slope, random.between(0.35f, 0.8f), 15'500,
                k % 3 ? grass : dry, k);
    });
  generator.model("mountain", [&](Model& m) {
    add_ground(m, {-700, -930}, {500, 4}, slope, 150'000, rock);
    add_ground(m, {-30, -30}, {25, 4}, slope, generator.rest() - 150'000, grass);
  });
  scene.note =
      "The scene is a procedural figure, grass and mountain with about the original's triangle count (1.9M) "
      "and with its number of models (51).";
}

}  // namespace

Scene build_spring(const LoadOptions& options) {
  Scene scene;
  scene.name = "SPRNG";
  scene.camera = {.eye = {-2.4033604f, -0.2906455f, 5.1551695f},
                  .target = {-2.7052931f, -0.0500029f, 4.2327120f},
                  .field_of_view = 20,
                  .focus_distance = 7};
  options.assets.empty() ? generate(scene, options) : load_folder(scene, options, rules());
  return scene;
}

}  // namespace glint::scenes

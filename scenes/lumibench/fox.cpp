// Builds FOX, a fox's head in thick fur among flowers, against the sky.
// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "scenes/generate/generated.h"
#include "scenes/generate/plants.h"
#include "scenes/import/asset_folder.h"

namespace glint::scenes {
namespace {

constexpr uint64_t kTriangles = 1'600'000;

void head(Generator& generator, const Frame& view, int32_t fur, int32_t dark) {
  const Frame skull = view.inner({0.2f, 0.5f, 0}, {1.05f, 0.95f, 1});
  const Vec3 fall = view.y * -1.0f;
  generator.model("fox_head", [&](Model& m) {
    add_ball(m, skull, 60'000, fur, 0.05f);
    add_ball(m, view.inner({0.15f, 0.15f, 1}, {0.42f, 0.34f, 0.75f}), 30'000, fur, 0.05f);  // the snout
    for (const float side : {-1.0f, 1.0f})
      add_lathe(m,
                {view.x * 0.4f, view.y * 0.75f + view.x * (0.2f * side), view.z * 0.15f,
                 view.at(0.2f + 0.68f * side, 1.75f, -0.1f)},
                std::array<Vec2, 3>{{{-1, 0.8f}, {-0.4f, 1}, {1, 0}}}, 12'000, fur);
    add_hair(m, skull, 0.5f, fall, 560'000, fur, 1);
    add_hair(m, view.inner({0.15f, 0.15f, 1}, {0.4f, 0.32f, 0.7f}), 0.14f, fall, 120'000, fur, 2);
  });
  generator.model("eyes", [&](Model& m) {
    for (const float side : {-1.0f, 1.0f})
      add_ball(m, view.inner({0.2f + 0.45f * side, 0.65f, 0.9f}, {0.13f, 0.13f, 0.1f}), 3'000, dark);
    add_ball(m, view.inner({0.15f, 0.3f, 1.75f}, {0.13f, 0.1f, 0.1f}), 2'000, dark);
  });
  generator.model("whiskers", [&](Model& m) {
    for (int k = 0; k < 14; ++k) {
      const float side = k % 2 ? 1.0f : -1.0f, lift = 0.1f * float(k / 2) - 0.3f;
      add_cable(m, view.at(0.15f + 0.3f * side, 0.1f, 1.3f), view.at(0.15f + 1.5f * side, 0.1f + lift, 1.1f),
                0.05f, 0.006f, 600, dark);
    }
  });
}

void tail(Generator& generator, const Frame& view, int32_t fur, int32_t tip) {
  for (int k = 0; k < 4; ++k)
    generator.model("tail_part", [&](Model& m) {
      const Frame part =
          view.inner({-1.2f + 0.42f * float(k), -1.5f + 0.12f * float(k * k), -0.4f}, {0.32f, 0.3f, 0.3f});
      add_hair(m, part, 0.45f, view.x * -0.5f, 75'000, k ? fur : tip, uint32_t(10 + k));
    });
  for (uint32_t k = 0; k < 2; ++k)
    generator.model("neck_hair", [&](Model& m) {
      add_hair(m, view.inner({-0.3f + float(k), -0.6f, -0.1f}, {0.6f, 0.4f, 0.5f}), 0.55f, view.y * -1.5f,
               60'000, k ? fur : tip, 20 + k);
    });
}

void generate(Scene& scene, const LoadOptions& options) {
  Generator generator(scene, options, kTriangles);
  const Frame view = in_view(scene.camera, 11);
  const int32_t fur = generator.color("fur", 0.8f, 0.36f, 0.1f),
                white = generator.color("white", 0.85f, 0.82f, 0.78f);
  const int32_t dark = generator.color("dark", 0.05f, 0.04f, 0.04f),
                stem = generator.color("stem", 0.2f, 0.42f, 0.15f);
  head(generator, view, fur, dark);
  tail(generator, view, fur, white);
  Random random(13);
  for (uint32_t k = 0; k < 20; ++k)
    generator.model("flower", [&](Model& m) {
      const float x = random.between(-2.8f, 2.8f), z = random.between(0.5f, 2.5f),
                  size = random.between(0.25f, 0.5f);
      add_flower(m, view.inner({x, -2.5f + 0.5f * float(k % 3), z}, {size, size * 2, size}), 4'600, stem,
                 k % 2 ? white : fur, k);
    });
  for (uint32_t k = 0; k < 8; ++k)  // planes of leaves below
    generator.model("growth", [&](Model& m) {
      const uint64_t share = generator.rest() / (8 - k);
      add_bush(m, view.inner({-2.8f + 0.8f * float(k), -2.7f, float(k % 2)}, {0.7f, 0.45f, 0.8f}), share,
               stem, 0.05f, k);
    });
  scene.note =
      "The scene is a procedural fox with fur of thin tubes. It has about the original's triangle count "
      "(1.6M) and number of models (37).";
}

}  // namespace

Scene build_fox(const LoadOptions& options, const std::string& original) {
  Scene scene;
  scene.name = "FOX";
  scene.camera = {.eye = {3.8318439f, 2.8577063f, 10.6312695f},
                  .target = {3.3567367f, 3.0268174f, 9.7677450f},
                  .field_of_view = 30,
                  .focus_distance = 7};
  original.empty() ? generate(scene, options) : load_folder(scene, original, options, {});
  return scene;
}

}  // namespace glint::scenes

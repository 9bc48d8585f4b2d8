// Builds SPRNG: a girl in stitched clothes close to the camera, stones and grass around her, and a mountain
// behind her.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/figures.h"
#include "scenes/generate/generated.h"
#include "scenes/generate/plants.h"
#include "scenes/import/asset_folder.h"

namespace glint::scenes {
namespace {

constexpr uint64_t kTriangles = 1'900'000;

FolderRules rules() {
  return {.skip = "Dirt_grass",
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
  const int32_t skin = generator.material("skin", paint(223, 175, 171)),
                jacket = generator.material("jacket", paint(163, 67, 42)),
                pants = generator.material("pants", paint(92, 74, 101)),
                boots = generator.material("boots", paint(150, 106, 86)),
                hair = generator.material("hair", paint(108, 86, 99)),
                scarf = generator.material("scarf", paint(114, 76, 64)),
                seam = generator.material("seam", paint(92, 64, 51)),
                band = generator.material("band", paint(69, 23, 8));
  const Figure figure{.hands = {{{-0.2f, 0.47f, 0.03f}, {0.27f, 0.56f, 0.14f}}}, .long_hair = true};
  const Frame body = view.inner({0, -1.1f, 0}, {1.72f, 1.72f, 1.72f}, -12);
  const auto part = [&](const char* name, FigurePart kind, uint64_t triangles, int32_t material) {
    generator.model(name, [&](Model& m) {
      add_figure_part(m, body, figure, kind, triangles, material, generator.threads());
    });
  };
  part("spring_body", FigurePart::Skin, 95'000, skin);
  part("spring_eyes", FigurePart::Eyes, 12'000, seam);
  part("spring_hair", FigurePart::Hair, 110'000, hair);
  part("spring_jacket", FigurePart::Top, 240'000, jacket);
  part("spring_pants", FigurePart::Legs, 120'000, pants);
  part("spring_boots", FigurePart::Shoes, 50'000, boots);
  generator.model("spring_scarf", [&](Model& m) {
    add_ring(m, body.inner({0, 0.815f, 0}, {0.085f, 0.03f, 0.075f}), 60'000, scarf, 0.55f);
  });
  generator.model("spring_hairband", [&](Model& m) {
    Frame ring = body.inner({0, 0.972f, -0.004f}, {0.069f, 0.007f, 0.077f});
    add_ring(m, ring, 12'000, band, 0.06f);
  });
  generator.model("spring_jacket_stitches", [&](Model& m) {
    stitches(m, body.inner({0, 0.66f, 0}, {0.12f, 0.14f, 0.08f}), 60'000, seam, 1);
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
                dry = generator.color("dry", 0.55f, 0.45f, 0.2f),
                stone = generator.color("stone", 0.42f, 0.4f, 0.36f),
                rock = generator.color("rock", 0.45f, 0.47f, 0.42f);
  girl(generator, in_view_upright(scene.camera, 4.6f));
  Random random(28);
  for (uint32_t k = 0; k < 30; ++k)
    generator.model("GEO-Rock", [&](Model& m) {
      const float x = -7.5f + 1.4f * float(k % 6) + random.between(-0.4f, 0.4f),
                  z = 1.6f - 2.2f * float(k / 6) + random.between(-0.6f, 0.6f),
                  size = random.between(0.12f, 0.34f);
      add_ball(m, upright({x, slope(x, z) + 0.3f * size, z}, {size * 1.3f, size, size}, float(k) * 41),
               14'000, stone, 0.35f, 1.2f);
    });
  for (uint32_t k = 0; k < 10; ++k)
    generator.model("GEO-Grass_patch", [&](Model& m) {
      const float x = -6.6f + 0.62f * float(k) + random.between(-0.2f, 0.2f), z = 1.9f - 0.35f * float(k % 3);
      add_grass(m, {x - 0.1f, z - 0.1f}, {x + 0.1f, z + 0.1f}, slope, random.between(0.2f, 0.45f), 3'000,
                k % 3 ? grass : dry, k);
    });
  generator.model("mountain", [&](Model& m) {
    add_ground(m, {-700, -930}, {500, -8}, slope, 300'000, rock);
  });
  generator.model("meadow", [&](Model& m) {
    add_ground(m, {-24, -9}, {18, 5}, slope, generator.rest(), grass);
  });
  scene.note =
      "The scene is a procedural figure, stones, grass and mountain with about the original's triangle count "
      "(1.9M) and with its number of models (51).";
}

}  // namespace

Scene build_spring(const LoadOptions& options, const std::string& original) {
  Scene scene;
  scene.name = "SPRNG";
  scene.camera = {.eye = {-2.4033604f, -0.2906455f, 5.1551695f},
                  .target = {-2.7052931f, -0.0500029f, 4.2327120f},
                  .field_of_view = 20,
                  .focus_distance = 7};
  original.empty() ? generate(scene, options) : load_folder(scene, original, options, rules());
  return scene;
}

}  // namespace glint::scenes

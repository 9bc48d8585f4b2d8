// Builds LANDS, white cliffs and sailing boats on reflecting water that fills the view, seen from above.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "scenes/generate/generated.h"
#include "scenes/generate/plants.h"
#include "scenes/import/asset_folder.h"

namespace glint::scenes {
namespace {

constexpr uint64_t kTriangles = 3'300'000;
constexpr float kWater = -4.5f;

FolderRules rules() {
  return {.colors = {{{"boat"}, paint(150, 111, 51)},
                     {{"water"}, metallic(18.0f / 256, 109.0f / 256, 105.0f / 256, 0.6f)},
                     {{"Landscape"}, paint(250, 250, 245)}}};
}

// Adds a hull of planks with ribs, decks and rails.
void boat(Model& model, const Frame& f, int32_t wood) {
  constexpr int kPlanks = 24;
  const auto hull = [&](float u, float down) {
    const float along = 2 * u - 1,
                beam = (1 - along * along * along * along) * (0.35f + 0.65f * std::sqrt(down));
    return Vec3{along, -0.3f + 0.9f * down + 0.25f * along * along, 0.28f * beam};
  };
  for (const float side : {-1.0f, 1.0f})
    for (int k = 0; k < kPlanks; ++k) {
      const float v0 = float(k) / kPlanks, v1 = (float(k) + 0.9f) / kPlanks;
      add_patch(model, 6'000, 6, wood, [&](float u, float v) {
        Vec3 p = hull(u, v0 + (v1 - v0) * v);
        p[2] = side * (p[2] + 0.012f * v * (1 - v) * 4);
        return f.at(p);
      });
    }
  for (int k = 0; k < 30; ++k) {  // deck
    const float z = -0.26f + 0.018f * float(k);
    add_rounded_box(model, f.inner({0, 0.45f, z}, {0.75f, 0.01f, 0.0085f}), 1'200, wood, 0.4f);
  }
  for (int k = 0; k < 40; ++k) {  // rail posts
    const float along = -0.9f + 1.8f * float(k / 2) / 19;
    const Vec3 p = hull(0.5f + 0.5f * along, 1);
    add_cable(model, f.at({p[0], p[1], p[2] * (k % 2 ? 1.0f : -1.0f)}),
              f.at({p[0], p[1] + 0.15f, p[2] * (k % 2 ? 1.0f : -1.0f)}), 0, 0.01f, 400, wood);
  }
  add_cable(model, f.at(0.1f, 0.4f, 0), f.at(0.1f, 2.9f, 0), 0, 0.03f, 4'000, wood);
  add_cable(model, f.at(0.7f, 0.6f, 0), f.at(1.5f, 1, 0), 0, 0.02f, 2'000, wood);
}

void fleet(Generator& generator, const Scene& scene) {
  const int32_t wood = generator.material("wood", paint(150, 111, 51)),
                sail = generator.color("sail", 0.8f, 0.76f, 0.65f);
  const int32_t rope = generator.color("rope", 0.4f, 0.33f, 0.2f);
  const Frame view = in_view_upright(scene.camera, 0);
  for (uint32_t k = 0; k < 4; ++k) {
    const float depth = 7.5f + 2.3f * float(k), x = k % 2 ? 0.9f + 0.3f * float(k) : -1.1f;
    Vec3 place = view.at(x, 0, -depth);
    place[1] = kWater;
    const Frame f = upright(place, {1.05f, 0.9f, 1}, 50 + 35 * float(k));
    generator.model("boat", [&](Model& m) { boat(m, f, wood); });
    for (const float mast : {0.0f, 0.6f})
      generator.model("ship_sail", [&](Model& m) {
        add_cloth(m,
                  {f.x * (0.35f - 0.1f * mast), f.y * (0.9f - 0.3f * mast), f.z * 0.2f,
                   f.at(0.1f + mast * 0.9f, 1.8f - mast * 0.6f, 0)},
                  5'000, sail, 0.7f, k);
      });
  }
  for (uint32_t k = 0; k < 3; ++k)
    generator.model("rope", [&](Model& m) {
      for (int line = 0; line < 8; ++line) {
        const Vec3 base = view.at(k % 2 ? 1.2f : -1.1f, 0, -7.5f - 2.3f * float(k));
        add_cable(m, {base[0], kWater + 2.5f, base[2]},
                  {base[0] + 0.3f * float(line) - 1.2f, kWater + 0.4f, base[2] + 0.3f}, 0.05f, 0.008f, 500,
                  rope);
      }
    });
}

float waves(float x, float z) {
  return kWater + 0.03f * fractal({x * 1.3f, 2, z * 1.3f}, 3);
}

// Returns the height of terraces of chalk.
float cliffs(float x, float z, float shift) {
  const float h = fractal({x * 0.16f + shift, 0, z * 0.16f}, 5) * 5 + 0.2f;
  const float step = std::floor(h * 1.5f) / 1.5f;
  return kWater - 1.2f + 1.4f * (0.75f * step + 0.25f * h);
}

void generate(Scene& scene, const LoadOptions& options) {
  Generator generator(scene, options, kTriangles);
  const int32_t water = generator.material("water", metallic(18.0f / 256, 109.0f / 256, 105.0f / 256, 0.6f));
  const int32_t chalk = generator.material("chalk", paint(250, 250, 245)),
                foam = generator.color("foam", 0.8f, 0.8f, 0.8f);
  fleet(generator, scene);
  generator.model("water", [&](Model& m) { add_ground(m, {-60, -25}, {8, 45}, waves, 60'000, water); });
  for (uint32_t k = 0; k < 3; ++k)
    generator.model("ship_wake", [&](Model& m) {
      add_ground(
          m, {-8 - 2.2f * float(k), 11 + float(k)}, {-7 - 2.2f * float(k), 13 + float(k)},
          [](float x, float z) {
            return waves(x, z) + 0.02f * fractal({x * 4, 0, z * 4}, 2);
          },
          2'000, foam);
    });
  for (uint32_t k = 0; k < 4; ++k)
    generator.model("mast_top", [&](Model& m) {
      add_ball(m, upright({-6 - 3 * float(k), kWater + 3, 11 + 1.5f * float(k)}, {0.05f, 0.05f, 0.05f}),
               1'500, foam);
    });
  for (uint32_t k = 0; k < 3; ++k) {
    const uint64_t share = generator.rest() / (3 - k);
    generator.model("Landscape", [&](Model& m) {
      const float x = -12 - 12 * float(k);
      add_ground(
          m, {x - 13, -20}, {x, 42}, [k](float a, float b) { return cliffs(a, b, 7 * float(k)); }, share,
          chalk);
    });
  }
  scene.note =
      "The scene is procedural cliffs, water and boats with about the original's triangle count (3.3M) and "
      "number of models (26).";
}

}  // namespace

Scene build_lands(const LoadOptions& options, const std::string& original) {
  Scene scene;
  scene.name = "LANDS";
  scene.camera = {.eye = {1.5133433f, -0.9918727f, 13.2851229f},
                  .target = {0.5776852f, -1.3168955f, 13.1476310f},
                  .field_of_view = 25,
                  .focus_distance = 7};
  original.empty() ? generate(scene, options) : load_folder(scene, original, options, rules());
  return scene;
}

}  // namespace glint::scenes

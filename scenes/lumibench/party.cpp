// Builds PARTY, a harbour town with boats, boxes, meters and cables: hundreds of structures of few triangles.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "scenes/generate/generated.h"
#include "scenes/generate/solids.h"
#include "scenes/import/asset_folder.h"

namespace glint::scenes {
namespace {

constexpr uint64_t kTriangles = 1'700'000;

FolderRules rules() {
  return {.folders = {"Scenes/Blender_2.83", "assets/Scenes/Blender_2.83", "PARTY"}};
}

struct Palette {
  std::vector<int32_t> colors;
  int32_t operator[](uint32_t k) const { return colors[k % colors.size()]; }
};

// Adds a house front with windows, sills and pipes. `f` is its block, in which y goes from -1 at the foot to
// 1.
void add_house(Model& model, const Frame& f, const Palette& palette, uint32_t seed) {
  Random random(seed);
  add_rounded_box(model, f, 1'200, palette[seed], 0.02f);
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 4; ++column) {
      const Frame window =
          f.inner({-0.72f + 0.48f * float(column), -0.75f + 0.4f * float(row), 1}, {0.15f, 0.13f, 0.05f});
      add_rounded_box(model, window, 150, palette[seed + 3], 0.1f);
      add_rounded_box(model, window.inner({0, -1.1f, 0.8f}, {1.2f, 0.12f, 1.4f}), 100, palette[seed + 1],
                      0.3f);
    }
  for (int pipe = 0; pipe < 3; ++pipe) {
    const float x = random.between(-0.95f, 0.95f);
    add_cable(model, f.at(x, -1, 1.03f), f.at(x, 1, 1.03f), 0, 0.12f, 400, palette[seed + 2]);
  }
  add_patch(model, 800, 1, palette[seed + 4], [&](float u, float v) {
    return f.at(2.2f * u - 1.1f, 1 + 0.25f * (v < 0.5f ? v : 1 - v), 2.2f * v - 1.1f);
  });
}

void add_boat(Model& model, const Frame& f, const Palette& palette, uint32_t seed) {
  add_patch(model, 2'500, 2, palette[seed], [&](float u, float v) {
    const float along = 2 * u - 1, across = 2 * v - 1, beam = 1 - along * along * along * along;
    return f.at(along, 0.9f * across * across * beam - 0.9f * beam, across * beam * 0.4f);
  });
  add_machine(model, f.inner({0.1f, 0.4f, 0}, {0.4f, 0.6f, 0.25f}), 3'500, palette.colors, seed);
  add_cable(model, f.at(0.2f, 0, 0), f.at(0.2f, 3.2f, 0), 0, 0.05f, 300, palette[seed + 1]);
}

// Adds houses and boats. `town` has x to the right, y up and z towards the camera; its origin is on the
// ground below the camera.
void houses_and_boats(Generator& generator, const Frame& town, const Palette& palette, Random& random) {
  for (uint32_t k = 0; k < 40; ++k)
    generator.model("House", [&](Model& m) {
      const float row = float(k / 8), depth = 70 + 16 * row,
                  x = (float(k % 8) - 3.5f) * (5 + row) + random.between(-1, 1);
      const float height = random.between(5, 8) + 0.8f * row;
      add_house(m, town.inner({x, height - 1, -depth}, {3 + 0.5f * row, height, 4}, random.between(-12, 12)),
                palette, k);
    });
  for (uint32_t k = 0; k < 24; ++k)
    generator.model("boatback", [&](Model& m) {
      const float depth = 30 + 2 * float(k), x = (k % 2 ? 0.085f : -0.1f) * depth + random.between(-1, 1);
      add_boat(m, town.inner({x, -3.4f, -depth}, {2.4f, 1, 2.4f}, random.between(20, 70)), palette, k);
    });
}

void small_things(Generator& generator, const Frame& town, const Palette& palette, Random& random) {
  const auto place = [&](float low, float high) -> Vec3 {
    const float depth = random.between(low, high), across = random.between(-0.14f, 0.14f);
    return {across * depth, -3, -depth};
  };
  for (uint32_t k = 0; k < 80; ++k)
    generator.model("boxes", [&](Model& m) {
      const float size = random.between(0.35f, 0.8f), stack = float(random.below(3));
      add_machine(
          m,
          town.inner(place(28, 68) + Vec3{0, size * (1 + 2 * stack), 0}, {size, size, size}, float(k) * 37),
          5'500, palette.colors, k);
    });
  for (uint32_t k = 0; k < 60; ++k)
    generator.model("Power_Meter", [&](Model& m) {
      const float depth = 64 + float(k % 6) * 0.2f, x = (float(k % 20) - 9.5f) * 0.95f,
                  y = 1.5f + 3.5f * float(k / 20);
      add_machine(m, town.inner({x, y, -depth}, {0.4f, 0.6f, 0.25f}), 3'000, palette.colors, 100 + k);
    });
  for (uint32_t k = 0; k < 50; ++k)
    generator.model("Cylinder", [&](Model& m) {
      static constexpr Vec2 kBarrel[] = {{-1, 0}, {-1, 0.9f}, {-0.4f, 1}, {0.4f, 1}, {1, 0.9f}, {1, 0}};
      add_lathe(m, town.inner(place(25, 60) + Vec3{0, 0.6f, 0}, {0.4f, 0.6f, 0.4f}), kBarrel, 2'400,
                palette[k]);
    });
  for (uint32_t k = 0; k < 40; ++k)
    generator.model("BezierCurve", [&](Model& m) {
      const float depth = random.between(35, 90), y = random.between(5, 14);
      add_cable(m, town.at(-0.2f * depth, y, -depth),
                town.at(0.2f * depth, y + random.between(-2, 2), -depth - 5), 2, 0.04f, 3'000, palette[k]);
    });
  for (uint32_t k = 0; k < 23; ++k)
    generator.model("Armature", [&](Model& m) {
      const Vec3 feet = place(22, 55);
      add_ball(m, town.inner(feet + Vec3{0, 0.9f, 0}, {0.3f, 0.9f, 0.25f}), 5'000, palette[k], 0.2f);
      add_ball(m, town.inner(feet + Vec3{0, 2, 0}, {0.18f, 0.22f, 0.2f}), 2'500, palette[k + 2], 0.1f);
    });
}

void generate(Scene& scene, const LoadOptions& options) {
  Generator generator(scene, options, kTriangles);
  Random random(283);
  Palette palette;
  for (int k = 0; k < 14; ++k) {
    const float r = random.between(0.15f, 0.85f), g = random.between(0.12f, 0.7f),
                b = random.between(0.1f, 0.6f);
    palette.colors.push_back(generator.color(fmt::format("paint_{}", k), r, g, b));
  }
  const int32_t water = generator.color("water", 0.1f, 0.2f, 0.25f),
                plank = generator.color("plank", 0.4f, 0.28f, 0.18f),
                steam = generator.color("steam", 0.8f, 0.8f, 0.8f);
  const Frame town = in_view_upright(scene.camera, 0);
  houses_and_boats(generator, town, palette, random);
  small_things(generator, town, palette, random);
  generator.model("Pier", [&](Model& m) {
    for (int k = 0; k < 160; ++k)
      add_rounded_box(m, town.inner({0, -3.2f, -20 - 0.3f * float(k)}, {4, 0.1f, 0.14f}), 200, plank, 0.2f);
  });
  generator.model("The_Water", [&](Model& m) {
    add_patch(m, 150'000, 1, water, [&](float u, float v) {
      const float x = 260 * u - 130, z = -260 * v;
      return town.at(x, -5 + 0.15f * fractal({x * 0.4f, 0, z * 0.4f}, 3), z);
    });
  });
  generator.model("Low_Drift_Complex_Steam", [&](Model& m) {
    add_ball(m, town.inner({12, 16, -110}, {10, 9, 8}), generator.rest(), steam, 0.5f, 2.5f);
  });
  scene.note =
      "The scene is a procedural harbour with about the original's triangle count (1.7M) and with its number "
      "of models (320).";
}

}  // namespace

Scene build_party(const LoadOptions& options) {
  Scene scene;
  scene.name = "PARTY";
  scene.camera = {.eye = {-63.8803749f, 4.6838064f, 59.8617097f},
                  .target = {-63.1351023f, 4.7005949f, 59.1951612f},
                  .field_of_view = 20,
                  .focus_distance = 7};
  options.assets.empty() ? generate(scene, options) : load_folder(scene, options, rules());
  return scene;
}

}  // namespace glint::scenes

// Builds ROBOT, a machine of plates, pistons and cables close to the camera, with the most triangles of all.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/generated.h"
#include "scenes/generate/solids.h"
#include "scenes/import/asset_folder.h"

namespace glint::scenes {
namespace {

constexpr uint64_t kTriangles = 20'600'000;

void head(Generator& generator, const Frame& robot, std::span<const int32_t> paint) {
  generator.model("Skull", [&](Model& m) {
    add_rounded_box(m, robot.inner({0, 0.06f, 0}, {0.11f, 0.12f, 0.12f}), 500'000, paint[0], 0.7f);
  });
  generator.model("Jaw", [&](Model& m) {
    add_machine(m, robot.inner({0, -0.07f, 0.05f}, {0.08f, 0.05f, 0.09f}), 300'000, paint, 1);
  });
  for (const float side : {-1.0f, 1.0f}) {
    generator.model("Eye", [&](Model& m) {
      add_ball(m, robot.inner({0.05f * side, 0.07f, 0.11f}, {0.025f, 0.025f, 0.025f}), 60'000, paint[3]);
    });
    generator.model("Socket", [&](Model& m) {
      add_ring(m, {robot.x * 0.04f, robot.z * 0.015f, robot.y * 0.04f, robot.at(0.05f * side, 0.07f, 0.115f)},
               90'000, paint[1], 0.3f);
    });
    generator.model("Ear", [&](Model& m) {
      add_machine(m, robot.inner({0.12f * side, 0.06f, 0}, {0.03f, 0.06f, 0.06f}), 250'000, paint, 2);
    });
  }
}

void torso(Generator& generator, const Frame& robot, std::span<const int32_t> paint) {
  Random random(278);
  for (uint32_t k = 0; k < 90; ++k)
    generator.model("Part", [&](Model& m) {
      const float x = random.between(-0.36f, 0.36f),
                  y = -0.24f - random.between(0, 0.3f) - 0.25f * (x < 0 ? -x : x),
                  z = random.between(-0.15f, 0.15f);
      const float size = random.between(0.03f, 0.08f);
      add_machine(m, robot.inner({x, y, z}, {size, size, size}, random.between(0, 90)), 110'000, paint,
                  10 + k);
    });
  for (uint32_t k = 0; k < 50; ++k)
    generator.model("Plate", [&](Model& m) {
      const float x = (float(k % 10) - 4.5f) * 0.075f,
                  y = -0.28f - 0.05f * float(k / 10) - 0.2f * (x < 0 ? -x : x);
      add_rounded_box(m, robot.inner({x, y, 0.17f - 0.3f * x * x}, {0.034f, 0.022f, 0.012f}, -60 * x), 40'000,
                      paint[k % 3], 0.4f);
    });
}

void cables(Generator& generator, const Frame& robot, std::span<const int32_t> paint) {
  Random random(87);
  for (uint32_t k = 0; k < 60; ++k)
    generator.model("Cable", [&](Model& m) {
      for (int strand = 0; strand < 12; ++strand) {
        const float x = random.between(-0.08f, 0.08f), z = random.between(-0.09f, 0.06f),
                    out = random.between(1.5f, 3.5f);
        add_cable(m, robot.at(x, -0.08f, z), robot.at(x * out, -0.34f, z * 1.4f),
                  random.between(0.01f, 0.06f), 0.0022f, 5'000, paint[uint32_t(strand) % paint.size()]);
      }
    });
  for (uint32_t k = 0; k < 38; ++k)
    generator.model("Bolt", [&](Model& m) {
      static constexpr Vec2 kBolt[] = {{-1, 0}, {-1, 1}, {0.4f, 1}, {0.5f, 0.6f}, {1, 0.6f}, {1, 0}};
      const double angle = 6.283185307 * k / 38;
      add_lathe(m, robot.inner({0.1f * cosine(angle), 0.17f, 0.1f * sine(angle)}, {0.006f, 0.012f, 0.006f}),
                kBolt, 8'000, paint[2]);
    });
}

void generate(Scene& scene, const LoadOptions& options) {
  Generator generator(scene, options, kTriangles);
  const int32_t paint[] = {
      generator.color("shell", 0.65f, 0.62f, 0.55f), generator.color("steel", 0.25f, 0.26f, 0.28f),
      generator.color("copper", 0.6f, 0.3f, 0.1f), generator.color("panel", 0.1f, 0.25f, 0.35f),
      generator.color("rubber", 0.05f, 0.05f, 0.05f)};
  const Frame robot = in_view_upright(scene.camera, 1.05f).inner({0.02f, 0.07f, 0}, {1, 1, 1}, 20);
  head(generator, robot, paint);
  torso(generator, robot, paint);
  cables(generator, robot, paint);
  generator.model("Hose", [&](Model& m) {
    for (int k = 0; k < 24; ++k) {
      const float x = -0.3f + 0.025f * float(k);
      add_cable(m, robot.at(x, -0.3f, -0.2f), robot.at(-x, -0.25f, -0.3f), 0.1f, 0.006f,
                generator.rest() / 48, paint[4]);
    }
    add_ball(m, robot.inner({0, -0.75f, -0.05f}, {0.5f, 0.42f, 0.2f}), generator.rest() / 2, paint[1], 0.15f,
             6);
  });
  generator.model("Floor", [&](Model& m) { add_quad(m, {-4, -1.26f, 4}, {8, 0, 0}, {0, 0, -8}, paint[0]); });
  scene.note =
      "The scene is a procedural machine with about the original's triangle count (20.6M) and with its "
      "number of models (248).";
}

}  // namespace

Scene build_robot(const LoadOptions& options, const std::string& original) {
  Scene scene;
  scene.name = "ROBOT";
  scene.camera = {.eye = {-0.3502433f, 1.1617968f, 1.0811127f},
                  .target = {-0.0603990f, 1.5020394f, 0.1865597f},
                  .field_of_view = 30,
                  .focus_distance = 7};
  original.empty() ? generate(scene, options) : load_folder(scene, original, options, {});
  return scene;
}

}  // namespace glint::scenes

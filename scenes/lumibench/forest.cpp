// Builds FRST, an autumn forest of hundreds of trees, bushes and flowers, each a structure of its own.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/generated.h"
#include "scenes/generate/plants.h"
#include "scenes/import/asset_folder.h"

namespace glint::scenes {
namespace {

constexpr uint64_t kTriangles = 4'200'000;

// Returns the colour of a bush: one of three, in shares of 30, 30 and 40 %.
Material bush_color(float draw) {
  return draw < 0.3f ? paint(175, 195, 62) : draw < 0.6f ? paint(224, 70, 45) : paint(236, 186, 85);
}

FolderRules rules(Random& draws) {
  return {.colors = {{{"Character2_Shirt"}, paint(156, 74, 61)},
                     {{"Character_Hair"}, paint(119, 74, 55)},
                     {{"Character_Pants"}, paint(131, 115, 160)},
                     {{"Character_hair_2"}, paint(121, 74, 56)},
                     {{"Character_watch"}, paint(163, 73, 78)},
                     {{"Character"}, paint(223, 187, 161)},
                     {{"backpackStraps"}, paint(104, 66, 64)},
                     {{"BackPackDec"}, paint(108, 191, 210)},
                     {{"BackPack"}, paint(97, 85, 85)},
                     {{"MidGround"}, paint(232, 189, 26)},
                     {{"FlowerParticles"}, paint(212, 207, 207)},
                     {{"Mesh"}, paint(142, 85, 47)}},
          .recolor = [&draws](const std::string& name, std::span<Material> materials) {
            if (name.find("ForeGround_terrain") != std::string::npos)
              for (size_t k = 0; k < materials.size() && k < 3; ++k)
                materials[k] = k < 2 ? paint(212, 207, 207) : paint(220, 139, 27);
            if (name.find("bush") == std::string::npos) return;
            const Material color = bush_color(draws.next());
            for (Material& material : materials) material = color;
          }};
}

float ground(float x, float z) {
  const float away = 60 - z;
  const float rise = away > 60 ? 0.06f * (away - 60) : 0.0f;
  return -1.5f + 1.6f * fractal({x * 0.04f, 0, z * 0.04f}, 3) +
         rise * (1 + fractal({x * 0.01f, 3, z * 0.01f}, 3));
}

void hiker(Generator& generator, const Vec3& feet) {
  const auto part = [&](const char* name, const Vec3& at, const Vec3& size, uint64_t triangles,
                        const Material& material) {
    const int32_t index = generator.material(name, material);
    generator.model(name,
                    [&](Model& m) { add_ball(m, upright(feet + at, size), triangles, index, 0.15f, 2); });
  };
  part("Character", {0, 1.62f, 0}, {0.12f, 0.15f, 0.13f}, 19'000, paint(223, 187, 161));
  part("Character2_Shirt", {0, 1.2f, 0}, {0.25f, 0.32f, 0.16f}, 8'700, paint(156, 74, 61));
  part("Character_Pants", {0, 0.55f, 0}, {0.2f, 0.55f, 0.15f}, 8'000, paint(131, 115, 160));
  part("Character_Sneakers", {0, 0.06f, 0.05f}, {0.2f, 0.08f, 0.16f}, 8'000, paint(200, 200, 200));
  part("Character_Hair", {0, 1.7f, 0.02f}, {0.14f, 0.14f, 0.14f}, 17'000, paint(119, 74, 55));
  part("BackPack", {0, 1.25f, 0.25f}, {0.22f, 0.3f, 0.14f}, 6'000, paint(97, 85, 85));
}

void plants(Generator& generator, Random& random) {
  const int32_t bark = generator.material("bark", paint(142, 85, 47)),
                leaves[] = {generator.material("young_leaves", bush_color(0)),
                            generator.material("leaves", bush_color(0.5f)),
                            generator.material("old_leaves", bush_color(1))};
  const int32_t petals = generator.material("petals", paint(212, 207, 207));
  for (uint32_t k = 0; k < 86; ++k)
    generator.model("Mesh", [&](Model& m) {
      const float depth = 24 + 1.5f * float(k), side = k % 2 ? 1.0f : -1.0f;
      const float x = -26 + (0.08f + side * random.between(0.08f, 0.45f)) * depth, z = 62 - depth;
      add_tree(m, m,
               {.foot = {x, ground(x, z) - 0.2f, z},
                .height = random.between(5, 9),
                .spread = 0.5f,
                .leaf = 0.05f,
                .wood = 0.45f,
                .bark = bark,
                .leaves = leaves[k % 3],
                .seed = k},
               23'000);
    });
  for (uint32_t k = 0; k < 139; ++k)
    generator.model("bush", [&](Model& m) {
      const float depth = 12 + 0.8f * float(k), side = k % 2 ? 1.0f : -1.0f, z = 62 - depth;
      const float x = -26 + (0.08f + side * random.between(0.03f, 0.4f)) * depth,
                  size = random.between(0.4f, 1);
      add_bush(m, upright({x, ground(x, z) + 0.5f * size, z}, {size, size * 0.9f, size}), 7'400,
               generator.material("bush", bush_color(random.next())), 0.16f, k);
    });
  for (uint32_t k = 0; k < 15; ++k)
    generator.model("FlowerParticles", [&](Model& m) {
      for (int flower = 0; flower < 12; ++flower) {
        const float x = -26.5f + random.between(-1.5f, 1.5f), z = random.between(53, 58);
        add_flower(m, upright({x, ground(x, z) + 0.2f, z}, {0.08f, 0.2f, 0.08f}), 600, bark, petals, k);
      }
    });
}

void generate(Scene& scene, const LoadOptions& options) {
  Generator generator(scene, options, kTriangles);
  Random random(291);
  plants(generator, random);
  hiker(generator, {-25.2f, ground(-25.2f, 52), 52});
  const int32_t cloud = generator.color("cloud", 0.8f, 0.8f, 0.8f),
                far = generator.material("far_hills", paint(232, 189, 26)),
                near = generator.material("near_hills", paint(220, 139, 27));
  for (uint32_t k = 0; k < 33; ++k)
    generator.model("CLOUDS", [&](Model& m) {
      const float x = -330 + 28 * float(k) + random.between(-10, 10), y = random.between(120, 230),
                  size = random.between(14, 34);
      add_ball(m, upright({x, y, -500 - 15 * float(k % 5)}, {size * 1.8f, size * 0.5f, size}), 9'000, cloud,
               0.5f, 2.2f);
    });
  generator.model("BackGround_terrain", [&](Model& m) {
    add_ground(
        m, {-400, -1100}, {700, -150},
        [](float x, float z) {
          return ground(x, z) + 25 * fractal({x * 0.006f, 9, z * 0.006f}, 4);
        },
        60'000, far);
  });
  for (uint32_t k = 0; k < 2; ++k)
    generator.model("MidGround_terrain", [&](Model& m) {
      add_ground(m, {k ? -26.0f : -160.0f, -150}, {k ? 120.0f : -26.0f, 10}, ground, 90'000, far);
    });
  generator.model("ForeGround_terrain", [&](Model& m) {
    add_ground(m, {-70, 10}, {20, 66}, ground, generator.rest(), near);
  });
  scene.note =
      "The scene is a procedural autumn forest with about the original's triangle count (4.2M) and with its "
      "number of models (283).";
}

}  // namespace

Scene build_forest(const LoadOptions& options, const std::string& original) {
  Scene scene;
  scene.name = "FRST";
  scene.camera = {.eye = {-25.9074593f, 2.5445480f, 61.7620773f},
                  .target = {-25.8289890f, 2.5999173f, 60.7666997f},
                  .field_of_view = 30,
                  .focus_distance = 7};
  Random draws(42);  // the application's generator, with one draw per bush
  original.empty() ? generate(scene, options) : load_folder(scene, original, options, rules(draws));
  return scene;
}

}  // namespace glint::scenes

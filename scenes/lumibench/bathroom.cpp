// Builds BATH, a bathroom with a mirror, a tub and lamps, which is open only behind the camera.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/generated.h"
#include "scenes/generate/plants.h"
#include "scenes/import/asset_folder.h"

namespace glint::scenes {
namespace {

constexpr uint64_t kTriangles = 423'821;

bool contains(const std::string& name, const char* part) {
  return name.find(part) != std::string::npos;
}

// Sets what the application overrides material by material.
void recolor(const std::string& name, std::span<Material> materials) {
  const auto set = [&](size_t index, const Material& material) {
    if (index < materials.size()) materials[index] = material;
  };
  const Material chrome = metallic(0.73f, 0.73f, 0.73f, 0);
  if (name == "sol") {
    set(0, diffuse_light(15, 15, 15));
    set(1, paint(44, 26, 12));
    set(2, chrome);
    set(4, paint(226, 243, 227));
    set(5, paint(196, 137, 88));
  }
  if (contains(name, "prise")) {
    set(0, paint(164, 150, 134));
    set(1, paint(34, 22, 13));
  }
  if (contains(name, "poubelle")) {
    set(0, chrome);
    set(1, paint(14, 5, 4));
  }
  if (contains(name, "pese_personne")) set(1, paint(14, 5, 4));
  if (contains(name, "bouteille")) set(2, paint(93, 77, 62));
}

FolderRules rules() {
  return {.colors = {{{"Meuble", "meuble", "baignoire"}, paint(196, 137, 88)},
                     {{"statu"}, paint(14, 6, 3)},
                     {{"robinet", "etend_serviette"}, metallic(0.73f, 0.73f, 0.73f, 0)},
                     {{"emit_haut"}, diffuse_light(15, 15, 15)}},
          .recolor = recolor};
}

// These are the bounds of the original's room: x -17 to 17, y 0 to 33.6, z -23 to 22.5, without a wall
// towards the camera.
constexpr float kX = 17, kY = 33.6f, kBack = -23, kFront = 22.5f;

void room(Model& model, int32_t wood, int32_t light, int32_t mirror, int32_t wall) {
  const float deep = kFront - kBack;
  for (int row = 0; row < 40; ++row)  // floor boards
    for (int board = 0; board < 4; ++board)
      add_rounded_box(model,
                      {{4.25f, 0, 0},
                       {0, 0.1f, 0},
                       {0, 0, deep / 80},
                       {-12.75f + 8.5f * float(board), -0.1f, kBack + deep * (float(row) + 0.5f) / 40}},
                      150, wood, 0.1f);
  // A quad lies below the boards, because their corners are round.
  add_quad(model, {-kX, -0.1f, kBack}, {0, 0, deep}, {2 * kX, 0, 0}, wood);
  add_patch(model, 3000, 1, wall, [=](float u, float v) -> Vec3 {
    return {kX * (2 * u - 1), kY * v, kBack};
  });
  add_patch(model, 3000, 1, wall, [=](float u, float v) -> Vec3 { return {-kX, kY * v, kFront - deep * u}; });
  add_patch(model, 3000, 1, wall, [=](float u, float v) -> Vec3 { return {kX, kY * v, kBack + deep * u}; });
  add_patch(model, 3000, 1, wall, [=](float u, float v) -> Vec3 {
    return {kX * (2 * u - 1), kY, kBack + deep * v};
  });
  add_quad(model, {-kX + 0.05f, 12, 8}, {0, 0, -16}, {0, 14, 0}, light);     // window
  add_quad(model, {-8, 14, kBack + 0.05f}, {20, 0, 0}, {0, 11, 0}, mirror);  // mirror
}

void furniture(Generator& generator, int32_t wood, int32_t white, int32_t chrome) {
  static constexpr Vec2 kBasin[] = {{-1, 0}, {-1, 0.5f}, {1, 1}, {0.9f, 0.92f}, {-0.6f, 0.4f}, {-0.7f, 0}};
  generator.model("bathtub", [&](Model& m) {
    add_lathe(m, upright({-10.5f, 3.6f, 3}, {5.5f, 3.4f, 11}), kBasin, 64'000, white);
  });
  generator.model("cabinet", [&](Model& m) {
    add_rounded_box(m, upright({3, 4, -19}, {10, 4, 3.6f}), 14'000, wood, 0.05f);
  });
  generator.model("cabinet_top", [&](Model& m) {
    add_rounded_box(m, upright({3, 8.4f, -19}, {10.4f, 0.4f, 4}), 6'000, wood, 0.3f);
  });
  for (const float x : {-2.0f, 8.0f}) {
    generator.model("basin", [&](Model& m) {
      add_lathe(m, upright({x, 10, -18.6f}, {3, 1.3f, 2.6f}), kBasin, 16'000, white);
    });
    generator.model("tap", [&](Model& m) {
      add_ring(m, {{0, 1.6f, 0}, {0.3f, 0, 0}, {0, 0, 1.6f}, {x, 11, -21}}, 9'000, chrome, 0.15f);
    });
    generator.model("tap_foot", [&](Model& m) {
      add_rounded_box(m, upright({x, 10, -21.8f}, {0.5f, 1.4f, 0.5f}), 4'000, chrome, 0.5f);
    });
    generator.model("lamp_arm", [&](Model& m) {
      add_cable(m, {x, 27, kBack}, {x, 27, kBack + 2.5f}, 0.6f, 0.15f, 5'000, chrome);
    });
    generator.model("lamp_ball", [&](Model& m) {
      add_ball(m, upright({x, 27.4f, kBack + 2.6f}, {1, 1, 1}), 7'000, white);
    });
  }
  generator.model("rail", [&](Model& m) {
    add_cable(m, {16, 14, -12}, {16, 14, 4}, 0, 0.2f, 6'000, chrome);
  });
  generator.model("bin", [&](Model& m) {
    add_lathe(m, upright({13.5f, 2, -17}, {1.6f, 2, 1.6f}), kBasin, 9'000, chrome);
  });
  generator.model("scale", [&](Model& m) {
    add_rounded_box(m, upright({5, 0.3f, -8}, {2, 0.3f, 2}, 20), 5'000, chrome, 0.4f);
  });
}

void small_things(Generator& generator, int32_t dark, int32_t chrome, int32_t light, int32_t socket) {
  const int32_t towel = generator.color("towel", 0.75f, 0.35f, 0.25f),
                glass = generator.color("glass", 0.36f, 0.3f, 0.24f);
  for (uint32_t k = 0; k < 5; ++k) {
    const bool hangs = k < 3;
    const Vec3 place = hangs ? Vec3{15.8f, 11, -10 + 5 * float(k)} : Vec3{-2 + 7 * float(k - 3), 0.3f, -11};
    generator.model("towel", [&](Model& m) {
      add_cloth(m,
                hangs ? Frame{{0, 0, 2}, {0, 3, 0}, {0.5f, 0, 0}, place}
                      : Frame{{3, 0, 0}, {0, 0, 2}, {0, 0.25f, 0}, place},
                14'000, towel, 4, k);
    });
  }
  for (uint32_t k = 0; k < 7; ++k)
    generator.model("bottle", [&](Model& m) {
      static constexpr Vec2 kBottle[] = {{-1, 0}, {-1, 0.9f}, {0.2f, 1}, {0.5f, 0.4f}, {0.9f, 0.4f}, {1, 0}};
      add_lathe(m, upright({1 + 0.95f * float(k), 9.6f, -17.4f - 0.4f * float(k % 2)}, {0.35f, 0.9f, 0.35f}),
                kBottle, 2'500, k % 2 ? glass : chrome);
    });
  for (uint32_t k = 0; k < 4; ++k)
    generator.model("statue", [&](Model& m) {
      const Vec3 place{k < 2 ? 14.5f : -14.5f, k % 2 ? 3.0f : 6.5f, k < 2 ? -2.0f : -19.0f};
      add_ball(m, upright(place, {1.5f, k % 2 ? 3.0f : 1.4f, 1.5f}), 11'000, dark, 0.45f,
               1.3f + 0.3f * float(k));
    });
  for (uint32_t k = 0; k < 2; ++k)
    generator.model("ceiling_light", [&](Model& m) {
      add_quad(m, {-8 + 11 * float(k), kY - 0.1f, -2}, {5, 0, 0}, {0, 0, 5}, light);
    });
  for (uint32_t k = 0; k < 4; ++k)
    generator.model("picture", [&](Model& m) {
      add_rounded_box(m, {{0, 0, 2}, {0, 2.6f, 0}, {0.2f, 0, 0}, {kX - 0.3f, 20, -16 + 6 * float(k)}}, 2'400,
                      k % 2 ? dark : towel, 0.2f);
    });
  for (uint32_t k = 0; k < 4; ++k)
    generator.model("socket", [&](Model& m) {
      add_rounded_box(m, upright({-9 + 1.4f * float(k), 11, kBack + 0.1f}, {0.5f, 0.5f, 0.12f}), 900, socket,
                      0.3f);
    });
}

void generate(Scene& scene, const LoadOptions& options) {
  Generator generator(scene, options, kTriangles);
  const int32_t wood = generator.material("wood", paint(196, 137, 88)),
                dark = generator.material("dark", paint(14, 6, 3));
  const int32_t wall = generator.material("wall", paint(226, 243, 227)),
                white = generator.color("white", 0.8f, 0.8f, 0.8f);
  const int32_t chrome = generator.material("chrome", metallic(0.73f, 0.73f, 0.73f, 0));
  const int32_t socket = generator.material("socket", paint(164, 150, 134)),
                light = generator.material("light", diffuse_light(15, 15, 15));
  generator.model("room", [&](Model& m) {
    room(m, generator.material("floor", paint(44, 26, 12)), light, chrome, wall);
  });
  furniture(generator, wood, white, chrome);
  small_things(generator, dark, chrome, light, socket);
  for (uint32_t k = 0; k < 3; ++k)
    generator.model("plant", [&](Model& m) {
      add_bush(m,
               upright({-13.5f + 0.6f * float(k), 11 - 3.2f * float(k), -20 + 2.5f * float(k)}, {2, 2.4f, 2}),
               9'000, generator.color("plant", 0.2f, 0.4f, 0.12f), 0.4f, k);
    });
  generator.model("rug", [&](Model& m) {
    const auto flat = [](float, float) { return 0.05f; };
    add_grass(m, {-2, -6}, {9, 5}, flat, 0.5f, generator.rest(), generator.color("rug", 0.7f, 0.65f, 0.5f),
              5);
  });
  scene.note =
      "The scene is a procedural bathroom in the original's room, with its triangle count (423,821) and "
      "number of models (47).";
}

}  // namespace

Scene build_bathroom(const LoadOptions& options, const std::string& original) {
  Scene scene;
  scene.name = "BATH";
  scene.camera = {.eye = {3.2814946f, 20.0356712f, 40.0068588f},
                  .target = {3.0562975f, 19.7621322f, 39.0717318f},
                  .field_of_view = 36,
                  .focus_distance = 7};
  original.empty() ? generate(scene, options) : load_folder(scene, original, options, rules());
  return scene;
}

}  // namespace glint::scenes

// Builds CAR, a racing car with hundreds of parts, most with a texture of their own.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/generated.h"
#include "scenes/generate/paintings.h"
#include "scenes/generate/solids.h"
#include "scenes/import/asset_folder.h"

namespace glint::scenes {
namespace {

constexpr uint64_t kTriangles = 12'700'000;
constexpr uint32_t kTextures = 244;     // as many as the original's
constexpr uint32_t kTextureSide = 720;  // texels; 244 of them are the original's 504 MB

FolderRules rules() {
  return {.folders = {"Scenes/Blender_2.77", "assets/Scenes/Blender_2.77", "CAR"}, .textures = true};
}

class Workshop {
 public:
  Workshop(Generator& generator) : generator_(generator), random_(277) {}

  // Returns the material of a new part. It has the next texture as long as there are any, then a plain
  // colour.
  int32_t paint() {
    static constexpr Pattern kPatterns[] = {Pattern::Panels, Pattern::Stone, Pattern::Stripes,
                                            Pattern::Planks};
    const float r = random_.between(0.2f, 0.9f), g = random_.between(0.15f, 0.6f),
                b = random_.between(0.1f, 0.5f);
    if (made_ >= kTextures) return generator_.color("", r, g, b);
    const uint32_t seed = made_++;
    return generator_.textured(
        "", paint_texture(kPatterns[seed % 4], {r, g, b}, kTextureSide, kTextureSide, seed));
  }
  Random& random() { return random_; }

 private:
  Generator& generator_;
  Random random_;
  uint32_t made_ = 0;
};

// Adds the wheels: 4 x (tyre, rim, 12 bolts, brake) = 60 models.
void wheels(Generator& generator, Workshop& shop, const Frame& car) {
  static constexpr Vec2 kBolt[] = {{-1, 0}, {-1, 1}, {0.4f, 1}, {0.5f, 0.6f}, {1, 0.6f}, {1, 0}};
  for (int k = 0; k < 4; ++k) {
    const Frame hub =
        car.inner({k % 2 ? 0.68f : -0.68f, -0.5f, k / 2 ? 0.95f : -0.95f}, {0.3f, 0.75f, 0.25f});
    const Frame wheel{hub.x, hub.z, hub.y, hub.origin};
    generator.model("Torus", [&](Model& m) { add_ring(m, wheel, 320'000, shop.paint(), 0.35f); });
    generator.model("Rim", [&](Model& m) {
      const int32_t material = shop.paint();
      add_machine(m, wheel.inner({0, 0, 0}, {0.5f, 0.8f, 0.5f}), 200'000, std::span(&material, 1),
                  uint32_t(k));
    });
    generator.model("Brake", [&](Model& m) {
      add_lathe(m, wheel.inner({0, 0.3f, 0}, {0.4f, 0.2f, 0.4f}), kBolt, 60'000, shop.paint());
    });
    for (int bolt = 0; bolt < 12; ++bolt)
      generator.model("Bolt", [&](Model& m) {
        const double angle = 6.283185307 * bolt / 12;
        add_lathe(m, wheel.inner({0.5f * cosine(angle), 0.9f, 0.5f * sine(angle)}, {0.05f, 0.2f, 0.05f}),
                  kBolt, 3'000, shop.paint());
      });
  }
}

void body(Generator& generator, Workshop& shop, const Frame& car) {
  Random& random = shop.random();
  for (int k = 0; k < 60; ++k)
    generator.model("Panel", [&](Model& m) {
      const float along = float(k % 20) / 10 - 0.95f,
                  narrow = 0.75f - 0.45f * (along > 0 ? along * along : 0);
      const Vec3 center{along, k < 20 ? 0.35f : -0.2f, k < 20 ? 0 : (k < 40 ? narrow : -narrow)};
      const Vec3 size{0.09f, k < 20 ? 0.08f : 0.45f, k < 20 ? narrow : 0.07f};
      add_rounded_box(m, car.inner(center, size, random.between(-4, 4)), 60'000, shop.paint(), 0.4f);
    });
  for (uint32_t k = 0; k < 70; ++k)
    generator.model("Cube", [&](Model& m) {
      const float x = random.between(-0.95f, 0.6f), y = random.between(-0.3f, 0.75f),
                  z = random.between(-0.5f, 0.5f), size = random.between(0.06f, 0.18f);
      const int32_t materials[] = {shop.paint()};
      add_machine(m, car.inner({x, y, z}, {size, size * 2, size}), 50'000, materials, 50 + k);
    });
  for (uint32_t k = 0; k < 60; ++k)
    generator.model("BezierCurve", [&](Model& m) {
      const float x = random.between(-0.9f, 0.5f), z = random.between(-0.6f, 0.6f),
                  reach = random.between(0.2f, 0.6f);
      add_cable(m, car.at(x, 0.4f, z), car.at(x + reach, random.between(0.1f, 0.6f), -z), 0.4f, 0.025f,
                20'000, shop.paint());
    });
  const Frame wing = car.inner({-1, 1, 0}, {0.16f, 0.08f, 1});
  generator.model("Wing", [&](Model& m) { add_rounded_box(m, wing, 200'000, shop.paint(), 0.6f); });
  generator.model("Helmet", [&](Model& m) {
    add_ball(m, car.inner({-0.05f, 0.75f, 0}, {0.14f, 0.4f, 0.2f}), 200'000, shop.paint(), 0.1f);
  });
  generator.model("Cockpit", [&](Model& m) {
    add_ring(m, car.inner({0, 0.5f, 0}, {0.3f, 0.25f, 0.4f}), 120'000, shop.paint(), 0.2f);
  });
}

// Adds the towers of the town around, and the slope below.
void surroundings(Generator& generator, Workshop& shop, const Frame& view) {
  Random& random = shop.random();
  for (uint32_t k = 0; k < 48; ++k)
    generator.model("Tower", [&](Model& m) {
      const float depth = 45 + 2 * float(k), x = random.between(-0.38f, 0.38f) * depth,
                  tall = random.between(0.06f, 0.2f) * depth;
      const int32_t materials[] = {shop.paint()};
      add_machine(m, view.inner({x, tall - 0.3f * depth, 18 - depth}, {0.05f * depth, tall, 0.05f * depth}),
                  15'000, materials, 200 + k);
    });
  generator.model("Ground", [&](Model& m) {
    const int32_t material = shop.paint();
    add_patch(m, generator.rest(), 1, material, [&](float u, float v) {
      const float depth = 24 + 110 * v, x = (u - 0.5f) * 1.3f * depth;
      return view.at(x, -0.20f * depth + 0.1f * depth * fractal({x * 0.05f, 1, depth * 0.05f}, 5),
                     18 - depth);
    });
  });
}

void generate(Scene& scene, const LoadOptions& options) {
  Generator generator(scene, options, kTriangles);
  Workshop shop(generator);
  const Frame view = in_view(scene.camera, 18);
  const Frame car = view.inner({-0.2f, -0.4f, 0}, {3.6f, 1.3f, 1.7f}, 35);
  body(generator, shop, car);
  wheels(generator, shop, car);
  surroundings(generator, shop, view);
  scene.note =
      "The scene is a procedural racing car with about the original's triangle count (12.7M), and with its "
      "number of models (302) and textures (244, 504 MB).";
}

}  // namespace

Scene build_car(const LoadOptions& options) {
  Scene scene;
  scene.name = "CAR";
  scene.camera = {.eye = {24.5407028f, -6.0577549f, -8.1028061f},
                  .target = {23.6588073f, -5.7356780f, -7.7585287f},
                  .field_of_view = 30,
                  .focus_distance = 7};
  options.assets.empty() ? generate(scene, options) : load_folder(scene, options, rules());
  return scene;
}

}  // namespace glint::scenes

// Builds CAR, a racing car with hundreds of parts, most with a texture of their own.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scenes/generate/generated.h"
#include "scenes/generate/paintings.h"
#include "scenes/generate/solids.h"
#include "scenes/import/asset_folder.h"

namespace glint::scenes {
namespace {

constexpr uint64_t kTriangles = 12'700'000;
constexpr uint32_t kTextures = 244;     // as many as the original's
constexpr uint32_t kTextureSide = 720;  // texels; 244 of them are the original's 504 MB

// Where the car's parts are, in its frame: x from the tail (-1) to the nose (1), y from the road (-1) to the
// roof (1), z across.
constexpr float kSill = -0.62f, kAxle = 0.6f, kWheel = 0.62f;  // the last in world units: a wheel's radius
constexpr float kWheelHeight = -0.523f, kTrack = 0.84f;

class Workshop {
 public:
  Workshop(Generator& generator) : generator_(generator), random_(277) {}

  // Returns the material of a new part. It has a texture of its own as long as there are any, then a plain
  // colour.
  int32_t paint(Pattern pattern, const Vec3& color) {
    if (made_ >= kTextures) return generator_.color("", color[0], color[1], color[2]);
    const uint32_t seed = made_++;
    return generator_.textured(
        "", paint_texture(pattern, color, kTextureSide, kTextureSide, seed, generator_.threads()));
  }
  int32_t lacquer(const Vec3& color) { return paint(Pattern::Lacquer, color); }
  Random& random() { return random_; }

 private:
  Generator& generator_;
  Random random_;
  uint32_t made_ = 0;
};

constexpr Vec3 kRed{0.72f, 0.05f, 0.04f}, kWhite{0.9f, 0.9f, 0.87f}, kSteel{0.5f, 0.5f, 0.53f},
    kRubber{0.05f, 0.05f, 0.055f};

float eased(float t) {
  t = std::clamp(t, 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

// Returns x with its sign and the square root of its size. It makes an ellipse nearly a rectangle.
float boxed(float x) {
  return x < 0 ? -std::sqrt(-x) : std::sqrt(x);
}

// Returns a point of the body's shell at `along` (-1 to 1) and `around`, from the sill at +z (0) over the top
// to the other sill (1).
Vec3 shell(float along, float around) {
  const float nose = eased((along - 0.25f) / 0.75f), tail = eased((-0.7f - along) / 0.3f);
  const float end = std::max(0.0f, std::abs(along) - 0.9f) / 0.1f;
  const float round = std::sqrt(std::max(0.0f, 1 - end * end));
  const float top = 0.1f - 0.36f * nose - 0.1f * tail, wide = 0.9f - 0.14f * nose - 0.06f * tail;
  const double turn = 3.14159265358979 * double(around);
  const float across = cosine(turn), up = std::sqrt(std::max(0.0f, sine(turn)));
  const float belly = 1 - 0.1f * up * up;  // the sides lean inwards
  return {along, kSill + (top - kSill) * up * (0.45f + 0.55f * round),
          wide * belly * boxed(across) * (0.7f + 0.3f * round)};
}

// Returns a point of the cabin's shell at `along` (0 at the rear window's foot, 1 at the windscreen's) and
// `around` as for shell().
Vec3 cabin(float along, float around) {
  const float high = std::min(eased(along / 0.34f), eased((1 - along) / 0.36f));
  const double turn = 3.14159265358979 * double(around);
  const float up = std::sqrt(std::max(0.0f, sine(turn))), y = 0.04f + (0.04f + 0.72f * high) * up;
  return {-0.7f + 1.02f * along, y, (0.74f - 0.26f * (y - 0.04f)) * boxed(cosine(turn))};
}

// Returns the axes of length 1 at a place of the car.
Frame fixed_to(const Frame& car, const Vec3& place) {
  return {normalized(car.x), normalized(car.y), normalized(car.z), car.at(place)};
}

void wheel(Generator& generator, Workshop& shop, const Frame& hub) {
  static constexpr Vec2 kTyre[] = {{-1, 0.62f}, {-1, 0.9f}, {-0.75f, 1}, {0.75f, 1}, {1, 0.9f}, {1, 0.62f}};
  static constexpr Vec2 kRim[] = {
      {-0.8f, 0.6f}, {0.75f, 0.6f}, {0.95f, 0.66f}, {0.95f, 0.58f}, {0.2f, 0.52f}};
  static constexpr Vec2 kBolt[] = {{-1, 0}, {-1, 1}, {0.4f, 1}, {0.5f, 0.6f}, {1, 0.6f}, {1, 0}};
  // The wheel turns about its y axis, which points outwards.
  generator.model(
      "Tyre", [&](Model& m) { add_lathe(m, hub, kTyre, 320'000, shop.paint(Pattern::Stripes, kRubber)); });
  generator.model("Rim", [&](Model& m) {
    const int32_t material = shop.lacquer(kSteel);
    add_lathe(m, hub, kRim, 80'000, material);
    for (int k = 0; k < 7; ++k) {
      const float degrees = 360.0f * float(k) / 7;
      const double turn = double(degrees) * 3.14159265358979 / 180;
      add_rounded_box(
          m, hub.inner({0.31f * cosine(turn), 0.55f, 0.31f * sine(turn)}, {0.3f, 0.14f, 0.07f}, -degrees),
          16'000, material, 0.4f);
    }
    add_ball(m, hub.inner({0, 0.6f, 0}, {0.13f, 0.3f, 0.13f}), 8'000, material);
  });
  generator.model("Brake", [&](Model& m) {
    add_lathe(m, hub.inner({0, -0.1f, 0}, {0.46f, 0.1f, 0.46f}), kBolt, 60'000, shop.lacquer(kSteel * 0.5f));
  });
  for (int bolt = 0; bolt < 12; ++bolt)
    generator.model("Bolt", [&](Model& m) {
      const double angle = 6.283185307 * bolt / 12;
      add_lathe(m, hub.inner({0.18f * cosine(angle), 0.7f, 0.18f * sine(angle)}, {0.025f, 0.12f, 0.025f}),
                kBolt, 3'000, shop.lacquer(kSteel * 0.7f));
    });
}

// Adds four wheels of 15 models each, and the dark houses that they stand in.
void wheels(Generator& generator, Workshop& shop, const Frame& car) {
  static constexpr Vec2 kHouse[] = {{-1, 0}, {-1, 1}, {1, 1}, {1, 0}};
  for (int k = 0; k < 4; ++k) {
    const float side = k % 2 ? 1.0f : -1.0f;
    const Frame at = fixed_to(car, {k / 2 ? kAxle : -kAxle, kWheelHeight, side * kTrack});
    const Frame axle{at.x * side, at.z * side, at.y * -1.0f, at.origin};
    wheel(generator, shop, axle.inner({0, 0, 0}, {kWheel, 0.24f, kWheel}));
    generator.model("Wheel_House", [&](Model& m) {
      add_lathe(m, axle.inner({0, 0.02f, 0}, {kWheel * 1.16f, 0.05f, kWheel * 1.16f}), kHouse, 30'000,
                shop.lacquer(kRubber * 0.6f));
    });
  }
}

// Adds the painted shell of 12 times 5 panels. Those in the middle are a white stripe.
void panels(Generator& generator, Workshop& shop, const Frame& car) {
  static constexpr std::array kBands = {0.0f, 0.2f, 0.44f, 0.56f, 0.8f, 1.0f};
  for (size_t k = 0; k < 60; ++k)
    generator.model("Panel", [&](Model& m) {
      const float low = float(k / 5) / 6 - 1;
      const size_t band = k % 5;
      add_patch(m, 60'000, 1, shop.lacquer(band == 2 ? kWhite : kRed), [&](float u, float v) {
        return car.at(shell(low + v / 6, kBands[band] + (kBands[band + 1] - kBands[band]) * u));
      });
    });
}

// Adds the dark glass of the cabin, the roof above it and the pillars between the windows.
void greenhouse(Generator& generator, Workshop& shop, const Frame& car) {
  const int32_t glass = generator.material("glass", metallic(0.12f, 0.16f, 0.2f, 0.02f));
  generator.model("Windows", [&](Model& m) {
    add_patch(m, 240'000, 1, glass, [&](float u, float v) { return car.at(cabin(v, u)); });
  });
  generator.model("Roof", [&](Model& m) {
    add_patch(m, 200'000, 1, shop.lacquer(kRed), [&](float u, float v) {
      Vec3 p = cabin(0.28f + 0.42f * v, 0.17f + 0.66f * u);
      p[1] += 0.03f;
      return car.at(p);
    });
  });
  for (int k = 0; k < 6; ++k)
    generator.model("Pillar", [&](Model& m) {
      const float foot = k / 2 == 0   ? 0.0f
                         : k / 2 == 1 ? 0.5f
                                      : 1.0f,
                  head = k / 2 == 0   ? 0.3f
                         : k / 2 == 1 ? 0.48f
                                      : 0.68f;
      std::vector<Vec3> path;
      for (int i = 0; i <= 60; ++i) {
        const float t = float(i) / 60, around = 0.02f + 0.16f * t;
        Vec3 p = cabin(foot + (head - foot) * t, k % 2 ? 1 - around : around);
        p[1] += 0.015f;
        path.push_back(car.at(p));
      }
      add_tube(m, path, 0.06f, 0.05f, 160, shop.lacquer(kRed));
    });
}

// Adds lamps, grille, bumpers, mirrors, wing and what else a body carries: 22 models.
void fittings(Generator& generator, Workshop& shop, const Frame& car) {
  const int32_t chrome = generator.material("chrome", metallic(0.75f, 0.75f, 0.78f, 0.05f)),
                lamp = generator.material("lamp", diffuse_light(1.6f, 1.55f, 1.3f));
  const auto box = [&](const char* name, const Vec3& center, const Vec3& size, uint64_t triangles,
                       int32_t material) {
    generator.model(
        name, [&](Model& m) { add_rounded_box(m, car.inner(center, size), triangles, material, 0.4f); });
  };
  for (const float side : {-1.0f, 1.0f}) {
    generator.model("Headlight", [&](Model& m) {
      add_ball(m, fixed_to(car, {0.93f, -0.32f, 0.5f * side}).inner({0, 0, 0}, {0.2f, 0.2f, 0.22f}), 50'000,
               lamp);
    });
    box("Taillight", {-0.965f, -0.2f, 0.55f * side}, {0.03f, 0.08f, 0.18f}, 30'000,
        shop.lacquer({0.9f, 0.1f, 0.05f}));
    box("Mirror", {0.22f, 0.2f, 0.92f * side}, {0.035f, 0.09f, 0.08f}, 30'000, shop.lacquer(kRed));
    box("Handle", {-0.22f, -0.05f, 0.87f * side}, {0.05f, 0.02f, 0.02f}, 10'000, chrome);
    box("Sill", {0, -0.66f, 0.82f * side}, {0.45f, 0.07f, 0.1f}, 40'000, shop.lacquer(kRubber));
    generator.model("Number", [&](Model& m) {
      static constexpr Vec2 kDisc[] = {{-1, 0}, {-1, 1}, {1, 1}, {1, 0}};
      const Frame at = fixed_to(car, {-0.02f, -0.22f, 0.885f * side});
      add_lathe(m, Frame{at.x * (0.36f * side), at.z * (0.03f * side), at.y * -0.36f, at.origin}, kDisc,
                30'000, shop.lacquer(kWhite));
    });
    generator.model("Exhaust", [&](Model& m) {
      add_cable(m, car.at(-0.8f, -0.72f, 0.35f * side), car.at(-1.03f, -0.7f, 0.35f * side), 0, 0.07f, 20'000,
                chrome);
    });
    box("Strut", {-0.92f, 0.16f, 0.5f * side}, {0.02f, 0.16f, 0.03f}, 10'000, shop.lacquer(kRubber));
    box(side < 0 ? "Bumper_front" : "Bumper_rear", {-0.97f * side, -0.58f, 0}, {0.05f, 0.06f, 0.68f}, 60'000,
        chrome);
  }
  box("Wing", {-0.94f, 0.36f, 0}, {0.09f, 0.03f, 0.88f}, 150'000, shop.lacquer(kRed));
  generator.model("Grille", [&](Model& m) {
    for (int bar = 0; bar < 9; ++bar)
      add_rounded_box(m, car.inner({0.985f, -0.34f, -0.28f + 0.07f * float(bar)}, {0.01f, 0.1f, 0.012f}),
                      6'000, chrome, 0.4f);
  });
  generator.model("Steering_Wheel", [&](Model& m) {
    add_ring(m, fixed_to(car, {0.1f, 0.12f, -0.35f}).inner({0, 0, 0}, {0.25f, 0.03f, 0.25f}), 40'000,
             shop.lacquer(kRubber), 0.12f);
  });
  box("Seat", {-0.3f, -0.1f, -0.35f}, {0.1f, 0.3f, 0.22f}, 60'000, shop.lacquer(kRubber));
}

// Adds what lies below the shell: 50 machines in the bonnet and the chassis, and 40 hoses.
void engine(Generator& generator, Workshop& shop, const Frame& car) {
  Random& random = shop.random();
  for (uint32_t k = 0; k < 50; ++k)
    generator.model("Cube", [&](Model& m) {
      const bool front = k < 25;
      const float x = front ? random.between(0.35f, 0.75f) : random.between(-0.8f, -0.3f),
                  y = random.between(-0.55f, -0.42f), z = random.between(-0.4f, 0.4f),
                  size = random.between(0.03f, 0.07f);
      const int32_t materials[] = {shop.lacquer(kSteel * random.between(0.3f, 1))};
      add_machine(m, car.inner({x, y, z}, {size, size * 1.6f, size * 1.6f}), 50'000, materials, 50 + k);
    });
  for (uint32_t k = 0; k < 40; ++k)
    generator.model("BezierCurve", [&](Model& m) {
      const float x = random.between(-0.8f, 0.5f), z = random.between(-0.5f, 0.5f),
                  reach = random.between(0.1f, 0.25f);
      add_cable(m, car.at(x, -0.5f, z), car.at(x + reach, random.between(-0.55f, -0.4f), z + 0.1f), 0.05f,
                0.02f, 20'000, shop.lacquer(kRubber));
    });
}

// Adds a house with rows of windows and a roof; `f` is its block.
void add_house(Model& model, const Frame& f, uint64_t triangles, int32_t wall, int32_t pane) {
  add_rounded_box(model, f, triangles / 4, wall, 0.02f);
  for (int k = 0; k < 20; ++k)
    add_rounded_box(
        model,
        f.inner({-0.72f + 0.48f * float(k % 4), -0.55f + 0.34f * float(k / 4), 1}, {0.13f, 0.11f, 0.02f}),
        triangles / 40, pane, 0.1f);
  add_patch(model, triangles / 4, 1, pane, [&](float u, float v) {
    return f.at(2.2f * u - 1.1f, 1 + 0.5f * std::min(v, 1 - v), 1.1f - 2.2f * v);
  });
}

// Adds the town behind the car, lamps along the road, and the ground. `stage` has its origin below the car.
void surroundings(Generator& generator, Workshop& shop, const Frame& stage) {
  Random& random = shop.random();
  for (uint32_t k = 0; k < 51; ++k)
    generator.model("House", [&](Model& m) {
      const float row = float(k / 14), away = 30 + 16 * row, x = (float(k % 14) - 6.5f) * (3.6f + 1.2f * row),
                  tall = random.between(1.4f, 3.5f) + 0.8f * row;
      const float tone = random.between(0.45f, 0.85f);
      const int32_t wall = shop.paint(k % 2 ? Pattern::Bricks : Pattern::Panels,
                                      {tone, tone * 0.85f, tone * 0.68f}),
                    pane = shop.lacquer({0.16f, 0.2f, 0.28f});
      add_house(m,
                stage.inner({x, tall - 0.3f, -away}, {1.5f + 0.4f * row, tall, 2}, random.between(-12, 12)),
                20'000, wall, pane);
    });
  for (int k = 0; k < 5; ++k)
    generator.model("Lamp_Post", [&](Model& m) {
      const Vec3 foot = stage.at(-11 + 5.5f * float(k), 0, -6);
      add_cable(m, foot, foot + stage.y * 5.0f, 0, 0.07f, 4'000, shop.lacquer(kRubber));
      add_ball(m, upright(foot + stage.y * 5.0f, {0.3f, 0.3f, 0.3f}), 8'000, shop.lacquer(kWhite));
    });
  generator.model("Road", [&](Model& m) {
    const int32_t road = shop.paint(Pattern::Stone, {0.22f, 0.22f, 0.23f});
    add_patch(m, 8'000, 4, road, [&](float u, float v) { return stage.at(-40 + 80 * u, 0, 14 - 20 * v); });
    for (int dash = 0; dash < 14; ++dash)
      add_patch(m, 40, 4, shop.lacquer(kWhite), [&](float u, float v) {
        return stage.at(-21 + 3 * float(dash) + 1.8f * u, 0.01f, 3.5f - 0.18f * v);
      });
  });
  generator.model("Ground", [&](Model& m) {
    const int32_t earth = shop.paint(Pattern::Stone, {0.36f, 0.4f, 0.22f});
    add_patch(m, generator.rest(), 1, earth, [&](float u, float v) {
      const float z = -6 - 110 * v, x = (u - 0.5f) * (90 + 40 * v);
      const float hill = z > -9 ? 0.0f : 0.02f * (-9 - z) * (1 + fractal({x * 0.06f, 1, z * 0.06f}, 4));
      return stage.at(x, hill - 0.02f, z);
    });
  });
}

void generate(Scene& scene, const LoadOptions& options) {
  Generator generator(scene, options, kTriangles);
  Workshop shop(generator);
  // The road is seen from a little above: it leans towards the camera by five degrees.
  const Frame view = in_view(scene.camera, 18);
  const float lean = sine(0.0873), upwards = cosine(0.0873);
  const Frame stage{view.x, view.y * upwards + view.z * lean, view.z * upwards - view.y * lean,
                    view.at(0, -2.2f, 0)};
  const Frame car = stage.inner({0.1f, 1.3f, 0}, {3.6f, 1.3f, 1.7f}, -28);
  panels(generator, shop, car);
  greenhouse(generator, shop, car);
  fittings(generator, shop, car);
  wheels(generator, shop, car);
  engine(generator, shop, car);
  surroundings(generator, shop, stage);
  scene.note =
      "The scene is a procedural racing car in a town with about the original's triangle count (12.7M), and "
      "with its number of models (302) and textures (244, 504 MB).";
}

}  // namespace

Scene build_car(const LoadOptions& options, const std::string& original) {
  Scene scene;
  scene.name = "CAR";
  scene.camera = {.eye = {24.5407028f, -6.0577549f, -8.1028061f},
                  .target = {23.6588073f, -5.7356780f, -7.7585287f},
                  .field_of_view = 30,
                  .focus_distance = 7};
  original.empty() ? generate(scene, options) : load_folder(scene, original, options, {.textures = true});
  return scene;
}

}  // namespace glint::scenes

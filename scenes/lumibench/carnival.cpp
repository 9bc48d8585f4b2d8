// Builds CRNVL, a fairground with a big wheel, a carousel, tents and strings of lamps, as one structure.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <fmt/format.h>

#include "scenes/generate/figures.h"
#include "scenes/generate/generated.h"
#include "scenes/generate/solids.h"
#include "scenes/import/asset_folder.h"
#include "scenes/import/obj_loader.h"

namespace glint::scenes {
namespace {

constexpr uint64_t kTriangles = 449'600;
constexpr double kPi = 3.14159265358979;

// Builds the fair in world units: the ground is y = 20, and the camera looks along -z from (275, 60, -700).
struct Fair {
  Model model{};
  std::vector<int32_t> colors{};

  int32_t color(uint32_t k) const { return colors[k % colors.size()]; }

  void big_wheel(const Vec3& hub, float radius) {
    constexpr uint32_t kSpokes = 24;
    for (const float side : {-14.0f, 14.0f}) {
      const Vec3 middle = hub + Vec3{0, 0, side};
      for (const float part : {1.0f, 0.9f, 0.35f})
        add_ring(model, {{radius * part, 0, 0}, {0, 0, 2.5f}, {0, radius * part, 0}, middle}, 2400, color(1),
                 0.012f);
      for (uint32_t k = 0; k < kSpokes; ++k) {
        const double angle = 2 * kPi * k / kSpokes;
        add_cable(model, middle, middle + Vec3{radius * cosine(angle), radius * sine(angle), 0}, 0, 1.1f, 32,
                  color(2));
      }
      for (const float lean : {-90.0f, 90.0f})
        add_cable(model, middle, {hub[0] + lean, 20, hub[2] + side * 2}, 0, 5, 1200, color(3));
      for (uint32_t k = 0; k < 2 * kSpokes; ++k) {  // braces between the two rims
        const double from = kPi * k / kSpokes, to = kPi * (k + 1) / kSpokes;
        const float inner = radius * (k % 2 ? 0.9f : 1), outer = radius * (k % 2 ? 1 : 0.9f);
        add_cable(model, middle + Vec3{inner * cosine(from), inner * sine(from), 0},
                  middle + Vec3{outer * cosine(to), outer * sine(to), 0}, 0, 0.8f, 64, color(2));
      }
    }
    for (uint32_t k = 0; k < kSpokes; ++k) {
      const double angle = 2 * kPi * k / kSpokes;
      const Vec3 place = hub + Vec3{radius * cosine(angle), radius * sine(angle) - 12, 0};
      add_rounded_box(model, upright(place, {9, 8, 11}), 1800, color(4 + k), 0.4f);
      add_ring(model, upright(place + Vec3{0, 9, 0}, {9, 2, 9}), 900, color(5 + k), 0.2f);
    }
  }

  void tent(const Vec3& foot, float size, uint32_t k) {
    static constexpr Vec2 kRoof[] = {{-1, 1},       {-0.6f, 0.98f}, {-0.55f, 1.1f},
                                     {0.2f, 0.45f}, {0.9f, 0.05f},  {1, 0}};
    add_lathe(model, upright(foot + Vec3{0, size, 0}, {size, size, size}), kRoof, 3600, color(k));
    for (uint32_t s = 0; s < 12; ++s) {
      const double angle = 2 * kPi * s / 12;
      const Vec3 rim = foot + Vec3{size * 1.06f * cosine(angle), size * 0.42f, size * 1.06f * sine(angle)};
      add_cloth(model, {{size * 0.12f, 0, 0}, {0, size * 0.12f, 0}, {0, 0, 3}, rim}, 300,
                color(k + s % 2 + 1), 2, s);
    }
    add_ball(model, upright(foot + Vec3{0, 2 * size + 4, 0}, {4, 4, 4}), 500, color(k + 2));
    for (uint32_t rope = 0; rope < 18; ++rope) {  // from the eaves to pegs in the ground
      const double angle = 2 * kPi * rope / 18;
      const Vec3 out{cosine(angle), 0, sine(angle)};
      add_cable(model, foot + out * (size * 1.08f) + Vec3{0, size * 0.45f, 0},
                {foot[0] + out[0] * size * 1.5f, 20, foot[2] + out[2] * size * 1.5f}, 0, 0.5f, 16, color(0));
    }
  }

  void carousel(const Vec3& foot, float size) {
    static constexpr Vec2 kDeck[] = {{-1, 0}, {-1, 1}, {1, 1}, {1, 0}};
    add_lathe(model, upright(foot + Vec3{0, 6, 0}, {size, 4, size}), kDeck, 3000, color(6));
    tent(foot + Vec3{0, size * 0.55f, 0}, size, 7);
    add_ball(model, upright(foot + Vec3{0, size * 2.6f + 12, 0}, {7, 7, 7}), 14'000, color(10), 0.15f, 4);
    for (uint32_t k = 0; k < 16; ++k) {
      const double angle = 2 * kPi * k / 16;
      const Vec3 place = foot + Vec3{size * 0.8f * cosine(angle), 26, size * 0.8f * sine(angle)};
      add_cable(model, place + Vec3{0, -20, 0}, place + Vec3{0, 40, 0}, 0, 1, 300, color(8));
      // This ball is a horse's body.
      add_ball(model, upright(place, {5, 6, 12}, float(k) * -22.5f), 1300, color(9 + k), 0.25f, 1.5f);
      add_ball(model, upright(place + Vec3{0, 8, 0}, {3, 6, 4}), 500, color(9 + k), 0.2f, 2);
    }
  }

  void booth(const Vec3& foot, float turn, uint32_t k) {
    const Frame frame = upright(foot, {32, 30, 20}, turn);
    add_rounded_box(model, frame.inner({0, 0.4f, -0.9f}, {1, 1.4f, 0.08f}), 900, color(k), 0.05f);
    add_rounded_box(model, frame.inner({0, -0.3f, 0.8f}, {1, 0.6f, 0.15f}), 900, color(k + 1), 0.05f);
    add_patch(model, 1800, 2, color(k + 2), [&](float u, float v) {
      return frame.at(2.2f * u - 1.1f, 1.7f + 0.4f * v - 0.1f * sine(double(u) * 40), 1.3f - 2.4f * v);
    });
    for (int row = 0; row < 3; ++row)
      for (int toy = 0; toy < 7; ++toy)
        add_ball(
            model,
            frame.inner({float(toy) * 0.28f - 0.84f, 0.45f * float(row) + 0.1f, -0.7f}, {0.1f, 0.14f, 0.15f}),
            120, color(uint32_t(toy + row) + k), 0.25f, 2);
  }

  void lamps(const Vec3& start, const Vec3& end, uint32_t k) {
    add_cable(model, start, end, 22, 0.6f, 480, color(0));
    for (uint32_t lamp = 0; lamp < 24; ++lamp) {
      const float t = (float(lamp) + 0.5f) / 24;
      const Vec3 place = start + (end - start) * t - Vec3{0, 88 * t * (1 - t) + 4, 0};
      add_ball(model, upright(place, {2.6f, 3.4f, 2.6f}), 72, color(k + lamp));
      for (const float beside : {-0.3f, 0.3f}) {  // paper flags
        const Vec3 along = (end - start) * (beside / 24), flag = place + along + Vec3{0, 3, 0};
        add_patch(model, 8, 1, color(k + lamp + 3), [&](float u, float v) {
          return flag + along * ((u - 0.5f) * (1 - v)) - Vec3{0, 9 * v, 2 * u * v};
        });
      }
    }
  }

  // Adds visitors on the way between the booths, some of them with balloons.
  void visitors() {
    Random random(77);
    for (uint32_t k = 0; k < 12; ++k) {
      const Vec3 feet{random.between(190, 360), 21, -800 - 18 * float(k)};
      const Figure figure{.hands = {{{-0.2f, 0.5f, 0.1f}, {0.22f, k % 2 ? 0.9f : 0.5f, 0.15f}}},
                          .skirt = k % 3 == 0,
                          .long_hair = k % 3 == 0};
      const Frame frame = upright(feet, {42, 42, 42}, random.between(0, 360));
      add_figure(model, frame, figure, 5'800,
                 {color(0), color(3), color(6 + k), color(k + 1), color(k + 12), color(3)});
      for (uint32_t b = 0; k % 2 && b < 7; ++b) {
        const Vec3 hand = frame.at(figure.hands[1]),
                   place = hand + Vec3{random.between(-9, 9), random.between(24, 40), random.between(-9, 9)};
        add_ball(model, upright(place, {5, 6, 5}), 160, color(k + 3 * b));
        add_cable(model, hand, place, 0, 0.2f, 32, color(0));
      }
    }
  }

  // Adds a fence along the way: posts, two rails and a crossed brace in each field.
  void fence(const Vec3& start, const Vec3& end) {
    constexpr uint32_t kPosts = 40;
    const Vec3 step = (end - start) * (1.0f / kPosts);
    for (uint32_t k = 0; k < kPosts; ++k) {
      const Vec3 foot = start + step * float(k), next = foot + step;
      add_cable(model, foot, foot + Vec3{0, 24, 0}, 0, 0.9f, 32, color(2));
      for (const float low : {5.0f, 21.0f})
        add_cable(model, foot + Vec3{0, low, 0}, next + Vec3{0, low, 0}, 0, 0.6f, 16, color(2));
      add_cable(model, foot + Vec3{0, 5, 0}, next + Vec3{0, 21, 0}, 0, 0.5f, 16, color(2));
      add_cable(model, foot + Vec3{0, 21, 0}, next + Vec3{0, 5, 0}, 0, 0.5f, 16, color(2));
    }
  }
};

void build_fair(Fair& fair) {
  fair.big_wheel({120, 250, -1250}, 190);
  fair.carousel({300, 20, -1010}, 75);
  fair.tent({20, 20, -1000}, 75, 11);
  fair.tent({-110, 20, -1150}, 95, 14);
  fair.tent({420, 20, -1300}, 110, 17);
  for (uint32_t k = 0; k < 7; ++k) {
    const float z = -800 - 75 * float(k);
    fair.booth({150 - 14 * float(k), 50, z}, 70, 3 * k);
    fair.booth({395 + 12 * float(k), 50, z - 20}, -70, 3 * k + 1);
  }
  for (uint32_t k = 0; k < 10; ++k) {
    const float z = -760 - 60 * float(k);
    fair.lamps({140 - 8 * float(k), 150, z}, {400, 165, z - 40}, k);
    fair.lamps({400 - 12 * float(k), 150, z - 20}, {120 + 10 * float(k), 175, z - 150}, k + 4);
  }
  fair.visitors();
  fair.fence({200, 20, -790}, {150, 20, -1200});
  fair.fence({330, 20, -780}, {380, 20, -930});
}

// Adds a coaster behind the fair: two rails, ties and posts.
void build_coaster(Fair& fair) {
  std::array<std::vector<Vec3>, 2> rails;
  for (int k = 0; k <= 600; ++k) {
    const double t = 2 * kPi * k / 600;
    const Vec3 middle{120 + 420 * cosine(t), 170 + 85 * sine(3 * t) + 30 * cosine(5 * t),
                      -1500 + 130 * sine(t)};
    for (size_t side = 0; side < 2; ++side) rails[side].push_back(middle + Vec3{0, 0, side ? 8.0f : -8.0f});
    if (k % 4 == 0) add_cable(fair.model, rails[0].back(), rails[1].back(), 0, 1, 16, fair.color(2));
    if (k % 12 == 0) add_cable(fair.model, middle, {middle[0], 20, middle[2]}, 0, 2.5f, 16, fair.color(3));
    if (k % 12 == 0 && k > 0) {  // braces between the posts
      const Vec3& before = rails[0][size_t(k - 12)];
      add_cable(fair.model, {before[0], 20, before[2]}, middle, 0, 1.2f, 16, fair.color(2));
      add_cable(fair.model, before, {middle[0], 20, middle[2]}, 0, 1.2f, 16, fair.color(2));
    }
  }
  for (const auto& rail : rails) add_tube(fair.model, rail, 2, 2, 8, fair.color(4));
}

void generate(Scene& scene, const LoadOptions& options) {
  Generator generator(scene, options, kTriangles);
  Fair fair;
  Random random(19);
  for (uint32_t k = 0; k < 35; ++k) {  // as many materials as the original has
    const float r = random.between(0.1f, 0.95f), g = random.between(0.1f, 0.9f),
                b = random.between(0.1f, 0.9f);
    fair.colors.push_back(k % 5 ? generator.color(fmt::format("paint_{}", k), r, g, b)
                                : generator.color(fmt::format("white_{}", k), 0.9f, 0.9f, 0.86f));
  }
  build_fair(fair);
  build_coaster(fair);
  const uint64_t made = fair.model.indices.size() / 3;
  add_patch(fair.model, made + 8'000 < kTriangles ? kTriangles - made : 8'000, 1, fair.color(3),
            [](float u, float v) -> Vec3 {
              const float x = -700 + 1600 * u, z = -600 - 1200 * v;
              return {x, 20 + 2.5f * fractal({x * 0.03f, 0, z * 0.03f}, 3), z};
            });
  generator.model("carnival", [&](Model& model) {
    model = std::move(fair.model);
    model.name = "carnival";
  });
  scene.note =
      "The scene is a procedural fairground with the original's triangle count (449.6K) and number of "
      "materials (35).";
}

}  // namespace

Scene build_carnival(const LoadOptions& options, const std::string& original) {
  Scene scene;
  scene.name = "CRNVL";
  scene.camera = {.eye = {275, 60, -700}, .target = {225, 120, -1000}, .field_of_view = 50};
  if (original.empty()) {
    generate(scene, options);
    return scene;
  }
  scene.models.push_back(load_obj(original, scene.materials, {.threads = options.threads}));
  place(scene.models.back(), {.translation = {400, 20, 150}, .scale = 0.2f});
  scene.form = "original";
  scene.note = "The mesh is from the assets folder.";
  return scene;
}

}  // namespace glint::scenes

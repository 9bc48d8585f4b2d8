// Builds PARTY, a hall with guests, a cake, balloons and garlands: hundreds of structures of few triangles.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <vector>

#include "scenes/generate/distance_field.h"
#include "scenes/generate/figures.h"
#include "scenes/generate/generated.h"
#include "scenes/generate/solids.h"
#include "scenes/import/asset_folder.h"

namespace glint::scenes {
namespace {

constexpr uint64_t kTriangles = 1'700'000;

// The hall's sizes, in units of the camera's distance. x is to the right, y up, z towards the camera; the eye
// is the origin, and the front of the hall is open.
constexpr float kWide = 4.6f, kFloor = -3.3f, kCeiling = 4.2f, kFront = -17, kBack = -31;
constexpr float kTableTop = kFloor + 1.25f, kTableZ = -24.2f;
constexpr double kTurn = 6.283185307179586;

struct Party {
  Generator& generator;
  Frame hall;
  Random random{283};
  std::vector<int32_t> colors{};  // bright paints
  int32_t white = 0, wood = 0, wall = 0, dark = 0, flame = 0, silver = 0;

  int32_t color(uint32_t k) const { return colors[k % colors.size()]; }
  // Adds a model whose frame lies at `place` of the hall, with half sizes `size`.
  template <class Make>
  void thing(const char* name, const Vec3& place, const Vec3& size, float degrees, Make&& make) {
    const Frame frame = hall.inner(place, size, degrees);
    generator.model(name, [&](Model& m) { make(m, frame); });
  }
};

void room(Party& party) {
  const float deep = kFront - kBack, high = kCeiling - kFloor;
  const auto plane = [&](const char* name, const Vec3& corner, const Vec3& side, const Vec3& other,
                         uint64_t triangles, int32_t material) {
    party.generator.model(name, [&](Model& m) {
      add_patch(m, triangles, length(side) / length(other), material,
                [&](float u, float v) { return party.hall.at(corner + side * u + other * v); });
    });
  };
  plane("Ceiling", {-kWide, kCeiling, kBack}, {2 * kWide, 0, 0}, {0, 0, deep}, 400,
        party.generator.material("ceiling", diffuse_light(1.0f, 0.97f, 0.9f)));
  plane("Wall_left", {-kWide, kFloor, kFront}, {0, 0, -deep}, {0, high, 0}, 400, party.wall);
  plane("Wall_right", {kWide, kFloor, kBack}, {0, 0, deep}, {0, high, 0}, 400, party.wall);
  plane("Wall_back", {-kWide, kFloor, kBack}, {2 * kWide, 0, 0}, {0, high, 0}, 400, party.wall);
  for (const float side : {-1.0f, 1.0f}) {
    party.thing("Window", {3 * side, 0.2f, kBack + 0.1f}, {0.85f, 1.4f, 0.05f}, 0,
                [&](Model& m, const Frame& f) { add_rounded_box(m, f, 3'000, party.flame, 0.05f); });
    for (const float edge : {-1.0f, 1.0f})
      party.thing(
          "Curtain", {3 * side + 1.05f * edge, 0, kBack + 0.35f}, {0.4f, 1.9f, 0.2f}, 0,
          [&](Model& m, const Frame& f) { add_cloth(m, f, 3'000, party.color(3), 5, side > 0 ? 1 : 2); });
  }
}

// Adds the table with its cloth, and a cake of three tiers with candles.
void table(Party& party) {
  static constexpr Vec2 kTier[] = {{-1, 0}, {-1, 1}, {0.7f, 1}, {1, 0.92f}, {1, 0}};
  static constexpr Vec2 kCandle[] = {{-1, 0}, {-1, 1}, {1, 1}, {1, 0}};
  party.thing(
      "Table", {0, kTableTop - 0.06f, kTableZ}, {2.5f, 0.06f, 0.95f}, 0, [&](Model& m, const Frame& f) {
        add_rounded_box(m, f, 6'000, party.wood, 0.1f);
        for (int leg = 0; leg < 4; ++leg)
          add_rounded_box(m,
                          f.inner({leg % 2 ? 0.9f : -0.9f, -10, leg / 2 ? 0.8f : -0.8f}, {0.03f, 10, 0.07f}),
                          600, party.wood, 0.1f);
      });
  party.generator.model("Tablecloth", [&](Model& m) {
    add_patch(m, 5'000, 2, party.white, [&](float u, float v) {
      const float x = 2 * u - 1, z = 2 * v - 1, out = std::max(std::abs(x), std::abs(z));
      const float fall = out < 0.8f ? 0 : out - 0.8f, wide = std::min(1.0f, 0.8f / out);
      const float folds = 0.4f * fall * wave((x + z) * 9);
      return party.hall.at(x * wide * 3.2f * (1 + 0.1f * folds), kTableTop + 0.03f - 3.2f * fall,
                           kTableZ + z * wide * (1.25f + folds));
    });
  });
  for (int tier = 0; tier < 3; ++tier)
    party.thing("Cake", {0, kTableTop + 0.25f + 0.4f * float(tier), kTableZ},
                {0.75f - 0.2f * float(tier), 0.2f, 0.75f - 0.2f * float(tier)}, 0,
                [&](Model& m, const Frame& f) {
                  add_lathe(m, f, kTier, 1'600, tier % 2 ? party.white : party.color(8));
                  for (int k = 0; k < 16; ++k)  // cream along the rim
                    add_ball(m,
                             f.inner({0.92f * cosine(kTurn * k / 16), 1, 0.92f * sine(kTurn * k / 16)},
                                     {0.1f, 0.25f, 0.1f}),
                             120, party.color(uint32_t(k % 2)));
                });
  party.thing(
      "Candles", {0, kTableTop + 1.4f, kTableZ}, {0.03f, 0.17f, 0.03f}, 0, [&](Model& m, const Frame& f) {
        for (int k = 0; k < 10; ++k) {
          const Frame candle = f.inner({9 * cosine(kTurn * k / 10), 0, 9 * sine(kTurn * k / 10)}, {1, 1, 1});
          add_lathe(m, candle, kCandle, 300, party.color(uint32_t(k)));
          add_ball(m, candle.inner({0, 1.4f, 0}, {0.9f, 0.4f, 0.9f}), 200, party.flame);
        }
      });
}

// Adds cups, bottles and small cakes on the table.
void dishes(Party& party) {
  static constexpr Vec2 kCup[] = {{-1, 0}, {-1, 0.7f}, {1, 1}, {1, 0.9f}, {-0.8f, 0.62f}, {-0.8f, 0}};
  static constexpr Vec2 kBottle[] = {{-1, 0}, {-1, 1}, {0.1f, 1}, {0.45f, 0.35f}, {1, 0.33f}, {1, 0}};
  Random& random = party.random;
  for (uint32_t k = 0; k < 6; ++k) {
    const float x = -2.1f + 1.6f * float(k % 3), z = kTableZ + (k / 3 ? 0.7f : -0.7f);
    party.thing("Cup", {x + 0.3f, kTableTop + 0.18f, z}, {0.09f, 0.14f, 0.09f}, 0,
                [&](Model& m, const Frame& f) { add_lathe(m, f, kCup, 2'000, party.color(k + 3)); });
  }
  for (uint32_t k = 0; k < 4; ++k)
    party.thing("Bottle",
                {-2.1f + 0.24f * float(k % 2) + (k / 2 ? 3.5f : 0.0f), kTableTop + 0.36f,
                 kTableZ + random.between(-0.35f, 0.35f)},
                {0.1f, 0.33f, 0.1f}, 0,
                [&](Model& m, const Frame& f) { add_lathe(m, f, kBottle, 1'000, party.color(2 * k + 1)); });
  for (const float side : {-1.0f, 1.0f})
    party.thing("Cupcakes", {side, kTableTop + 0.1f, kTableZ}, {0.08f, 0.07f, 0.08f}, 0,
                [&](Model& m, const Frame& f) {
                  for (uint32_t k = 0; k < 9; ++k) {
                    const Frame cake = f.inner({2.6f * float(k % 3), 0, 2.6f * float(k / 3)}, {1, 1, 1});
                    add_lathe(m, cake, kCup, 600, party.color(k));
                    add_ball(m, cake.inner({0, 1.1f, 0}, {1, 0.9f, 1}), 400, party.color(k + 4), 0.2f, 2);
                  }
                });
}

// Adds nine guests with paper hats, around the table and behind it.
void guests(Party& party) {
  static constexpr Vec2 kHat[] = {{-1, 0.9f}, {-1, 1}, {1, 0.15f}, {1, 0}};
  struct Guest {
    Vec3 feet;
    float degrees, tall, left, right;  // how high the hands are
  };
  static constexpr Guest kGuests[] = {
      {{-3.3f, 0, -23.4f}, 25, 3.1f, 1.12f, 0.6f}, {{3.2f, 0, -23.2f}, -30, 3.0f, 0.55f, 1.1f},
      {{-2.1f, 0, -26}, 10, 3.2f, 0.8f, 1.1f},     {{-0.9f, 0, -26.3f}, 5, 2.9f, 1.1f, 1.1f},
      {{0.8f, 0, -26.2f}, -5, 3.1f, 0.9f, 0.5f},   {{2.1f, 0, -26}, -15, 3.3f, 1.12f, 0.8f},
      {{-3.5f, 0, -27.4f}, 40, 3.0f, 0.5f, 1.1f},  {{3.5f, 0, -27.6f}, -40, 3.2f, 1.1f, 1.1f},
      {{0.1f, 0, -28.8f}, 0, 3.2f, 0.6f, 1.12f}};
  uint32_t k = 0;
  for (const Guest& guest : kGuests) {
    const Figure figure{.hands = {{{-0.26f, guest.left, 0.12f}, {0.26f, guest.right, 0.12f}}},
                        .girth = k % 3 == 1 ? 1.15f : 1.0f,
                        .skirt = k % 2 == 1,
                        .long_hair = k % 2 == 1};
    const Vec3 feet = guest.feet + Vec3{0, kFloor, 0};
    party.thing("Guest", feet, Vec3{1, 1, 1} * guest.tall, guest.degrees, [&](Model& m, const Frame& f) {
      const int32_t skin =
          party.generator.color("skin", 0.55f + 0.3f * float(k % 3) / 2, 0.36f + 0.3f * float(k % 3) / 2,
                                0.26f + 0.26f * float(k % 3) / 2);
      add_figure(m, f, figure, 25'000,
                 {skin, party.dark, k % 4 ? party.dark : party.wood, party.color(k), party.color(k + 5),
                  party.dark});
    });
    party.thing("Hat", feet + Vec3{0, 1.045f * guest.tall, 0}, Vec3{0.045f, 0.075f, 0.045f} * guest.tall,
                guest.degrees, [&](Model& m, const Frame& f) {
                  add_lathe(m, f, kHat, 400, party.color(k + 7));
                  add_ball(m, f.inner({0, 1.05f, 0}, {0.3f, 0.18f, 0.3f}), 160, party.color(k + 2), 0.3f, 4);
                });
    ++k;
  }
}

// Adds balloons: below the ceiling, in bunches above the table's ends, and some on the floor.
void balloons(Party& party) {
  static constexpr Vec2 kKnot[] = {{-1, 1}, {1, 0.2f}};
  Random& random = party.random;
  for (uint32_t k = 0; k < 42; ++k) {
    const bool bunch = k < 12, fallen = k >= 26;
    const float side = k % 2 ? 1.0f : -1.0f, size = random.between(0.26f, 0.4f);
    Vec3 place{random.between(-4.1f, 4.1f), random.between(3, 3.8f), random.between(-30.3f, -22)};
    const Vec3 tie{side * 2.3f, kTableTop + 0.1f, kTableZ};
    if (bunch)
      place =
          tie + Vec3{random.between(-0.9f, 0.9f), random.between(1.4f, 2.6f), random.between(-0.8f, 0.8f)};
    if (fallen) place = {side * random.between(2.4f, 3.9f), kFloor + size, random.between(-23, -20.4f)};
    party.thing("Balloon", place, {size, size * 1.2f, size}, 0, [&](Model& m, const Frame& f) {
      add_ball(m, f, 1'600, party.color(k * 3 + k / 7));
      add_lathe(m, f.inner({0, -1.06f, 0}, {0.1f, 0.07f, 0.1f}), kKnot, 120, party.color(k * 3 + k / 7));
    });
  }
}

// Adds lines of flags, lanterns and a string of lamps across the hall.
void garlands(Party& party) {
  Random& random = party.random;
  const auto hang = [](const Vec3& a, const Vec3& b, float sag, float t) {
    return a + (b - a) * t - Vec3{0, 4 * sag * t * (1 - t), 0};
  };
  for (uint32_t k = 0; k < 4; ++k) {
    const bool lamps = k == 3;
    const float z = lamps ? -26.8f : -22.4f - 2.9f * float(k);
    const float y = random.between(3.2f, 3.9f), sag = random.between(0.3f, 0.5f);
    const Vec3 a{-kWide, y, z}, b{kWide, y + random.between(-0.2f, 0.2f), z};
    party.generator.model(lamps ? "Fairy_Lights" : "Garland", [&](Model& m) {
      add_cable(m, party.hall.at(a), party.hall.at(b), sag, 0.015f, 1'600, party.white);
      for (uint32_t i = 0; i < 24; ++i) {
        const Vec3 p = hang(a, b, sag, (float(i) + 0.5f) / 24);
        if (lamps)
          add_ball(m, party.hall.inner(p - Vec3{0, 0.07f, 0}, {0.05f, 0.07f, 0.05f}), 200, party.flame);
        else  // a flag that hangs with its point down
          add_patch(m, 64, 1, party.color(i + k), [&](float u, float v) {
            return party.hall.at(p +
                                 Vec3{(u - 0.5f) * 0.34f * (1 - v), -0.42f * v, 0.04f * wave(u + 0.3f * v)});
          });
      }
    });
  }
  for (uint32_t k = 0; k < 4; ++k)
    party.thing("Lantern",
                {-3.6f + 2.4f * float(k), 3.1f - 0.2f * float(k % 3), -29.5f + 1.1f * float(k % 4)},
                {0.28f, 0.22f, 0.28f}, 0, [&](Model& m, const Frame& f) {
                  for (int rib = 0; rib < 6; ++rib) {
                    const float y = 0.333f * float(rib) - 0.83f;
                    add_ring(m, f.inner({0, y, 0}, {1 - 0.5f * y * y, 0.18f, 1 - 0.5f * y * y}), 700,
                             party.color(k + 2), 0.2f);
                  }
                  add_cable(m, f.at(0, 1, 0), f.at(0, 5, 0), 0, 0.01f, 100, party.white);
                });
  party.thing("Disco_Ball", {0, 3.1f, -25.5f}, {0.45f, 0.45f, 0.45f}, 0,
              [&](Model& m, const Frame& f) { add_ball(m, f, 2'000, party.silver); });
}

// Writes PARTY on the back wall, a tube for each stroke.
void banner(Party& party) {
  using Stroke = std::vector<Vec2>;
  static const std::vector<std::vector<Stroke>> kLetters = {
      {{{0, 0}, {0, 1}, {0.6f, 1}, {0.75f, 0.75f}, {0.6f, 0.5f}, {0, 0.5f}}},
      {{{0, 0}, {0.4f, 1}, {0.8f, 0}}, {{0.18f, 0.4f}, {0.62f, 0.4f}}},
      {{{0, 0}, {0, 1}, {0.6f, 1}, {0.75f, 0.75f}, {0.6f, 0.5f}, {0, 0.5f}}, {{0.3f, 0.5f}, {0.8f, 0}}},
      {{{0, 1}, {0.8f, 1}}, {{0.4f, 1}, {0.4f, 0}}},
      {{{0, 1}, {0.4f, 0.5f}, {0.8f, 1}}, {{0.4f, 0.5f}, {0.4f, 0}}}};
  for (uint32_t k = 0; k < 5; ++k)
    party.generator.model("Letter", [&](Model& m) {
      for (const Stroke& stroke : kLetters[k]) {
        std::vector<Vec3> path;
        for (const Vec2& p : stroke)
          path.push_back(party.hall.at(-2.1f + 0.88f * float(k) + 0.85f * p[0], 1.9f + p[1], kBack + 0.25f));
        for (size_t i = 0; i + 1 < path.size(); ++i)
          add_cable(m, path[i], path[i + 1], 0, 0.07f, 900, party.color(k * 3));
        for (const Vec3& p : path) add_ball(m, upright(p, {0.07f, 0.07f, 0.07f}), 300, party.color(k * 3));
      }
    });
}

// Adds presents, chairs, loudspeakers and pictures.
void furniture(Party& party) {
  Random& random = party.random;
  for (uint32_t k = 0; k < 16; ++k) {
    const float side = k % 2 ? 1.0f : -1.0f, size = random.between(0.22f, 0.4f),
                stack = k < 12 ? 0.0f : 0.75f;
    const float out = side * random.between(1.6f, 3.3f), near = random.between(-22.6f, -20.8f),
                turned = random.between(0, 90);
    party.thing(
        "Present", {out, kFloor + size + stack, near}, {size, size, size}, turned,
        [&](Model& m, const Frame& f) {
          add_rounded_box(m, f, 2'400, party.color(k), 0.05f);
          add_rounded_box(m, f.inner({0, 0, 0}, {1.02f, 1.02f, 0.15f}), 900, party.color(k + 3), 0.05f);
          add_rounded_box(m, f.inner({0, 0, 0}, {0.15f, 1.02f, 1.02f}), 900, party.color(k + 3), 0.05f);
          for (const float bow : {-1.0f, 1.0f})
            add_ring(m, {f.x * 0.3f, f.z * 0.15f, f.y * 0.22f, f.at(0.3f * bow, 1.2f, 0)}, 500,
                     party.color(k + 3), 0.3f);
        });
  }
  for (uint32_t k = 0; k < 4; ++k)
    party.thing(
        "Chair", {-2.6f + 1.7f * float(k), kFloor + 0.75f, kTableZ + 1.5f}, {0.4f, 0.75f, 0.4f}, 180,
        [&](Model& m, const Frame& f) {
          add_rounded_box(m, f.inner({0, -0.05f, 0}, {1, 0.07f, 1}), 900, party.wood, 0.3f);
          add_rounded_box(m, f.inner({0, 0.75f, -0.95f}, {0.95f, 0.25f, 0.07f}), 900, party.wood, 0.3f);
          for (int leg = 0; leg < 4; ++leg) {
            const bool back = leg / 2 == 0;
            add_rounded_box(m,
                            f.inner({leg % 2 ? 0.9f : -0.9f, back ? 0 : -0.5f, back ? -0.9f : 0.9f},
                                    {0.08f, back ? 1.0f : 0.5f, 0.08f}),
                            300, party.wood, 0.2f);
          }
        });
  for (uint32_t k = 0; k < 4; ++k)
    party.thing(
        "Loudspeaker", {k % 2 ? 4.1f : -4.1f, kFloor + 0.7f + 1.2f * float(k / 2), -30.2f},
        {0.42f, 0.58f, 0.4f}, 0, [&](Model& m, const Frame& f) {
          add_rounded_box(m, f, 2'400, party.dark, 0.08f);
          for (const float y : {-0.4f, 0.45f})
            add_ring(m, {f.x * 0.6f, f.z * 0.1f, f.y * 0.45f, f.at(0, y, 1)}, 1'500, party.silver, 0.2f);
        });
  for (uint32_t k = 0; k < 8; ++k) {  // pictures on the side walls
    const float side = k % 2 ? 1.0f : -1.0f, along = -30 + 1.1f * float(k / 2);
    party.thing(
        "Picture", {side * (kWide - 0.04f), 0.9f, along}, {0.03f, 0.55f, 0.42f}, 0,
        [&](Model& m, const Frame& f) {
          add_rounded_box(m, f, 1'200, party.wood, 0.2f);
          add_rounded_box(m, f.inner({-0.8f * side, 0, 0}, {0.4f, 0.85f, 0.85f}), 600, party.color(k), 0.1f);
        });
  }
}

// Adds a garden far to the left of the hall, out of sight: a lawn and rows of bushes. In the published
// order of traversal, rays would also visit what lies behind the wall that they hit.
void garden(Party& party) {
  constexpr uint32_t kBushes = 183;
  const int32_t leaf = party.generator.color("leaf", 0.2f, 0.42f, 0.12f);
  party.generator.model("Garden", [&](Model& m) {
    add_patch(m, 30'000, 2, leaf, [&](float u, float v) {
      const float x = -190 + 84 * u, z = -15 - 46 * v;
      return party.hall.at(x, kFloor + 0.3f * fractal({x * 0.4f, 0, z * 0.4f}, 3), z);
    });
  });
  for (uint32_t k = 0; k < kBushes; ++k) {
    const uint64_t share = party.generator.rest() / (kBushes - k);
    const float x = -188 + 5.0f * float(k % 16), z = -18 - 4.2f * float(k / 16);
    party.thing("Bush", {x, kFloor, z}, {1.5f, 2, 1.5f}, 0, [&](Model& m, const Frame& f) {
      add_patch(m, share, 1, leaf, [&](float u, float v) {
        const float a = 2 * u - 1, b = 1 - 2 * v;
        return f.at(a, (1 - a * a) * (1 - b * b) * (1 + 0.3f * fractal({4 * a + x, 0, 4 * b}, 2)), b);
      });
    });
  }
}

void generate(Scene& scene, const LoadOptions& options) {
  static constexpr Vec3 kBright[] = {{0.85f, 0.1f, 0.12f}, {0.1f, 0.35f, 0.8f}, {0.95f, 0.75f, 0.1f},
                                     {0.45f, 0.12f, 0.6f}, {0.1f, 0.6f, 0.25f}, {0.9f, 0.35f, 0.1f},
                                     {0.1f, 0.65f, 0.7f},  {0.9f, 0.3f, 0.55f}, {0.95f, 0.6f, 0.65f},
                                     {0.55f, 0.8f, 0.2f},  {0.2f, 0.2f, 0.6f}};
  Generator generator(scene, options, kTriangles);
  Party party{generator, in_view_upright(scene.camera, 0)};
  for (const Vec3& c : kBright)
    party.colors.push_back(generator.color(fmt::format("paint_{}", party.colors.size()), c[0], c[1], c[2]));
  party.white = generator.color("white", 0.88f, 0.87f, 0.84f);
  party.wood = generator.color("wood", 0.5f, 0.33f, 0.2f);
  party.wall = generator.color("wall", 0.8f, 0.72f, 0.55f);
  party.dark = generator.color("dark", 0.08f, 0.06f, 0.06f);
  party.flame = generator.material("flame", diffuse_light(2, 1.8f, 1.3f));
  party.silver = generator.material("silver", metallic(0.85f, 0.85f, 0.88f, 0.1f));
  room(party);
  table(party);
  dishes(party);
  guests(party);
  balloons(party);
  garlands(party);
  banner(party);
  furniture(party);
  generator.model("Rug", [&](Model& m) {
    add_patch(m, 600, 1, party.color(5), [&](float u, float v) {
      return party.hall.at(7.2f * u - 3.6f, kFloor + 0.02f, kTableZ + 3 - 6 * v);
    });
  });
  generator.model("Floor", [&](Model& m) {
    add_patch(m, 400, 1, party.wood, [&](float u, float v) {
      return party.hall.at(kWide * (2 * u - 1), kFloor, kFront + (kBack - kFront) * v);
    });
  });
  garden(party);
  scene.note =
      "The scene is a procedural birthday party in a hall with about the original's triangle count (1.7M) "
      "and "
      "with its number of models (320).";
}

}  // namespace

Scene build_party(const LoadOptions& options, const std::string& original) {
  Scene scene;
  scene.name = "PARTY";
  scene.camera = {.eye = {-63.8803749f, 4.6838064f, 59.8617097f},
                  .target = {-63.1351023f, 4.7005949f, 59.1951612f},
                  .field_of_view = 20,
                  .focus_distance = 7};
  original.empty() ? generate(scene, options) : load_folder(scene, original, options, {});
  return scene;
}

}  // namespace glint::scenes

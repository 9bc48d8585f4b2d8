// Builds SHIP's generated form, a two-masted schooner of long thin triangles with the original's bounds.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "scenes/generate/tubes.h"
#include "scenes/lumibench/builders.h"

namespace glint::scenes {
namespace {

// Coordinates are in metres, y is up, the bow points towards +z, and the water line is near y = 0.
constexpr float kStern = -9.6f, kBow = 8.36f, kKeel = -1.36f;

struct Shipyard {
  Model ship;
  int32_t spar, sail, planks, dark_planks, rope, window, dark_wood, barrel, old_barrel, carriage, cannon;

  explicit Shipyard(Scene& scene) {
    const auto add = [&scene](const char* name, float r, float g, float b) {
      return add_material(scene, name, lambertian(r, g, b));
    };
    spar = add("spar", 0.37f, 0.30f, 0.22f);
    sail = add("sail", 0.88f, 0.84f, 0.76f);
    planks = add("planks", 0.62f, 0.47f, 0.31f);
    dark_planks = add("dark_planks", 0.27f, 0.19f, 0.12f);
    rope = add("rope", 0.76f, 0.66f, 0.42f);
    window = add("window", 0.95f, 0.80f, 0.40f);
    dark_wood = add("dark_wood", 0.17f, 0.12f, 0.07f);
    barrel = add("barrel", 0.44f, 0.34f, 0.22f);
    old_barrel = add("old_barrel", 0.36f, 0.33f, 0.27f);
    carriage = add("carriage", 0.38f, 0.24f, 0.14f);
    cannon = add("cannon", 0.16f, 0.16f, 0.17f);
  }
  void spar_between(const Vec3& a, const Vec3& b, float ra, float rb, uint32_t sides) {
    const Ring rings[] = {{0, ra}, {0.5f, 0.5f * (ra + rb) * 1.08f}, {1, rb}};
    add_turned_body(ship, a, b, rings, sides, true, spar);
  }
  void line(const Vec3& a, const Vec3& b) { add_rope(ship, a, b, 0.022f, rope); }
};

// Return the height of the rail, the half width at the rail, and the depth of the hull along the ship, from t
// = 0 (stern) to t = 1 (bow).
float rail_height(float t) {
  return 1.62f + 1.6f * (t - 0.45f) * (t - 0.45f) + (t < 0.2f ? 0.3f * (0.2f - t) : 0);
}
float half_width(float t) {
  const float fore = std::max((t - 0.45f) / 0.55f, 0.0f), aft = std::max((0.45f - t) / 0.45f, 0.0f);
  return 1.92f * (1 - fore * fore * fore) * (1 - 0.28f * aft * aft);
}
float keel_height(float t) {
  const float fore = std::max((t - 0.70f) / 0.30f, 0.0f), aft = std::max((0.2f - t) / 0.2f, 0.0f);
  return kKeel + 2.6f * fore * fore + 1.4f * aft * aft;
}
float along(float t) {
  return kStern + (kBow - kStern) * t;
}
float station(float z) {
  return (z - kStern) / (kBow - kStern);
}

// Returns a point of the planking, from v = 0 at the keel to v = 1 at the rail. The bow rakes forward.
Vec3 hull_point(float t, float v, float side) {
  const float low = keel_height(t), high = rail_height(t);
  const float bulge = std::sqrt(std::max(v * (2 - v), 0.0f)) * (1 - 0.06f * v * v);
  const float rake = std::max(t - 0.8f, 0.0f) * 5 * (v - 1) * 1.1f;
  return {side * half_width(t) * bulge, low + (high - low) * v, along(t) + rake};
}

void build_hull(Shipyard& yard) {
  for (const float side : {-1.0f, 1.0f}) {
    const auto outside = [side](float u, float v) { return hull_point(side > 0 ? 1 - u : u, v, side); };
    add_sheet(yard.ship, 24, 7, yard.planks, outside);
    const auto inside = [side](float u, float v) {
      const float t = side > 0 ? u : 1 - u;
      Vec3 p = hull_point(t, 0.72f + 0.28f * v, side);
      p[0] -= side * 0.12f * std::min(half_width(t), 1.0f);
      return p;
    };
    add_sheet(yard.ship, 24, 1, yard.dark_planks, inside);
    // These are the rail's cap and two rubbing strakes.
    for (const float height : {1.0f, 0.83f, 0.62f}) {
      const float thickness = height == 1.0f ? 0.07f : 0.045f;
      const auto strake = [=](float u, float v) {
        const float angle = v * 2 * float(std::numbers::pi);
        Vec3 p = hull_point(u, height, side);
        p[0] += side * thickness * cosine(angle);
        p[1] += thickness * sine(side > 0 ? angle : -angle);
        return p;
      };
      add_sheet(yard.ship, 16, 3, yard.dark_planks, strake);
    }
  }
  const auto transom = [](float u, float v) { return hull_point(0, v, 1 - 2 * u); };
  add_sheet(yard.ship, 5, 5, yard.planks, transom);
  const auto deck = [](float u, float v) {
    const float t = 1 - 0.985f * u;
    const float x = half_width(t) * (2 * v - 1) * 0.97f;
    return Vec3{x, rail_height(t) - 0.72f - 0.03f * x * x, along(t)};
  };
  add_sheet(yard.ship, 16, 2, yard.planks, deck);
  add_box(yard.ship, {-0.06f, kKeel - 0.0f, -8}, {0.06f, kKeel + 0.12f, 3}, yard.dark_planks);
  add_box(yard.ship, {-0.05f, -0.7f, kStern - 0.3f}, {0.05f, 1.2f, kStern + 0.1f}, yard.dark_planks);
}

float deck_height(float z) {
  return rail_height(station(z)) - 0.72f;
}

struct Mast {
  float z, top;
};
constexpr Mast kMasts[] = {{-3.2f, 15.43f}, {3.4f, 14.9f}};  // main, fore

void build_spars(Shipyard& yard) {
  for (const Mast& mast : kMasts) {
    yard.spar_between({0, 0.5f, mast.z}, {0, 10.4f, mast.z - 0.5f}, 0.19f, 0.14f, 10);
    yard.spar_between({0, 9.6f, mast.z - 0.3f}, {0, mast.top, mast.z - 0.72f}, 0.10f, 0.03f, 8);
    add_box(yard.ship, {-0.3f, 9.7f, mast.z - 0.75f}, {0.3f, 9.8f, mast.z - 0.1f}, yard.spar);
  }
  yard.spar_between({0, 1.7f, 6.6f}, {0, 3.3f, 13.78f}, 0.17f, 0.05f, 8);         // bowsprit
  yard.spar_between({0, 2.5f, -3.5f}, {0, 3.0f, -13.78f}, 0.11f, 0.06f, 8);       // main boom
  yard.spar_between({0, 8.4f, -3.6f}, {0, 11.2f, -9.8f}, 0.08f, 0.04f, 8);        // main gaff
  yard.spar_between({0, 2.4f, 3.1f}, {0, 2.6f, -2.4f}, 0.09f, 0.06f, 8);          // fore boom
  yard.spar_between({0, 8.2f, 2.9f}, {0, 10.4f, -1.2f}, 0.07f, 0.04f, 8);         // fore gaff
  yard.spar_between({-3.9f, 9.4f, 3.3f}, {3.9f, 9.4f, 3.3f}, 0.08f, 0.08f, 8);    // fore yard
  yard.spar_between({-2.7f, 12.9f, 3.0f}, {2.7f, 12.9f, 3.0f}, 0.06f, 0.06f, 8);  // topsail yard
}

// Adds a sail over four corners in turn (u = 0 is the edge at the mast), filled out to the side by `belly`.
void add_sail(Shipyard& yard, const std::array<Vec3, 4>& c, const Vec3& belly, uint32_t columns,
              uint32_t rows) {
  add_sheet(yard.ship, columns, rows, yard.sail, [=](float u, float v) {
    const Vec3 low = c[0] * (1 - u) + c[1] * u, high = c[3] * (1 - u) + c[2] * u;
    return low * (1 - v) + high * v + belly * (16 * u * (1 - u) * v * (1 - v) * (1.2f - 0.4f * v));
  });
}

void build_sails(Shipyard& yard) {
  add_sail(yard, {{{0, 2.7f, -3.6f}, {0, 3.15f, -13.3f}, {0, 11.1f, -9.6f}, {0, 8.3f, -3.8f}}}, {0.9f, 0, 0},
           8, 8);
  add_sail(yard, {{{0, 2.6f, 3.0f}, {0, 2.75f, -2.2f}, {0, 10.3f, -1.1f}, {0, 8.1f, 2.8f}}}, {0.7f, 0, 0}, 6,
           8);
  add_sail(yard, {{{0, 8.8f, -3.75f}, {0, 11.2f, -9.5f}, {0, 14.8f, -3.95f}, {0, 14.9f, -3.9f}}},
           {0.3f, 0, 0}, 5, 5);
  add_sail(yard, {{{-3.3f, 9.5f, 3.4f}, {3.3f, 9.5f, 3.4f}, {2.4f, 12.85f, 3.1f}, {-2.4f, 12.85f, 3.1f}}},
           {0, 0, 0.7f}, 7, 5);
  const Vec3 jibs[3][3] = {{{0, 2.45f, 9.6f}, {0, 3.3f, 5.2f}, {0, 9.4f, 3.5f}},
                           {{0, 2.9f, 11.6f}, {0, 3.9f, 6.3f}, {0, 11.4f, 3.6f}},
                           {{0, 3.35f, 13.6f}, {0, 5.2f, 8.6f}, {0, 13.6f, 3.5f}}};
  for (const auto& [tack, clew, head] : jibs)
    add_sail(yard, {{tack, clew, head + Vec3{0, -0.02f, -0.05f}, head}}, {0.45f, 0, -0.1f}, 4, 5);
}

void build_shrouds(Shipyard& yard) {
  constexpr int kShrouds = 6, kRatlines = 10;
  for (const Mast& mast : kMasts)
    for (const float side : {-1.0f, 1.0f}) {
      const auto foot = [&](float i) {
        const float z = mast.z + 0.5f - i * 0.42f;
        return hull_point(station(z), 1, side) + Vec3{side * 0.06f, 0, 0};
      };
      const Vec3 head{side * 0.12f, 9.7f, mast.z - 0.45f};
      for (int i = 0; i < kShrouds; ++i) yard.line(foot(float(i)), head);
      for (int i = 1; i <= kRatlines; ++i) {
        const float t = float(i) / (kRatlines + 2.5f);
        yard.line(foot(0) + (head - foot(0)) * t, foot(kShrouds - 1) + (head - foot(kShrouds - 1)) * t);
      }
      // This line goes from the crosstree to the head of the topmast.
      yard.line({side * 0.3f, 9.8f, mast.z - 0.2f}, {0, mast.top - 0.5f, mast.z - 0.7f});
      yard.line({side * 0.3f, 9.8f, mast.z - 0.7f}, {0, mast.top - 0.5f, mast.z - 0.7f});
      yard.line(foot(7.5f), {0, mast.top - 0.6f, mast.z - 0.7f});
    }
}

void build_stays(Shipyard& yard) {
  const Vec3 lines[][2] = {
      {{0, 9.7f, 3.1f}, {0, 2.4f, 9.7f}},        {{0, 11.7f, 2.9f}, {0, 2.85f, 11.7f}},
      {{0, 14.0f, 2.75f}, {0, 3.3f, 13.7f}},     {{0, 10.2f, -3.5f}, {0, 10.3f, 3.0f}},
      {{0, 15.2f, -3.9f}, {0, 14.6f, 2.7f}},     {{0, 10.0f, -3.6f}, {0, 11.1f, -9.7f}},
      {{0, 14.9f, -3.9f}, {0, 11.2f, -9.7f}},    {{0, 11.1f, -9.7f}, {0, 3.0f, -13.7f}},
      {{0, 9.9f, 3.0f}, {0, 10.35f, -1.15f}},    {{0, 10.3f, -1.15f}, {0, 2.6f, -2.35f}},
      {{0, 3.0f, -13.0f}, {0, 1.9f, -9.3f}},     {{0, 2.9f, -11.0f}, {0, 1.8f, -9.0f}},
      {{0, 3.3f, 13.7f}, {0, -0.1f, 7.3f}},      {{0, 2.6f, 10.8f}, {0, 0.3f, 7.5f}},
      {{-3.8f, 9.4f, 3.3f}, {0, 11.8f, 3.0f}},   {{3.8f, 9.4f, 3.3f}, {0, 11.8f, 3.0f}},
      {{-2.6f, 12.9f, 3.0f}, {0, 14.4f, 2.75f}}, {{2.6f, 12.9f, 3.0f}, {0, 14.4f, 2.75f}},
      {{-3.8f, 9.4f, 3.3f}, {-1.9f, 1.7f, -2}},  {{3.8f, 9.4f, 3.3f}, {1.9f, 1.7f, -2}},
      {{-2.6f, 12.9f, 3.0f}, {0, 9.8f, -3.2f}},  {{2.6f, 12.9f, 3.0f}, {0, 9.8f, -3.2f}},
      {{0, 3.3f, 5.2f}, {1.4f, 1.9f, 2.4f}},     {{0, 3.9f, 6.3f}, {1.5f, 1.9f, 1.9f}},
      {{0, 5.2f, 8.6f}, {1.6f, 1.9f, 1.4f}},     {{0, 2.6f, -2.0f}, {0.8f, 1.1f, -2.4f}},
  };
  for (const auto& [a, b] : lines) yard.line(a, b);
}

void build_barrels(Shipyard& yard) {
  const auto place_barrel = [&yard](float x, float z, float height, float radius, uint32_t sides,
                                    int32_t material) {
    const float y = deck_height(z);
    const Ring rings[] = {{0, radius * 0.8f},
                          {0.25f, radius * 0.96f},
                          {0.5f, radius},
                          {0.75f, radius * 0.96f},
                          {1, radius * 0.8f}};
    add_turned_body(yard.ship, {x, y, z}, {x, y + height, z}, rings, sides, true, material);
  };
  for (int i = 0; i < 8; ++i)
    place_barrel((i % 2 ? 0.32f : -0.36f), -0.5f - 0.62f * float(i / 2) + 0.1f * float(i % 2), 0.66f, 0.25f,
                 12, yard.barrel);
  for (int i = 0; i < 5; ++i)
    place_barrel((i % 2 ? 1.05f : -1.1f), -7.2f + 2.3f * float(i), 0.56f, 0.21f, 10, yard.old_barrel);
}

void build_guns(Shipyard& yard) {
  for (int i = 0; i < 8; ++i) {
    const float side = i % 2 ? 1.0f : -1.0f, z = -5.6f + 2.65f * float(i / 2);
    const float x = side * (half_width(station(z)) - 0.55f), y = deck_height(z);
    add_box(yard.ship, {x - 0.32f, y + 0.12f, z - 0.17f}, {x + 0.32f, y + 0.26f, z + 0.17f}, yard.carriage);
    for (const float w : {-0.17f, 0.13f})
      add_box(yard.ship, {x - 0.3f, y + 0.26f, z + w}, {x + 0.3f, y + 0.42f, z + w + 0.04f}, yard.carriage);
    const Ring wheel[] = {{0, 0.11f}, {1, 0.11f}};
    add_turned_body(yard.ship, {x - 0.2f, y + 0.1f, z - 0.22f}, {x - 0.2f, y + 0.1f, z + 0.22f}, wheel, 6,
                    true, yard.carriage);
    add_turned_body(yard.ship, {x + 0.2f, y + 0.1f, z - 0.22f}, {x + 0.2f, y + 0.1f, z + 0.22f}, wheel, 6,
                    true, yard.carriage);
    const Ring barrel[] = {{0, 0.05f}, {0.06f, 0.13f}, {0.5f, 0.105f}, {0.94f, 0.08f}, {1, 0.10f}};
    add_turned_body(yard.ship, {x - side * 0.4f, y + 0.42f, z}, {x + side * 0.85f, y + 0.47f, z}, barrel, 7,
                    true, yard.cannon);
  }
}

void build_deck_houses(Shipyard& yard) {
  Model& ship = yard.ship;
  const float aft = deck_height(-7), fore = deck_height(5);
  add_box(ship, {-1.0f, aft, -8.4f}, {1.0f, aft + 0.8f, -6.0f}, yard.dark_planks);
  add_box(ship, {-1.1f, aft + 0.8f, -8.5f}, {1.1f, aft + 0.88f, -5.9f}, yard.planks);
  for (const float z : {-8.0f, -7.2f, -6.5f})
    add_box(ship, {-1.02f, aft + 0.35f, z - 0.15f}, {1.02f, aft + 0.6f, z + 0.15f}, yard.window);
  add_box(ship, {-0.5f, fore, 4.5f}, {0.5f, fore + 0.35f, 6.0f}, yard.dark_wood);
  add_box(ship, {-0.45f, deck_height(0), 0.1f}, {0.45f, deck_height(0) + 0.25f, 1.5f}, yard.dark_wood);
  const Vec3 hub{0, aft + 1.35f, -5.6f};
  for (int i = 0; i < 4; ++i) {  // the wheel's spokes
    const double angle = std::numbers::pi * i / 4;
    const Vec3 reach{0.45f * cosine(angle), 0.45f * sine(angle), 0};
    const Ring spoke[] = {{0, 0.025f}, {1, 0.025f}};
    add_turned_body(ship, hub - reach, hub + reach, spoke, 4, true, yard.dark_wood);
  }
  add_box(ship, {-0.08f, aft, -5.75f}, {0.08f, hub[1], -5.62f}, yard.dark_wood);
  for (int i = 0; i < 20; ++i)  // stanchions of the rail
    for (const float side : {-1.0f, 1.0f}) {
      const float t = 0.05f + 0.043f * float(i);
      const Vec3 p = hull_point(t, 1, side) - Vec3{side * 0.1f, 0, 0};
      add_box(ship, p - Vec3{0.04f, 0.7f, 0.05f}, p + Vec3{0.04f, -0.04f, 0.05f}, yard.dark_planks);
    }
}

}  // namespace

Model make_schooner(Scene& scene) {
  Shipyard yard(scene);
  yard.ship.name = "schooner";
  build_hull(yard);
  build_spars(yard);
  build_sails(yard);
  build_shrouds(yard);
  build_stays(yard);
  build_barrels(yard);
  build_guns(yard);
  build_deck_houses(yard);
  return std::move(yard.ship);
}

}  // namespace glint::scenes

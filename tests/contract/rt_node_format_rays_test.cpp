// Tests that rays find to the bit in every node format what tests of every primitive find, under all flags.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/registry.h"
#include "rtunit/structure/validate.h"
#include "tests/support/catch.h"
#include "tests/support/rt_brute.h"

namespace glint::rt::test {
namespace {

Positions scaled(Positions p, float scale, std::array<float, 3> move = {}) {
  for (auto& x : p)
    for (size_t a = 0; a < 3; ++a) x[a] = x[a] * scale + move[a];
  return p;
}

// Returns triangles with points, lines and not-a-numbers among them, several of them twice.
Positions with_degenerate(Random& random, Positions p) {
  for (int i = 0; i < 20; ++i) {
    const size_t at = 3 * random.below(uint32_t(p.size() / 3)),
                 from = 3 * random.below(uint32_t(p.size() / 3));
    switch (random.below(4)) {
      case 0:
        p[at + 1] = p[at];
        break;
      case 1:
        p[at] = p[at + 1] = p[at + 2];
        break;
      case 2:
        p[at][random.below(3)] = NAN;
        break;
      default:
        for (size_t c = 0; c < 3; ++c) p[at + c] = p[from + c];
    }
  }
  return p;
}

std::vector<Bounds> some_boxes(Random& random, int count, float size) {
  std::vector<Bounds> out;
  for (int i = 0; i < count; ++i) {
    const auto p = random.point(size), s = random.point(size / 8);
    Bounds box{p, p};
    for (size_t a = 0; a < 3; ++a) box.high[a] += random.below(5) ? std::fabs(s[a]) : 0;  // some are flat
    if (random.below(10) == 0) box.low[0] = NAN;
    out.push_back(i % 7 == 6 ? out.back() : box);
  }
  return out;
}

struct Named {
  const char* name;
  Scene scene;
  float size = 10;  // rays start within twice this size around `center`, and aim at what is there
  std::array<float, 3> center{};
};

Named mixed(uint64_t seed) {
  Random random{seed};
  Named out{"mixed", {}, 10};
  BottomScene& all = out.scene.bottoms.emplace_back();
  all.add_triangles(with_degenerate(random, soup(random, 60, 10, 4)), true);
  all.add_triangles(with_degenerate(random, soup(random, 40, 10, 4)), false);
  all.add_boxes(some_boxes(random, 25, 10), seed % 2);
  out.scene.bottoms.emplace_back().add_triangles(soup(random, 1, 8, 8), true);
  out.scene.bottoms.emplace_back();
  out.scene.bottoms.emplace_back().add_boxes(some_boxes(random, 1, 5), false);
  for (uint32_t i = 0; i < 20; ++i) {
    Instance instance;
    instance.transform = random_transform(random, random.uniform(0.2f, 1.2f) * (i % 2 ? 1.f : -1.f), 10);
    instance.bottom = i % 4;
    instance.flags = random.below(16);
    instance.mask = random.below(3) ? 0xff : 1u << random.below(8);
    if (i % 5 == 4) instance.transform = out.scene.instances[i - 4].transform;  // at exactly the same place
    out.scene.instances.push_back(instance);
  }
  return out;
}

Named plain(const char* name, BottomScene bottom, float size) {
  Named out{name, {}, size};
  out.scene.bottoms.push_back(std::move(bottom));
  out.scene.instances.resize(1);
  return out;
}

std::vector<Named> scenes() {
  std::vector<Named> out;
  out.push_back(mixed(1));
  out.push_back(mixed(2));
  Random random{77};
  for (float scale : {1e-12f, 1e12f}) {
    BottomScene b;
    b.add_triangles(scaled(soup(random, 80, 10, 5), scale), true);
    out.push_back(plain(scale < 1 ? "tiny" : "huge", std::move(b), 10 * scale));
  }
  BottomScene far_off, spread, same, one, one_box;
  far_off.add_triangles(scaled(soup(random, 80, 10, 5), 1, {3e5f, -2e6f, 1e4f}), true);
  out.push_back(plain("far from the origin", std::move(far_off), 10));
  out.back().center = {3e5f, -2e6f, 1e4f};
  for (int i = 0; i < 40;
       ++i)  // each triangle is half as large as the one before, which gives unbalanced trees
    spread.add_triangles(scaled({{-1, -1, -1}, {2, 0, 1}, {0, 2, 1}}, std::ldexp(1.f, -i)), true);
  out.push_back(plain("of all sizes", std::move(spread), 1));
  Positions copies;
  for (int i = 0; i < 100; ++i) copies.insert(copies.end(), {{-5, -4, 0}, {6, -3, 1}, {0, 7, 2}});
  same.add_triangles(copies, true);
  same.add_triangles(copies, false);
  out.push_back(plain("in one place", std::move(same), 5));
  one.add_triangles({{-5, -4, 0}, {6, -3, 1}, {0, 7, 2}}, true);
  out.push_back(plain("one triangle", std::move(one), 5));
  one_box.add_boxes({{{-3, -3, -3}, {3, 3, 3}}}, true);
  out.push_back(plain("one box", std::move(one_box), 5));
  out.push_back(plain("nothing", {}, 5));
  out.push_back({"no instances", {}, 5});
  return out;
}

RayState random_ray(Random& random, Address top, float size, std::array<float, 3> center = {}) {
  static constexpr uint32_t kFlags[] = {0,     0,     1,    2,    0x10, 0x20, 0x40, 0x80,
                                        0x100, 0x200, 0x11, 0x22, 0x42, 0x81, 0x110};
  auto origin = random.point(2 * size);
  const auto target = random.point(size / 2);
  std::array<float, 3> direction;
  for (size_t a = 0; a < 3; ++a) direction[a] = random.below(12) ? target[a] - origin[a] : 0;
  for (size_t a = 0; a < 3; ++a) origin[a] += center[a];
  RayState state = ray_of(top, origin, direction, random.below(2) ? 0.f : random.uniform(0, 1),
                          random.below(4) ? 1e30f : random.uniform(1, 2), kFlags[random.below(15)]);
  state.ray.cull_mask = random.below(3) ? 0xff : random.bits() & 0xff;
  return state;
}

bool same(const Hit& a, const Hit& b) {
  return std::memcmp(&a.t, &b.t, sizeof a.t) == 0 && a.u == b.u && a.v == b.v && a.kind == b.kind &&
         a.instance == b.instance && a.geometry == b.geometry && a.primitive == b.primitive;
}

// Compares one ray in one format. For a ray that any hit ends, the hit only has to be one of all.
void check_ray(const BuiltScene& built, RayState state, const std::vector<Hit>& expected) {
  state.ray.structure = built.top.address;
  REQUIRE(begin(state, built.memory));
  run_to_end(state, built.memory);
  REQUIRE_FALSE(state.broken);
  REQUIRE(state.committed.valid() == !expected.empty());
  if (!expected.empty()) REQUIRE(same(state.committed, expected[0]));
  state.ray.flags |= ray_flag::kTerminateOnFirstHit;
  REQUIRE(begin(state, built.memory));
  run_to_end(state, built.memory);
  REQUIRE(state.committed.valid() == !expected.empty());
  if (expected.empty()) return;
  const auto found = std::find_if(expected.begin(), expected.end(),
                                  [&](const Hit& hit) { return same(state.committed, hit); });
  REQUIRE(found != expected.end());
}

TEST_CASE("in every node format a ray finds what testing every primitive finds") {
  uint32_t hits = 0;
  for (const Named& named : scenes()) {
    const BuiltScene reference(named.scene, "bvh6");
    const BruteForce brute(named.scene, reference);
    std::vector<std::unique_ptr<BuiltScene>> built;
    for (const std::string& name : Registry<NodeFormat>::names()) {
      built.push_back(std::make_unique<BuiltScene>(named.scene, name));
      CAPTURE(named.name, name);
      CHECK(validate(built.back()->memory, built.back()->top.address).empty());
      CHECK(BruteForce(named.scene, *built.back()).num_instances() == brute.num_instances());
    }
    Random random{5};
    for (int i = 0; i < 400; ++i) {
      const RayState ray = random_ray(random, 0, named.size, named.center);
      const std::vector<Hit> expected = brute.hits(ray.ray);
      hits += !expected.empty();
      for (size_t f = 0; f < built.size(); ++f) {
        CAPTURE(named.name, Registry<NodeFormat>::names()[f], i, ray.ray.flags);
        check_ray(*built[f], ray, expected);
      }
    }
  }
  CHECK(hits > 1000);
}

TEST_CASE("in every node format a lane's timed ray ends as the functional one, with every request size") {
  const Named named = mixed(3);
  for (const std::string& name : Registry<NodeFormat>::names()) {
    const BuiltScene built(named.scene, name);
    const uint32_t node_bytes = make_format(name)->node_bytes();
    for (uint32_t request_bytes : {32u, 64u, 128u}) {
      CAPTURE(name, request_bytes);
      Random random{request_bytes};
      std::vector<WarpRays> timed(3);
      for (WarpRays& warp : timed)
        for (RayState& state : warp) {
          state = random_ray(random, built.top.address, 10);
          REQUIRE(begin(state, built.memory));
        }
      std::vector<WarpRays> functional = timed;
      Params params;
      params.request_bytes = request_bytes;
      mem::FixedLatencyMemory l1(20, 2);
      RtUnit unit(params, {built.memory, l1});
      launch(unit, l1, timed, false);
      for (size_t w = 0; w < timed.size(); ++w)
        for (size_t lane = 0; lane < kLanes; ++lane) {
          run_to_end(functional[w][lane], built.memory);
          REQUIRE(timed[w][lane].status == RayStatus::Done);
          REQUIRE(same(timed[w][lane].committed, functional[w][lane].committed));
          REQUIRE(timed[w][lane].nodes_visited == functional[w][lane].nodes_visited);
        }
      // A node's bytes lie in sectors of 32, so there is at most one more than its size needs when it begins
      // within one.
      const RtStats& s = unit.stats();
      const uint64_t leaves = s.fetches.value() * 128;
      CHECK(s.sectors.value() * 32 >= s.fetches.value() * std::min(64u, node_bytes));
      CHECK(s.sectors.value() * 32 <= s.fetches.value() * (node_bytes + 16) + leaves);
    }
  }
}

}  // namespace
}  // namespace glint::rt::test

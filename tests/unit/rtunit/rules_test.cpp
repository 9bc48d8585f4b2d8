// Tests Vulkan's traversal rules, one by one: flags, masks, intervals, opacity, facing, shaders' answers.
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstring>
#include <utility>

#include "base/registry.h"
#include "rtunit/leaf_filter.h"
#include "tests/support/catch.h"
#include "tests/support/rt_scenes.h"

namespace glint::rt::test {
namespace {

// Returns a triangle that is counterclockwise seen from +z. A ray along -z sees its front (normal towards the
// origin of the ray).
Positions triangle_at(float z) {
  return {{-1, -1, z}, {3, -1, z}, {-1, 3, z}};
}

struct World {
  mem::AddressSpace memory;
  StructureInfo top;
  explicit World(const BottomLevel& bottom, Instance instance = {}) {
    const StructureInfo built = build_bottom(memory, "bottom", bottom);
    top = build_top(memory, "top", std::vector{instance}, std::vector{built});
  }
  // Shoots a ray from (0, 0, 10) towards -z, so that z = 10 - t.
  RayState shoot(uint32_t flags = 0, float t_min = 0, float t_max = 100, uint32_t mask = 0xff) const {
    RayState state = ray_of(top.address, {0, 0, 10}, {0, 0, -1}, t_min, t_max, flags);
    state.ray.cull_mask = mask;
    REQUIRE(begin(state, memory));
    run(state, memory);
    return state;
  }
};

World one_triangle(bool opaque = true, Instance instance = {}, float z = 0) {
  const Positions p = triangle_at(z);
  return World({{triangles(p, opaque)}}, instance);
}
Instance with_flags(uint32_t flags) {
  Instance out;
  out.flags = flags;
  return out;
}
World one_box(bool opaque, Instance instance = {}) {
  const Bounds box{{-1, -1, -1}, {1, 1, 1}};
  Geometry g;
  g.aabbs = {&box, 1};
  g.opaque = opaque;
  return World({{g}}, instance);
}

TEST_CASE("a hit reports distance, weights, kind and what was hit") {
  Instance instance;
  instance.custom_index = 0xabcdef;
  instance.sbt_offset = 0x123456;
  instance.mask = 0x40;
  const World world = one_triangle(true, instance);
  const Hit hit = world.shoot().committed;
  REQUIRE(hit.valid());
  CHECK(hit.t == 10);
  CHECK(hit.u == 0.25f);
  CHECK(hit.v == 0.25f);
  CHECK(hit.kind == kHitKindFront);
  CHECK(hit.instance == 0);
  CHECK(hit.custom_index == 0xabcdef);
  CHECK(hit.sbt_record == 0x123456);
  InstanceLeaf leaf;
  std::memcpy(&leaf, world.memory.find(hit.instance_leaf, sizeof leaf), sizeof leaf);
  CHECK(leaf.object_to_world == kIdentity);
  CHECK(leaf.world_to_object == kIdentity);
}

TEST_CASE("a triangle's interval is open at both ends") {
  const World world = one_triangle();
  CHECK(world.shoot(0, 9.999f, 10.001f).committed.valid());
  CHECK_FALSE(world.shoot(0, 10, 20).committed.valid());
  CHECK_FALSE(world.shoot(0, 0, 10).committed.valid());
  CHECK(world.shoot(0, 0, std::nextafter(10.f, 11.f)).committed.valid());
  CHECK(world.shoot(0, std::nextafter(10.f, 9.f), 20).committed.valid());
  const RayState miss = world.shoot(0, 0, 5);
  CHECK(miss.status == RayStatus::Done);
  CHECK(miss.committed.t == 5);
}

TEST_CASE("a triangle at the ray's end stays out when a box's hit lies there") {
  const Positions p = triangle_at(0);
  const Bounds box{{-1, -1, -1}, {1, 1, 1}};
  Geometry procedural;
  procedural.aabbs = {&box, 1};
  mem::AddressSpace memory;
  Instance of_triangle, of_box;
  of_box.bottom = 1;
  const std::vector built{build_bottom(memory, "triangle", {{triangles(p, true)}}),
                          build_bottom(memory, "box", {{procedural}})};
  const StructureInfo top = build_top(memory, "top", std::vector{of_triangle, of_box}, built);
  RayState state = ray_of(top.address, {0, 0, 10}, {0, 0, -1}, 0, 10, 0);
  REQUIRE(begin(state, memory));
  run(state, memory);
  REQUIRE(state.status == RayStatus::NeedsIntersection);  // the box is nearer and comes first
  report(state, 10, 5);
  if (state.status == RayStatus::NeedsAnyHit) accept_candidate(state);
  finish_intersection(state);
  run(state, memory);
  CHECK(state.committed.instance == 1);
  CHECK(state.committed.t == 10);
}

TEST_CASE("an instance is visited only when its mask shares a bit with the ray's low eight") {
  Instance instance;
  instance.mask = 0x12;
  const World world = one_triangle(true, instance);
  CHECK(world.shoot(0, 0, 100, 0x02).committed.valid());
  CHECK(world.shoot(0, 0, 100, 0x10).committed.valid());
  CHECK_FALSE(world.shoot(0, 0, 100, 0xed).committed.valid());
  CHECK_FALSE(world.shoot(0, 0, 100, 0x1200).committed.valid());
}

TEST_CASE("facing culls by winding, flipped or disabled by the instance") {
  const World plain = one_triangle(), flipped = one_triangle(true, with_flags(instance_flag::kFlipFacing)),
              disabled = one_triangle(true, with_flags(instance_flag::kFacingCullDisable));
  CHECK(plain.shoot(ray_flag::kCullBackFacing).committed.valid());
  CHECK_FALSE(plain.shoot(ray_flag::kCullFrontFacing).committed.valid());
  CHECK(flipped.shoot().committed.kind == kHitKindBack);
  CHECK_FALSE(flipped.shoot(ray_flag::kCullBackFacing).committed.valid());
  CHECK(flipped.shoot(ray_flag::kCullFrontFacing).committed.valid());
  CHECK(disabled.shoot(ray_flag::kCullFrontFacing).committed.valid());
  CHECK(disabled.shoot(ray_flag::kCullBackFacing).committed.kind == kHitKindFront);
}

TEST_CASE("a mirroring instance does not change which side is the front") {
  Instance mirror;
  mirror.transform = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  CHECK(one_triangle(true, mirror).shoot().committed.kind == kHitKindFront);
}

TEST_CASE("opacity: the ray's flag beats the instance's, which beats the geometry's") {
  using namespace instance_flag;
  const auto status = [](bool opaque, uint32_t instance_flags, uint32_t ray_flags) {
    return one_triangle(opaque, with_flags(instance_flags)).shoot(ray_flags).status;
  };
  CHECK(status(true, 0, 0) == RayStatus::Done);
  CHECK(status(false, 0, 0) == RayStatus::NeedsAnyHit);
  CHECK(status(false, kForceOpaque, 0) == RayStatus::Done);
  CHECK(status(true, kForceNoOpaque, 0) == RayStatus::NeedsAnyHit);
  CHECK(status(true, kForceNoOpaque, ray_flag::kOpaque) == RayStatus::Done);
  CHECK(status(true, kForceOpaque, ray_flag::kNoOpaque) == RayStatus::NeedsAnyHit);
}

TEST_CASE("opaque and non-opaque geometry is culled by its final opacity") {
  CHECK_FALSE(one_triangle(true).shoot(ray_flag::kCullOpaque).committed.valid());
  CHECK(one_triangle(true).shoot(ray_flag::kCullNoOpaque).committed.valid());
  CHECK(one_triangle(false).shoot(ray_flag::kCullNoOpaque).status == RayStatus::Done);
  CHECK(one_triangle(false).shoot(ray_flag::kCullOpaque).status == RayStatus::NeedsAnyHit);
  CHECK(one_triangle(false).shoot(ray_flag::kCullNoOpaque | ray_flag::kOpaque).committed.valid());
  CHECK(one_box(true).shoot(ray_flag::kCullOpaque).status == RayStatus::Done);
  CHECK(one_box(false).shoot(ray_flag::kCullOpaque).status == RayStatus::NeedsIntersection);
}

// Returns what becomes of a ray that meets a triangle whose map comes first and has one state all over.
RayState with_map(MicroState map, bool opaque, uint32_t instance_flags, uint32_t ray_flags) {
  const Positions p = triangle_at(0);
  Geometry geometry = triangles(p, opaque);
  const Micromaps maps{{}, {Micromaps::uniform(map)}, {}, true};
  geometry.micromaps = &maps;
  const World world({{geometry}}, with_flags(instance_flags));
  const auto filter =
      Registry<LeafFilter>::instance().entry("micromaps").make_default({nullptr, world.memory});
  RayState state = ray_of(world.top.address, {0, 0, 10}, {0, 0, -1}, 0, 100, ray_flags);
  state.filter = filter.get();
  REQUIRE(begin(state, world.memory));
  run(state, world.memory);
  return state;
}

TEST_CASE(
    "a map that comes first stands for the geometry's opacity, and its transparent parts beat all flags") {
  using namespace instance_flag;
  const auto hits = [](auto... all) {
    const RayState state = with_map(all...);
    return state.status == RayStatus::Done && state.committed.valid();
  };
  const auto asks = [](auto... all) { return with_map(all...).status == RayStatus::NeedsAnyHit; };
  for (const bool opaque : {false, true}) {
    for (const uint32_t of_instance : {0u, kForceOpaque, kForceNoOpaque})
      for (const uint32_t of_ray : {0u, ray_flag::kOpaque, ray_flag::kNoOpaque}) {
        const RayState state = with_map(MicroState::Transparent, opaque, of_instance, of_ray);
        CHECK(state.status == RayStatus::Done);
        CHECK_FALSE(state.committed.valid());
      }
    CHECK(hits(MicroState::Opaque, opaque, 0u, 0u));
    CHECK(asks(MicroState::UnknownOpaque, opaque, 0u, 0u));
    CHECK(asks(MicroState::UnknownTransparent, opaque, 0u, 0u));
    CHECK(hits(MicroState::UnknownOpaque, opaque, kForceMicromaps2State, 0u));
    CHECK_FALSE(hits(MicroState::UnknownTransparent, opaque, kForceMicromaps2State, 0u));
    CHECK(hits(MicroState::UnknownTransparent, opaque, kForceOpaque, 0u));
    CHECK(asks(MicroState::Opaque, opaque, kForceNoOpaque, 0u));
    CHECK(hits(MicroState::Opaque, opaque, kForceNoOpaque, ray_flag::kOpaque));
    CHECK_FALSE(hits(MicroState::Opaque, opaque, 0u, ray_flag::kCullOpaque));
    CHECK(asks(MicroState::UnknownOpaque, opaque, 0u, ray_flag::kCullOpaque));
    CHECK(with_map(MicroState::UnknownOpaque, opaque, 0u, ray_flag::kCullNoOpaque).status == RayStatus::Done);
    CHECK(hits(MicroState::Transparent, opaque, kDisableMicromaps, 0u) == opaque);
    CHECK(asks(MicroState::Transparent, opaque, kDisableMicromaps, 0u) != opaque);
  }
}

TEST_CASE("skip flags pass over triangles and boxes") {
  CHECK_FALSE(one_triangle().shoot(ray_flag::kSkipTriangles).committed.valid());
  CHECK(one_triangle().shoot(ray_flag::kSkipAabbs).committed.valid());
  CHECK(one_box(true).shoot(ray_flag::kSkipAabbs).status == RayStatus::Done);
  CHECK(one_box(true).shoot(ray_flag::kSkipTriangles).status == RayStatus::NeedsIntersection);
}

TEST_CASE("an AABB's interval is closed, and a ray inside it or of no length enters it") {
  const World world = one_box(true);  // the ray enters at t = 9 and leaves at 11
  CHECK(world.shoot(0, 0, 9).status == RayStatus::NeedsIntersection);
  CHECK(world.shoot(0, 11, 20).status == RayStatus::NeedsIntersection);
  CHECK(world.shoot(0, 10, 10).status == RayStatus::NeedsIntersection);
  CHECK(world.shoot(0, 0, 8.99f).status == RayStatus::Done);
  CHECK(world.shoot(0, 11.01f, 20).status == RayStatus::Done);
}

TEST_CASE("reports outside the interval are rejected and shorten nothing") {
  const World world = one_box(true);
  RayState state = world.shoot(0, 2, 50);
  REQUIRE(state.status == RayStatus::NeedsIntersection);
  CHECK(report(state, 1.9f, 1) == Report::Rejected);
  CHECK(report(state, 50.1f, 1) == Report::Rejected);
  CHECK(report(state, NAN, 1) == Report::Rejected);
  CHECK_FALSE(state.report_accepted);
  CHECK(state.committed.t == 50);
  CHECK(report(state, 50, 5) == Report::Accepted);  // the interval is closed at the ray's end
  CHECK(state.report_accepted);
  CHECK(state.attribute_slot);
  CHECK(report(state, 50, 6) == Report::Accepted);  // a primitive may report its hit again
  CHECK_FALSE(state.attribute_slot);
  CHECK(report(state, 20, 7) == Report::Accepted);
  CHECK(state.attribute_slot);
  CHECK(report(state, 30, 8) == Report::Rejected);
  finish_intersection(state);
  REQUIRE(state.status == RayStatus::Done);
  CHECK(state.committed.t == 20);
  CHECK(state.committed.kind == 7);
}

TEST_CASE("a non-opaque report waits for its any-hit shader") {
  RayState state = one_box(false).shoot();
  REQUIRE(report(state, 9, 3) == Report::NeedsAnyHit);
  CHECK(state.status == RayStatus::NeedsAnyHit);
  CHECK(state.candidate.t == 9);
  ignore_candidate(state);
  CHECK(state.status == RayStatus::NeedsIntersection);
  CHECK_FALSE(state.report_accepted);
  CHECK_FALSE(state.attribute_slot);
  REQUIRE(report(state, 9.5f, 4) == Report::NeedsAnyHit);
  accept_candidate(state);
  CHECK(state.report_accepted);
  CHECK(state.attribute_slot);
  finish_intersection(state);
  CHECK(state.status == RayStatus::Done);
  CHECK(state.committed.t == 9.5f);
}

TEST_CASE("after terminate in an any-hit shader an intersection shader can report nothing more") {
  RayState state = one_box(false).shoot();
  REQUIRE(report(state, 10, 3) == Report::NeedsAnyHit);
  terminate_candidate(state);
  CHECK(state.status == RayStatus::NeedsIntersection);
  CHECK(report(state, 9, 4) == Report::Rejected);
  finish_intersection(state);
  CHECK(state.status == RayStatus::Done);
  CHECK(state.committed.t == 10);
}

struct Layers {
  Positions positions;
  World world;
  explicit Layers(bool opaque) : positions(make()), world({{triangles(positions, opaque)}}) {}
  static Positions make() {
    Positions out;
    for (int i = 0; i < 20; ++i)
      for (const auto& p : triangle_at(float(-i))) out.push_back(p);
    return out;
  }
};

TEST_CASE("ignored candidates let the ray go on to the next, terminate ends it") {
  const Layers layers(false);
  RayState state = layers.world.shoot();
  uint32_t seen = 0;
  while (state.status == RayStatus::NeedsAnyHit) {
    seen |= 1u << state.candidate.primitive;
    ignore_candidate(state);
    run(state, layers.world.memory);
  }
  CHECK(seen == 0xfffff);  // each of the twenty was seen exactly once, and none was committed
  CHECK(state.status == RayStatus::Done);
  CHECK_FALSE(state.committed.valid());

  state = layers.world.shoot();
  terminate_candidate(state);
  CHECK(state.status == RayStatus::Done);
  CHECK(state.committed.valid());
}

TEST_CASE("accepted candidates shorten the ray to the nearest") {
  const Layers layers(false);
  RayState state = layers.world.shoot();
  uint32_t asked = 0;
  while (state.status == RayStatus::NeedsAnyHit) {
    ++asked;
    accept_candidate(state);
    run(state, layers.world.memory);
  }
  CHECK(state.committed.primitive == 0);
  CHECK(state.committed.t == 10);
  CHECK(asked == 1);  // near children come first, so nothing behind the first hit is asked
}

TEST_CASE("terminate-on-first-hit ends with the first confirmed hit and no earlier") {
  const Layers layers(false);
  RayState state = layers.world.shoot(ray_flag::kTerminateOnFirstHit);
  REQUIRE(state.status == RayStatus::NeedsAnyHit);
  ignore_candidate(state);
  CHECK(state.status == RayStatus::Traversing);
  run(state, layers.world.memory);
  REQUIRE(state.status == RayStatus::NeedsAnyHit);
  accept_candidate(state);
  CHECK(state.status == RayStatus::Done);
  const Layers opaque(true);
  const RayState first = opaque.world.shoot(ray_flag::kTerminateOnFirstHit), all = opaque.world.shoot();
  CHECK(first.committed.valid());
  CHECK(first.triangle_tests <= all.triangle_tests);
}

TEST_CASE("of hits at equal distance the lowest instance, geometry and primitive wins") {
  const Positions twice = [] {
    Positions out = triangle_at(0);
    for (int i = 0; i < 11; ++i)
      for (const auto& p : triangle_at(0)) out.push_back(p);
    return out;
  }();
  mem::AddressSpace memory;
  const StructureInfo bottom = build_bottom(memory, "b", {{triangles(twice), triangles(twice)}});
  const StructureInfo top = build_top(memory, "t", std::vector<Instance>(9), std::vector{bottom});
  RayState state = ray_of(top.address, {0.3f, 0.2f, 10}, {0.01f, 0.02f, -1});
  REQUIRE(begin(state, memory));
  run(state, memory);
  CHECK(state.committed.instance == 0);
  CHECK(state.committed.geometry == 0);
  CHECK(state.committed.primitive == 0);
}

TEST_CASE("instances inherit t: a scaled instance is hit at the world's distance") {
  Instance half;
  half.transform = {0.5f, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0, 0.5f, 4};
  const RayState state = one_triangle(true, half).shoot();
  CHECK(state.committed.t == 6);  // the plane z = 0 lies at z = 4
}

TEST_CASE("rays that are not finite, empty intervals and null structures miss at once") {
  const World world = one_triangle();
  const auto status = [&](RayState state) {
    CHECK(begin(state, world.memory));
    return std::pair(state.status, state.committed.valid());
  };
  const std::pair miss(RayStatus::Done, false);
  CHECK(status(ray_of(world.top.address, {NAN, 0, 10}, {0, 0, -1})) == miss);
  CHECK(status(ray_of(world.top.address, {0, 0, 10}, {0, INFINITY, -1})) == miss);
  CHECK(status(ray_of(world.top.address, {0, 0, 10}, {0, 0, -1}, 5, 4)) == miss);
  CHECK(status(ray_of(world.top.address, {0, 0, 10}, {0, 0, -1}, 0, NAN)) == miss);
  CHECK(status(ray_of(0, {0, 0, 10}, {0, 0, -1})) == miss);
}

TEST_CASE("only the header of a top level is a structure that rays can be traced in") {
  World world = one_triangle();
  RayState state = ray_of(world.top.address + 64, {0, 0, 10}, {0, 0, -1});
  CHECK_FALSE(begin(state, world.memory));
  state.ray.structure = Address{7} << 40;
  CHECK_FALSE(begin(state, world.memory));
  CHECK(state.status == RayStatus::Done);
}

TEST_CASE("a ray ends as broken when overwritten nodes lead outside memory") {
  World world = one_triangle();
  auto bytes = world.memory.view<std::byte>(world.top.address + 64, 64);
  std::memset(&bytes[12], 0xff, 3);  // the first child's block
  RayState state = ray_of(world.top.address, {0, 0, 10}, {0, 0, -1});
  REQUIRE(begin(state, world.memory));
  run(state, world.memory);
  CHECK(state.status == RayStatus::Done);
  CHECK(state.broken);
}

TEST_CASE("triangles of no area are never hit") {
  const Positions flat{{-1, 0, 0}, {1, 0, 0}, {0, 0, 0}, {0, 0, 0},  {0, 0, 0},
                       {0, 0, 0},  {1, 1, 0}, {1, 1, 0}, {-1, -1, 0}};
  const World world({{triangles(flat)}});
  CHECK(world.top.primitives == 0);
  CHECK_FALSE(world.shoot().committed.valid());
}

}  // namespace
}  // namespace glint::rt::test

// Tests structures in memory: contents, sizes, determinism, and a validator that sees damage.
// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/registry.h"
#include "rtunit/node_format.h"
#include "rtunit/structure/validate.h"
#include "tests/support/catch.h"
#include "tests/support/rt_scenes.h"

namespace glint::rt::test {
namespace {

std::vector<std::byte> bytes_of(const mem::AddressSpace& memory, const StructureInfo& info) {
  const auto view = memory.view<std::byte>(info.address, info.bytes);
  return {view.begin(), view.end()};
}

TEST_CASE("a structure is its header, 64 B a node and a leaf, and nothing more") {
  Random random{1};
  const Positions positions = soup(random, 1000, 10, 1);
  mem::AddressSpace memory;
  const StructureInfo info = build_bottom(memory, "b", {{triangles(positions)}}, {"bvh6", false});
  CHECK(info.primitives == 1000);
  CHECK(info.leaves == 1000);
  CHECK(info.bytes == 64 + 64 * (uint64_t(info.nodes) + info.leaves));
  CHECK(info.nodes >= 200);  // (1000 - 1) / 5
  CHECK(info.nodes < 400);
  CHECK(info.depth >= 4);
  CHECK(info.depth <= 12);
  CHECK(validate(memory, info.address).empty());
}

TEST_CASE("the two triangles of a quad share a leaf") {
  Positions quads;
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i < 50; ++i) {
    const float x = 3 * float(i);
    for (const std::array<float, 3>& p :
         {std::array{x, 0.f, 0.f}, {x + 1, 0.f, 0.f}, {x + 1, 1.f, 0.f}, {x, 1.f, 0.f}})
      quads.push_back(p);
    for (uint32_t k : {0, 1, 2, 0, 2, 3}) indices.push_back(4 * i + k);
  }
  Geometry g = triangles(quads);
  g.indices = indices;
  mem::AddressSpace memory;
  const StructureInfo paired = build_bottom(memory, "p", {{g}}),
                      single = build_bottom(memory, "s", {{g}}, {"bvh6", false});
  CHECK(paired.leaves == 50);
  CHECK(single.leaves == 100);
  CHECK(paired.primitives == 100);
  CHECK(validate(memory, paired.address).empty());
  const StructureInfo top = build_top(memory, "t", std::vector<Instance>(1), std::vector{paired});
  for (uint32_t i = 0; i < 100; ++i) {
    const bool second = i % 2;
    RayState state = ray_of(
        top.address, {3 * float(i / 2) + (second ? 0.25f : 0.75f), second ? 0.75f : 0.25f, 5}, {0, 0, -1});
    REQUIRE(begin(state, memory));
    run(state, memory);
    CHECK(state.committed.primitive == i);
    // The weights are in the order of the triangle's own corners.
    CHECK(state.committed.u == (second ? 0.25f : 0.5f));
    CHECK(state.committed.v == (second ? 0.5f : 0.25f));
  }
}

TEST_CASE("the same geometry gives the same bytes") {
  Random random{2};
  const Positions positions = soup(random, 20000, 10, 0.2f);
  mem::AddressSpace a, b;
  CHECK(bytes_of(a, build_bottom(a, "b", {{triangles(positions)}})) ==
        bytes_of(b, build_bottom(b, "b", {{triangles(positions)}})));
}

// Neighbours share edges, so pairs of triangles reach across what one thread looks at. Identical triangles
// have no order but that of their numbers.
TEST_CASE("threads that build do not show in a structure's bytes") {
  Random random{9};
  Positions positions = soup(random, 70'000, 10, 0.2f);
  for (int i = 0; i < 9; ++i)
    positions.insert(positions.end(), positions.begin() + 9, positions.begin() + 18);
  std::vector<uint32_t> strip;
  for (uint32_t i = 0; i < 70'000; ++i) strip.insert(strip.end(), {i, i + 1, i + 2});
  const std::vector<Bounds> boxes(3000, Bounds{{0, 0, 0}, {1, 1, 1}});
  Geometry stripped = triangles(positions), procedural;
  stripped.indices = strip;
  procedural.aabbs = boxes;
  const BottomLevel level{{triangles(positions), procedural, stripped}};
  for (const std::string& format : Registry<NodeFormat>::names()) {
    const EncodedStructure one = encode_bottom("b", level, {format.c_str()}, 1);
    CHECK(one.info.primitives > one.info.leaves);
    const EncodedStructure several = encode_bottom("b", level, {format.c_str()}, 3);
    CAPTURE(format);
    REQUIRE(several.bytes.size() == one.bytes.size());
    CHECK(std::memcmp(several.bytes.data(), one.bytes.data(), one.bytes.size()) == 0);
    CHECK(several.info.depth == one.info.depth);
    CHECK(several.info.stack_need == one.info.stack_need);
  }
}

TEST_CASE("of several wrong indices the first is named, at any number of threads") {
  Random random{9};
  const Positions positions = soup(random, 1000, 10, 0.2f);
  std::vector<uint32_t> indices(600'000);
  for (const size_t wrong : {300'000u, 300'100u, 599'999u}) indices[wrong] = 3000;
  Geometry geometry = triangles(positions);
  geometry.indices = indices;
  for (const uint32_t threads : {1u, 2u, 8u})
    CHECK_THROWS_WITH(encode_bottom("b", {{geometry}}, {}, threads),
                      Catch::Contains("triangle 100000 names"));
}

TEST_CASE("thousands of identical triangles still make a tree that a ray's stack can hold") {
  Positions positions;
  for (int i = 0; i < 5000; ++i)
    for (const std::array<float, 3>& p : {std::array{0.f, 0.f, 0.f}, {1.f, 0.f, 0.f}, {0.f, 1.f, 0.f}})
      positions.push_back(p);
  mem::AddressSpace memory;
  const StructureInfo info = build_bottom(memory, "b", {{triangles(positions)}}, {"bvh6", false});
  CHECK(info.stack_need <= kStackEntries);
  CHECK(info.primitives == 5000);
  CHECK(validate(memory, info.address).empty());
}

TEST_CASE("geometries, AABBs and instances lie where the input says") {
  const Positions positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Bounds> boxes{{{5, 5, 5}, {6, 6, 6}}, {{NAN, 0, 0}, {1, 1, 1}}, {{7, 5, 5}, {8, 6, 6}}};
  Geometry moved = triangles(positions), procedural;
  moved.transform = {1, 0, 0, 10, 0, 1, 0, 0, 0, 0, 1, 0};
  procedural.aabbs = boxes;
  mem::AddressSpace memory;
  const StructureInfo bottom = build_bottom(memory, "b", {{triangles(positions), moved, procedural}});
  CHECK(bottom.primitives == 4);
  CHECK(bottom.bounds == Bounds{{0, 0, 0}, {11, 6, 6}});
  const StructureInfo top = build_top(memory, "t", std::vector<Instance>(3), std::vector{bottom});
  CHECK(top.primitives == 3);
  CHECK(validate(memory, top.address).empty());
  RayState state = ray_of(top.address, {10.2f, 0.2f, 3}, {0, 0, -1});
  REQUIRE(begin(state, memory));
  run(state, memory);
  CHECK(state.committed.geometry == 1);
  state = ray_of(top.address, {7.5f, 5.5f, 30}, {0, 0, -1});
  REQUIRE(begin(state, memory));
  run(state, memory);
  REQUIRE(state.status == RayStatus::NeedsIntersection);
  CHECK(state.candidate.geometry == 2);
  CHECK(state.candidate.primitive == 2);
}

TEST_CASE("empty structures are sound and rays miss them") {
  mem::AddressSpace memory;
  const StructureInfo bottom = build_bottom(memory, "b", {});
  const StructureInfo top = build_top(memory, "t", std::vector<Instance>(2), std::vector{bottom});
  CHECK(top.primitives == 0);
  CHECK(validate(memory, top.address).empty());
  RayState state = ray_of(top.address, {0, 0, 0}, {0, 0, 1});
  REQUIRE(begin(state, memory));
  run(state, memory);
  CHECK(state.status == RayStatus::Done);
  CHECK_FALSE(state.broken);
}

TEST_CASE("input that cannot be built is refused with its index") {
  const Positions positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<uint32_t> indices{0, 1, 3};
  Geometry g = triangles(positions);
  g.indices = indices;
  mem::AddressSpace memory;
  CHECK_THROWS_WITH(build_bottom(memory, "b", {{g}}), Catch::Contains("triangle 0 names vertex 3"));
  const StructureInfo bottom = build_bottom(memory, "b", {{triangles(positions)}});
  std::vector<Instance> instances(2);
  instances[1].transform = {1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 1, 0};
  CHECK_THROWS_WITH(build_top(memory, "t", instances, std::vector{bottom}),
                    Catch::Contains("'t': instance 1: its transform cannot be inverted"));
  instances[1] = {};
  instances[1].bottom = 1;
  CHECK_THROWS_WITH(build_top(memory, "t", instances, std::vector{bottom}),
                    Catch::Contains("instance 1 names bottom level 1 of 1"));
}

// The validator must refuse each kind of damage.
TEST_CASE("the validator finds damage") {
  Random random{3};
  const Positions positions = soup(random, 100, 10, 1);
  mem::AddressSpace memory;
  const StructureInfo info = build_bottom(memory, "b", {{triangles(positions)}}, {"bvh6", false});
  const auto view = memory.view<std::byte>(info.address, info.bytes);
  REQUIRE(validate(memory, info.address).empty());
  const auto damaged = [&](size_t offset, std::byte value) {
    const std::byte before = view[offset];
    view[offset] = value;
    const auto errors = validate(memory, info.address);
    view[offset] = before;
    return !errors.empty();
  };
  CHECK(damaged(0, std::byte{1}));          // the magic number
  CHECK(damaged(32, std::byte{99}));        // number of primitives
  CHECK(damaged(64 + 12, std::byte{200}));  // the first child's block
  CHECK(damaged(64 + 16, std::byte{1}));    // an exponent, so that the boxes shrink
  CHECK(damaged(64 + 19, std::byte{1}));    // five children are lost
}

}  // namespace
}  // namespace glint::rt::test

// Tests rays that gather candidates: full tables, candidates that the ray no longer reaches, ties, ends.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/traversal/candidate_table.h"

#include <algorithm>

#include "tests/support/catch.h"
#include "tests/support/rt_scenes.h"

namespace glint::rt::test::candidate_table_test {
namespace {

// Holds primitives one behind the other along -z, seen from (0, 0, 10): t = 1, 2, ...
struct Layers {
  mem::AddressSpace memory;
  StructureInfo top;
  CandidateTable table;

  Layers(uint32_t alpha, uint32_t rows, float opaque_at = 0, bool boxes = false) {
    Positions layers, wall;
    std::vector<Bounds> bounds;
    for (uint32_t i = 0; i < alpha; ++i) {
      const float z = 9.0f - float(i);
      layers.insert(layers.end(), {{-1, -1, z}, {3, -1, z}, {-1, 3, z}});
      bounds.push_back({{-1, -1, z - 0.1f}, {1, 1, z}});
    }
    Geometry front = triangles(layers, false);
    if (boxes) front.positions = {}, front.aabbs = bounds;
    BottomLevel level{{front}};
    if (opaque_at > 0) {
      const float z = 10.0f - opaque_at;
      wall = {{-1, -1, z}, {3, -1, z}, {-1, 3, z}};
      level.geometries.push_back(triangles(wall));
    }
    top = build_top(memory, "top", std::vector<Instance>(1),
                    std::vector{build_bottom(memory, "bottom", level)});
    table.row.resize(rows);
  }
  RayState shoot(uint32_t flags = 0) {
    RayState state = ray_of(top.address, {0, 0, 10}, {0, 0, -1}, 0, 100, flags);
    state.table = &table;
    REQUIRE(begin(state, memory));
    run(state, memory);
    return state;
  }
  uint32_t row_at(float t) const {
    for (uint32_t r = 0; r < table.row.size(); ++r)
      if ((table.used >> r & 1) && std::fabs(table.row[r].hit.t - t) < 1e-3f) return r;
    FAIL("no candidate at " << t);
    return 0;
  }
};

TEST_CASE("a ray runs past candidates and stops at its end with all of them in the table") {
  Layers world(5, 8);
  const RayState state = world.shoot();
  CHECK(state.status == RayStatus::Gathered);
  CHECK(state.stack_size == 0);
  CHECK(world.table.gathered == 5);
  CHECK(std::popcount(world.table.used) == 5);
  CHECK(world.table.overflows == 0);
}

TEST_CASE(
    "a full table stops the ray, which goes on when all of it is decided, and no candidate is lost or seen "
    "twice") {
  Layers world(20, 4);
  RayState state = world.shoot();
  std::vector<float> seen;
  uint32_t stops = 0;
  while (state.status != RayStatus::Done) {
    REQUIRE(state.status == RayStatus::Gathered);
    ++stops;
    CHECK(std::popcount(world.table.used) <= 4);
    while (state.status == RayStatus::Gathered) {
      present(state, uint32_t(std::countr_zero(world.table.used)));
      seen.push_back(state.candidate.t);
      ignore_candidate(state);
    }
    run(state, world.memory);
  }
  std::sort(seen.begin(), seen.end());
  REQUIRE(seen.size() == 20);
  for (size_t i = 0; i < seen.size(); ++i) CHECK(std::fabs(seen[i] - float(i + 1)) < 1e-3f);
  CHECK(stops >= 5);
  CHECK(world.table.overflows >= 4);
  CHECK_FALSE(state.committed.valid());
}

TEST_CASE("an accepted candidate drops those behind it, and those before it stay") {
  Layers world(5, 8);
  RayState state = world.shoot();
  present(state, world.row_at(3));
  accept_candidate(state);
  CHECK(state.status == RayStatus::Gathered);
  CHECK(world.table.dropped == 2);
  CHECK(std::popcount(world.table.used) == 2);
  present(state, world.row_at(1));
  accept_candidate(state);
  CHECK(state.status == RayStatus::Done);
  CHECK(world.table.dropped == 3);
  CHECK(std::fabs(state.committed.t - 1) < 1e-3f);
}

TEST_CASE("an opaque hit that is found later drops the candidates behind it") {
  for (const bool boxes : {false, true}) {
    Layers world(6, 8, 2.5f, boxes);
    RayState state = world.shoot();
    CHECK(state.status == RayStatus::Gathered);
    CHECK(std::popcount(world.table.used) == 2);
    CHECK(world.table.gathered == 2 + world.table.dropped);
    CHECK(state.committed.t == 2.5f);
  }
}

TEST_CASE("a box whose entry lies beyond the new end of the ray does not run its intersection shader") {
  Layers world(5, 8, 0, true);
  RayState state = world.shoot();
  present(state, world.row_at(2));
  REQUIRE(state.status == RayStatus::NeedsIntersection);
  REQUIRE(report(state, 2.05f, 7) == Report::NeedsAnyHit);
  accept_candidate(state);
  CHECK(state.report_accepted);
  finish_intersection(state);
  CHECK(state.status == RayStatus::Gathered);
  CHECK(world.table.dropped == 3);
  present(state, world.row_at(1));
  finish_intersection(state);  // the shader reports nothing
  CHECK(state.status == RayStatus::Done);
  CHECK(state.committed.kind == 7);
}

TEST_CASE("of two candidates at the same distance the lower primitive wins, whichever is decided first") {
  for (const uint32_t first : {0u, 1u}) {
    mem::AddressSpace memory;
    Positions twice;
    for (int i = 0; i < 2; ++i) twice.insert(twice.end(), {{-1, -1, 0}, {3, -1, 0}, {-1, 3, 0}});
    const StructureInfo top = single(memory, triangles(twice, false));
    CandidateTable table;
    table.row.resize(4);
    RayState state = ray_of(top.address, {0, 0, 10}, {0, 0, -1});
    state.table = &table;
    REQUIRE(begin(state, memory));
    run(state, memory);
    REQUIRE(std::popcount(table.used) == 2);
    present(state, table.row[0].hit.primitive == first ? 0 : 1);
    accept_candidate(state);
    CHECK((state.status == RayStatus::Done) == (first == 0));
    if (first == 1) {
      present(state, uint32_t(std::countr_zero(table.used)));
      accept_candidate(state);
    }
    CHECK(state.status == RayStatus::Done);
    CHECK(state.committed.primitive == 0);
  }
}

TEST_CASE("a terminated ray is done, and the rest of its table is dropped") {
  Layers world(5, 8);
  RayState state = world.shoot();
  present(state, world.row_at(4));
  terminate_candidate(state);
  CHECK(state.status == RayStatus::Done);
  CHECK(world.table.used == 0);
  CHECK(world.table.dropped == 4);
  CHECK(std::fabs(state.committed.t - 4) < 1e-3f);
  REQUIRE(begin(state, world.memory));  // a new ray
  CHECK(world.table.dropped == 0);
}

}  // namespace
}  // namespace glint::rt::test::candidate_table_test

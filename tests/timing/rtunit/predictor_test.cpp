// Tests the cycles of a look-up and of a predicted ray exactly, and which rays share an entry of the table.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/registry.h"
#include "rtunit/ray_entry.h"
#include "tests/support/catch.h"
#include "tests/support/rt_launch.h"

namespace glint::rt::test {
namespace {

constexpr uint32_t kFlags = ray_flag::kOpaque | ray_flag::kTerminateOnFirstHit;

struct Field {
  mem::AddressSpace memory;
  Positions positions;
  StructureInfo top;
  Field() {
    Random random{3};
    positions = soup(random, 300, 10, 1.5f);
    top = single(memory, triangles(positions));
  }
  RayState ray(std::array<float, 3> origin, std::array<float, 3> direction) const {
    RayState state = ray_of(top.address, origin, direction, 0, 100, kFlags);
    REQUIRE(begin(state, memory));
    return state;
  }
};

Params plain(const char* entry) {
  Params params;
  params.entry.name = entry;
  params.stack.name = "full";
  params.mshr_entries = 0;
  params.warps = 1;
  return params;
}

struct Outcome {
  std::vector<Cycle> completion;
  uint64_t nodes = 0, internal = 0, triangles = 0;
};

// Runs warps of one ray each, one after the other.
Outcome run(const Field& field, const Params& params, Cycle latency, const std::vector<RayState>& rays) {
  std::vector<WarpRays> warps(rays.size());
  for (size_t w = 0; w < rays.size(); ++w) warps[w][5] = rays[w];
  mem::FixedLatencyMemory l1(latency);
  RtUnit unit(params, {field.memory, l1});
  Outcome out;
  out.completion = launch(unit, l1, warps, false).completion;
  const RtStats& s = unit.stats();
  out.nodes = s.nodes.value(), out.internal = s.internal_nodes.value();
  out.triangles = s.triangle_leaves.value();
  return out;
}

TEST_CASE(
    "a look-up costs its latency, and a predicted ray an instance's leaf and the nodes below its start") {
  const Field field;
  Random random{4};
  int predicted = 0;
  for (int i = 0; i < 30; ++i) {
    const RayState ray = field.ray(random.point(12), random.point(1));
    const Cycle latency = 11;
    const Params root = plain("root"), params = plain("predictor");
    const Outcome from_root = run(field, root, latency, {ray, ray}),
                  alone = run(field, params, latency, {ray}), twice = run(field, params, latency, {ray, ray});
    CHECK(alone.completion[0] == from_root.completion[0] + 3);
    CHECK(alone.nodes * 2 == from_root.nodes);
    RayState result = ray;
    run_to_end(result, field.memory);
    const Cycle second = twice.completion[1] - twice.completion[0];
    if (!result.committed.valid()) {  // Nothing is learned from a ray without a hit.
      CHECK(second == from_root.completion[1] - from_root.completion[0] + 3);
      continue;
    }
    ++predicted;
    const uint64_t internal = twice.internal - alone.internal, leaves = twice.triangles - alone.triangles;
    CHECK(internal + leaves < alone.nodes);
    const Cycle entering = from_root.completion[1] - from_root.completion[0] -
                           (from_root.completion[0] - 2);  // from a warp's return to the start of the next
    CHECK(second == entering + 3 + (latency + 1 + params.transform.latency) +
                        internal * (latency + params.box.latency) +
                        leaves * (latency + params.triangle.latency));
  }
  CHECK(predicted > 5);
}

TEST_CASE(
    "the rays of a warp are looked up four at a time, and each reads its first node after its look-up") {
  const Field field;
  Params params = plain("predictor");
  params.coalescing.name = "each_lane";
  mem::FixedLatencyMemory l1(1000);
  RtUnit unit(params, {field.memory, l1});
  WarpRays warp;
  warp.fill(field.ray({0, 0, 20}, {0, 0, -1}));
  unit.submit(0, 0, kAllLanes, warp.data());
  // The first four rays begin in cycle 1, and their look-up takes three cycles. A cycle sends one request.
  for (Cycle now = 1; now < 200; ++now) {
    unit.tick(now);
    CHECK(l1.log().size() == (now < 4 ? 0 : std::min<size_t>(now - 3, 32)));
  }
  CHECK(unit.stats().cycles.count(Stall::TestBusy) == 3);
}

// Holds a structure's header alone: rays in it have hashes.
struct Table {
  mem::AddressSpace memory;
  Address top = memory.allocate("structure", 4096), other = memory.allocate("other", 4096);
  std::unique_ptr<RayEntry> policy =
      Registry<RayEntry>::instance().entry("predictor").make_default({nullptr, memory});
  Table() {
    StructureHeader header;
    header.bounds = {{0, 0, 0}, {32, 32, 32}};
    memory.write(top, &header, sizeof header);
    memory.write(other, &header, sizeof header);
  }
  RayState ray(std::array<float, 3> origin, std::array<float, 3> direction = {0, 0, 1}) const {
    RayState state = ray_of(top, origin, direction, 0, 100, kFlags);
    state.committed.instance = 0;
    return state;
  }
  static Start start(uint32_t number) { return {64, 1024 + 16 * number, NodeKind::Internal}; }
  void teach(const RayState& ray, uint32_t number) { policy->ended(ray, {false, false, start(number)}); }
};

TEST_CASE("rays of the same cell of origin and direction share an entry, and others do not") {
  Table table;
  const RayState ray = table.ray({3.5f, 7.5f, 30.5f}, {1, 0.2f, 0.3f});
  CHECK_FALSE(table.policy->look_up(ray));
  table.teach(ray, 5);
  CHECK(table.policy->look_up(ray) == Table::start(5));
  CHECK(table.policy->look_up(table.ray({3.1f, 7.9f, 30.9f}, {2, 0.5f, 0.55f})) == Table::start(5));
  for (size_t axis = 0; axis < 3; ++axis) {
    RayState moved = ray;
    moved.ray.origin[axis] -= 1;
    CHECK_FALSE(table.policy->look_up(moved));
  }
  CHECK_FALSE(table.policy->look_up(table.ray({3.5f, 7.5f, 30.5f}, {-1, 0.2f, 0.3f})));
  CHECK_FALSE(table.policy->look_up(table.ray({3.5f, 7.5f, 30.5f}, {1, 0.2f, -2})));
  RayState elsewhere = ray;
  elsewhere.ray.structure = table.other;
  CHECK_FALSE(table.policy->look_up(elsewhere));
}

TEST_CASE("only a hit that was not predicted is learned, and it replaces what its hash had") {
  Table table;
  RayState ray = table.ray({3.5f, 7.5f, 30.5f});
  table.policy->ended(ray, {true, true, Table::start(1)});
  CHECK_FALSE(table.policy->look_up(ray));
  ray.committed.instance = kNoHit;
  table.teach(ray, 1);
  CHECK_FALSE(table.policy->look_up(ray));
  ray.committed.instance = 0;
  table.teach(ray, 1);
  table.policy->ended(ray, {true, false, Table::start(2)});
  CHECK(table.policy->look_up(ray) == Table::start(2));
}

TEST_CASE("a set of four entries loses the one that was used longest ago") {
  Table table;
  // A direction along z has the polar angle 0 and the azimuth 0, so the hash is that of the origin: x in its
  // low five bits, then y, then z. These fall into set 0.
  std::vector<RayState> rays;
  for (uint32_t i = 0; i < 5; ++i) {
    const uint32_t hash = i << 8 | i;
    rays.push_back(
        table.ray({float(hash & 31) + 0.5f, float(hash >> 5 & 31) + 0.5f, float(hash >> 10) + 0.5f}));
  }
  for (uint32_t i = 0; i < 4; ++i) table.teach(rays[i], i);
  CHECK(table.policy->look_up(rays[0]));
  table.teach(rays[4], 4);
  for (uint32_t i = 0; i < 5; ++i) CHECK(table.policy->look_up(rays[i]).has_value() == (i != 1));
}

}  // namespace
}  // namespace glint::rt::test

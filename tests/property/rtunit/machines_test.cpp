// Tests that run(), step by step and the timed unit drive one traversal to the same bits.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <tuple>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/rt_launch.h"

namespace glint::rt::test {
namespace {

// Holds opaque and alpha triangles and boxes in several instances, with rays of every kind.
struct Zoo {
  mem::AddressSpace memory;
  Positions opaque, alpha;
  std::vector<Bounds> boxes;
  StructureInfo top;
  Random random;

  explicit Zoo(uint64_t seed) : random{seed} {
    opaque = soup(random, 200, 10, 2);
    alpha = soup(random, 100, 10, 3);
    for (int i = 0; i < 60; ++i) {
      const auto p = random.point(10), s = random.point(1);
      boxes.push_back(
          {{p[0], p[1], p[2]}, {p[0] + std::fabs(s[0]), p[1] + std::fabs(s[1]), p[2] + std::fabs(s[2])}});
    }
    Geometry procedural;
    procedural.aabbs = boxes;
    procedural.opaque = seed % 2;
    const std::vector<StructureInfo> bottoms{
        build_bottom(memory, "mixed", {{triangles(opaque), triangles(alpha, false), procedural}}),
        build_bottom(memory, "alpha", {{triangles(alpha, false)}})};
    std::vector<Instance> instances(12);
    for (size_t i = 0; i < instances.size(); ++i) {
      instances[i].transform =
          random_transform(random, random.uniform(0.3f, 1.5f) * (i % 2 ? 1.f : -1.f), 15);
      instances[i].bottom = uint32_t(i % 3 == 2);
      instances[i].flags = random.below(16);
      instances[i].mask = 1u << random.below(8) | 0x80;
    }
    top = build_top(memory, "top", instances, bottoms);
  }
  RayState ray() {
    RayState state = ray_of(top.address, random.point(20), random.point(1), random.uniform(0, 1),
                            random.below(4) ? 100.f : 3.f);
    static constexpr uint32_t kFlags[] = {0, 0, 0, 1, 2, 4, 0x10, 0x20, 0x40, 0x80, 0x100, 0x200, 5};
    state.ray.flags = kFlags[random.below(13)];
    state.ray.cull_mask = random.below(2) ? 0xff : random.bits() & 0xff;
    REQUIRE(begin(state, memory));
    return state;
  }
  std::vector<WarpRays> rays(size_t warps) {
    std::vector<WarpRays> out(warps);
    for (WarpRays& warp : out)
      for (RayState& state : warp) state = ray();
    return out;
  }
};

void check_same(const RayState& a, const RayState& b) {
  REQUIRE(a.status == b.status);
  REQUIRE(a.committed.instance == b.committed.instance);
  REQUIRE(a.committed.geometry == b.committed.geometry);
  REQUIRE(a.committed.primitive == b.committed.primitive);
  REQUIRE(std::memcmp(&a.committed.t, &b.committed.t, 12) == 0);  // t, u, v
  REQUIRE(a.committed.kind == b.committed.kind);
  REQUIRE(a.committed.instance_leaf == b.committed.instance_leaf);
  REQUIRE(a.attribute_slot == b.attribute_slot);
  REQUIRE(a.nodes_visited == b.nodes_visited);
  REQUIRE(a.triangle_tests == b.triangle_tests);
}

// Gives the rays of a warp tables and starts them again. Their hit may not depend on which candidate is found
// first.
struct Tables {
  std::vector<std::array<CandidateTable, kLanes>> of_warp;
  Tables(std::vector<WarpRays>& warps, uint32_t rows, const mem::AddressSpace& memory)
      : of_warp(warps.size()) {
    for (size_t w = 0; w < warps.size(); ++w)
      for (size_t lane = 0; lane < kLanes; ++lane) {
        of_warp[w][lane].row.resize(rows);
        warps[w][lane].table = &of_warp[w][lane];
        warps[w][lane].rules.end_at_first_hit = false;
        REQUIRE(begin(warps[w][lane], memory));
      }
  }
};

void check_same_hit(const RayState& a, const RayState& b) {
  REQUIRE(a.status == b.status);
  REQUIRE(std::memcmp(&a.committed.t, &b.committed.t, 12) == 0);  // t, u, v
  REQUIRE(a.committed.kind == b.committed.kind);
  REQUIRE(std::tuple(a.committed.instance, a.committed.geometry, a.committed.primitive) ==
          std::tuple(b.committed.instance, b.committed.geometry, b.committed.primitive));
}

TEST_CASE(
    "rays that gather candidates find the hit of rays that stop at each, whatever the table's size and the "
    "order") {
  for (uint64_t seed = 0; seed < 6; ++seed) {
    Zoo zoo(seed);
    const uint32_t rows = std::array{1u, 2u, 3u, 5u, 8u, 32u}[seed];
    std::vector<WarpRays> stopping = zoo.rays(20), gathering = stopping;
    const Tables tables(gathering, rows, zoo.memory);
    Random random{seed};
    uint32_t overflows = 0, dropped = 0, gathered = 0;
    for (size_t w = 0; w < stopping.size(); ++w)
      for (size_t lane = 0; lane < kLanes; ++lane) {
        RayState &a = stopping[w][lane], &b = gathering[w][lane];
        a.rules.end_at_first_hit = false;
        REQUIRE(begin(a, zoo.memory));
        run_to_end(a, zoo.memory);
        uint32_t decided = 0;
        while (b.status != RayStatus::Done) {
          run(b, zoo.memory);
          if (b.status != RayStatus::Gathered) continue;
          uint32_t used = b.table->used;
          for (uint32_t skip = random.below(uint32_t(std::popcount(used))); skip; --skip) used &= used - 1;
          present(b, uint32_t(std::countr_zero(used)));
          ++decided;
          decide(b);
        }
        check_same_hit(a, b);
        REQUIRE(b.table->used == 0);
        REQUIRE(b.table->gathered == decided + b.table->dropped);
        overflows += b.table->overflows;
        dropped += b.table->dropped;
        gathered += b.table->gathered;
      }
    INFO(rows << " rows");
    CHECK(gathered > 200);
    CHECK((dropped > 0) == (rows > 1));  // what is alone in the table is decided next
    CHECK((overflows > 0) == (rows < 32));
  }
}

TEST_CASE("the timed unit gathers what run gathers, writes it to memory once, and skips no event") {
  for (uint64_t seed = 0; seed < 4; ++seed) {
    Zoo zoo(seed);
    const uint32_t rows = 2 + uint32_t(seed);
    std::vector<WarpRays> functional = zoo.rays(5), timed = functional, skipped = functional;
    const Tables of_functional(functional, rows, zoo.memory), of_timed(timed, rows, zoo.memory),
        of_skipped(skipped, rows, zoo.memory);
    Params params;
    params.warps = 1 + uint32_t(seed % 3);
    params.result_store = seed % 2;
    constexpr Address kResults = Address{1} << 30, kTables = Address{1} << 31;
    mem::FixedLatencyMemory l1_all(20, 1), l1_some(20, 1);
    RtUnit all(params, {zoo.memory, l1_all, nullptr, kResults, {kTables, rows}});
    RtUnit some(params, {zoo.memory, l1_some, nullptr, kResults, {kTables, rows}});
    const Launch a = launch(all, l1_all, timed, true), b = launch(some, l1_some, skipped, false);
    CHECK(a.completion == b.completion);
    CHECK(all.stats().cycles.parts() == some.stats().cycles.parts());
    uint64_t gathered = 0, dropped = 0, written = 0;
    for (size_t w = 0; w < timed.size(); ++w)
      for (size_t lane = 0; lane < kLanes; ++lane) {
        run_to_end(functional[w][lane], zoo.memory);
        check_same(functional[w][lane], timed[w][lane]);
        gathered += timed[w][lane].table->gathered;
        dropped += timed[w][lane].table->dropped;
      }
    for (const mem::Request& request : l1_all.log()) {
      if (request.traffic != mem::Traffic::RtTable) continue;
      CHECK(request.write);
      CHECK(request.line >= kTables);
      written += uint64_t(std::popcount(request.sectors));
    }
    CHECK(written == all.stats().table_entries.value());
    CHECK(gathered > 20);
    CHECK(written <= gathered);            // what a full table drops at once is not written
    CHECK(written >= gathered - dropped);  // what a shader looked at was
  }
}

TEST_CASE("run and steps give the same bits") {
  Zoo zoo(1);
  uint32_t hits = 0, asked = 0;
  for (int i = 0; i < 3000; ++i) {
    RayState whole = zoo.ray(), stepped = whole;
    run_to_end(whole, zoo.memory);
    while (stepped.status != RayStatus::Done) {
      if (stepped.status == RayStatus::Traversing) {
        const Fetch fetch = next_fetch(stepped);
        step(stepped, zoo.memory.find(fetch.address, fetch.bytes));
      } else {
        ++asked;
        resolve(stepped);
      }
    }
    check_same(whole, stepped);
    hits += whole.committed.valid();
  }
  CHECK(hits > 500);
  CHECK(asked > 500);
}

TEST_CASE("the timed unit finds what run finds, under every scheduler, memory and port") {
  for (uint64_t seed = 0; seed < 8; ++seed) {
    Zoo zoo(seed);
    std::vector<WarpRays> timed = zoo.rays(6), functional = timed;
    Params params;
    params.warps = 1 + uint32_t(seed % 4);
    params.scheduler.name = seed % 2 ? "oldest_first" : "round_robin";
    params.request_bytes = 32u << (seed % 3);
    params.requests_per_cycle = 1 + uint32_t(seed % 2);
    params.responses_per_cycle = 1 + uint32_t(seed % 3);
    params.result_store = seed % 4 == 3;
    mem::FixedLatencyMemory l1(1 + 7 * seed, 1 + uint32_t(seed % 2));
    RtUnit unit(params, {zoo.memory, l1});
    const Launch done = launch(unit, l1, timed, false);
    CHECK(done.last_completion > 0);
    for (size_t w = 0; w < timed.size(); ++w)
      for (size_t lane = 0; lane < kLanes; ++lane) {
        run_to_end(functional[w][lane], zoo.memory);
        check_same(functional[w][lane], timed[w][lane]);
      }
    // Nothing may be lost.
    const RtStats& s = unit.stats();
    CHECK(s.finished.value() + s.suspended.value() == s.rays.value() + s.resumed.value());
    CHECK(done.completions == s.warps.value());
    CHECK(s.cycles.total() == s.unit_cycles.value());
    CHECK(s.nodes.value() == s.internal_nodes.value() + s.instance_leaves.value() +
                                 s.triangle_leaves.value() + s.procedural_leaves.value());
    CHECK(s.nodes.value() == s.fetches.value() + s.merged_lanes.value());
  }
}

// Each interface promises that skipping changes nothing: the cycles and accounts are the same.
TEST_CASE("ticking at events only gives the same cycles and counts as ticking always") {
  for (uint64_t seed = 20; seed < 26; ++seed) {
    Zoo zoo(seed);
    const std::vector<WarpRays> rays = zoo.rays(5);
    Params params;
    params.warps = 1 + uint32_t(seed % 3);
    params.triangle.interval = 1 + uint32_t(seed % 5);
    params.result_store = seed % 2;
    std::vector<WarpRays> a = rays, b = rays;
    mem::FixedLatencyMemory l1_a(40 + 30 * (seed % 3), 1), l1_b(40 + 30 * (seed % 3), 1);
    RtUnit unit_a(params, {zoo.memory, l1_a}), unit_b(params, {zoo.memory, l1_b});
    const Launch all = launch(unit_a, l1_a, a, true), some = launch(unit_b, l1_b, b, false);
    CHECK(all.last_completion == some.last_completion);
    CHECK(all.completion == some.completion);
    CHECK(unit_a.stats().cycles.parts() == unit_b.stats().cycles.parts());
    CHECK(unit_a.stats().ray_cycles.value() == unit_b.stats().ray_cycles.value());
    CHECK(unit_a.stats().warp_cycles.value() == unit_b.stats().warp_cycles.value());
    CHECK(unit_a.stats().refusals.value() == unit_b.stats().refusals.value());
    CHECK(unit_a.stats().ray_latency.counts() == unit_b.stats().ray_latency.counts());
    CHECK(l1_a.log().size() == l1_b.log().size());
  }
}

}  // namespace
}  // namespace glint::rt::test

// Tests that rays find what the functional traversal finds, whatever the RT unit's policies and limits are.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdint>

#include "base/registry.h"
#include "tests/support/catch.h"
#include "tests/support/rt_brute.h"

namespace glint::rt::test {
namespace {

struct Rays {
  std::vector<WarpRays> warps{2};
  std::vector<std::array<CandidateTable, kLanes>> tables{2};
  // Half of the seeds gather candidates. Lanes 0 to 3 of a warp, and the first lanes of all warps, have the
  // same ray.
  Rays(uint64_t seed, const BuiltScene& built, bool gather) {
    Random random{seed};
    RayState same;
    for (size_t w = 0; w < warps.size(); ++w)
      for (size_t lane = 0; lane < kLanes; ++lane) {
        RayState state = ray_of(built.top.address, random.point(15), random.point(1));
        state.ray.flags = std::array{0u, 4u, 5u, 0x100u}[random.below(4)];
        if (w == 0 && lane == 0) same = state;
        if (lane < 4) state.ray = same.ray;
        state.rules.end_at_first_hit = false;
        if (gather) {
          tables[w][lane].row.resize(3);
          state.table = &tables[w][lane];
        }
        REQUIRE(begin(state, built.memory));
        warps[w][lane] = state;
      }
  }
};

bool same_hit(const Hit& a, const Hit& b) {
  return std::memcmp(&a.t, &b.t, 12) == 0 && a.kind == b.kind && a.instance == b.instance &&
         a.geometry == b.geometry && a.primitive == b.primitive;
}

// Returns every policy that a traversal may depend on, and the limits beside it.
std::vector<Params> combinations() {
  std::vector<Params> out;
  uint32_t number = 0;
  const std::vector<std::string> prefetchers = Registry<Prefetcher>::names();
  for (const std::string& order : Registry<ChildOrder>::names())
    for (const std::string& coalescing : Registry<Coalescer>::names())
      for (const std::string& stack : Registry<StackModel>::names())
        for (const std::string& scheduler : Registry<RayScheduler>::names())
          for (const bool retest : {true, false})
            for (const uint32_t entries : {0u, 1u, 7u}) {
              Params& p = out.emplace_back();
              p.child_order.name = order;
              p.coalescing.name = coalescing;
              p.stack.name = stack;
              p.scheduler.name = scheduler;
              p.prefetch.name = prefetchers[number % prefetchers.size()];
              p.retest = retest;
              p.mshr_entries = entries;
              p.result_store = number++ % 2;
              p.warps = 1 + number % 3;
              p.request_bytes = 32u << number % 3;
            }
  return out;
}

TEST_CASE(
    "with every combination of policies each ray finds the same hit, and skipping to events changes no "
    "cycle") {
  uint64_t hits = 0, combination = 0, spills = 0, restarts = 0, across = 0, stale = 0, full = 0,
           prefetches = 0;
  std::vector<std::unique_ptr<BuiltScene>> built;
  std::vector<Scene> scenes;
  for (const std::string& format : Registry<NodeFormat>::names()) {
    scenes.push_back(crowd(built.size(), 60));
    built.push_back(std::make_unique<BuiltScene>(scenes.back(), format));
  }
  for (const Params& params : combinations()) {
    const BuiltScene& scene = *built[combination % built.size()];
    const bool gather = combination / 4 % 2;
    ++combination;
    CAPTURE(params.child_order.name, params.coalescing.name, params.stack.name, params.scheduler.name,
            params.prefetch.name, params.retest, params.mshr_entries, gather);
    Rays expected(combination, scene, false), ticked(combination, scene, gather),
        skipped(combination, scene, gather);
    mem::FixedLatencyMemory l1_ticked(20, 2), l1_skipped(20, 2);
    const RtUnit::Context context{
        scene.memory,    l1_ticked, nullptr, Address{1} << 30, {Address{1} << 31, gather ? 3u : 0u},
        Address{1} << 32};
    RtUnit::Context other{scene.memory, l1_skipped, nullptr, context.results, context.tables, context.stacks};
    RtUnit all(params, context), some(params, other);
    const Launch a = launch(all, l1_ticked, ticked.warps, true),
                 b = launch(some, l1_skipped, skipped.warps, false);
    REQUIRE(a.completion == b.completion);
    REQUIRE(all.stats().cycles.parts() == some.stats().cycles.parts());
    for (size_t w = 0; w < expected.warps.size(); ++w)
      for (size_t lane = 0; lane < kLanes; ++lane) {
        RayState& e = expected.warps[w][lane];
        run_to_end(e, scene.memory);
        REQUIRE(ticked.warps[w][lane].status == RayStatus::Done);
        REQUIRE(same_hit(e.committed, ticked.warps[w][lane].committed));
        hits += e.committed.valid();
      }
    const RtStats& s = all.stats();
    REQUIRE(s.stack_fills.value() <= s.stack_spills.value());
    REQUIRE(s.finished.value() + s.suspended.value() == s.rays.value() + s.resumed.value());
    spills += s.stack_spills.value();
    restarts += s.restarts.value();
    across += s.merged_across.value();
    stale += s.stale_nodes.value();
    full += s.cycles.count(Stall::MshrFull);
    prefetches += s.cycles.count(Stall::Prefetch);
  }
  CHECK(combination == combinations().size());
  CHECK(hits > 10000);
  // Each mechanism must have been at work.
  for (const uint64_t count : {spills, restarts, across, stale, full, prefetches}) CHECK(count > 100);
}

}  // namespace
}  // namespace glint::rt::test

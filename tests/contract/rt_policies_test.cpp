// Tests that rays find what the functional traversal finds, whatever the RT unit's policies and limits are.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <utility>

#include "base/registry.h"
#include "tests/support/catch.h"
#include "tests/support/rt_brute.h"
#include "tests/support/rt_trace.h"
#include "tests/support/stat_listing.h"

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
        state.ray.flags = std::array{0u, 4u, 5u, 0x100u, 0x201u, 0x205u}[random.below(6)];
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

// Takes the next policy of a kind from a number, which has a digit for each kind.
template <class Interface>
std::string take(uint32_t& number) {
  const std::vector<std::string> names = Registry<Interface>::names();
  const std::string name = names[number % names.size()];
  number /= uint32_t(names.size());
  return name;
}

// Chooses the policies that go around a traversal, all combinations of them in turn. Those that do not go
// together make way.
void choose_around(uint32_t number, Params& p) {
  p.prefetch.name = take<Prefetcher>(number);
  p.mapping.name = take<WorkMapping>(number);
  p.entry.name = take<RayEntry>(number);
  p.pool.name = take<RayPool>(number);
  p.order.name = take<TraversalOrder>(number);
  p.leaf_filter.name = take<LeafFilter>(number);
  p.oracle.any_lane = number % 2;
  if (p.scheduler.make({})->needs_treelet_ahead()) p.prefetch.name = "treelet";
  Params alone = p;
  alone.pool.name = RayPool::kNone, alone.mapping.name = WorkMapping::kOwnRay;
  if (!RtUnit::why_not_together(alone).empty()) p.order.name = TraversalOrder::kDepthFirst;
  if (!RtUnit::why_not_together(p).empty()) p.pool.name = RayPool::kNone;
  if (!RtUnit::why_not_together(p).empty()) p.mapping.name = WorkMapping::kOwnRay;
  REQUIRE(RtUnit::why_not_together(p) == "");
}

// Returns every policy that a traversal may depend on, and the limits beside it.
std::vector<Params> combinations() {
  std::vector<Params> out;
  uint32_t number = 0;
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
              choose_around(37 * number, p);  // The factor keeps a digit from following a loop.
              p.retest = retest;
              p.mshr_entries = entries;
              p.result_store = number++ % 2;
              p.warps = 1 + number % 3;
              p.request_bytes = 32u << number % 3;
            }
  return out;
}

TEST_CASE("every two policies that go together are tried together") {
  const auto names = [](const Params& p) {
    return std::array{p.prefetch.name, p.mapping.name, p.entry.name,
                      p.pool.name,     p.order.name,   p.leaf_filter.name};
  };
  std::set<std::pair<std::string, std::string>> tried;
  for (const Params& p : combinations())
    for (const std::string& a : names(p))
      for (const std::string& b : names(p)) tried.emplace(a, b);
  for (const std::string& prefetch : Registry<Prefetcher>::names())
    for (const std::string& mapping : Registry<WorkMapping>::names())
      for (const std::string& entry : Registry<RayEntry>::names())
        for (const std::string& pool : Registry<RayPool>::names())
          for (const std::string& order : Registry<TraversalOrder>::names())
            for (const std::string& filter : Registry<LeafFilter>::names()) {
              Params p;
              p.stack.name = "full";
              p.prefetch.name = prefetch, p.mapping.name = mapping, p.entry.name = entry, p.pool.name = pool;
              p.order.name = order, p.leaf_filter.name = filter;
              if (!RtUnit::why_not_together(p).empty()) continue;
              for (const std::string& a : names(p))
                for (const std::string& b : names(p)) {
                  CAPTURE(a, b);
                  CHECK(tried.contains({a, b}));
                }
            }
}

TEST_CASE(
    "with every combination of policies each ray finds the same hit, and skipping to events changes no "
    "cycle") {
  uint64_t hits = 0, combination = 0, spills = 0, restarts = 0, across = 0, stale = 0, full = 0,
           prefetches = 0, predicted = 0, moves = 0, formed = 0, decided = 0;
  std::vector<std::unique_ptr<BuiltScene>> built;
  std::vector<Scene> scenes;
  const auto layouts = Registry<TreeLayout>::names();
  for (const std::string& format : Registry<NodeFormat>::names()) {
    scenes.push_back(crowd(built.size(), 60));
    const std::string& layout = layouts[built.size() % layouts.size()];
    built.push_back(
        std::make_unique<BuiltScene>(scenes.back(), BuildOptions{format.c_str(), true, layout.c_str()}));
  }
  for (const Params& params : combinations()) {
    const BuiltScene& scene = *built[combination % built.size()];
    const bool gather = combination / 4 % 2 && params.pool.name == RayPool::kNone;
    ++combination;
    CAPTURE(params.child_order.name, params.coalescing.name, params.stack.name, params.scheduler.name,
            params.prefetch.name, params.mapping.name, params.entry.name, params.pool.name, params.order.name,
            params.leaf_filter.name, params.oracle.any_lane, params.retest, params.mshr_entries, gather);
    Rays expected(combination, scene, false), ticked(combination, scene, gather),
        skipped(combination, scene, gather);
    mem::FixedLatencyMemory l1_ticked(20, 2), l1_skipped(20, 2);
    stats::Group root_ticked(nullptr, "ticked"), root_skipped(nullptr, "skipped");
    RtUnit all(params, context_of(scene.memory, l1_ticked, root_ticked, gather ? 3 : 0)),
        some(params, context_of(scene.memory, l1_skipped, root_skipped, gather ? 3 : 0));
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
    const std::string listed = glint::test::listing(root_ticked);
    predicted += glint::test::counter_in(listed, "predicted");
    moves += glint::test::counter_in(listed, "moves");
    decided += glint::test::counter_in(listed, "transparent") + glint::test::counter_in(listed, "opaque");
    formed += params.pool.name != RayPool::kNone;
  }
  CHECK(combination == combinations().size());
  CHECK(hits > 10000);
  // Each mechanism must have been at work.
  for (const uint64_t count : {spills, restarts, across, stale, full, prefetches, predicted, moves, decided})
    CHECK(count > 100);
  CHECK(formed > 10);
}

}  // namespace
}  // namespace glint::rt::test

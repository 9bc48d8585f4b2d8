// Tests that every registered ray pool keeps the promises of rtunit/ray_pool.h.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdint>
#include <fmt/format.h>
#include <string>
#include <utility>
#include <vector>

#include "base/config.h"
#include "base/diagnostics.h"
#include "base/registry.h"
#include "tests/support/catch.h"
#include "tests/support/rt_brute.h"
#include "tests/support/rt_trace.h"
#include "tests/support/stat_listing.h"

namespace glint::rt::test {
namespace {

constexpr uint32_t kWarps = 12;
constexpr uint32_t kNoShader = ray_flag::kOpaque | ray_flag::kSkipAabbs;
const BuildOptions kTreelets{"bvh6", true, "treelet_breadth_first"};

TEST_CASE("a pool names each waiting ray once, and repeats itself exactly") {
  Random of_scene{8};
  mem::AddressSpace memory;
  const StructureInfo top = single(memory, triangles(soup(of_scene, 600, 8, 3)), kTreelets);
  for (const std::string& name : Registry<RayPool>::names()) {
    if (name == RayPool::kNone) continue;
    CAPTURE(name);
    const auto& entry = Registry<RayPool>::instance().entry(name);
    const RayPool::Context context{nullptr, memory, 2, kWarps * kLanes};
    const auto a = entry.make_default(context), b = entry.make_default(context);
    Random random{5};
    std::vector<bool> waits(context.rays), was_in(context.rays);
    std::vector<RayState> rays(context.rays);
    for (RayState& ray : rays) {
      ray = ray_of(top.address, random.point(12), random.point(1), 0, 60);
      REQUIRE(begin(ray, memory));
      for (uint32_t steps = random.below(20); steps && ray.status == RayStatus::Traversing; --steps) {
        const Fetch node = next_fetch(ray);
        RayState before = ray;
        step(ray, memory.find(node.address, node.bytes));
        if (ray.status != RayStatus::Traversing) ray = before;
      }
    }
    uint32_t waiting = 0, named = 0;
    for (Cycle now = 1; now < 400; ++now) {
      for (uint32_t i = 0; i < 20; ++i) {
        const uint32_t id = random.below(context.rays);
        if (waits[id]) continue;
        const WaitingRay ray{id, !was_in[id], was_in[id] && id % 2, &rays[id]};
        a->add(ray, now);
        b->add(ray, now);
        waits[id] = was_in[id] = true;
        ++waiting;
      }
      std::array<uint32_t, kLanes> ids{}, again{};
      const uint32_t count = a->form(ids, now);
      REQUIRE(count == b->form(again, now));
      REQUIRE(count <= uint32_t(kLanes));
      for (uint32_t i = 0; i < count; ++i) {
        REQUIRE(ids[i] == again[i]);
        REQUIRE(waits[ids[i]]);
        waits[ids[i]] = false;
      }
      if (count == 0) REQUIRE(a->next_event(now) > now);
      waiting -= count;
      named += count;
    }
    for (Cycle now = 400; waiting != 0 && now < 100'000; ++now) {
      std::array<uint32_t, kLanes> ids{};
      const uint32_t count = a->form(ids, now);
      waiting -= count;
      if (count == 0) REQUIRE(a->next_event(now) != kNever);
    }
    CHECK(waiting == 0);
    CHECK(named > 500);
  }
}

template <class Interface = RayPool>
PolicyChoice<Interface> chosen(const std::string& name, const std::string& params) {
  PolicyChoice<Interface> choice(name.c_str());
  Config config;
  config.add_text("test", params);
  Diagnostics diagnostics;
  ConfigTable table = config.root(diagnostics);
  Registry<Interface>::instance().entry(name).read(table, &choice);
  REQUIRE_FALSE(diagnostics.has_errors());
  return choice;
}

// Traces warps of which only some lanes have rays, and these of very different lengths.
Traced trace(const Params& params, const mem::AddressSpace& memory, const StructureInfo& top, uint64_t seed,
             uint32_t flags, bool every_cycle) {
  Random random{seed};
  std::vector<WarpRays> rays(kWarps);
  for (WarpRays& warp : rays)
    for (RayState& state : warp) {
      state = ray_of(top.address, random.point(12), random.point(1), 0, random.below(3) ? 2 : 60);
      state.ray.flags = flags;
      state.rules.end_at_first_hit = false;
      REQUIRE(begin(state, memory));
    }
  return trace_rays(params, memory, std::move(rays), mem::FixedLatencyMemory(40, 1), every_cycle);
}

TEST_CASE("rays that change their warps find the hits that they find in one, with every other policy") {
  Random random{8};
  const Positions positions = soup(random, 600, 8, 3);
  mem::AddressSpace memory;
  const StructureInfo top = single(memory, triangles(positions), kTreelets);
  const std::vector<std::string> entries = Registry<RayEntry>::names();
  uint64_t seed = 0, returned = 0, runs = 0;
  for (const std::string& name : Registry<RayPool>::names())
    for (const std::string& stack : Registry<StackModel>::names())
      for (const std::string& prefetch : Registry<Prefetcher>::names())
        for (const std::string& scheduler : Registry<RayScheduler>::names())
          for (const uint32_t flags : {kNoShader, kNoShader | ray_flag::kTerminateOnFirstHit}) {
            Params params;
            params.pool.name = name;
            params.stack.name = stack;
            params.prefetch.name = prefetch;
            params.scheduler.name = scheduler;
            params.entry.name = entries[seed % entries.size()];
            params.retest = seed % 4 < 2;
            params.warps = uint32_t(1 + ++seed % 3);
            params.pool_warps = uint32_t(2 + seed % 5);
            params.pool_stacks = seed % 3 != 0;
            params.mshr_entries = seed % 2 ? 0 : 9;
            params.result_store = seed % 3 == 0;
            if (!RtUnit::why_not_together(params).empty()) continue;
            CAPTURE(name, stack, prefetch, scheduler, flags);
            const Traced a = trace(params, memory, top, seed, flags, true),
                         b = trace(params, memory, top, seed, flags, false);
            CHECK(a.completion == b.completion);
            CHECK(glint::test::first_difference(a.stats, b.stats) == "");
            returned += a.count("returned");
            runs += name != RayPool::kNone;
            Params alone = params;
            alone.pool.name = RayPool::kNone;
            const Traced c = trace(alone, memory, top, seed, flags, true);
            require_same_hits(a.rays, c.rays);
          }
  CHECK(runs > 8);
  CHECK(returned > 1000);
}

TEST_CASE("the rays of a treelet form warps that they leave with it") {
  Random random{8};
  mem::AddressSpace memory;
  const StructureInfo top = single(memory, triangles(soup(random, 600, 8, 3)), kTreelets);
  Params params;
  params.warps = 2;
  params.pool_warps = kWarps;
  const Traced alone = trace(params, memory, top, 3, 0, true);
  for (const int queue : {1, 2, 4096}) {
    CAPTURE(queue);
    params.pool = chosen("treelet_queues", fmt::format("spread = 1\nqueue = {}", queue));
    const Traced a = trace(params, memory, top, 3, 0, true), b = trace(params, memory, top, 3, 0, false);
    CHECK(a.completion == b.completion);
    CHECK(glint::test::first_difference(a.stats, b.stats) == "");
    require_same_hits(a.rays, alone.rays);
    CHECK(a.count("returned") > 20);
    CHECK((a.count("treelet_warps") > 5) == (queue != 4096));
  }
}

TEST_CASE("rays whose look-up gave a node form warps of their own, and keep what was looked up") {
  Random random{8};
  mem::AddressSpace memory;
  const StructureInfo top = single(memory, triangles(soup(random, 600, 8, 3)), kTreelets);
  constexpr uint32_t kFirstHit = kNoShader | ray_flag::kTerminateOnFirstHit;
  Params params;
  params.warps = 2;
  params.pool_warps = kWarps;
  params.entry = chosen<RayEntry>("predictor", "origin_bits = 1\ndirection_bits = 1");
  const Traced none = trace(params, memory, top, 3, kFirstHit, true);
  params.pool.name = "predicted";
  const Traced a = trace(params, memory, top, 3, kFirstHit, true),
               b = trace(params, memory, top, 3, kFirstHit, false);
  CHECK(a.completion == b.completion);
  CHECK(glint::test::first_difference(a.stats, b.stats) == "");
  CHECK(none.count("looked_up") == kWarps * kLanes);
  CHECK(a.count("looked_up") == kWarps * kLanes);
  CHECK(a.count("predicted") > 20);
  CHECK(a.count("verified") > 0);
  CHECK(a.count("returned") == a.count("predicted"));
  CHECK(a.count("state_reads") == 0);   // They have no state to move.
  params.entry.name = RayEntry::kRoot;  // Nobody predicts anything.
  CHECK(trace(params, memory, top, 3, kFirstHit, true).count("returned") == 0);
}

TEST_CASE("a pool refuses what follows a ray in its lane") {
  Params params;
  params.pool.name = "repack";
  CHECK(RtUnit::why_not_together(params).empty());
  const auto refused = [&](auto Params::*choice, const char* name) {
    Params other = params;
    (other.*choice).name = name;
    return RtUnit::why_not_together(other).find(name) != std::string::npos;
  };
  CHECK(refused(&Params::mapping, "cooperative"));
  CHECK(refused(&Params::any_hit, "deferred"));
  params.shortcuts.store_each_hit = true;
  CHECK_FALSE(refused(&Params::any_hit, "deferred"));
}

}  // namespace
}  // namespace glint::rt::test

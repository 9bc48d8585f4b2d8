// Tests that every registered work mapping keeps the promises of rtunit/work_mapping.h.
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/registry.h"
#include "tests/support/catch.h"
#include "tests/support/rt_brute.h"
#include "tests/support/rt_trace.h"
#include "tests/support/stat_listing.h"

namespace glint::rt::test {
namespace {

TEST_CASE("a mapping moves from a giver to a taker, and repeats itself exactly") {
  const auto names = Registry<WorkMapping>::names();
  REQUIRE(names.size() >= 2);
  for (const std::string& name : names) {
    CAPTURE(name);
    const auto& entry = Registry<WorkMapping>::instance().entry(name);
    const auto a = entry.make_default({}), b = entry.make_default({});
    Random random{5};
    uint32_t moves = 0;
    for (int round = 0; round < 2000; ++round) {
      WorkView view;
      for (int lane = 0; lane < kLanes; ++lane) {
        const uint32_t kind = random.below(3);
        view.givers |= LaneMask{kind == 0} << lane;
        view.takers |= LaneMask{kind == 1} << lane;
      }
      if (!view.givers || !view.takers) continue;
      const auto move = a->choose(view), again = b->choose(view);
      REQUIRE(move.has_value() == again.has_value());
      if (!move) continue;
      ++moves;
      REQUIRE(move->from == again->from);
      REQUIRE(move->to == again->to);
      REQUIRE((view.givers >> move->from & 1) == 1);
      REQUIRE((view.takers >> move->to & 1) == 1);
    }
    CHECK((moves != 0) == (name != WorkMapping::kOwnRay));
    CHECK(a->moves_per_cycle() >= 1);
  }
}

// Traces warps of which only some lanes have rays, and these of very different lengths.
Traced trace_uneven(const Params& params, const mem::AddressSpace& memory, const StructureInfo& top,
                    uint64_t seed, uint32_t flags, bool every_cycle) {
  Random random{seed};
  std::vector<WarpRays> rays(5);
  for (WarpRays& warp : rays)
    for (RayState& state : warp) {
      state = ray_of(top.address, random.point(12), random.point(1), 0, random.below(3) ? 2 : 60);
      state.ray.flags = flags;
      state.rules.end_at_first_hit = false;
      REQUIRE(begin(state, memory));
    }
  return trace_rays(params, memory, std::move(rays), mem::FixedLatencyMemory(40, 1), every_cycle);
}

TEST_CASE("rays whose work lanes share find the hits that they find alone, with every other policy") {
  Random random{8};
  const Positions positions = soup(random, 600, 8, 3);
  mem::AddressSpace memory;
  const StructureInfo top = single(memory, triangles(positions));
  uint64_t seed = 0, moves = 0;
  for (const std::string& name : Registry<WorkMapping>::names())
    for (const std::string& stack : Registry<StackModel>::names())
      for (const std::string& prefetch : Registry<Prefetcher>::names())
        for (const bool retest : {true, false})
          for (const uint32_t flags : {0u, 4u}) {
            Params params;
            params.mapping.name = name;
            params.stack.name = stack;
            params.prefetch.name = prefetch;
            params.retest = retest;
            params.warps = uint32_t(1 + ++seed % 3);
            params.mshr_entries = seed % 2 ? 0 : 9;
            params.result_store = seed % 3 == 0;
            if (!RtUnit::why_not_together(params).empty()) continue;
            CAPTURE(name, stack, prefetch, retest, flags);
            const Traced a = trace_uneven(params, memory, top, seed, flags, true),
                         b = trace_uneven(params, memory, top, seed, flags, false);
            CHECK(a.completion == b.completion);
            CHECK(glint::test::first_difference(a.stats, b.stats) == "");
            moves += a.count("moves");
            CHECK((a.count("moves") != 0) == (name != WorkMapping::kOwnRay));
            Params alone = params;
            alone.mapping.name = WorkMapping::kOwnRay;
            const Traced c = trace_uneven(alone, memory, top, seed, flags, true);
            require_same_hits(a.rays, c.rays);
          }
  CHECK(moves > 5000);
}

TEST_CASE("a ray that may need a shader is not shared, and gets its shader") {
  Random random{8};
  const Positions positions = soup(random, 300, 8, 3);
  for (const bool opaque : {true, false}) {
    mem::AddressSpace memory;
    const StructureInfo top = single(memory, triangles(positions, opaque));
    Params params;
    params.mapping.name = "cooperative";
    const Traced plain = trace_uneven(params, memory, top, 3, 0, true);
    CHECK((plain.count("moves") != 0) == opaque);
    const Traced forced = trace_uneven(params, memory, top, 3, ray_flag::kOpaque, true);
    CHECK(forced.count("moves") != 0);
    const Traced refused = trace_uneven(params, memory, top, 3, ray_flag::kNoOpaque, true);
    CHECK(refused.count("moves") == 0);
  }
}

TEST_CASE("a stack that follows a ray's path is refused with a mapping that shares rays") {
  Params params;
  params.stack.name = "restart_trail";
  CHECK(RtUnit::why_not_together(params).empty());
  params.mapping.name = "cooperative";
  CHECK(RtUnit::why_not_together(params).find("restart_trail") != std::string::npos);
}

}  // namespace
}  // namespace glint::rt::test

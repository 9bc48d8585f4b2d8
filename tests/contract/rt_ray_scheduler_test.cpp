// Tests that every registered ray scheduler keeps the promises of rtunit/ray_scheduler.h.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdint>

#include "base/registry.h"
#include "rtunit/ray_scheduler.h"
#include "rtunit/unit/rt_unit.h"
#include "tests/support/catch.h"
#include "tests/support/rt_scenes.h"

namespace glint::rt::test {
namespace {

// Lets each lane want one of a few nodes.
struct RandomNodes final : WantedNodes {
  std::array<LaneMask, 8> wanting{};
  std::array<std::array<Fetch, kLanes>, 8> nodes;
  TreeletId ahead = kNoTreelet;
  LaneMask lanes(uint32_t warp) const override { return wanting[warp]; }
  const Fetch& node(uint32_t warp, int lane) const override { return nodes[warp][size_t(lane)]; }
  TreeletId treelet(uint32_t warp, int lane) const override { return 1 + node(warp, lane).address / 512; }
  TreeletId treelet_ahead() const override { return ahead; }
};

TEST_CASE("every scheduler picks a ready warp, repeats itself exactly and serves all") {
  const auto names = Registry<RayScheduler>::names();
  REQUIRE(names.size() >= 2);
  for (const std::string& name : names) {
    CAPTURE(name);
    const auto& entry = Registry<RayScheduler>::instance().entry(name);
    const auto a = entry.make_default({nullptr, 8}), b = entry.make_default({nullptr, 8});
    RandomNodes wanted;
    Random random{5};
    std::vector<WarpView> warps(8);
    uint64_t age = 0;
    std::array<uint32_t, 8> served{};
    for (WarpView& w : warps) w.age = age++;
    for (int round = 0; round < 5000; ++round) {
      bool any = false;
      for (size_t i = 0; i < warps.size(); ++i) {
        WarpView& w = warps[i];
        w.ready = random.below(3) == 0;
        w.lanes_wanting = w.ready ? 1 + random.below(32) : 0;
        wanted.wanting[i] = w.lanes_wanting ? kAllLanes >> (32 - w.lanes_wanting) : 0;
        for (Fetch& node : wanted.nodes[i]) node = {64 * (1 + random.below(40)), 64, NodeKind::Internal};
        any |= w.ready;
      }
      wanted.ahead = random.below(6);
      const auto [pick, lane] = a->choose(warps, wanted);
      const RayScheduler::Choice again = b->choose(warps, wanted);
      REQUIRE(pick == again.warp);
      REQUIRE(lane == again.lane);
      if (!any) {
        REQUIRE(pick == RayScheduler::kNone);
        continue;
      }
      REQUIRE(pick < warps.size());
      REQUIRE(warps[pick].ready);
      REQUIRE((lane < 0 || (wanted.wanting[pick] >> lane & 1)));
      ++served[pick];
      if (random.below(10) == 0) warps[pick].age = age++;  // it left, another came
    }
    for (uint32_t n : served) CHECK(n > 50);
  }
}

TEST_CASE("omr prefers the oldest warp with a lane in the treelet that is read ahead, and pmr the fullest") {
  RandomNodes wanted;
  std::vector<WarpView> warps(4);
  for (uint32_t i = 0; i < 4; ++i) {
    warps[i] = {true, 4, 10 - i, 0};  // The last one is the oldest.
    wanted.wanting[i] = 0xf;
    wanted.nodes[i].fill({64, 64, NodeKind::Internal});
  }
  const auto pick = [&](const char* name) {
    return Registry<RayScheduler>::instance()
        .entry(name)
        .make_default({nullptr, 4})
        ->choose(warps, wanted)
        .warp;
  };
  const Fetch ahead{5 * 512, 64, NodeKind::Internal};
  wanted.nodes[1][0] = wanted.nodes[1][2] = wanted.nodes[2][3] = ahead;
  CHECK(pick("omr") == 3);  // Nothing is read ahead.
  CHECK(pick("pmr") == 3);
  wanted.ahead = 6;
  CHECK(pick("omr") == 2);
  CHECK(pick("pmr") == 1);
  warps[1].ready = false;
  CHECK(pick("pmr") == 2);
}

TEST_CASE("schedulers that go by the treelet that is read ahead are refused without one, with a reason") {
  for (const char* name : {"omr", "pmr"}) {
    Params params;
    params.scheduler.name = name;
    CHECK(RtUnit::why_not_together(params).find("rt.prefetch") != std::string::npos);
    params.prefetch.name = "treelet";
    CHECK(RtUnit::why_not_together(params).empty());
    CHECK(RtUnit::who_needs_treelets(params).find("treelet") != std::string::npos);
  }
  CHECK(RtUnit::who_needs_treelets({}).empty());
}

}  // namespace
}  // namespace glint::rt::test

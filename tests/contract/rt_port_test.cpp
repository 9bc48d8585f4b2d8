// Tests that the RT unit keeps the promises of rtunit/rt_port.h under every scheduler.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <map>

#include "base/registry.h"
#include "tests/support/catch.h"
#include "tests/support/rt_launch.h"

namespace glint::rt::test {
namespace {

TEST_CASE("each submit is answered once, later, with every ray stopped") {
  Random random{8};
  const Positions positions = soup(random, 400, 10, 2);
  mem::AddressSpace memory;
  const StructureInfo top = single(memory, triangles(positions, false));
  for (const std::string& name : Registry<RayScheduler>::names()) {
    CAPTURE(name);
    Params params;
    params.scheduler.name = name;
    params.warps = 3;
    mem::FixedLatencyMemory l1(15, 1);
    RtUnit unit(params, {memory, l1});
    std::vector<WarpRays> warps(9);
    for (WarpRays& warp : warps)
      for (RayState& state : warp) {
        state = ray_of(top.address, random.point(12), random.point(1));
        REQUIRE(begin(state, memory));
      }
    std::map<uint32_t, Cycle> open;
    uint32_t next = 0, answers = 0;
    for (Cycle now = 0; answers < warps.size(); ++now) {
      REQUIRE(now < 1'000'000);
      unit.tick(now);
      for (;;) {
        const bool may_return = unit.has_completion();
        const auto warp = unit.pop_completion(now);
        CHECK((may_return || !warp));
        if (!warp) break;
        REQUIRE(open.count(*warp) == 1);
        CHECK(open[*warp] < now);
        open.erase(*warp);
        ++answers;
        for (const RayState& state : warps[*warp])
          CHECK((state.status == RayStatus::Done || state.status == RayStatus::NeedsAnyHit));
      }
      CHECK(unit.can_accept() == (open.size() < 3));
      if (next < warps.size() && unit.can_accept()) {
        open[next] = now;
        unit.submit(now, next, kAllLanes, warps[next].data());
        ++next;
      }
    }
    CHECK(open.empty());
    CHECK_FALSE(unit.pop_completion(1'000'000).has_value());
  }
}

}  // namespace
}  // namespace glint::rt::test

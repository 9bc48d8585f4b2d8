// Tests that every registered ray scheduler keeps the promises of rtunit/ray_scheduler.h.
// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "base/registry.h"
#include "rtunit/ray_scheduler.h"
#include "tests/support/catch.h"
#include "tests/support/rt_scenes.h"

namespace glint::rt::test {
namespace {

TEST_CASE("every scheduler picks a ready warp, repeats itself exactly and serves all") {
  const auto names = Registry<RayScheduler>::names();
  REQUIRE(names.size() >= 2);
  for (const std::string& name : names) {
    CAPTURE(name);
    const auto& entry = Registry<RayScheduler>::instance().entry(name);
    const auto a = entry.make_default({}), b = entry.make_default({});
    Random random{5};
    std::vector<WarpView> warps(8);
    uint64_t age = 0;
    std::array<uint32_t, 8> served{};
    for (WarpView& w : warps) w.age = age++;
    for (int round = 0; round < 5000; ++round) {
      bool any = false;
      for (WarpView& w : warps) {
        w.ready = random.below(3) == 0;
        w.lanes_wanting = w.ready ? 1 + random.below(32) : 0;
        any |= w.ready;
      }
      const uint32_t pick = a->pick(warps);
      REQUIRE(pick == b->pick(warps));
      if (!any) {
        REQUIRE(pick == RayScheduler::kNone);
        continue;
      }
      REQUIRE(pick < warps.size());
      REQUIRE(warps[pick].ready);
      ++served[pick];
      if (random.below(10) == 0) warps[pick].age = age++;  // it left, another came
    }
    for (uint32_t n : served) CHECK(n > 50);
  }
}

}  // namespace
}  // namespace glint::rt::test

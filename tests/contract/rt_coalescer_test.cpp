// Tests that every registered coalescing policy keeps the promises of rtunit/coalescer.h.
// SPDX-License-Identifier: Apache-2.0
#include <bit>

#include "base/registry.h"
#include "rtunit/coalescer.h"
#include "tests/support/catch.h"
#include "tests/support/rt_scenes.h"

namespace glint::rt::test {
namespace {

TEST_CASE("a coalescing policy names no partners, or the warp itself and others that are ready") {
  const auto names = Registry<Coalescer>::names();
  REQUIRE(names.size() >= 3);
  for (const std::string& name : names) {
    CAPTURE(name);
    const auto policy = Registry<Coalescer>::instance().entry(name).make_default({});
    Random random{7};
    for (int i = 0; i < 2000; ++i) {
      std::vector<WarpView> warps(1 + random.below(64));
      uint64_t ready = 0;
      for (size_t w = 0; w < warps.size(); ++w) {
        warps[w].ready = random.below(2);
        ready |= uint64_t{warps[w].ready} << w;
      }
      if (!ready) continue;
      const auto picked = uint32_t(std::countr_zero(ready));
      const uint64_t partners = policy->partners(picked, warps);
      REQUIRE(partners == policy->partners(picked, warps));
      REQUIRE((partners & ~ready) == 0);
      REQUIRE((partners == 0 || (partners >> picked & 1)));
    }
  }
}

TEST_CASE("lanes share a fetch with nobody, with their warp, or with all that are ready") {
  std::vector<WarpView> warps(5);
  warps[1].ready = warps[2].ready = warps[4].ready = true;
  const auto partners = [&](const char* name) {
    return Registry<Coalescer>::instance().entry(name).make_default({})->partners(2, warps);
  };
  CHECK(partners("each_lane") == 0);
  CHECK(partners("within_warp") == 0b00100);
  CHECK(partners("across_warps") == 0b10110);
}

}  // namespace
}  // namespace glint::rt::test

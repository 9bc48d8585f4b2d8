// Runs a load-store unit until it is idle.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "core/lsu.h"
#include "tests/support/catch.h"

namespace glint::core {

// Returns the cycles in which accesses complete, until the unit is idle.
inline std::vector<Cycle> completions(Lsu& lsu, Cycle from) {
  std::vector<Cycle> out;
  for (Cycle now = from; !lsu.idle(); ++now) {
    REQUIRE(now < from + 10'000);
    lsu.tick(now);
    for (uint32_t id : lsu.completed()) {
      out.push_back(now);
      lsu.release(id);
    }
  }
  return out;
}

}  // namespace glint::core

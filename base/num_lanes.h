// Counts the lanes of a mask without needing an instruction that not every machine has.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "base/types.h"

namespace glint {

// Returns the number of set bits of `mask`. std::popcount is not used because it calls a library function
// where the compiler may not assume the instruction.
constexpr uint32_t num_lanes(LaneMask mask) {
  mask -= (mask >> 1) & 0x5555'5555u;
  mask = (mask & 0x3333'3333u) + ((mask >> 2) & 0x3333'3333u);
  mask = (mask + (mask >> 4)) & 0x0f0f'0f0fu;
  return mask * 0x0101'0101u >> 24;
}
static_assert(num_lanes(kAllLanes) == kLanes && num_lanes(0x8000'0001u) == 2 && num_lanes(0) == 0);

}  // namespace glint

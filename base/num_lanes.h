// Works on masks of lanes: counts them without needing an instruction that not every machine has, and lets
// lanes of two masks change places.
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

// Lets bit `i` of `a` and bit `j` of `b` change places.
constexpr void swap_bits(LaneMask& a, int i, LaneMask& b, int j) {
  const LaneMask differ = (a >> i ^ b >> j) & 1;
  a ^= differ << i;
  b ^= differ << j;
}

}  // namespace glint

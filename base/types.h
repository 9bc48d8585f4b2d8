// Defines the plain units of the model: cycles, addresses, lane masks, and the size of a warp.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstdint>

namespace glint {

using Cycle = uint64_t;     // core clock cycles since launch
using Address = uint64_t;   // virtual address in simulated memory (memsys/address_space.h)
using LaneMask = uint32_t;  // bit i = lane i of a warp

inline constexpr int kLanes = 32;                   // lanes of a warp
inline constexpr LaneMask kAllLanes = 0xffff'ffff;  // every lane of a warp
inline constexpr Cycle kNever = ~Cycle{0};          // marks that no event is scheduled

// Calls `visit(lane)` for each set bit, lowest lane first.
template <class Visit>
inline void for_each_lane(LaneMask mask, Visit&& visit) {
  for (; mask; mask &= mask - 1) visit(std::countr_zero(mask));
}

}  // namespace glint

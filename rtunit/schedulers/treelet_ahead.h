// Chooses among warps by the lanes whose node lies in the treelet that is read ahead.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <span>

#include "rtunit/ray_scheduler.h"

namespace glint::rt {

// Returns the ready warp with the most lanes in the treelet that is read ahead, where lanes above `most` do
// not count. Of equals, and when no lane is in it, the oldest warp is chosen.
inline uint32_t by_treelet_ahead(std::span<const WarpView> warps, const WantedNodes& wanted, uint32_t most) {
  const TreeletId ahead = wanted.treelet_ahead();
  uint32_t best = RayScheduler::kNone, most_lanes = 0;
  for (uint32_t warp = 0; warp < warps.size(); ++warp) {
    if (!warps[warp].ready) continue;
    uint32_t lanes = 0;
    if (ahead != kNoTreelet)
      for_each_lane(wanted.lanes(warp), [&](int lane) { lanes += wanted.treelet(warp, lane) == ahead; });
    lanes = std::min(lanes, most);
    const bool is_older = best == RayScheduler::kNone || warps[warp].age < warps[best].age;
    if (lanes < most_lanes || (lanes == most_lanes && !is_older)) continue;
    most_lanes = lanes;
    best = warp;
  }
  return best;
}

}  // namespace glint::rt

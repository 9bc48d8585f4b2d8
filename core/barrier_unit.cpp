// Implements the barrier unit of a core.
// SPDX-License-Identifier: Apache-2.0
#include "core/barrier_unit.h"

#include <algorithm>

namespace glint::core {

void BarrierUnit::come(uint32_t slot, Cycle now, Cycle latency) {
  WarpSlot& at = core_.warps[slot];
  ++core_.counts.stats.barriers;
  free_at_ = std::max(free_at_, now) + core_.params.units.barrier.interval;
  at.front = {at.warp.waiting_at_barrier ? kNever : free_at_ + latency, Stall::Barrier};
  pass(*at.warp.block, free_at_ + latency, now);
}

void BarrierUnit::end_warp(const exec::Block& block, Cycle now) {
  pass(block, now + core_.params.units.barrier.latency, now);
}

// Lets the warps of the block whose barrier has opened issue from `at` on.
void BarrierUnit::pass(const exec::Block& block, Cycle at, Cycle now) {
  for (uint32_t w = 0; w < block.num_warps(); ++w) {
    if (!(block.live() >> w & 1) || block.warps[w]->waiting_at_barrier) continue;
    const uint32_t slot = block.warps[w]->slot;
    Scoreboard::Ready& front = core_.warps[slot].front;
    if (front.at != kNever || front.wait != Stall::Barrier) continue;
    front.at = at;
    core_.warps.refresh(slot, now);
  }
}

}  // namespace glint::core

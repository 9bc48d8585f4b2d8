// Attributes every cycle of an RT unit to exactly one reason.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/unit/rt_unit.h"

namespace glint::rt {

void RtUnit::account_gap(Cycle now) {
  if (now <= next_unaccounted_) return;
  const uint64_t skipped = now - next_unaccounted_;
  stats_.cycles.add(gap_reason_, skipped);
  stats_.unit_cycles += skipped;
  stats_.warp_cycles += skipped * gap_warps_;
  stats_.lane_slots += skipped * gap_warps_ * kLanes;
  stats_.ray_cycles += skipped * gap_rays_;
  next_unaccounted_ = now;
}

void RtUnit::account(Cycle now, Stall reason) {
  if (now < next_unaccounted_) return;  // ticked twice in a cycle: counted once
  stats_.cycles.add(reason);
  ++stats_.unit_cycles;
  stats_.warp_cycles += num_resident_;
  stats_.lane_slots += uint64_t(num_resident_) * kLanes;
  stats_.ray_cycles += num_rays_;
  next_unaccounted_ = now + 1;
  gap_reason_ = waiting_reason();
  gap_warps_ = num_resident_;
  gap_rays_ = num_rays_;
}

// What a cycle in which nothing is sent is spent on.
Stall RtUnit::waiting_reason() const {
  if (is_mshr_full() && has_reads_waiting()) return Stall::MshrFull;
  for (const Pipeline& pipe : pipes_)
    if (!pipe.waiting.empty()) return Stall::TestBusy;
  if (num_fetches_) return Stall::WaitingMemory;
  for (const Pipeline& pipe : pipes_)
    if (!pipe.running.empty()) return Stall::TestLatency;
  return num_resident_ ? Stall::Handover : Stall::Idle;
}

}  // namespace glint::rt

// Attributes every cycle of the RT unit to exactly one reason.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "base/types.h"
#include "rtunit/unit/rt_stats.h"

namespace glint::rt {

class CycleAccount {
 public:
  // Says how much the unit holds.
  struct Load {
    uint32_t warps = 0, rays = 0;
  };

  explicit CycleAccount(RtStats& stats) : stats_(stats) {}

  // Accounts the cycles before `now` that were skipped. Nothing happened in them, so each has the reason that
  // held at the end of the last accounted cycle.
  void skip_to(Cycle now) {
    if (now <= next_) return;
    add(now - next_, skipped_reason_, skipped_load_);
    next_ = now;
  }
  // Accounts cycle `now`; a second call for it has no effect. `idle_reason` is the reason of the following
  // cycles if they are skipped.
  void account(Cycle now, Stall reason, Stall idle_reason, Load load) {
    if (now < next_) return;
    add(1, reason, load);
    next_ = now + 1;
    skipped_reason_ = idle_reason;
    skipped_load_ = load;
  }
  // Returns what RtStats::warp_cycles will be at the start of cycle `at` if nothing happens before.
  uint64_t warp_cycles_until(Cycle at) const {
    return stats_.warp_cycles.value() + (at - next_) * skipped_load_.warps;
  }

 private:
  void add(uint64_t cycles, Stall reason, Load load) {
    stats_.cycles.add(reason, cycles);
    stats_.unit_cycles += cycles;
    stats_.warp_cycles += cycles * load.warps;
    stats_.lane_slots += cycles * load.warps * kLanes;
    stats_.ray_cycles += cycles * load.rays;
  }

  RtStats& stats_;
  Cycle next_ = 0;  // first cycle that has not been accounted
  Stall skipped_reason_ = Stall::Idle;
  Load skipped_load_;
};

}  // namespace glint::rt

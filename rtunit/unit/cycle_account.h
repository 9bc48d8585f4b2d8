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
    bool operator==(const Load&) const = default;
  };

  explicit CycleAccount(RtStats& stats) : stats_(stats) {}

  // Accounts cycle `now` and the cycles before it that were skipped; a second call for it has no effect.
  // `idle_reason` is the reason of the following cycles if they are skipped, because nothing happens in them.
  void account(Cycle now, Stall reason, Stall idle_reason, Load load) {
    if (now < next_) return;
    if (now > next_) begin(next_, idle_reason_);
    begin(now, reason);
    if (load != load_) {
      add_load(now);
      load_ = load;
    }
    next_ = now + 1;
    idle_reason_ = idle_reason;
  }
  // Accounts the cycles before `end`, which were skipped.
  void skip_to(Cycle end) {
    if (end > next_) {
      begin(next_, idle_reason_);
      next_ = end;
    }
    settle();
  }
  // Adds to the statistics what has been accounted since they were brought up to date last.
  void settle() const {
    add_reason(next_);
    add_load(next_);
  }
  // Returns what RtStats::warp_cycles will be at the start of cycle `at` if nothing happens before.
  uint64_t warp_cycles_until(Cycle at) const {
    return stats_.warp_cycles.value() + (at - load_since_) * load_.warps;
  }

 private:
  // Notes that cycles from `at` on have this reason. Most cycles have that of the cycle before.
  void begin(Cycle at, Stall reason) {
    if (reason == reason_) return;
    add_reason(at);
    reason_ = reason;
  }
  void add_reason(Cycle end) const {
    stats_.cycles.add(reason_, end - reason_since_);
    reason_since_ = end;
  }
  void add_load(Cycle end) const {
    const uint64_t cycles = end - load_since_;
    stats_.unit_cycles += cycles;
    stats_.warp_cycles += cycles * load_.warps;
    stats_.lane_slots += cycles * load_.warps * kLanes;
    stats_.ray_cycles += cycles * load_.rays;
    load_since_ = end;
  }

  RtStats& stats_;
  Cycle next_ = 0;  // first cycle that has not been accounted
  Stall reason_ = Stall::Idle, idle_reason_ = Stall::Idle;
  Load load_;
  // From these cycles on the unit has had reason_ and load_, and the statistics do not know it yet.
  mutable Cycle reason_since_ = 0, load_since_ = 0;
};

}  // namespace glint::rt

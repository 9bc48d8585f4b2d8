// Knows when each scheduler of a core has something to do.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "base/types.h"
#include "core/params.h"

namespace glint::core {

// Says which schedulers of a core have something to do, and when the others will. The state of all schedulers
// lies together because a core looks at all of it in each of its cycles.
class Alarms {
 public:
  Alarms() { timer_.fill(kNever); }
  void wake(uint32_t scheduler) { awake_ |= 1u << scheduler; }
  // Lets the scheduler sleep until `timer`, unless somebody wakes it before.
  void sleep(uint32_t scheduler, Cycle timer) {
    awake_ &= ~(1u << scheduler);
    timer_[scheduler] = timer;
  }
  // Brings the scheduler's timer forward to `timer`, if that is earlier.
  void sleep_less(uint32_t scheduler, Cycle timer) { timer_[scheduler] = std::min(timer_[scheduler], timer); }
  void watch(uint32_t scheduler) { watching_ |= 1u << scheduler; }
  void watch_nothing(uint32_t scheduler) { watching_ &= ~(1u << scheduler); }

  // These return schedulers as the bits of a mask: those that are awake, those that watch a full door, and
  // those that are awake or whose timer has run out.
  uint32_t awake() const { return awake_; }
  uint32_t watching() const { return watching_; }
  uint32_t due(Cycle now) const {
    uint32_t due = awake_;
    for (size_t s = 0; s < timer_.size(); ++s) due |= uint32_t{timer_[s] <= now} << s;
    return due;
  }
  // Returns the first cycle from `now` on in which a scheduler is due.
  Cycle next(Cycle now) const {
    return awake_ ? now : std::max(now, *std::min_element(timer_.begin(), timer_.end()));
  }

 private:
  uint32_t awake_ = 0, watching_ = 0;
  std::array<Cycle, kMaxSchedulers> timer_;
};

}  // namespace glint::core

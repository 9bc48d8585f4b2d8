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
  // `schedulers` is their number, at most kMaxSchedulers.
  explicit Alarms(uint32_t schedulers) : is_small_(schedulers <= kFew) { timer_.fill(kNever); }
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
  uint32_t due(Cycle now) const { return awake_ | (is_small_ ? rung<kFew>(now) : rung<kMaxSchedulers>(now)); }
  // Returns the first cycle from `now` on in which a scheduler is due.
  Cycle next(Cycle now) const {
    return awake_ ? now : std::max(now, is_small_ ? first<kFew>() : first<kMaxSchedulers>());
  }

 private:
  // Loops of a fixed length cost the host no mispredicted branch, and most cores have few schedulers.
  static constexpr size_t kFew = 4;
  template <size_t kCount>
  uint32_t rung(Cycle now) const {
    uint32_t rung = 0;
    for (size_t s = 0; s < kCount; ++s) rung |= uint32_t{timer_[s] <= now} << s;
    return rung;
  }
  template <size_t kCount>
  Cycle first() const {
    return *std::min_element(timer_.begin(), timer_.begin() + kCount);
  }

  const bool is_small_;
  uint32_t awake_ = 0, watching_ = 0;
  std::array<Cycle, kMaxSchedulers> timer_;
};

}  // namespace glint::core

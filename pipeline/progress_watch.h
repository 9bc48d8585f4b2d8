// Says for how long a launch has made no progress of some kind, such as the end of a warp.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "base/types.h"

namespace glint::pipeline {

// Looks at the machine between turns. A budget of 0 stands for no limit.
class ProgressWatch {
 public:
  explicit ProgressWatch(uint64_t budget) : budget_(budget) {}

  // Looks for progress. `memory_changed` says whether memory has changed since the last look, where that
  // counts as progress. `count()` grows with everything else that counts, and is called only now and then.
  template <class Count>
  void look(Cycle now, bool memory_changed, Count&& count) {
    if (memory_changed) since_ = now;
    if (budget_ == 0 || now < next_) return;
    next_ = now + kPeriod;
    if (const uint64_t changes = count(); changes != last_) last_ = changes, since_ = now;
  }
  // Returns the last time at which anything was seen to happen.
  Cycle since() const { return since_; }
  bool is_over(Cycle now) const { return budget_ != 0 && now - since_ > budget_; }

 private:
  static constexpr Cycle kPeriod = 4096;  // Choice: so rare that it costs nothing
  const uint64_t budget_;
  uint64_t last_ = 0;
  Cycle since_ = 0, next_ = 0;
};

}  // namespace glint::pipeline

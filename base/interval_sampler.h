// Reads a cell's counters every so many cycles of simulated time, whatever windows or skipping its cell runs
// in. SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <utility>
#include <vector>

#include "base/types.h"

namespace glint {

// Off until start(). The cell calls reach(now) before it changes anything in cycle `now`: what changes only
// in such cycles was the same in all cycles since the last, so a sample at a cycle that was skipped is exact
// too.
class IntervalSampler {
 public:
  // The counters as they are at the start of cycle `at`. Always the same number of them.
  using Read = std::function<std::vector<uint64_t>(Cycle at)>;

  void start(Cycle interval, Read read) {
    interval_ = next_ = interval;
    read_ = std::move(read);
  }
  void reach(Cycle now) {
    while (now >= next_) [[unlikely]] {
        samples_.push_back(read_(next_));
        next_ += interval_;
      }
  }
  // The end of the run: a last sample, unless one was just taken.
  void finish(Cycle end) {
    reach(end);
    if (read_ && end % interval_ != 0) samples_.push_back(read_(end));
  }
  // Sample i is of cycle (i + 1) * interval; the last one of the end.
  const std::vector<std::vector<uint64_t>>& samples() const { return samples_; }

 private:
  Cycle interval_ = 0, next_ = kNever;
  Read read_;
  std::vector<std::vector<uint64_t>> samples_;
};

}  // namespace glint

// Reads the counters of a cell at a fixed interval of simulated time, independent of windows and skipped
// cycles.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "base/types.h"

namespace glint {

// Takes samples once start() was called. The cell calls reach(now) before it changes anything in cycle `now`.
// Counters change only in such cycles and were constant since the last one, so a sample at a skipped cycle is
// exact too.
class IntervalSampler {
 public:
  // Returns the values of the counters at the start of cycle `at`. Every call returns the same number of
  // values.
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
  // Takes a last sample at the end of the run, unless a sample was just taken.
  void finish(Cycle end) {
    reach(end);
    if (read_ && end % interval_ != 0) samples_.push_back(read_(end));
  }
  // Sample i was taken at cycle (i + 1) * interval, and the last sample at the end of the run.
  const std::vector<std::vector<uint64_t>>& samples() const { return samples_; }

 private:
  Cycle interval_ = 0, next_ = kNever;
  Read read_;
  std::vector<std::vector<uint64_t>> samples_;
};

}  // namespace glint

// Decides how many threads are fastest, for the present launch and the processors that are free.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace glint {

// Tries a few windows with each of several numbers of threads, goes on with the fastest for many windows, and
// then tries again. It reads the clock of the host, so its choice differs from run to run. No result depends
// on the choice.
class Pace {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // Choice: a trial has enough windows for the caches to settle. With few threads, a window takes a multiple
  // of its time on many, so a trial ends early when it is much slower than the best before it. Fewer threads
  // still are then not tried. There are fewer trials while their answer stays the same.
  static constexpr uint32_t kTrial = 32, kLeast = 4, kStay = 40 * kTrial, kMostStays = 8;
  static constexpr double kMuchSlower = 1.5;

  // `ways` is how many numbers of threads there are to choose from. They are told by their index, and the
  // largest has index 0.
  explicit Pace(size_t ways) : ways_(ways), stayed_(ways - 1) {}

  // Returns the index of the number of threads for the window that begins now. `progress` returns a count of
  // what the machine has done so far (Cell::progress). It is called in and after trials only.
  template <class Progress>
  size_t way_for(Time now, Progress&& progress) {
    const bool may_end = !is_staying_ && way_ > 0 && windows_ >= kLeast;
    if (windows_ == 0 || windows_ >= length() || may_end) {
      const uint64_t count = progress();
      const double cost = windows_ == 0 ? 0 : cost_of(now, count);
      if (windows_ >= length() || (may_end && cost > kMuchSlower * best_cost_)) {
        end(cost);
        windows_ = 0;
      }
      if (windows_ == 0) started_ = now, progress_ = count;
    }
    ++windows_;
    return way_;
  }

 private:
  uint32_t length() const { return is_staying_ ? stays_ * kStay : kTrial; }
  // Returns the time of the phase per unit of progress. If nothing moved, the whole time is the cost.
  double cost_of(Time now, uint64_t progress) const {
    const double time = std::chrono::duration<double>(now - started_).count();
    return time / double(progress > progress_ ? progress - progress_ : 1);
  }
  // Ends a stay, or the trial of a number of threads.
  void end(double cost) {
    if (is_staying_) {
      is_staying_ = false, way_ = 0;
      return;
    }
    if (way_ == 0 || cost < best_cost_) best_ = way_, best_cost_ = cost;
    if (way_ + 1 < ways_ && cost <= kMuchSlower * best_cost_) {
      ++way_;
      return;
    }
    stays_ = best_ == stayed_ ? std::min(2 * stays_, kMostStays) : 1;
    stayed_ = way_ = best_;
    is_staying_ = true;
  }

  const size_t ways_;
  size_t way_ = 0;
  size_t stayed_;         // the answer of the last trials
  size_t best_ = 0;       // the fastest of the present trials
  double best_cost_ = 0;  // its cost
  bool is_staying_ = false;
  uint32_t windows_ = 0;   // number of windows that the phase has had
  uint32_t stays_ = 1;     // length of a stay, in multiples of kStay
  uint64_t progress_ = 0;  // the progress when the phase began
  Time started_{};
};

}  // namespace glint

// Decides whether several threads are faster than one, for the present launch and the processors that are
// free.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <chrono>
#include <cstdint>

namespace glint {

// Tries a few windows with several threads and a few with one, goes on in the faster way for many windows,
// and then tries again. It reads the clock of the host, so its choice differs from run to run. No result
// depends on the choice.
class Pace {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // Choice: a trial has enough windows for the caches to settle. With many threads, a window on one thread
  // takes as long as ten on all of them, so a trial of one thread ends early when it is much slower, and
  // there are fewer trials while their answer stays the same.
  static constexpr uint32_t kTrial = 32, kLeast = 4, kStay = 40 * kTrial, kMostStays = 8;
  static constexpr double kMuchSlower = 1.5;

  // Tells whether the window that begins now shall run on several threads. `progress` returns a count of what
  // the machine has done so far (Cell::progress). It is called in and after trials only.
  template <class Progress>
  bool in_parallel(Time now, Progress&& progress) {
    const bool may_end = phase_ == Phase::TrySerial && windows_ >= kLeast;
    if (windows_ == 0 || windows_ >= length() || may_end) {
      const uint64_t count = progress();
      const double cost = windows_ == 0 ? 0 : cost_of(now, count);
      if (windows_ >= length() || (may_end && cost > kMuchSlower * parallel_)) {
        end(cost);
        windows_ = 0;
      }
      if (windows_ == 0) started_ = now, progress_ = count;
    }
    ++windows_;
    return way_ == Way::Parallel;
  }

 private:
  enum class Way { Serial, Parallel };
  enum class Phase { TryParallel, TrySerial, Stay };

  uint32_t length() const { return phase_ == Phase::Stay ? stays_ * kStay : kTrial; }
  // Returns the time of the phase per unit of progress. If nothing moved, the whole time is the cost.
  double cost_of(Time now, uint64_t progress) const {
    const double time = std::chrono::duration<double>(now - started_).count();
    return time / double(progress > progress_ ? progress - progress_ : 1);
  }
  void end(double cost) {
    switch (phase_) {
      case Phase::TryParallel:
        parallel_ = cost;
        phase_ = Phase::TrySerial;
        way_ = Way::Serial;
        break;
      case Phase::TrySerial:
        way_ = parallel_ < cost ? Way::Parallel : Way::Serial;
        stays_ = way_ == stayed_ ? std::min(2 * stays_, kMostStays) : 1;
        stayed_ = way_;
        phase_ = Phase::Stay;
        break;
      case Phase::Stay:
        phase_ = Phase::TryParallel;
        way_ = Way::Parallel;
        break;
    }
  }

  Phase phase_ = Phase::TryParallel;
  Way way_ = Way::Parallel;
  Way stayed_ = Way::Serial;  // the answer of the last trial
  uint32_t windows_ = 0;      // number of windows that the phase has had
  uint32_t stays_ = 1;        // length of a stay, in multiples of kStay
  uint64_t progress_ = 0;     // the progress when the phase began
  Time started_{};
  double parallel_ = 0;  // the cost of the last trial with several threads
};

}  // namespace glint

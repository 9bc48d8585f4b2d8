// Decides whether several threads are faster than one, for the present launch and the processors that are
// free.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <cstdint>

namespace glint {

// Tries a few windows with one thread and a few with several, goes on in the faster way for many windows, and
// then tries again. It reads the clock of the host, so its choice differs from run to run. No result depends
// on the choice.
class Pace {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // Tells whether the window that begins now shall run on several threads. `progress` counts what the machine
  // has done so far (Cell::progress).
  bool in_parallel(Time now, uint64_t progress) {
    if (windows_ == 0) begin(now, progress);
    if (windows_++ < length()) return way_ == Way::Parallel;
    end(now, progress);
    begin(now, progress);
    ++windows_;
    return way_ == Way::Parallel;
  }

  // Choice: a trial has enough windows for the caches to settle. Trials make up a twentieth of all windows.
  static constexpr uint32_t kTrial = 32, kStay = 40 * kTrial;

 private:
  enum class Way { Serial, Parallel };
  enum class Phase { TrySerial, TryParallel, Stay };

  uint32_t length() const { return phase_ == Phase::Stay ? kStay : kTrial; }
  void begin(Time now, uint64_t progress) {
    started_ = now;
    progress_ = progress;
    windows_ = 0;
  }
  // Ends a phase, whose cost is its time per unit of progress. If nothing moved, the whole time is the cost.
  void end(Time now, uint64_t progress) {
    const double time = std::chrono::duration<double>(now - started_).count();
    const double cost = time / double(progress > progress_ ? progress - progress_ : 1);
    switch (phase_) {
      case Phase::TrySerial:
        serial_ = cost;
        phase_ = Phase::TryParallel;
        way_ = Way::Parallel;
        break;
      case Phase::TryParallel:
        way_ = cost < serial_ ? Way::Parallel : Way::Serial;
        phase_ = Phase::Stay;
        break;
      case Phase::Stay:
        phase_ = Phase::TrySerial;
        way_ = Way::Serial;
        break;
    }
  }

  Phase phase_ = Phase::TrySerial;
  Way way_ = Way::Serial;
  uint32_t windows_ = 0;   // number of windows that the phase has had
  uint64_t progress_ = 0;  // the progress when the phase began
  Time started_{};
  double serial_ = 0;  // the cost of the last trial with one thread
};

}  // namespace glint

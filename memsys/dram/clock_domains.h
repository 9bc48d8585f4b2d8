// Relates core cycles to DRAM command clocks exactly.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>
#include <numeric>

#include "base/types.h"

namespace glint::mem {

// Counts command clocks since the launch. The compiler cannot tell it from a Cycle; the code never mixes the
// two.
using DramClock = uint64_t;

// Both clocks start together at 0 and have a common tick. With clocks in whole kHz, a core cycle has
// dram_khz/g ticks and a command clock has core_khz/g ticks, where g is the greatest common divisor. All
// these numbers are integers, so nothing drifts. Products stay below 2^64 for 2^40 cycles and clocks up to 16
// GHz.
class ClockDomains {
 public:
  ClockDomains(double core_mhz, double dram_mhz) {
    const uint64_t core = uint64_t(std::llround(core_mhz * 1000)),
                   dram = uint64_t(std::llround(dram_mhz * 1000));
    const uint64_t g = std::gcd(core, dram);
    cycle_ticks_ = dram / g;
    clock_ticks_ = core / g;
  }
  // Returns the last edge of the command clock at or before the start of a core cycle.
  DramClock clock_at(Cycle cycle) const { return cycle * cycle_ticks_ / clock_ticks_; }
  // Returns the first core cycle that starts at or after an edge of the command clock.
  Cycle cycle_after(DramClock clock) const {
    return (clock * clock_ticks_ + cycle_ticks_ - 1) / cycle_ticks_;
  }

 private:
  uint64_t cycle_ticks_ = 1, clock_ticks_ = 1;
};

}  // namespace glint::mem

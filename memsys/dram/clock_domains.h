// The exact relation between core cycles and DRAM command clocks.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>
#include <numeric>

#include "base/types.h"

namespace glint::mem {

// Command clocks since launch. A type of its own in name only: never mix with Cycle.
using DramClock = uint64_t;

// Both clocks tick on multiples of a common tick and start together at 0. With clocks in whole kHz a core
// cycle is dram_khz/g ticks and a command clock core_khz/g ticks, g their greatest common divisor: integers,
// no drift. Products stay below 2^64 for 2^40 cycles and clocks up to 16 GHz.
class ClockDomains {
 public:
  ClockDomains(double core_mhz, double dram_mhz) {
    const uint64_t core = uint64_t(std::llround(core_mhz * 1000)),
                   dram = uint64_t(std::llround(dram_mhz * 1000));
    const uint64_t g = std::gcd(core, dram);
    cycle_ticks_ = dram / g;
    clock_ticks_ = core / g;
  }
  // The last command clock edge at or before the start of a core cycle.
  DramClock clock_at(Cycle cycle) const { return cycle * cycle_ticks_ / clock_ticks_; }
  // The first core cycle that starts at or after a command clock edge.
  Cycle cycle_after(DramClock clock) const {
    return (clock * clock_ticks_ + cycle_ticks_ - 1) / cycle_ticks_;
  }

 private:
  uint64_t cycle_ticks_ = 1, clock_ticks_ = 1;
};

}  // namespace glint::mem

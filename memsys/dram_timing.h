// DRAM times in command clocks, and the exact relation between core cycles and command clocks.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "base/types.h"
#include "memsys/params.h"
#include "memsys/request.h"

namespace glint::mem {

// Command clocks since launch. A type of its own in name only: never mix with Cycle.
using DramClock = uint64_t;

// Both clocks tick on multiples of a common tick and start together at 0. With clocks in whole kHz a core cycle is
// dram_khz/g ticks and a command clock core_khz/g ticks, g their greatest common divisor: integers, no drift.
// Products stay below 2^64 for 2^40 cycles and clocks up to 16 GHz.
class ClockDomains {
 public:
  ClockDomains(double core_mhz, double dram_mhz) {
    const uint64_t core = uint64_t(std::llround(core_mhz * 1000)), dram = uint64_t(std::llround(dram_mhz * 1000));
    const uint64_t g = std::gcd(core, dram);
    cycle_ticks_ = dram / g;
    clock_ticks_ = core / g;
  }
  // The last command clock edge at or before the start of a core cycle.
  DramClock clock_at(Cycle cycle) const { return cycle * cycle_ticks_ / clock_ticks_; }
  // The first core cycle that starts at or after a command clock edge.
  Cycle cycle_after(DramClock clock) const { return (clock * clock_ticks_ + cycle_ticks_ - 1) / cycle_ticks_; }

 private:
  uint64_t cycle_ticks_ = 1, clock_ticks_ = 1;
};

struct DramTiming {
  DramClock rcd, rcd_write, rp, ras, rc, cl, wl, wr, rtp, ccd_s, ccd_l, rrd_s, rrd_l, faw, wtr_s, wtr_l;
  DramClock data;  // data-bus clocks of one request: a sector, or an atom where that is larger
  DramClock rtw;   // read command to write command: two clocks to turn the bus around, as GPGPU-Sim has it

  explicit DramTiming(const DramParams& p) {
    const auto clocks = [&](double ns) { return DramClock(std::ceil(ns * p.clock_mhz / 1000.0 - 1e-6)); };
    rcd = clocks(p.rcd), rcd_write = clocks(p.rcd_write), rp = clocks(p.rp), ras = clocks(p.ras), rc = clocks(p.rc);
    cl = clocks(p.cl), wl = clocks(p.wl), wr = clocks(p.wr), rtp = clocks(p.rtp);
    rrd_s = clocks(p.rrd_s), rrd_l = clocks(p.rrd_l), faw = clocks(p.faw), wtr_s = clocks(p.wtr_s), wtr_l = clocks(p.wtr_l);
    // Model: where an atom is smaller than a sector the sector's column commands go out back to back as one.
    const DramClock bursts = p.atom_bytes() < kSectorBytes ? kSectorBytes / p.atom_bytes() : 1;
    const DramClock burst = p.burst / p.transfers_per_clock;
    data = bursts * burst;
    ccd_s = std::max(clocks(p.ccd_s), burst) * bursts;
    ccd_l = std::max(clocks(p.ccd_l), burst) * bursts;
    rtw = cl + data + 2 > wl ? cl + data + 2 - wl : 1;
  }
};

}  // namespace glint::mem

// Holds the times of a DRAM channel in command clocks.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/check.h"
#include "memsys/dram/clock_domains.h"
#include "memsys/dram/dram_params.h"
#include "memsys/request.h"

namespace glint::mem {

struct DramTiming {
  DramClock rcd, rcd_write, rp, ras, rc, cl, wl, wr, rtp, ccd_s, ccd_l, rrd_s, rrd_l, faw, wtr_s, wtr_l;
  DramClock data;      // clocks of the data bus for one request: a sector, or an atom where that is larger
  DramClock rtw;       // clocks from a read command to a write command: the bus turns between their data
  DramClock activate;  // clocks of the command bus that an activate takes
  DramClock refresh_interval = kNever;  // clocks from one refresh to the next; kNever: there is no refresh
  DramClock refresh_time = 0;           // clocks from a refresh until its banks can open rows again
  bool refresh_per_bank = false;

  explicit DramTiming(const DramParams& p) {
    const auto clocks = [&](double ns) { return DramClock(std::ceil(ns * p.clock_mhz / 1000.0 - 1e-6)); };
    rcd = clocks(p.rcd), rcd_write = clocks(p.rcd_write), rp = clocks(p.rp), ras = clocks(p.ras),
    rc = clocks(p.rc);
    cl = clocks(p.cl), wl = clocks(p.wl), wr = clocks(p.wr), rtp = clocks(p.rtp);
    rrd_s = clocks(p.rrd_s), rrd_l = clocks(p.rrd_l), faw = clocks(p.faw), wtr_s = clocks(p.wtr_s),
    wtr_l = clocks(p.wtr_l);
    // Model: where an atom is smaller than a sector, the sector's column commands go out in a row, as one.
    const DramClock bursts = p.atom_bytes() < kSectorBytes ? kSectorBytes / p.atom_bytes() : 1;
    const DramClock burst = p.burst / p.transfers_per_clock;
    data = bursts * burst;
    ccd_s = std::max(clocks(p.ccd_s), burst) * bursts;
    ccd_l = std::max(clocks(p.ccd_l), burst) * bursts;
    rtw = cl + data + p.bus_turn > wl ? cl + data + p.bus_turn - wl : 1;
    activate = p.activate_clocks;
    if (p.refresh == "none") return;
    refresh_per_bank = p.refresh == "per_bank";
    refresh_time = clocks(refresh_per_bank ? p.rfc_bank : p.rfc);
    // tREFI is the longest time allowed, so it is rounded down. Banks that take turns share it.
    const double interval = refresh_per_bank ? p.refi / p.banks : p.refi;
    refresh_interval = std::max<DramClock>(1, DramClock(std::floor(interval * p.clock_mhz / 1000.0 + 1e-6)));
  }
};

}  // namespace glint::mem

// Drives one DRAM channel by bank and row, for tests of its timing.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <utility>

#include "memsys/dram/dram_channel.h"

namespace glint::mem {

// Returns parameters in which core and command clocks are equal, all times are whole clocks, and an access
// moves 4 clocks of data.
inline DramParams plain() {
  DramParams p;
  p.clock_mhz = 1000.0;
  p.refresh = "none";
  p.rcd = 15, p.rcd_write = 9, p.rp = 16, p.ras = 30, p.rc = 46, p.cl = 14, p.wl = 4, p.wr = 17, p.rtp = 5;
  p.ccd_s = 4, p.ccd_l = 6, p.rrd_s = 5, p.rrd_l = 7, p.faw = 40, p.wtr_s = 8, p.wtr_l = 10;
  return p;
}

// Drives one channel. Addresses are chosen by bank group, bank in the group and row, through the inverse of
// the mapping.
class DramRig {
 public:
  explicit DramRig(const DramParams& params, double core_mhz = 1000.0)
      : root(nullptr, "test"), params_(params), channel({params_, 256, core_mhz, &root}) {
    DramMap map(params.banks, params.bank_groups, params.row_bytes, 256);
    for (Address local = 0; local < Address{params.banks} * params.row_bytes * 8; local += 256) {
      const DramLocation at = map.locate(local);
      local_.try_emplace({at.bank, at.row}, local);
    }
  }
  void add(Cycle now, uint32_t bank, uint32_t row, bool write = false, uint32_t name = 0) {
    channel.advance(now);
    channel.add(now, name * 128, 1, local_.at({bank, row}), write);
  }
  // Runs to the end. Returns the cycle at which each read's data was complete, by name.
  std::map<uint32_t, Cycle> run() {
    std::map<uint32_t, Cycle> out;
    while (channel.next_command() != kNever) channel.advance(channel.next_command());
    for (; !channel.returns().empty(); channel.returns().pop())
      out[uint32_t(channel.returns().front().line / 128)] = channel.returns().front().ready;
    return out;
  }
  // Moves the end of run() to a cycle that is later than all that was asked for.
  void idle_until(Cycle now) { channel.advance(now), idle_ = now; }
  Cycle idle() const { return idle_; }  // returns a cycle that is later than all that was asked for
  Cycle read_alone(uint32_t bank, uint32_t row) {
    const Cycle start = idle_;
    add(start, bank, row);
    const Cycle end = run()[0];
    idle_ = end + 1000;
    return end - start;
  }

  stats::Group root;

 private:
  DramParams params_;

 public:
  DramChannel channel;

 private:
  std::map<std::pair<uint32_t, uint32_t>, Address> local_;
  Cycle idle_ = 0;
};

inline constexpr Cycle kEdge = 1;  // a request is seen at the next clock edge
inline constexpr Cycle kData = 4;

}  // namespace glint::mem

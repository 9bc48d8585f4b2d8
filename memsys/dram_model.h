// Interface: says when a memory channel has served the requests of its L2 slices.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/registry.h"
#include "base/stats.h"
#include "base/types.h"
#include "memsys/dram/clock_domains.h"
#include "memsys/dram/dram_stats.h"
#include "memsys/ring.h"

namespace glint::mem {

struct DramParams;

// Describes read data that have left the data bus.
struct DramReturn {
  Cycle ready = 0;  // core cycle in which the last transfer is over
  Address line = 0;
  uint8_t sectors = 0;
  Cycle command = 0;  // core cycle of the column command
};

// Contract (tests/contract/memsys/dram_model_test.cpp):
//  - Every read that was added comes back once in returns(), in order of `ready`, which is later than its
//    add(). Writes give nothing back.
//  - A request holds an entry of the queue from add() on. Calls of advance() at next_command() free entries
//    without further requests, so full() does not stay true.
//  - Results do not depend on how often advance() is called, as long as it is called at each next_command().
//  - Every clock up to finish() is counted in `use` once, and data move no faster than the bus.
//  - The model allocates nothing once it is warm.
class DramModel {
 public:
  static constexpr PolicyKind kKind{"memory.dram.model", "memsys/dram_models"};
  struct Context {
    const DramParams& params;
    uint32_t interleave = 256;
    double core_mhz = 1000;
    stats::Group* parent = nullptr;
    double refresh_phase = 1;  // the first refresh falls due after this share of the interval
  };
  virtual ~DramModel() = default;

  bool full() const { return in_flight_ == capacity_; }
  // Adds a request, after advance(now) and only while !full(). The model sees it at the next edge of the
  // command clock. `local` is the address inside the partition.
  virtual void add(Cycle now, Address line, uint8_t sectors, Address local, bool write) = 0;
  // Simulates the command clocks up to core cycle `now`.
  virtual void advance(Cycle now) = 0;
  virtual void finish(Cycle end) = 0;  // counts the clocks up to the end of the run in `use`
  // Returns the rows that are open after a launch, by bank, and opens them before the first request of the
  // next. Model: commands of the launch before delay none of the next, and refreshes begin anew.
  virtual std::vector<uint32_t> open_rows() const { return {}; }
  virtual void open_rows(const std::vector<uint32_t>&) {}
  Cycle next_command() const { return next_step_ == kNever ? kNever : clocks_.cycle_after(next_step_); }
  Ring<DramReturn>& returns() { return returns_; }  // is in order of `ready`, which may lie in the future
  const Ring<DramReturn>& returns() const { return returns_; }
  size_t in_flight() const { return in_flight_; }
  bool finished() const { return in_flight_ == 0 && returns_.empty(); }
  const DramStats& stats() const { return stats_; }
  const ClockDomains& clocks() const { return clocks_; }
  // Returns the clocks of the data bus that a request takes.
  DramClock data_clocks() const { return data_clocks_; }

 protected:
  DramModel(const Context& context, DramClock data_clocks);  // is defined in dram_params.h

  const ClockDomains clocks_;
  const DramClock data_clocks_;
  DramStats stats_;
  Ring<DramReturn> returns_;
  DramClock next_step_ = kNever;
  size_t in_flight_ = 0;  // number of requests whose column command has not gone out
  const size_t capacity_;
};

}  // namespace glint::mem

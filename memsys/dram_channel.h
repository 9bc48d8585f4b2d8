// One DRAM channel: banks with row buffers, command timing, the data bus.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <memory>
#include <vector>

#include "base/stats.h"
#include "memsys/address_map.h"
#include "memsys/dram_scheduler.h"
#include "memsys/dram_timing.h"
#include "memsys/ring.h"

namespace glint::mem {

// What a command clock went into (GPGPU-Sim's split of wasted bandwidth): each clock has exactly one.
enum class DramUse : uint8_t { Data, ColumnWait, RowWait, Idle, Count };
constexpr std::string_view name_of(DramUse use) {
  constexpr std::string_view kNames[] = {"data", "column_wait", "row_wait", "idle"};
  return kNames[size_t(use)];
}

// Read data that has left the data bus.
struct DramReturn {
  Cycle ready = 0;  // core cycle at which its last transfer is over
  Address line = 0;
  uint8_t sectors = 0;
  Cycle command = 0;  // core cycle of its column command
};

struct DramStats {
  explicit DramStats(stats::Group* parent);
  stats::Group group;
  stats::Counter reads{&group, "reads", "request", "Read requests whose column command was issued."};
  stats::Counter writes{&group, "writes", "request", "Write requests whose column command was issued."};
  stats::Counter activates{&group, "activates", "command", "Rows opened."};
  stats::Counter precharges{&group, "precharges", "command", "Rows closed to open another."};
  stats::Counter row_hits{&group, "row_hits", "request", "Requests whose row was open when their bank took them."};
  stats::Counter turnarounds{&group, "turnarounds", "command", "Changes of the data bus between reading and writing."};
  stats::Counter picks{&group, "picks", "request", "Requests that a bank has taken from the scheduler."};
  stats::Counter clocks{&group, "clocks", "clock", "Command clocks simulated."};
  stats::Counter busy_clocks{&group, "busy_clocks", "clock", "Command clocks of data transferred."};
  stats::Counter active_clocks{&group, "active_clocks", "clock", "Command clocks in which a bank held a request or a timer ran."};
  stats::Counter bank_clocks{&group, "bank_clocks", "clock", "Sum over banks of the command clocks in which they held a request."};
  stats::Counter any_bank_clocks{&group, "any_bank_clocks", "clock", "Command clocks in which at least one bank held a request."};
  stats::Counter queue_clocks{&group, "queue_clocks", "clock", "Sum over requests of the clocks from the queue to the column command."};
  stats::Breakdown<DramUse> use{&group, "use", "clock", "What each command clock went into."};
  stats::Histogram queue_latency{&group, "queue_latency", "clock", stats::linear(0, 1024, 16), "From the queue to the column command."};
  stats::Counter requests{&group, "requests", "request", "Requests taken into the queue."};
  // timing.md 2.2: the definitions of GPGPU-Sim, so that numbers compare.
  stats::Ratio utilisation{&group, "utilisation", "ratio", busy_clocks, clocks, "Share of all clocks that carried data."};
  stats::Ratio efficiency{&group, "efficiency", "ratio", busy_clocks, active_clocks, "Share of the active clocks that carried data."};
  stats::Ratio row_buffer_locality{&group, "row_buffer_locality", "ratio", row_hits, picks, "Share of picks that hit the open row."};
  stats::Ratio bank_parallelism{&group, "bank_parallelism", "bank", bank_clocks, any_bank_clocks, "Banks at work while any was."};
};

// Every bank works on one request at a time, taken from the scheduler; each command clock may carry one command (or one
// row and one column command). Commands go out at exactly the clock all their constraints allow; clocks in which none
// can are skipped. Column commands go before row commands, older requests before younger.
// Model: rows stay open; there is no refresh (3 to 6 % of bandwidth in hardware) and no temperature.
class DramChannel {
 public:
  DramChannel(const DramParams& params, uint32_t interleave, double core_mhz, stats::Group* parent);

  bool full() const { return free_.empty(); }
  // Needs !full() and advance(now) before. The scheduler sees the request at the next command clock edge.
  void add(Cycle now, Address line, uint8_t sectors, Address local, bool write);
  // Issues all commands of the clocks up to core cycle `now`.
  void advance(Cycle now);
  Cycle next_command() const { return next_step_ == kNever ? kNever : clocks_.cycle_after(next_step_); }
  Ring<DramReturn>& returns() { return returns_; }  // in order of `ready`, which may lie ahead
  const Ring<DramReturn>& returns() const { return returns_; }
  size_t in_flight() const { return slots_.size() - free_.size(); }
  bool finished() const { return in_flight() == 0 && returns_.empty(); }
  void finish(Cycle end);  // closes the accounts at the end of a run
  const DramStats& stats() const { return stats_; }
  const DramTiming& timing() const { return timing_; }
  const ClockDomains& clocks() const { return clocks_; }

 private:
  static constexpr uint32_t kNone = DramScheduler::kNone;
  static constexpr uint32_t kClosed = DramScheduler::kClosed;

  struct Slot {
    DramRequest request;
    DramClock arrival = 0;
    Address line = 0;
    uint8_t sectors = 0;
  };
  enum Command : uint8_t { Activate, Precharge, Read, Write, NumCommands };
  // Earliest clock of each command, as far as one bank, one group or the channel is concerned.
  struct Gates {
    DramClock at[NumCommands] = {};
    void raise(Command command, DramClock to) { at[command] = std::max(at[command], to); }
  };
  struct Bank {
    uint32_t row = kClosed;
    uint32_t current = kNone;    // slot it works on
    uint32_t queued = 0;         // requests in the scheduler
    Command next = Activate;     // for the current request
    uint64_t age = 0;            // of the current request
    Gates gates;
  };
  struct Plan {  // the next clock at which commands can go out, and the oldest ready bank of each kind then
    DramClock at = kNever;
    uint32_t column = kNone, row = kNone;
  };

  void step(DramClock now);
  bool pick_all();
  void pick_for(uint32_t bank, bool& any);
  Command next_command_of(const Bank& bank) const;
  void plan_from(DramClock first);
  void issue_column(uint32_t bank, DramClock now);
  void issue_row(uint32_t bank, DramClock now);
  void account(DramClock until);
  void run_timers_until(DramClock clock) { timers_until_ = std::max(timers_until_, clock); }

  const DramTiming timing_;
  const ClockDomains clocks_;
  const DramMap map_;
  const bool dual_command_bus_;
  DramStats stats_;
  std::unique_ptr<DramScheduler> scheduler_;
  std::vector<Slot> slots_;
  std::vector<uint32_t> free_;
  std::vector<Bank> banks_;
  std::vector<uint8_t> bank_group_;  // by bank
  std::vector<Gates> group_gates_;
  Gates channel_gates_;
  DramClock last_activates_[4] = {};  // a ring: tFAW allows no fifth inside the window
  uint64_t num_activates_ = 0;
  uint64_t busy_banks_ = 0;     // bit = bank works on a request
  uint64_t waiting_banks_ = 0;  // bit = bank has requests in the scheduler
  uint64_t next_age_ = 0;
  Plan plan_;
  DramClock next_step_ = kNever;  // of the plan, or an earlier arrival
  DramClock accounted_ = 0;     // clocks before this have been attributed
  DramClock data_until_ = 0;    // DramUse::Data up to here
  DramClock timers_until_ = 0;  // some bank's timer runs up to here
  bool last_was_write_ = false;
  Ring<DramReturn> returns_;
};

}  // namespace glint::mem

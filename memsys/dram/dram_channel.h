// Models a DRAM channel with its banks, their row buffers, the timing of commands, and the data bus.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "memsys/address_map.h"
#include "memsys/dram/dram_timing.h"
#include "memsys/dram_model.h"
#include "memsys/dram_scheduler.h"

namespace glint::mem {

// Every bank works on one request at a time, which it takes from the scheduler. Each command clock carries at
// most one command, or one row and one column command where the command bus is dual. A command goes out in
// the first clock that all its constraints allow; clocks in which none can go are skipped. Column commands go
// before row commands, and older requests before younger ones. When a refresh is due, its banks finish what
// they have begun, close their rows and take no command until the refresh is over. Model: rows stay open
// until then; a refresh is never early, late or left out, its commands take no clock of the command bus, and
// there is no temperature.
class DramChannel : public DramModel {
 public:
  explicit DramChannel(const Context& context);

  void add(Cycle now, Address line, uint8_t sectors, Address local, bool write) override;
  void advance(Cycle now) override;
  void finish(Cycle end) override;
  std::vector<uint32_t> open_rows() const override;
  void open_rows(const std::vector<uint32_t>& rows) override;
  const DramTiming& timing() const { return timing_; }

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
  // Holds the earliest clock of each command, as far as one bank, one group or the channel is concerned.
  struct Gates {
    DramClock at[NumCommands] = {};
    void raise(Command command, DramClock to) { at[command] = std::max(at[command], to); }
  };
  struct Bank {
    uint32_t row = kClosed;
    uint32_t current = kNone;  // slot of the request that the bank works on
    uint32_t queued = 0;       // number of its requests in the scheduler
    Command next = Activate;   // next command for the current request
    uint64_t age = 0;          // age of the current request
    DramClock refresh_until = 0;
    Gates gates;
  };
  // Holds the next clock at which commands can go out. For each kind of command it names the ready bank whose
  // request is the oldest.
  struct Plan {
    DramClock at = kNever;
    uint32_t column = kNone, row = kNone;
  };

  void step(DramClock now);
  bool refresh_up_to(DramClock now);
  void refresh(DramClock due);
  void refresh_bank(Bank& bank, DramClock until);
  DramClock closed_at(const Bank& bank, DramClock due) const;
  bool pick_all();
  void pick_for(uint32_t bank, bool& any);
  Command next_command_of(const Bank& bank) const;
  void plan_from(DramClock first);
  void issue_column(uint32_t bank, DramClock now);
  void issue_row(uint32_t bank, DramClock now);
  void account(DramClock until);
  void account_waiting(DramClock from, DramClock until);
  DramClock turned_at(uint32_t bank) const;
  void run_timers_until(DramClock clock) { timers_until_ = std::max(timers_until_, clock); }

  const DramTiming timing_;
  const DramMap map_;
  const bool dual_command_bus_;
  std::unique_ptr<DramScheduler> scheduler_;
  std::vector<Slot> slots_;
  std::vector<uint32_t> free_;
  std::vector<Bank> banks_;
  std::vector<uint8_t> bank_group_;  // by bank
  std::vector<Gates> group_gates_;
  Gates channel_gates_;
  // group_turned_ and turned_ say when a Read or a Write may go out again, as far as the direction of the
  // data bus is concerned. The gates above contain these clocks.
  std::vector<DramClock> group_turned_;  // clock from which a Read may go out, by group
  DramClock turned_[2] = {};             // clocks from which a Read and a Write may go out
  DramClock last_activates_[4] = {};     // is a ring; tFAW allows no fifth activate inside its window
  uint64_t num_activates_ = 0;
  uint64_t busy_banks_ = 0;     // has one bit for each bank that works on a request
  uint64_t waiting_banks_ = 0;  // has one bit for each bank that has requests in the scheduler
  uint64_t next_age_ = 0;
  DramClock refresh_due_ = kNever;
  uint32_t refresh_next_ = 0;  // number of the next bank, when banks are refreshed one by one
  Plan plan_;
  DramClock accounted_ = 0;     // clocks before this one have been counted by reason
  DramClock data_until_ = 0;    // clocks before this one carry data
  DramClock timers_until_ = 0;  // the timer of some bank runs until this clock
  bool last_was_write_ = false;
};

}  // namespace glint::mem

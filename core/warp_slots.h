// Holds the warp slots of a core and the schedulers that they belong to.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/core_observer.h"
#include "core/warp_slot.h"

namespace glint::core {

// Holds the slots. Units change what a warp waits for in its slot and then call refresh(), which tells the
// slot's scheduler.
class WarpSlots {
 public:
  // `fetch` is null when every instruction is present when its warp comes to it.
  WarpSlots(uint32_t size, const Params& params, const exec::World& world, const IssueTable& table,
            InstructionFetch* fetch, const CoreObservers& observers);

  uint32_t size() const { return uint32_t(slots_.size()); }
  WarpSlot& operator[](uint32_t slot) { return slots_[slot]; }
  const WarpSlot& operator[](uint32_t slot) const { return slots_[slot]; }
  std::vector<Scheduler>& schedulers() { return schedulers_; }
  const std::vector<Scheduler>& schedulers() const { return schedulers_; }
  BlockSlots& blocks() { return blocks_; }
  const BlockSlots& blocks() const { return blocks_; }

  uint32_t num_resident() const { return num_resident_; }
  uint64_t num_launched() const { return num_launched_; }
  // Returns the slot of a scheduler's warp, which the scheduler numbers locally.
  uint32_t slot_of(const Scheduler& scheduler, uint32_t local) const {
    return local * params_.schedulers + scheduler.index();
  }
  bool is_resident(uint32_t slot) const { return slots_[slot].scheduler->is_resident(slots_[slot].local); }
  uint32_t first_free() const;
  const Alarms& alarms() const { return *alarms_; }
  // Starts the warp in the slot, which the executor has started. It can issue its first instruction at
  // `ready`.
  void start(uint32_t slot, BlockSlot& home, Cycle ready, Cycle now);
  // Looks up when the warp's next instruction is present and has its operands. It has to be called after each
  // change to the warp's front, scoreboard, sequence or place in the program.
  void refresh(uint32_t slot, Cycle now) { refresh(slots_[slot], now); }
  void refresh(WarpSlot& at, Cycle now) {
    if (!is_plain_ || at.sequence.is_under_way()) return refresh_in_full(at, now);
    const IssueRow& row = table_.row(at.warp.simt.pc);
    const Scoreboard::Ready ready = at.scoreboard.ready(row, table_.uses(row), at.front);
    prefetch_registers(at.warp, row);
    at.scheduler->set_next(at.local, {ready.at, ready.wait, row.pipe, row.door, &row});
  }
  // Does the same for a warp that has just issued an instruction of fixed latency, where is_plain() holds.
  void go_on(Scheduler& scheduler, uint32_t local, WarpSlot& at) {
    const IssueRow& row = table_.row(at.warp.simt.pc);
    const Scoreboard::Ready ready = at.scoreboard.ready(row, table_.uses(row), at.front);
    prefetch_registers(at.warp, row);
    scheduler.go_on(local, {ready.at, ready.wait, row.pipe, row.door, &row});
  }
  // Returns whether operands are ready when the scoreboard says so, and nothing else counts.
  bool is_plain() const { return is_plain_; }
  // Notes that the warp has ended while its last accesses have not.
  void drain(uint32_t slot) { slots_[slot].scheduler->drain(slots_[slot].local); }
  // Notes that the warp has ended with all of its accesses. Another warp can take the slot.
  void free(uint32_t slot, Cycle now);

  // Notes that a line of instructions has come. Warps of the scheduler that wait for it go on.
  void take_line(uint32_t scheduler, uint32_t line, Cycle now);

 private:
  // Brings registers of the warp's next instruction near to the host's core: the destination, which keeps the
  // values of lanes that do not execute, and two of the sources. Other warps issue in between, as a rule. The
  // indices of predicates stand for registers here, which does no harm.
  static void prefetch_registers(const exec::WarpContext& warp, const IssueRow& row) {
    constexpr uint32_t kWordsOfLine = 16;  // A row takes two cache lines.
    for (const uint16_t r : {row.first_def, row.first_uses[0], row.first_uses[1]}) {
      const uint32_t* const values = warp.regs.bank[0] + (r % kFirstPredicate) * kLanes;
      __builtin_prefetch(values);
      __builtin_prefetch(values + kWordsOfLine);
    }
  }
  void refresh_in_full(WarpSlot& at, Cycle now);
  void come_to_line(WarpSlot& slot, Cycle now);
  Scoreboard::Ready operands_ready(const WarpSlot& slot, const IssueRow& row) const;

  const Params& params_;
  const IssueTable& table_;
  const CoreObservers& observers_;
  InstructionFetch* const fetch_;
  const bool holds_operands_;  // Memory instructions read their registers when they leave their queue.
  const bool is_plain_;        // is_plain()
  const uint32_t prologue_;    // machine instructions before a warp's first instruction
  const std::unique_ptr<Alarms> alarms_;  // the schedulers refer to it
  std::vector<Scheduler> schedulers_;
  std::vector<WarpSlot> slots_;
  BlockSlots blocks_;
  uint32_t num_resident_ = 0;
  uint64_t num_launched_ = 0;
};

}  // namespace glint::core

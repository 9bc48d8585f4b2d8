// The issue state of one scheduler's warps, in flat arrays: what every cycle of a core looks at.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>

#include "base/types.h"
#include "core/issue_scheduler.h"
#include "core/stall.h"
#include "core/units.h"

namespace glint::core {

// Warps are numbered locally: warp slot w is warp w / schedulers of scheduler w mod schedulers.
struct SchedulerState {
  uint32_t index = 0;
  uint64_t resident = 0;                                // bit i: warp i is there
  std::array<Cycle, kMaxWarpsPerScheduler> ready_at{};  // operands of its next instruction; kNever: not known
  std::array<Stall, kMaxWarpsPerScheduler> wait{};      // what it waits for until then
  std::array<Pipe, kMaxWarpsPerScheduler> pipe{};       // of its next instruction
  uint64_t needs_lsu = 0, needs_tex = 0, needs_rt = 0;  // its next instruction goes through that door
  std::array<uint64_t, kMaxWarpsPerScheduler> age{};    // launch number
  std::array<Cycle, kNumPipes> pipe_free{};          // first cycle in which another instruction can go there
  std::array<Cycle, kNumPipes> pipe_busy{};          // the same to parts of a cycle
  std::array<Cycle, kMaxRegisterBanks> bank_free{};  // of the register file: its port

  // Until `sleep_until` no warp can issue and the reason stays, unless something wakes the scheduler, or a
  // door that it watches may have opened: the RT unit's in any cycle of the core, the load-store unit's when
  // vacated.
  Cycle sleep_until = 0;
  bool watches_rt = false, watches_lsu = false;  // either queue of that unit
  uint64_t lsu_vacated = 0;                      // Lsu::num_vacated() when it was looked at
  Stall reason = Stall::NoWarp;

  std::unique_ptr<IssueScheduler> policy;
  bool has_latches = false;  // Params::dispatch_latch

  void wake() { sleep_until = 0; }
  // An instruction issues to a pipe; how much later it enters. With latches that is when the pipe has
  // finished what is in it, and the next one can issue when it has entered.
  Cycle occupy(Pipe at, Cycle now, Cycle parts) {
    constexpr Cycle kParts = OpTime::kParts;
    if (!has_latches) return take(at, now, parts), 0;
    Cycle& busy = pipe_busy[size_t(at)];
    const Cycle start = std::max(busy, now * kParts);
    busy = start + parts;
    pipe_free[size_t(at)] = start / kParts + 1;
    return start / kParts - now;
  }
  // An instruction goes to a pipe that is free. Intervals that are no whole cycles are kept on average: one
  // begins where the last one ended, within the cycle, if the pipe has not been idle since.
  void take(Pipe at, Cycle now, Cycle parts) {
    constexpr Cycle kParts = OpTime::kParts;
    Cycle& busy = pipe_busy[size_t(at)];
    busy = (pipe_free[size_t(at)] == now ? busy : now * kParts) + parts;
    pipe_free[size_t(at)] = (busy + kParts - 1) / kParts;
  }
};

}  // namespace glint::core

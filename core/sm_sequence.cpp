// Instructions that hardware makes of one of the ISA's, or puts before a kernel: each takes an issue slot of
// its warp.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/core_cell.h"

namespace glint::core {

// The effect has happened and the pipe is taken; the rest of the sequence follows in even steps, its result
// comes behind the last. Model: only the first instruction takes a pipe, for the interval of the whole; what
// follows in the warp does not issue in between, where an assembler would mix the two. One that had to wait
// for its slot does not hold up the next beyond its own step: sequences have slack between their long
// operations.
void CoreCell::start_sequence(uint32_t slot, const IssueRow& row, uint32_t pc, Cycle now) {
  const uint32_t issues = table_.issues(pc);
  const Cycle step = std::max<Cycle>(row.latency / issues, 1);
  sequence_[slot] = {issues - 1, pc, step, row.latency - (issues - 1) * step};
  front_[slot] = {now + step, row.wait};
}

void CoreCell::issue_rest(SchedulerState& scheduler, uint32_t slot, Cycle now) {
  Sequence& rest = sequence_[slot];
  ++progress_;
  ++stats_.sequence_slots;
  const bool is_prologue = rest.pc == kPrologue;
  if (profile_) profile_->point(scheduler.index, is_prologue ? warps_[slot].simt.pc : rest.pc);
  const Cycle due = front_[slot].at;
  front_[slot] = {due + rest.step, is_prologue ? Stall::Dispatch : table_.row(rest.pc).wait};
  if (--rest.left == 0) {
    front_[slot] = {now + 1, Stall::RawFixed};
    if (!is_prologue) {
      const IssueRow& row = table_.row(rest.pc);
      scoreboards_[slot].set(table_.defs(row), {std::max(now + 1, due + rest.last), row.wait},
                             row.alternates ? Pipe::Count : row.pipe);
    }
  }
  refresh(slot);
}

// Only an issue slot is needed: no operands, and no pipe but that of memory, which is never busy by itself.
void CoreCell::refresh_sequence(SchedulerState& scheduler, uint32_t slot) {
  const uint32_t local = slot / params_.schedulers;
  const uint64_t others = ~(uint64_t{1} << local);
  scheduler.ready_at[local] = front_[slot].at;
  scheduler.wait[local] = front_[slot].wait;
  scheduler.pipe[local] = Pipe::Memory;
  scheduler.needs_lsu &= others;
  scheduler.needs_tex &= others;
  scheduler.needs_rt &= others;
  scheduler.wake();
}

}  // namespace glint::core

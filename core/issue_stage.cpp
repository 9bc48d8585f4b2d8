// Issues an instruction: chooses its warp, executes it, and hands it over to its unit.
// SPDX-License-Identifier: Apache-2.0
#include "core/issue_stage.h"

#include <algorithm>
#include <bit>

#include "base/check.h"
#include "core/barrier_unit.h"
#include "core/constant_port.h"
#include "core/mbarrier_unit.h"
#include "core/memory_accesses.h"
#include "core/ray_door.h"
#include "core/reorder_unit.h"
#include "core/subwarp_unit.h"

namespace glint::core {

uint64_t IssueStage::leave_out_bank_conflicts(Scheduler& scheduler, uint64_t ready, Cycle now) const {
  for (uint64_t rest = ready; rest; rest &= rest - 1) {
    const auto local = uint32_t(std::countr_zero(rest));
    const uint32_t pc = core_.warps[core_.warps.slot_of(scheduler, local)].warp.simt.pc;
    const Cycle at =
        scheduler.banks.free_at(core_.table.bank_reads(pc), now, core_.params.register_file.window);
    if (at == now) continue;
    ready &= ~(uint64_t{1} << local);
    scheduler.hold_for_banks(at);
  }
  return ready;
}

uint64_t IssueStage::leave_out_held(Scheduler& scheduler, uint64_t ready, Cycle now) const {
  if (units_.subwarps) units_.subwarps->look(scheduler, now);
  if (core_.params.register_file.banks) ready = leave_out_bank_conflicts(scheduler, ready, now);
  return ready ? scheduler.leave_out_held(ready, now) : 0;
}

// Finds what the operands of the warp's next instruction add to its sequence. They have to be read before
// the instruction is executed, because its result may take the register of one of them.
void IssueStage::look_for_slow_path(const exec::WarpContext& warp, const IssueRow& row) {
  const isa::Inst& inst = core_.executor.next(warp);
  LaneMask lanes = warp.simt.active;
  if (inst.guard != isa::kNoGuard) {
    const LaneMask guard = warp.regs.predicate[inst.guard & (isa::kNumPredicates - 1)];
    lanes &= inst.guard & isa::kGuardNegate ? ~guard : guard;
  }
  slow_ = slow_time(row.slow_path, warp.regs, inst, lanes);
}

void IssueStage::start_sequence(WarpSlot& at, const IssueRow& row, uint32_t pc, Cycle now) {
  uint32_t issues = core_.table.issues(pc);
  Cycle latency = row.latency, step = 1;
  if (row.is_whole) {
    issues += slow_.issues;
    latency += slow_.latency;
    step = std::max<Cycle>(latency / issues, 1);
  }
  at.sequence = {issues - 1, pc, step, latency - (issues - 1) * step};
  at.front = {now + step, row.wait};
}

// Issues the rest of a sequence. Model: a machine instruction that had to wait for its issue slot does not
// hold up the next one beyond its own step, because sequences have slack between their long operations.
void IssueStage::issue_rest(uint32_t slot, Cycle now) {
  WarpSlot& at = core_.warps[slot];
  Sequence& rest = at.sequence;
  ++core_.counts.progress;
  ++core_.counts.stats.sequence_slots;
  if (core_.counts.profile)
    core_.counts.profile->point(at.scheduler->index(), rest.is_prologue() ? at.warp.simt.pc : rest.pc);
  const Cycle due = at.front.at;
  at.front = {due + rest.step, rest.is_prologue() ? Stall::Dispatch : core_.table.row(rest.pc).wait};
  if (--rest.left == 0) {
    at.front = {now + 1, Stall::RawFixed};
    if (!rest.is_prologue()) {
      const IssueRow& row = core_.table.row(rest.pc);
      at.scoreboard.set(core_.table.defs(row), {std::max(now + 1, due + rest.last), row.wait},
                        row.alternates ? Pipe::Count : row.pipe);
    }
  }
  core_.warps.refresh(slot, now);
}

inline void IssueStage::finish_fixed(uint32_t slot, const IssueRow& row, const exec::Issued& issued,
                                     Cycle late, Cycle now) {
  if (row.pipe == Pipe::Const && units_.constants.is_timed() && issued.lanes)
    return units_.constants.start(slot, row, issued, now);
  WarpSlot& at = core_.warps[slot];
  core_.counts.end(issued.pc, late + row.latency);
  if (row.is_whole) [[unlikely]]
    core_.counts.end(issued.pc, slow_.latency);
  if (row.is_sequence) [[unlikely]]
    start_sequence(at, row, issued.pc, now);
  else
    at.scoreboard.set(row, core_.table.defs(row), {now + late + row.latency, row.wait},
                      row.alternates ? Pipe::Count : row.pipe);
}

// Hands an instruction over to its unit. `late` is the number of cycles that the instruction waits in front
// of its pipe.
[[gnu::always_inline]] inline void IssueStage::hand_over(uint32_t slot, const IssueRow& row,
                                                         const exec::Issued& issued, Cycle late, Cycle now) {
  WarpSlot& at = core_.warps[slot];
  const Cycle done = now + late + row.latency;
  at.front = {now + 1, Stall::RawFixed};
  if (row.finish == Finish::Fixed) [[likely]]
    return finish_fixed(slot, row, issued, late, now);
  switch (row.finish) {
    case Finish::Fixed:
      break;
    case Finish::Control:
      at.front = {done, row.wait};
      core_.counts.end(issued.pc, late + row.latency);
      break;
    case Finish::Memory:
    case Finish::CallRecord:
      if (row.is_mbarrier && units_.mbarriers->come(slot, issued, now)) [[unlikely]]
        break;
      if (!units_.memory.start(slot, row, issued, now)) {
        at.front.at = row.finish == Finish::Memory ? now + 1 : done;
        core_.counts.end(issued.pc, at.front.at - now);
      }
      break;
    case Finish::Rays:
      units_.rays.start(slot, row, issued, now);
      break;
    case Finish::Barrier:
      units_.barriers.come(slot, now, row.latency);
      core_.counts.end(issued.pc, row.latency);
      break;
    case Finish::Reorder:
      if (units_.reorder && issued.lanes) {
        units_.reorder->come(slot, issued, now);
      } else {
        at.front = {done, row.wait};
        core_.counts.end(issued.pc, late + row.latency);
      }
      break;
    case Finish::Fence:
      units_.memory.start_fence(slot, row, issued, now);
      core_.counts.end(issued.pc, row.latency);
      break;
    case Finish::Copies:
      units_.memory.order_copies(slot, row, issued, now);
      core_.counts.end(issued.pc, row.latency);
      break;
  }
}

void IssueStage::take_turns(uint32_t slot, const IssueRow& row, LaneMask before, Cycle now) {
  units_.subwarps->follow(slot, before);
  if (row.finish == Finish::Memory && row.num_defs > 0) units_.subwarps->yield(slot, now);
}

// Finds when the next instruction of the warp can issue, and brings what its issue needs near to the host's
// core: other warps come first, as a rule.
inline void IssueStage::prepare_next(WarpSlot& at, Cycle now) {
  core_.executor.prefetch(at.warp);
  core_.counts.prefetch(at.warp.simt.pc);
  core_.warps.refresh(at, now);
}

void IssueStage::issue(uint32_t slot, Cycle now) {
  if (!core_.observers.empty()) [[unlikely]]
    tell_select(slot, now);
  WarpSlot& at = core_.warps[slot];
  if (at.sequence.is_under_way()) return issue_rest(slot, now);
  Scheduler& scheduler = *at.scheduler;
  const IssueRow& row = core_.table.row(at.warp.simt.pc);
  if (row.is_whole) [[unlikely]]
    look_for_slow_path(at.warp, row);
  const LaneMask before = at.warp.simt.active;
  const exec::Issued issued = core_.executor.execute(at.warp, now);
  if (core_.executor.fault()) [[unlikely]] {
    fault_ = core_.executor.fault();
    return;
  }
  core_.observers.tell([&](CoreObserver& observer) { observer.issue(now, slot, issued); });
  core_.counts.issue(scheduler.index(), row, issued);
  const Cycle late = row.pipe != Pipe::Memory ? scheduler.occupy(row.pipe, now, row.interval) : 0;
  if (core_.params.register_file.banks) [[unlikely]]
    scheduler.banks.read(core_.table.bank_reads(issued.pc), now);
  hand_over(slot, row, issued, late, now);
  if (units_.subwarps) [[unlikely]]
    take_turns(slot, row, before, now);
  if (issued.finished) [[unlikely]]
    units_.barriers.end_warp(*at.warp.block, now);
  if (at.warp.instructions > core_.params.instruction_budget) [[unlikely]]
    fault_ = no_end_in_sight(core_.world, at.warp, issued.pc, core_.params.instruction_budget);
  else if (issued.finished) [[unlikely]]
    units_.memory.retire(slot, now);
  else
    prepare_next(at, now);
}

void IssueStage::start_block() {
  is_plain_ = core_.warps.is_plain() && core_.observers.empty() && !core_.counts.profile &&
              !core_.params.register_file.banks && !core_.params.dispatch_latch &&
              !core_.executor.has_clock();
}

// Does what issue() does, for an instruction that only computes values in a core of which is_plain_ holds.
inline void IssueStage::issue_value(Scheduler& scheduler, uint32_t local, WarpSlot& at, const IssueRow& row,
                                    Cycle now) {
  const uint32_t pc = at.warp.simt.pc++;
  const LaneMask lanes = core_.executor.lanes_at(at.warp, pc);
  if (lanes != at.counted.mask) at.counted = {lanes, num_lanes(lanes)};
  core_.counts.issue_value(pc, at.counted.lanes, row.latency);
  scheduler.take(row.pipe, now, row.interval);
  at.scoreboard.set_value(row, {now + row.latency, row.wait});
  at.front = {now + 1, Stall::RawFixed};
  core_.executor.prefetch(at.warp);
  core_.counts.prefetch(at.warp.simt.pc);
  core_.warps.go_on(scheduler, local, at);
  // Choice: the values come last, because the host mispredicts the call of many handlers and does everything
  // else meanwhile.
  core_.executor.execute_value(at.warp, pc, lanes);
  if (at.warp.instructions > core_.params.instruction_budget) [[unlikely]]
    fault_ = no_end_in_sight(core_.world, at.warp, pc, core_.params.instruction_budget);
}

void IssueStage::run(uint32_t due, Cycle now) {
  const Alarms& alarms = core_.warps.alarms();
  for (uint32_t left = ~0u; due != 0 && !fault_; due = (due | alarms.awake()) & left) {
    const auto s = uint32_t(std::countr_zero(due));
    left = ~0u << s << 1;
    run(core_.warps.schedulers()[s], now);
  }
}

inline void IssueStage::run(Scheduler& scheduler, Cycle now) {
  core_.counts.spend(scheduler, now);
  uint64_t ready = scheduler.find_ready(now, doors_);
  if (scheduler.may_hold_back()) [[unlikely]]
    ready = leave_out_held(scheduler, ready, now);
  if (!ready) {
    if (core_.counts.profile) [[unlikely]]
      core_.counts.profile->point(scheduler.index(), blamed_pc(scheduler, now));
    return;
  }
  const uint32_t local = scheduler.pick(ready, now, doors_), slot = core_.warps.slot_of(scheduler, local);
  WarpSlot& at = core_.warps[slot];
  const IssueRow* const row = scheduler.row_of(local);
  GLINT_DCHECK(!row || row == &core_.table.row(at.warp.simt.pc), "warp {} is not where it was", slot);
  if (is_plain_ && row && row->is_value)
    issue_value(scheduler, local, at, *row, now);
  else
    issue(slot, now);
}

// Tells observers of a selected warp. Model: a warp that is ready to go through a door counts as waiting for
// it, even when only another warp was picked before it.
void IssueStage::tell_select(uint32_t slot, Cycle now) const {
  const WarpSlot& at = core_.warps[slot];
  const NextIssue next = at.scheduler->next_of(at.local);
  const Stall door = next.door == Door::RtUnit    ? Stall::RtFull
                     : next.door == Door::Texture ? Stall::TexThrottle
                     : next.door == Door::Lsu     ? Stall::LsuThrottle
                                                  : Stall::Issued;
  core_.observers.tell([&](CoreObserver& observer) {
    observer.select(now, slot, next.ready_at, next.wait, door, at.warp.simt.pc);
  });
}

// Returns the instruction that an idle cycle is charged to. As in hardware's sampling, that is where the
// blamed warp waits: the instruction that it would issue next. Waits for rays are charged to the instruction
// that traced them.
uint32_t IssueStage::blamed_pc(const Scheduler& scheduler, Cycle now) const {
  const std::optional<uint32_t> local = scheduler.to_blame(now, doors_);
  if (!local) return Profile::kNowhere;
  const uint32_t slot = core_.warps.slot_of(scheduler, *local);
  return scheduler.reason() == Stall::RtWait && scheduler.next_of(*local).ready_at == kNever
             ? units_.rays.traced_at(slot)
             : core_.warps[slot].warp.simt.pc;
}

}  // namespace glint::core

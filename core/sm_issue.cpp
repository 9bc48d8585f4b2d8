// A core from inside: choosing warps, issuing instructions and charging time for them.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>

#include "base/num_lanes.h"
#include "core/core_cell.h"

namespace glint::core {

using isa::Effect;

// Gives this cycle of the scheduler to an instruction or to a reason.
void CoreCell::run_scheduler(SchedulerState& scheduler, Cycle now) {
  const uint64_t ready = find_ready(scheduler, now);
  if (!ready) {
    if (profile_) profile_->point(scheduler.index, blamed_pc(scheduler, now));
    return;
  }
  const uint32_t local = scheduler.policy->pick({ready, {scheduler.age.data(), scheduler.age.size()}, now});
  GLINT_DCHECK(ready >> local & 1, "the issue policy chose warp {}, which is not ready", local);
  scheduler.reason = Stall::Issued;
  scheduler.sleep_until = now + 1;
  issue(scheduler, local, now);
}

// Warps that can issue now. When there are none: the reason, and until when it stays.
uint64_t CoreCell::find_ready(SchedulerState& scheduler, Cycle now) {
  Cycle next = kNever;
  Stall reason = Stall::NoWarp;
  uint64_t free = 0;
  // Without branches: which warps wait changes every cycle.
  for (uint64_t rest = scheduler.resident; rest; rest &= rest - 1) {
    const auto i = size_t(std::countr_zero(rest));
    const bool waits = scheduler.ready_at[i] > now;
    const Cycle until = waits ? scheduler.ready_at[i] : scheduler.pipe_free[size_t(scheduler.pipe[i])];
    const Stall why = waits ? scheduler.wait[i] : Stall::MathThrottle;
    const bool blocked = until > now;
    next = std::min(next, blocked ? until : kNever);
    reason = std::min(reason, blocked ? why : Stall::NoWarp);
    free |= uint64_t{!blocked} << i;
  }
  const uint64_t at_lsu = free & scheduler.needs_lsu, at_rt = free & scheduler.needs_rt;
  const uint64_t at_tex = free & scheduler.needs_tex;
  const bool lsu_full = at_lsu && !lsu_.can_take(scheduler.index),
             tex_full = at_tex && !lsu_.can_take(scheduler.index, true);
  scheduler.watches_lsu = lsu_full || tex_full;
  scheduler.watches_rt = at_rt && !rt_.can_accept();
  scheduler.lsu_vacated = lsu_.num_vacated();
  if (lsu_full) {
    free &= ~at_lsu;
    reason = std::min(reason, Stall::LsuThrottle);
  }
  if (tex_full) {
    free &= ~at_tex;
    reason = std::min(reason, Stall::TexThrottle);
  }
  if (scheduler.watches_rt) {
    free &= ~at_rt;
    reason = std::min(reason, Stall::RtFull);
  }
  if (params_.register_file.banks) {
    const uint64_t kept = leave_out_bank_conflicts(scheduler, free, now, next);
    if (kept != free) reason = std::min(reason, Stall::RegisterBanks);
    free = kept;
  }
  scheduler.reason = reason;
  scheduler.sleep_until = next;
  return free;
}

// An instruction reads its registers in the window that begins with its issue, one a bank and cycle, after
// those of others.
uint64_t CoreCell::leave_out_bank_conflicts(SchedulerState& scheduler, uint64_t free, Cycle now,
                                            Cycle& next) const {
  for (uint64_t rest = free; rest; rest &= rest - 1) {
    const auto local = uint32_t(std::countr_zero(rest));
    const IssueTable::BankReads& reads =
        table_.bank_reads(warps_[local * params_.schedulers + scheduler.index].simt.pc);
    Cycle at = now;
    for (size_t bank = 0; bank < reads.size(); ++bank)
      if (reads[bank])
        at = std::max(at,
                      std::max<Cycle>(scheduler.bank_free[bank] + reads[bank], params_.register_file.window) -
                          params_.register_file.window);
    if (at == now) continue;
    free &= ~(uint64_t{1} << local);
    next = std::min(next, at);
  }
  return free;
}

void CoreCell::read_banks(SchedulerState& scheduler, uint32_t pc, Cycle now) {
  const IssueTable::BankReads& reads = table_.bank_reads(pc);
  for (size_t bank = 0; bank < reads.size(); ++bank)
    if (reads[bank]) scheduler.bank_free[bank] = std::max(scheduler.bank_free[bank], now) + reads[bank];
}

void CoreCell::issue(SchedulerState& scheduler, uint32_t local, Cycle now) {
  const uint32_t slot = local * params_.schedulers + scheduler.index;
  if (!observers_.empty()) [[unlikely]]
    tell_select(scheduler, slot, now);
  if (sequence_[slot].left > 0) return issue_rest(scheduler, slot, now);
  exec::WarpContext& warp = warps_[slot];
  const IssueRow& row = table_.row(warp.simt.pc);
  const exec::Issued issued = executor_.execute(warp, now);
  if (executor_.fault()) {
    fault_ = executor_.fault();
    return;
  }
  ++progress_;
  count(slot, row, issued, now);
  const Cycle late = row.pipe != Pipe::Memory ? scheduler.occupy(row.pipe, now, row.interval) : 0;
  if (params_.register_file.banks) read_banks(scheduler, issued.pc, now);
  const Cycle done = now + late + row.latency;
  front_[slot] = {now + 1, Stall::RawFixed};
  switch (row.finish) {
    case Finish::Fixed:
      if (row.pipe == Pipe::Const && times_constants_ && issued.lanes) {
        start_constant(scheduler, slot, row, issued, now);
        break;
      }
      stats_.add_latency(row.stage, row.klass, late + row.latency);
      if (row.is_sequence)
        start_sequence(slot, row, issued.pc, now);
      else
        scoreboards_[slot].set(table_.defs(row), {done, row.wait}, row.alternates ? Pipe::Count : row.pipe);
      break;
    case Finish::Control:
      front_[slot] = {done, row.wait};
      stats_.add_latency(row.stage, row.klass, late + row.latency);
      break;
    case Finish::Memory:
    case Finish::CallRecord:
      if (!start_access(slot, row, issued, now)) {
        front_[slot].at = row.finish == Finish::Memory ? now + 1 : done;
        stats_.add_latency(row.stage, row.klass, front_[slot].at - now);
      }
      break;
    case Finish::Rays:
      start_rays(slot, row, issued, now);
      break;
    case Finish::Barrier:
      come_to_barrier(slot, now, row.latency);
      stats_.add_latency(row.stage, row.klass, row.latency);
      break;
    case Finish::Fence:
      start_fence(slot, row, issued, now);
      stats_.add_latency(row.stage, row.klass, row.latency);
      break;
  }
  // The end of a warp may complete a barrier for the others.
  if (issued.finished) pass_barrier(*warp.block, now + params_.units.barrier.latency);
  if (warp.instructions > params_.instruction_budget) {
    fault_ = no_end_in_sight(world_, warps_[slot], issued.pc, params_.instruction_budget);
  } else if (issued.finished) {
    retire(slot);
  } else {
    refresh(slot);
  }
}

// The core's barrier unit takes one warp after another; those that wait go on a latency after the last.
void CoreCell::come_to_barrier(uint32_t slot, Cycle now, Cycle latency) {
  ++stats_.barriers;
  barrier_free_ = std::max(barrier_free_, now) + params_.units.barrier.interval;
  front_[slot] = {barrier_free_ + latency, Stall::Barrier};
  if (warps_[slot].waiting_at_barrier) front_[slot].at = kNever;
  pass_barrier(*warps_[slot].block, barrier_free_ + latency);
}

// Warps of the block whose barrier has opened can issue from `at` on.
void CoreCell::pass_barrier(const exec::Block& block, Cycle at) {
  for (uint32_t w = 0; w < block.num_warps(); ++w) {
    if (!(block.live() >> w & 1) || block.warps[w]->waiting_at_barrier) continue;
    const auto slot = uint32_t(block.warps[w] - warps_.data());
    if (front_[slot].at != kNever || front_[slot].wait != Stall::Barrier) continue;
    front_[slot].at = at;
    refresh(slot);
  }
}

// A fence among cores lasts until they see what came before it, however short its latency.
// Model: one of the whole system takes longer than any acknowledgement anyway.
void CoreCell::start_fence(uint32_t slot, const IssueRow& row, const exec::Issued& issued, Cycle now) {
  ++stats_.fences;
  const bool waits = outstanding_[slot] > 0,
             among_cores = isa::FenceScope(issued.row->detail) > isa::FenceScope::Block;
  const bool acknowledged = stored_[slot] && isa::FenceScope(issued.row->detail) == isa::FenceScope::Gpu;
  const Cycle latency = std::max<Cycle>(row.latency + (acknowledged ? params_.fence.acknowledgement : 0),
                                        among_cores && turn_ ? turn_end(now) - now : 0);
  stored_[slot] = stored_[slot] && !among_cores;
  fence_[slot] = waits ? latency : 0;
  front_[slot] = {waits ? kNever : now + latency, Stall::Fence};
}

void CoreCell::count(uint32_t slot, const IssueRow& row, const exec::Issued& issued, Cycle now) {
  const uint64_t lanes = num_lanes(issued.lanes);
  if (profile_) profile_->issue(slot % params_.schedulers, issued.pc, lanes);
  for (CoreObserver* observer : observers_) observer->issue(now, slot, issued);
  ++stats_.instructions;
  stats_.lane_instructions += lanes;
  stats_.lane_slots += uint64_t(kLanes);
  stats_.by_class.add(row.klass);
  stats_.lanes_by_class.add(row.klass, lanes);
  StageStats& stage = *stats_.stage[size_t(row.stage)];
  stage.instructions.add(row.klass);
  stage.lanes.add(row.klass, lanes);
  ++op_counts_[issued.inst->op];
  op_lanes_[issued.inst->op] += lanes;
  if (row.is_conditional) {
    ++stats_.branches;
    if (issued.lanes != 0 && issued.lanes != issued.active) ++stats_.divergent_branches;
  }
  if (row.pipe == Pipe::Const) ++stats_.constant_loads;
}

// Gives the rays of an rt.trace or rt.resume to the RT unit, or goes on at once when none has to travel.
void CoreCell::start_rays(uint32_t slot, const IssueRow& row, const exec::Issued& issued, Cycle now) {
  exec::WarpContext& warp = warps_[slot];
  LaneMask travelling = 0;
  if (warp.waiting_for_rays) {
    for_each_lane(issued.lanes, [&](int lane) {
      if (warp.rays[lane].status == rt::RayStatus::Traversing) travelling |= LaneMask{1} << lane;
    });
  }
  if (travelling) {
    for (CoreObserver* observer : observers_) observer->start_rays(slot, travelling, warp.rays);
    rays_lanes_[slot] = travelling;
    rt_.submit(now, slot, travelling, warp.rays);
    front_[slot] = {kNever, Stall::RtWait};
    rays_issued_[slot] = now;
    rays_pc_[slot] = issued.pc;
    ++stats_.rt_warps;
    stats_.rt_lanes += uint64_t(std::popcount(travelling));
    return;
  }
  if (warp.waiting_for_rays) executor_.finish_rays(warp);
  front_[slot] = {now + row.latency, Stall::RtWait};
  stats_.add_latency(row.stage, row.klass, row.latency);
}

void CoreCell::complete_rays(uint32_t slot, Cycle now) {
  const IssueRow& row = table_.row(rays_pc_[slot]);
  for (CoreObserver* observer : observers_) observer->end_rays(slot, rays_lanes_[slot], warps_[slot].rays);
  executor_.finish_rays(warps_[slot]);
  front_[slot] = {now + row.latency, Stall::RtWait};
  stats_.add_latency(row.stage, row.klass, now + row.latency - rays_issued_[slot]);
  if (profile_) profile_->end(rays_pc_[slot], now + row.latency - rays_issued_[slot]);
  ++progress_;
  refresh(slot);
}

void CoreCell::retire(uint32_t slot) {
  if (outstanding_[slot] == 0) {
    free_slot(slot);
    return;
  }
  SchedulerState& scheduler = scheduler_of(slot);
  scheduler.ready_at[slot / params_.schedulers] = kNever;
  scheduler.wait[slot / params_.schedulers] = Stall::Drain;
}

void CoreCell::free_slot(uint32_t slot) {
  SchedulerState& scheduler = scheduler_of(slot);
  scheduler.resident &= ~(uint64_t{1} << (slot / params_.schedulers));
  scheduler.wake();
  --num_resident_;
  if (--home_[slot]->warps == 0) --num_blocks_;
  for (CoreObserver* observer : observers_) observer->end_warp(now_, slot);
}

Scoreboard::Ready CoreCell::operands_ready(uint32_t slot, const IssueRow& row) const {
  const Scoreboard& board = scoreboards_[slot];
  const Cycle crossing = params_.pipe_crossing, guard = params_.guard_delay;
  const Cycle slack = row.finish == Finish::Fixed && !params_.write_order ? row.latency - 1 : 0;
  const auto uses = table_.uses(row);
  Scoreboard::Ready ready = crossing + guard > 0
                                ? board.ready(uses, front_[slot], row, crossing, guard, slack)
                            : slack > 0 ? board.ready_in_order(uses.first(uses.size() - row.num_defs),
                                                               table_.defs(row), front_[slot], row.latency)
                                        : board.ready(uses, front_[slot]);
  if (holds_operands_) ready = board.unread(table_.defs(row), ready);
  if (waits_for_line_[slot] && ready.at != kNever) ready = {kNever, Stall::NoInstruction};
  return ready;
}

// Looks up when the warp's next instruction is there and has its operands, after anything about that changed.
void CoreCell::refresh(uint32_t slot) {
  if (code_ && code_->fetch) come_to_line(slot);
  SchedulerState& scheduler = scheduler_of(slot);
  const uint32_t local = slot / params_.schedulers;
  if (sequence_[slot].left > 0) return refresh_sequence(scheduler, slot);
  const IssueRow& row = table_.row(warps_[slot].simt.pc);
  const Scoreboard::Ready ready = operands_ready(slot, row);
  scheduler.ready_at[local] = ready.at;
  scheduler.wait[local] = ready.wait;
  scheduler.pipe[local] = row.pipe;
  const bool memory = row.finish == Finish::Memory || row.finish == Finish::CallRecord;
  const bool own_queue = row.is_texture && params_.texture.queue > 0;
  const uint64_t tex = memory && own_queue, lsu = memory && !own_queue, rt = row.finish == Finish::Rays;
  scheduler.needs_lsu = (scheduler.needs_lsu & ~(uint64_t{1} << local)) | lsu << local;
  scheduler.needs_tex = (scheduler.needs_tex & ~(uint64_t{1} << local)) | tex << local;
  scheduler.needs_rt = (scheduler.needs_rt & ~(uint64_t{1} << local)) | rt << local;
  scheduler.wake();
}

}  // namespace glint::core

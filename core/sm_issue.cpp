// A core from inside: choosing warps, issuing instructions and charging time for them.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>

#include "base/num_lanes.h"
#include "core/core_cell.h"

namespace glint::core {

using isa::Effect;

namespace {
bool is_surface(Effect effect) {
  return effect == Effect::SurfaceLoad || effect == Effect::SurfaceStore || effect == Effect::SurfaceAtomic;
}
}  // namespace

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
  scheduler.watches_lsu = at_lsu && !lsu_.can_take(scheduler.index);
  scheduler.watches_rt = at_rt && !rt_.can_accept();
  scheduler.lsu_vacated = lsu_.num_vacated();
  if (scheduler.watches_lsu) {
    free &= ~at_lsu;
    reason = std::min(reason, Stall::LsuThrottle);
  }
  if (scheduler.watches_rt) {
    free &= ~at_rt;
    reason = std::min(reason, Stall::RtFull);
  }
  scheduler.reason = reason;
  scheduler.sleep_until = next;
  return free;
}

void CoreCell::issue(SchedulerState& scheduler, uint32_t local, Cycle now) {
  const uint32_t slot = local * params_.schedulers + scheduler.index;
  WarpContext& warp = warps_[slot];
  const IssueRow& row = table_.row(warp.simt.pc);
  const Issued issued = executor_.execute(warp, now);
  if (executor_.fault()) {
    fault_ = executor_.fault();
    return;
  }
  ++progress_;
  count(row, issued);
  if (profile_) profile_->issue(scheduler.index, issued.pc, num_lanes(issued.lanes));
  if (row.pipe != Pipe::Memory) scheduler.pipe_free[size_t(row.pipe)] = now + row.interval;
  const Cycle done = now + row.latency;
  front_[slot] = {now + 1, Stall::RawFixed};
  switch (row.finish) {
    case Finish::Fixed:
      scoreboards_[slot].set(table_.defs(row), {done, row.wait}, row.alternates ? Pipe::Count : row.pipe);
      stats_.latency.add(row.klass, row.latency);
      break;
    case Finish::Control:
      front_[slot] = {done, row.wait};
      stats_.latency.add(row.klass, row.latency);
      break;
    case Finish::Memory:
    case Finish::CallRecord:
      if (!start_access(slot, row, issued, now)) {
        front_[slot].at = row.finish == Finish::Memory ? now + 1 : done;
        stats_.latency.add(row.klass, front_[slot].at - now);
      }
      break;
    case Finish::Rays:
      start_rays(slot, row, issued, now);
      break;
    case Finish::Barrier:
      come_to_barrier(slot, now, row.latency);
      stats_.latency.add(row.klass, row.latency);
      break;
    case Finish::Fence:
      start_fence(slot, row, issued, now);
      stats_.latency.add(row.klass, row.latency);
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
void CoreCell::pass_barrier(const Block& block, Cycle at) {
  for (uint32_t w = 0; w < block.num_warps(); ++w) {
    if (!(block.live() >> w & 1) || block.warps[w]->waiting_at_barrier) continue;
    const auto slot = uint32_t(block.warps[w] - warps_.data());
    if (front_[slot].at != kNever || front_[slot].wait != Stall::Barrier) continue;
    front_[slot].at = at;
    refresh(slot);
  }
}

// A fence among cores lasts until they see what came before it, however short its latency.
void CoreCell::start_fence(uint32_t slot, const IssueRow& row, const Issued& issued, Cycle now) {
  ++stats_.fences;
  const bool waits = outstanding_[slot] > 0, among_cores = isa::FenceScope(issued.row->detail) > isa::FenceScope::Block;
  const Cycle latency = std::max<Cycle>(row.latency, among_cores && turn_ ? turn_end(now) - now : 0);
  fence_[slot] = waits ? latency : 0;
  front_[slot] = {waits ? kNever : now + latency, Stall::Fence};
}

void CoreCell::count(const IssueRow& row, const Issued& issued) {
  const uint64_t lanes = num_lanes(issued.lanes);
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

void CoreCell::count_access(const isa::OpRow& op) {
  // Generic accesses count where most of them go; every other effect makes no access.
  const bool local = op.memory.space == isa::Space::Local, shared = op.memory.space == isa::Space::Shared;
  if (op.effect == Effect::Atomic) {
    ++(shared ? stats_.shared_atomics : stats_.global_atomics);
  } else if (op.effect == Effect::Load) {
    ++(shared ? stats_.shared_loads : local ? stats_.local_loads : stats_.global_loads);
  } else if (op.effect == Effect::Store) {
    ++(shared ? stats_.shared_stores : local ? stats_.local_stores : stats_.global_stores);
  } else if (op.effect == Effect::Texture) {
    ++stats_.texture_fetches;
  } else if (op.effect == Effect::SurfaceLoad || op.effect == Effect::SurfaceAtomic) {
    ++stats_.surface_loads;  // Model: an atomic on an image costs what a load of it costs
  } else if (op.effect == Effect::SurfaceStore) {
    ++stats_.surface_stores;
  } else {
    ++stats_.binding_reads;
  }
}

// Hands the access to the load-store unit; false when no lane makes one.
bool CoreCell::start_access(uint32_t slot, const IssueRow& row, const Issued& issued, Cycle now) {
  if (issued.lanes == 0) return false;
  // Texels that are all border, or outside of their image, need no memory.
  const bool is_image = issued.row->effect == Effect::Texture || is_surface(issued.row->effect);
  if (is_image && executor_.texels().empty()) return false;
  MemoryAccess& access = lsu_.take(slot % params_.schedulers, now);
  access.slot = slot;
  access.pc = issued.pc;
  if (executor_.is_late()) access.late_until = turn_end(now);
  access.write = issued.row->effect == Effect::Store || issued.row->effect == Effect::SurfaceStore;
  collect_lines(access, issued);
  // red: nobody waits for an answer.
  access.write |= issued.row->effect == Effect::Atomic && row.num_defs == 0;
  ++outstanding_[slot];
  if (row.finish == Finish::CallRecord)
    front_[slot] = {kNever, Stall::Call};
  else
    scoreboards_[slot].set(table_.defs(row), {kNever, row.wait});
  count_access(*issued.row);
  stats_.shared_passes += access.passes;
  if (access.lines.lines().empty()) return true;
  ++stats_.accesses;
  stats_.lines += access.lines.lines().size();
  stats_.sectors += access.lines.num_sectors();
  if (profile_) profile_->access(issued.pc, access.lines.lines().size(), access.lines.num_sectors());
  return true;
}

void CoreCell::collect_lines(MemoryAccess& access, const Issued& issued) {
  const isa::Access& addresses = warps_[access.slot].regs.access;
  access.texture = false;
  if (issued.row->effect == Effect::Texture) {
    access.traffic = mem::Traffic::ShaderTexture;
    collect_texels(access, issued.lanes);
  } else if (is_surface(issued.row->effect)) {
    access.traffic = mem::Traffic::ShaderSurface;
    collect_texels(access, issued.lanes);
  } else if (isa::is_shader_call(issued.row->effect)) {
    access.traffic = mem::Traffic::ShaderBinding;
    if (issued.row->effect == Effect::CallCandidate) collect_candidates(access, issued.lanes);
    coalesce_global(access.lines, *world_.memory, addresses, issued.lanes, mem::kSectorBytes);
  } else {
    collect_memory(access, issued);
  }
}

// The entries of the candidates whose shaders are called.
// Model: one read for all of a warp's lanes, with their records of the binding table; what the shaders then read of a
// candidate is in registers. Tables of nested traces share their place: an outer one is empty by then.
void CoreCell::collect_candidates(MemoryAccess& access, LaneMask lanes) {
  if (tables_.rows == 0) return;
  const TraceFrame& frame = warps_[access.slot].frame();
  for_each_lane(lanes, [&](int lane) {
    access.lines.add(tables_.entry(access.slot, frame.ray[size_t(lane)].candidate_row, lane), rt::kTableEntryBytes);
  });
  access.num_table_lines = uint32_t(access.lines.lines().size());
}

// Loads, stores and atomics. Model: lanes of a generic access that are in local memory travel as global traffic, and
// those in the constant bank take no time of their own.
void CoreCell::collect_memory(MemoryAccess& access, const Issued& issued) {
  using isa::Space;
  const isa::Access& addresses = warps_[access.slot].regs.access;
  const auto bytes = uint32_t(issued.row->memory.bytes * issued.row->memory.count);
  const bool is_atomic = issued.row->effect == Effect::Atomic;
  access.traffic = is_atomic                                        ? mem::Traffic::ShaderAtomic
                   : issued.row->memory.space == Space::Local ? mem::Traffic::ShaderLocal
                                                              : mem::Traffic::ShaderGlobal;
  access.atomic = is_atomic;
  if (const LaneMask lanes = executor_.lanes_in(Space::Shared)) access.passes = shared_passes(addresses, lanes, bytes, is_atomic);
  const LaneMask in_global = executor_.lanes_in(Space::Global);
  if (params_.lsu.bank_conflicts && !is_atomic && in_global) access.bank_turns = shared_passes(addresses, in_global, bytes, false);
  coalesce_local(access.lines, local_, access.slot, addresses, executor_.lanes_in(Space::Local), bytes);
  coalesce_global(access.lines, *world_.memory, addresses, in_global, bytes);
}

void CoreCell::collect_texels(MemoryAccess& access, LaneMask lanes) {
  access.texture = true;
  for (const auto& row : executor_.texels().rows())
    for_each_lane(lanes, [&](int lane) {
      const Address texel = row[size_t(lane)];
      if (texel != TexelList::kNone) access.lines.add(world_.memory->physical(texel), 4);
    });
}

void CoreCell::complete(uint32_t access_id, Cycle now) {
  const MemoryAccess& access = lsu_.access(access_id);
  const uint32_t slot = access.slot;
  const IssueRow& row = table_.row(access.pc);
  stats_.latency.add(row.klass, now - access.issued);
  if (profile_) profile_->end(access.pc, now - access.issued);
  if (row.finish == Finish::CallRecord) {
    // The branch itself was resolved long ago, or now.
    front_[slot] = {std::max(now, access.issued + row.latency), Stall::Call};
  } else if (!access.write) {
    scoreboards_[slot].set(table_.defs(row), {std::max(now, access.late_until), row.wait});
  }
  lsu_.release(access_id);
  --outstanding_[slot];
  ++progress_;
  if (fence_[slot] != 0 && outstanding_[slot] == 0) {
    front_[slot].at = now + fence_[slot];
    fence_[slot] = 0;
  }
  if (!warps_[slot].simt.finished())
    refresh(slot);
  else if (outstanding_[slot] == 0)
    free_slot(slot);
}

// Gives the rays of an rt.trace or rt.resume to the RT unit, or goes on at once when none has to travel.
void CoreCell::start_rays(uint32_t slot, const IssueRow& row, const Issued& issued, Cycle now) {
  WarpContext& warp = warps_[slot];
  LaneMask travelling = 0;
  if (warp.waiting_for_rays) {
    for_each_lane(issued.lanes, [&](int lane) {
      if (warp.rays[lane].status == rt::RayStatus::Traversing) travelling |= LaneMask{1} << lane;
    });
  }
  if (travelling) {
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
  stats_.latency.add(row.klass, row.latency);
}

void CoreCell::complete_rays(uint32_t slot, Cycle now) {
  const IssueRow& row = table_.row(rays_pc_[slot]);
  executor_.finish_rays(warps_[slot]);
  front_[slot] = {now + row.latency, Stall::RtWait};
  stats_.latency.add(row.klass, now + row.latency - rays_issued_[slot]);
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
}

// Looks up when the warp's next instruction has its operands, after anything about that changed.
void CoreCell::refresh(uint32_t slot) {
  SchedulerState& scheduler = scheduler_of(slot);
  const uint32_t local = slot / params_.schedulers;
  const IssueRow& row = table_.row(warps_[slot].simt.pc);
  const Cycle crossing = params_.pipe_crossing, guard = params_.guard_delay;
  const Scoreboard::Ready ready = crossing + guard == 0
                                      ? scoreboards_[slot].ready(table_.uses(row), front_[slot])
                                      : scoreboards_[slot].ready(table_.uses(row), front_[slot], row, crossing, guard);
  scheduler.ready_at[local] = ready.at;
  scheduler.wait[local] = ready.wait;
  scheduler.pipe[local] = row.pipe;
  const uint64_t lsu = row.finish == Finish::Memory || row.finish == Finish::CallRecord;
  const uint64_t rt = row.finish == Finish::Rays;
  scheduler.needs_lsu = (scheduler.needs_lsu & ~(uint64_t{1} << local)) | lsu << local;
  scheduler.needs_rt = (scheduler.needs_rt & ~(uint64_t{1} << local)) | rt << local;
  scheduler.wake();
}

}  // namespace glint::core

// Handles the memory accesses of a core's warps.
// SPDX-License-Identifier: Apache-2.0
#include "core/memory_accesses.h"

#include <algorithm>

#include "isa/barrier.h"

namespace glint::core {

using isa::Effect;

MemoryAccesses::MemoryAccesses(const CoreParts& core, const Context& context)
    : core_(core),
      lsu_(context.lsu),
      lines_(core.params, core.world, core.executor, context.local, context.tables),
      turn_(context.turn),
      holds_operands_(core.params.lsu.holds_operands()),
      pending_(core.warps.size()),
      copies_(AsyncCopies::make(core, context.barriers, core.params.lsu.accesses)),
      subwarps_(context.subwarps) {
}

bool MemoryAccesses::start(uint32_t slot, const IssueRow& row, const exec::Issued& issued, Cycle now) {
  if (issued.lanes == 0) return false;
  // Texels that are all border, or outside of their image, need no memory.
  if (row.is_texture && core_.executor.texels().empty()) return false;
  WarpSlot& at = core_.warps[slot];
  MemoryAccess& access = lsu_.take(at.scheduler->index(), now, row.is_texture);
  access.slot = slot;
  access.pc = issued.pc;
  if (core_.executor.is_late()) access.late_until = turn_end(now);
  access.write = isa::only_writes_memory(issued.row->effect);
  // Nobody waits for the answer of a red.
  access.write |= issued.row->effect == Effect::Atomic && row.num_defs == 0;
  access.atomic_kind = row.atomic;
  access.merges_lanes = row.merges_lanes;
  lines_.collect(access, at.warp, issued);
  const bool reaches_l1 = !access.lines.lines().empty();
  Pending& pending = pending_[slot];
  pending.has_stored |= access.write && reaches_l1;
  ++(row.is_copy ? pending.copies : pending.accesses);
  if (row.is_copy) [[unlikely]]
    copies_->start(slot, lsu_.number_of(access), issued);
  if (row.finish == Finish::Memory && war_latency(access) > 0) at.scoreboard.hold(core_.table.sources(row));
  if (row.finish == Finish::CallRecord)
    at.front = {kNever, Stall::Call};
  else
    at.scoreboard.set(core_.table.defs(row), {kNever, row.wait});
  if (subwarps_ && row.finish != Finish::CallRecord && !access.write && row.num_defs > 0) [[unlikely]]
    subwarps_->begin(slot, lsu_.number_of(access), issued.pc, issued.lanes);
  CoreStats& stats = core_.counts.stats;
  count(*issued.row);
  stats.shared_passes += access.passes;
  if (!reaches_l1) return true;
  const uint64_t lines = access.lines.lines().size(), sectors = access.lines.num_sectors();
  ++stats.accesses;
  stats.lines += lines;
  stats.sectors += sectors;
  if (core_.counts.profile) core_.counts.profile->access(issued.pc, lines, sectors);
  return true;
}

void MemoryAccesses::count(const isa::OpRow& op) {
  CoreStats& stats = core_.counts.stats;
  // Generic accesses count as global, where most of them go. Effects that are not named here make no access.
  const bool local = op.memory.space == isa::Space::Local, shared = op.memory.space == isa::Space::Shared;
  if (op.effect == Effect::Atomic) {
    ++(shared ? stats.shared_atomics : stats.global_atomics);
  } else if (op.effect == Effect::Load) {
    ++(shared ? stats.shared_loads : local ? stats.local_loads : stats.global_loads);
  } else if (op.effect == Effect::Store) {
    ++(shared ? stats.shared_stores : local ? stats.local_stores : stats.global_stores);
  } else if (op.effect == Effect::Copy) {
    ++stats.global_loads;
    ++stats.shared_stores;
  } else if (op.effect == Effect::Mbarrier) {
    ++stats.shared_atomics;
  } else if (op.effect == Effect::Texture) {
    ++stats.texture_fetches;
  } else if (op.effect == Effect::SurfaceLoad || op.effect == Effect::SurfaceAtomic) {
    ++stats.surface_loads;  // Model: an atomic on an image costs what a load of it costs.
  } else if (op.effect == Effect::SurfaceStore) {
    ++stats.surface_stores;
  } else {
    ++stats.binding_reads;
  }
}

// Starts a fence. Model: a fence of the whole system takes longer than any acknowledgement anyway.
void MemoryAccesses::start_fence(uint32_t slot, const IssueRow& row, const exec::Issued& issued, Cycle now) {
  ++core_.counts.stats.fences;
  Pending& pending = pending_[slot];
  const auto scope = isa::FenceScope(issued.row->detail);
  const bool waits = pending.accesses > 0, among_cores = scope > isa::FenceScope::Block;
  const bool acknowledged = pending.has_stored && scope == isa::FenceScope::Gpu;
  const Cycle latency = std::max<Cycle>(row.latency + (acknowledged ? core_.params.fence.acknowledgement : 0),
                                        among_cores && turn_ ? turn_end(now) - now : 0);
  pending.has_stored = pending.has_stored && !among_cores;
  pending.fence = waits ? latency : 0;
  core_.warps[slot].front = {waits ? kNever : now + latency, Stall::Fence};
}

void MemoryAccesses::take_news(Cycle now) {
  if (holds_operands_)
    for (uint32_t id : lsu_.accepted()) read_operands(id, now);
  for (uint32_t id : lsu_.completed()) complete(id, now);
  lsu_.forget_news();
}

// Notes that an access has left its queue. The unit reads its registers, and others may write them from then
// on.
void MemoryAccesses::read_operands(uint32_t access_id, Cycle now) {
  const MemoryAccess& access = lsu_.access(access_id);
  const IssueRow& row = core_.table.row(access.pc);
  const Cycle latency = war_latency(access);
  if (row.finish != Finish::Memory || latency == 0) return;
  WarpSlot& at = core_.warps[access.slot];
  at.scoreboard.read(core_.table.sources(row), now - 1 + latency);
  if (!at.warp.simt.finished()) core_.warps.refresh(access.slot, now);
}

void MemoryAccesses::complete(uint32_t access_id, Cycle now) {
  const MemoryAccess& access = lsu_.access(access_id);
  const bool is_copy = core_.table.row(access.pc).is_copy;
  if (is_copy && !copies_->end(access_id, access.late_until, now)) [[unlikely]]
    return;
  finish(access_id, now);
  if (is_copy) [[unlikely]]
    while (const auto ended = copies_->take_ended()) finish(*ended, now);
}

void MemoryAccesses::take_late_copies(Cycle now) {
  while (const auto late = copies_->due(now)) complete(*late, now);
}

void MemoryAccesses::finish(uint32_t access_id, Cycle now) {
  const MemoryAccess& access = lsu_.access(access_id);
  const uint32_t slot = access.slot;
  const Cycle duration = now - access.issued;
  const IssueRow& row = core_.table.row(access.pc);
  CoreCounts& counts = core_.counts;
  counts.end(access.pc, duration);
  if (counts.profile) counts.profile->end(access.pc, duration);
  if (!access.write && !access.lines.lines().empty()) counts.latencies.add(access.traffic, duration);
  deliver(access, row, now);
  lsu_.release(access_id);
  ++counts.progress;
  WarpSlot& at = core_.warps[slot];
  Pending& pending = pending_[slot];
  --(row.is_copy ? pending.copies : pending.accesses);
  if (pending.fence != 0 && pending.accesses == 0) {
    at.front.at = now + pending.fence;
    pending.fence = 0;
  }
  if (!at.warp.simt.finished())
    core_.warps.refresh(slot, now);
  else if (in_flight(slot) == 0)
    core_.warps.free(slot, now);
}

// Tells the warp when it has what the access was for.
void MemoryAccesses::deliver(const MemoryAccess& access, const IssueRow& row, Cycle now) {
  WarpSlot& at = core_.warps[access.slot];
  if (row.finish == Finish::CallRecord) {
    // The branch itself was resolved long ago, or is resolved now.
    at.front = {std::max(now, access.issued + row.latency), Stall::Call};
  } else if (!access.write) {
    const bool is_global_atomic =
        access.traffic == mem::Traffic::ShaderAtomic && !access.lines.lines().empty();
    const Cycle late = is_global_atomic ? core_.params.lsu.atomic_latency : 0;
    const Cycle ready = std::max(now + late, access.late_until);
    if (!subwarps_) [[likely]]
      at.scoreboard.set(core_.table.defs(row), {ready, row.wait});
    else if (row.num_defs > 0)
      subwarps_->end(access.slot, lsu_.number_of(access), ready);
  }
}

LaneMask MemoryAccesses::readers_of(mem::Token access, Address line, uint32_t& slot) const {
  const MemoryAccess& of = lsu_.access(access);
  slot = of.slot;
  LaneMask lanes = 0;
  for (const LineSectors& touched : of.lines.lines())
    if (touched.line == line) lanes |= touched.lanes;
  return lanes;
}

}  // namespace glint::core

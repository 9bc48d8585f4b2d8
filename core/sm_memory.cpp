// A core's accesses: which lines and banks an instruction wants, what it holds until they are done.
// SPDX-License-Identifier: Apache-2.0
#include <bit>

#include "core/core_cell.h"

namespace glint::core {

using isa::Effect;

namespace {
bool is_surface(Effect effect) {
  return effect == Effect::SurfaceLoad || effect == Effect::SurfaceStore || effect == Effect::SurfaceAtomic;
}
}  // namespace

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
bool CoreCell::start_access(uint32_t slot, const IssueRow& row, const exec::Issued& issued, Cycle now) {
  if (issued.lanes == 0) return false;
  // Texels that are all border, or outside of their image, need no memory.
  if (row.is_texture && executor_.texels().empty()) return false;
  MemoryAccess& access = lsu_.take(slot % params_.schedulers, now, row.is_texture);
  access.slot = slot;
  access.pc = issued.pc;
  if (executor_.is_late()) access.late_until = turn_end(now);
  access.write = issued.row->effect == Effect::Store || issued.row->effect == Effect::SurfaceStore;
  // red: nobody waits for an answer.
  access.write |= issued.row->effect == Effect::Atomic && row.num_defs == 0;
  access.atomic_kind = row.atomic;
  collect_lines(access, issued);
  stored_[slot] |= access.write && !access.lines.lines().empty();
  if (row.finish == Finish::Memory && war_latency(access) > 0) scoreboards_[slot].hold(table_.sources(row));
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

void CoreCell::collect_lines(MemoryAccess& access, const exec::Issued& issued) {
  const isa::Access& addresses = warps_[access.slot].regs.access;
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
// Model: one read for all of a warp's lanes, with their records of the binding table; what the shaders then
// read of a candidate is in registers. Tables of nested traces share their place: an outer one is empty by
// then.
void CoreCell::collect_candidates(MemoryAccess& access, LaneMask lanes) {
  if (tables_.rows == 0) return;
  const exec::TraceFrame& frame = warps_[access.slot].frame();
  for_each_lane(lanes, [&](int lane) {
    access.lines.add(tables_.entry(access.slot, frame.ray[size_t(lane)].candidate_row, lane),
                     rt::kTableEntryBytes, lane);
  });
  access.num_table_lines = uint32_t(access.lines.lines().size());
}

// Loads, stores and atomics. Model: lanes of a generic access that are in local memory travel as global
// traffic, and those in the constant bank take no time of their own.
void CoreCell::collect_memory(MemoryAccess& access, const exec::Issued& issued) {
  using isa::Space;
  const isa::Access& addresses = warps_[access.slot].regs.access;
  const auto bytes = uint32_t(issued.row->memory.bytes * issued.row->memory.count);
  const bool is_atomic = issued.row->effect == Effect::Atomic;
  access.traffic = is_atomic                                  ? mem::Traffic::ShaderAtomic
                   : issued.row->memory.space == Space::Local ? mem::Traffic::ShaderLocal
                                                              : mem::Traffic::ShaderGlobal;
  access.atomic = is_atomic;
  if (const LaneMask lanes = executor_.lanes_in(Space::Shared))
    access.passes = shared_passes(addresses, lanes, bytes, is_atomic);
  const LaneMask in_global = executor_.lanes_in(Space::Global);
  if (params_.lsu.bank_conflicts && !is_atomic && in_global)
    access.bank_turns = shared_passes(addresses, in_global, bytes, false);
  coalesce_local(access.lines, local_, access.slot, addresses, executor_.lanes_in(Space::Local), bytes);
  coalesce_global(access.lines, *world_.memory, addresses, in_global, bytes);
  if (is_atomic && in_global)
    count_turns(access.lines, *world_.memory, addresses, bytes, params_.lsu.atomic_turns, !access.write);
}

void CoreCell::collect_texels(MemoryAccess& access, LaneMask lanes) {
  access.samples = uint32_t(std::popcount(lanes)) * uint32_t((executor_.texels().rows().size() + 3) / 4);
  for (const auto& row : executor_.texels().rows())
    for_each_lane(lanes, [&](int lane) {
      const Address texel = row[size_t(lane)];
      if (texel != exec::TexelList::kNone) access.lines.add(world_.memory->physical(texel), 4, lane);
    });
}

// An access has left its queue: the unit reads its registers, and others may write them from then on.
void CoreCell::read_operands(uint32_t access_id, Cycle now) {
  const MemoryAccess& access = lsu_.access(access_id);
  const IssueRow& row = table_.row(access.pc);
  const Cycle latency = war_latency(access);
  if (row.finish != Finish::Memory || latency == 0) return;
  scoreboards_[access.slot].read(table_.sources(row), now - 1 + latency);
  if (!warps_[access.slot].simt.finished()) refresh(access.slot);
}

void CoreCell::complete(uint32_t access_id, Cycle now) {
  const MemoryAccess& access = lsu_.access(access_id);
  const uint32_t slot = access.slot;
  const IssueRow& row = table_.row(access.pc);
  stats_.add_latency(row.stage, row.klass, now - access.issued);
  if (profile_) profile_->end(access.pc, now - access.issued);
  if (!access.write && !access.lines.lines().empty()) latencies_.add(access.traffic, now - access.issued);
  if (row.finish == Finish::CallRecord) {
    // The branch itself was resolved long ago, or now.
    front_[slot] = {std::max(now, access.issued + row.latency), Stall::Call};
  } else if (!access.write) {
    const Cycle late = access.traffic == mem::Traffic::ShaderAtomic && !access.lines.lines().empty()
                           ? params_.lsu.atomic_latency
                           : 0;
    scoreboards_[slot].set(table_.defs(row), {std::max(now + late, access.late_until), row.wait});
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

}  // namespace glint::core

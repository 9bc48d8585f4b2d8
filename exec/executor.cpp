// Executes instructions: applies guards, and finds the family of the effect.
// SPDX-License-Identifier: Apache-2.0
#include "exec/executor.h"

#include <bit>
#include <fmt/format.h>
#include <memory>

#include "base/check.h"
#include "exec/prints.h"
#include "isa/hit_object.h"

namespace glint::exec {

using isa::Effect;
using isa::EffectFamily;

Executor::Executor(const World& world, double clock_mhz)
    : world_(world),
      reads_clock_(reads_clock(*world.image)),
      clock_mhz_(clock_mhz),
      faults_(world),
      ray_faults_(world, faults_),
      memory_(world, faults_, seen_),
      images_(world, faults_, seen_),
      candidates_(world, candidate_counts_),
      calls_(world, faults_, ray_faults_, called, candidate_counts_),
      rays_(world, faults_, ray_faults_, candidates_),
      queries_(world, faults_, ray_faults_),
      hit_objects_(world, faults_, ray_faults_, rays_),
      reorder_calls_(world, faults_),
      traversal_(world, rays_, calls_),
      control_(world, faults_, calls_, traversal_),
      barriers_(world, faults_) {
  GLINT_CHECK(warps_per_block() <= kMaxBlockWarps, "a block of {} warps: check() reports this",
              warps_per_block());
}

void Executor::start(WarpContext& warp, uint32_t warp_index) const {
  GLINT_CHECK(world_.block_size[0] == 0, "a warp of a block needs its block");
  if (!warp.own_block) warp.own_block = std::make_unique<Block>();
  start(*warp.own_block, warp_index);
  start(warp, *warp.own_block, 0);
}

void Executor::execute_effect(WarpContext& warp, Issued& issued, Cycle now) {
  const isa::Inst& inst = *issued.inst;
  const isa::OpRow& row = *issued.row;
  if (reads_clock_) [[unlikely]]
    fill_clock(*world_.image, warp, now, clock_mhz_);
  if (seen_.is_used()) seen_.view().begin(now);
  if (warp.simt.has_yielded() && world_.image->code[issued.pc].meets) [[unlikely]] {
    if (!control_.meet(warp, issued.pc)) {
      issued.lanes = 0;
      ++warp.instructions;
      return;
    }
    issued.active = warp.simt.active;
    warp.regs.exec = lanes_at(warp, issued.pc);
  }
  bool ok = true;
  if (row.effect == Effect::None) {
    row.run(warp.regs, inst, row);
    ++warp.simt.pc;
  } else {
    ok = dispatch(warp, inst, row);
  }
  issued.lanes = warp.regs.exec;  // Ray effects leave out lanes that had nothing to do.
  if (warp.waiting_for_rays && traversal_.is_used() && ok) traversal_.walk(warp, issued.pc);
  issued.finished = warp.simt.finished();
  if (ok && issued.finished) [[unlikely]]
    ok = barriers_.end_warp(warp);
  if (ok) {
    ++warp.instructions;
    retired.fire([&] { return Retired{warp, issued}; });
  }
}

void Executor::tell_retired(const WarpContext& warp, const Issued& issued) const {
  retired.fire([&] { return Retired{warp, issued}; });
}

bool Executor::resume(WarpContext& warp) {
  control_.resume_if_empty(warp);
  if (!warp.simt.finished()) return false;
  // Such a warp is a block of its own, so no barrier is left without it.
  barriers_.end_warp(warp);
  return true;
}

bool Executor::dispatch(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  if (isa::needs_trace(row.effect) && !is_in_trace(warp, row)) return false;
  switch (isa::effect_row(row.effect).family) {
    case EffectFamily::None:
      break;
    case EffectFamily::Memory:
      return memory_.run(warp, inst, row);
    case EffectFamily::Image:
      warp.effects += row.effect == Effect::SurfaceStore;
      return images_.run(warp, inst, row);
    case EffectFamily::Control:
      return control_.run(warp, inst, row);
    case EffectFamily::ShaderCall:
      return calls_.run(warp, inst, row);
    case EffectFamily::Trace:
      return isa::TraceKind(row.detail) == isa::TraceKind::Ray ? rays_.run(warp, inst, row)
                                                               : hit_objects_.begin_trace(warp, inst);
    case EffectFamily::Query:
      return queries_.run(warp, inst, row);
    case EffectFamily::HitObject:
      return hit_objects_.run(warp, inst, row);
    case EffectFamily::Reorder:
      return reorder_calls_.run(warp, inst, row);
    case EffectFamily::Barrier:
      return barriers_.run(warp, inst, row);
    case EffectFamily::Print:
      run_print(world_, warp, inst, row);
      return true;
  }
  GLINT_PANIC("effect {} of '{}'", int(row.effect), row.name);
}

bool Executor::is_in_trace(WarpContext& warp, const isa::OpRow& row) {
  return warp.depth > 0 || faults_.fail(warp, std::countr_zero(warp.simt.active),
                                        fmt::format("runs {} outside a trace", row.name));
}

}  // namespace glint::exec

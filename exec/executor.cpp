// Instruction execution: guards, and the way to the families of effects.
// SPDX-License-Identifier: Apache-2.0
#include "exec/executor.h"

#include <bit>

namespace glint::exec {

using isa::Effect;

Issued Executor::execute(WarpContext& warp, Cycle now) {
  const uint32_t pc = warp.simt.pc;
  const isa::Inst& inst = world_.image->code[pc];
  const isa::OpRow& row = *world_.image->rows[pc];
  LaneMask exec = warp.simt.active;
  Issued issued{pc, &inst, &row, exec, exec, false};
  if (inst.guard != isa::kNoGuard) {
    const LaneMask guard = warp.regs.predicate[inst.guard & (isa::kNumPredicates - 1)];
    exec &= inst.guard & isa::kGuardNegate ? ~guard : guard;
  }
  warp.regs.exec = issued.lanes = exec;
  if (reads_clock_) [[unlikely]]
    fill_clock(warp, now);
  if (view_) view_->begin(now);

  bool ok = true;
  switch (row.effect) {
    case Effect::None:
      row.run(warp.regs, inst);
      ++warp.simt.pc;
      break;
    case Effect::Load:
    case Effect::Store:
    case Effect::Atomic:
      ok = run_memory(warp, inst, row);
      break;
    case Effect::Texture:
    case Effect::SurfaceLoad:
    case Effect::SurfaceStore:
    case Effect::SurfaceAtomic:
    case Effect::ImageQuery:
      ok = run_image(warp, inst, row);
      break;
    case Effect::Branch:
    case Effect::PushReconvergence:
    case Effect::Join:
    case Effect::Exit:
    case Effect::Return:
    case Effect::BranchIndexed:
    case Effect::Call:
    case Effect::Trap:
    case Effect::Fence:
    case Effect::Ignore:
    case Effect::Terminate:
      ok = run_control(warp, inst, row);
      break;
    case Effect::Print:
    case Effect::PrintPart:
      ok = run_print(warp, inst, row);
      break;
    case Effect::Barrier:
      ok = run_barrier(warp, inst, row);
      break;
    case Effect::HitObject:
      ok = run_hit_object(warp, inst, row);
      break;
    case Effect::Query:
    case Effect::QueryProceed:
      ok = run_query(warp, inst, row);
      break;
    case Effect::CallCandidate:
    case Effect::CallAnyHit:
    case Effect::CallHit:
    case Effect::CallCallable:
    case Effect::Trace:
    case Effect::Resume:
    case Effect::Report:
    case Effect::Accepted:
    case Effect::EndTrace:
      ok = run_rays(warp, inst, row);
      issued.lanes = warp.regs.exec;
      break;
  }
  if (warp.waiting_for_rays && world_.traversal.shader != kNoShader && ok) walk_in_code(warp, pc);
  issued.finished = warp.simt.finished();
  if (ok && issued.finished) [[unlikely]]
    ok = end_warp(warp);
  if (ok) {
    ++warp.instructions;
    retired.fire([&] { return Retired{warp, issued}; });
  }
  return issued;
}

}  // namespace glint::exec

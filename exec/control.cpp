// Runs control flow on the SIMT stack.
// SPDX-License-Identifier: Apache-2.0
#include "exec/control.h"

#include <array>
#include <bit>
#include <cstdint>
#include <fmt/format.h>
#include <utility>

#include "base/check.h"
#include "exec/ray_specials.h"

namespace glint::exec {

using isa::Effect;

bool Control::run(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  SimtStack& simt = warp.simt;
  const LaneMask exec = warp.regs.exec;
  const uint32_t target = uint32_t(inst.imm);
  switch (row.effect) {
    case Effect::Branch:
      return branch(warp, target);
    case Effect::BranchIndexed:
      return branch_indexed(warp, inst);
    case Effect::Call:
      return call_function(warp, target);
    case Effect::PushReconvergence:
      simt.push_reconvergence(target);
      ++simt.pc;
      return true;
    case Effect::Join:
      if (!simt.arrive(simt.pc, simt.active))
        return faults_.fail(warp, std::countr_zero(simt.active), "reaches a join without its ssy");
      simt.active = 0;
      resume_if_empty(warp);
      return true;
    case Effect::Exit:
      leave(warp, exec);
      return true;
    case Effect::Trap:
      if (exec) return faults_.fail(warp, std::countr_zero(exec), "the program stops itself with a trap");
      ++simt.pc;
      return true;
    case Effect::Return:
    case Effect::Ignore:
    case Effect::Terminate:
      return return_from(warp, row.effect);
    case Effect::Fence:
    case Effect::CopyGroup:
      // Every access has its effect when it is executed, in one order for all, so a fence takes time but has
      // nothing else to do, and so does waiting for copies.
      ++simt.pc;
      return true;
    default:
      GLINT_PANIC("{} is not a control effect", row.name);
  }
}

bool Control::branch(WarpContext& warp, uint32_t target) {
  SimtStack& simt = warp.simt;
  const LaneMask exec = warp.regs.exec, stay = simt.active & ~exec;
  if (stay == 0) {
    simt.pc = target;
  } else if (exec == 0) {
    ++simt.pc;
  } else if (world_.image->code[simt.pc].target_is_join) {
    // Lanes that go to a join wait there at once, so a loop's exits never grow the stack.
    if (!simt.arrive(target, exec))
      return faults_.fail(warp, std::countr_zero(exec), "branches to a join without its ssy");
    simt.active = stay;
    ++simt.pc;
  } else if (world_.image->code[simt.pc + 1].effect == Effect::Join) {
    if (!simt.arrive(simt.pc + 1, stay))
      return faults_.fail(warp, std::countr_zero(stay), "falls into a join without its ssy");
    simt.active = exec;
    simt.pc = target;
  } else {
    simt.push_path(target, exec);
    simt.active = stay;
    ++simt.pc;
  }
  return true;
}

// Branches by index. Lanes with one index go together, those of the lowest lane first. Lanes that the guard
// leaves out go before all others.
bool Control::branch_indexed(WarpContext& warp, const isa::Inst& inst) {
  SimtStack& simt = warp.simt;
  const uint32_t* const index = warp.regs.read(inst.operand[0]);
  const Shader& shader = world_.image->shaders[world_.image->shader_of[simt.pc]];
  const uint32_t table = uint32_t(inst.imm);
  const LaneMask stay = simt.active & ~warp.regs.exec;
  std::array<std::pair<uint32_t, LaneMask>, kLanes> group;
  size_t num_groups = 0;
  for (LaneMask rest = warp.regs.exec; rest;) {
    const int lane = std::countr_zero(rest);
    const uint32_t chosen = index[lane];
    if (chosen >= shader.end - table || world_.image->code[table + chosen].effect != Effect::Branch)
      return faults_.fail(warp, lane,
                          fmt::format("branches to entry {} of a table that has no such entry", chosen));
    LaneMask same = 0;
    for_each_lane(rest, [&](int other) { same |= LaneMask{index[other] == chosen} << other; });
    group[num_groups++] = {table + chosen, same};
    rest &= ~same;
  }
  ++simt.pc;
  simt.active = stay;
  while (num_groups-- > 0) simt.push_path(group[num_groups].first, group[num_groups].second);
  resume_if_empty(warp);
  return true;
}

bool Control::call_function(WarpContext& warp, uint32_t target) {
  // Choice: PTX programs with a stack of their own end long before this number, which catches recursion
  // without end.
  constexpr size_t kMaxNesting = 1 << 16;
  SimtStack& simt = warp.simt;
  const LaneMask exec = warp.regs.exec;
  const uint32_t back = simt.pc + 1;
  if (exec == 0) return simt.pc = back, true;
  if (simt.depth() >= kMaxNesting)
    return faults_.fail(warp, std::countr_zero(exec), "calls are nested without end");
  simt.push_call(back, simt.active & ~exec, warp.depth, world_.image->shader_of[simt.pc], warp.callables,
                 true);
  simt.active = exec;
  simt.pc = target;
  return true;
}

// Returns from a call. ret goes back to the innermost call; out of a shader, it makes the decision of the
// shader's stage. rt.ignore and rt.terminate leave the shader, out of all functions.
bool Control::return_from(WarpContext& warp, Effect effect) {
  SimtStack& simt = warp.simt;
  const LaneMask exec = warp.regs.exec;
  const bool leaves_shader = effect != Effect::Return;
  const SimtStack::Entry* const call = simt.innermost_call(leaves_shader);
  if (!call) return faults_.fail(warp, exec ? std::countr_zero(exec) : 0, "returns, and nobody has called");
  if (exec && !call->is_function) calls_.finish_shader(warp, effect);
  simt.arrive_return(exec, leaves_shader);
  leave(warp, exec);
  return true;
}

void Control::leave(WarpContext& warp, LaneMask lanes) {
  warp.simt.active &= ~lanes;
  ++warp.simt.pc;
  resume_if_empty(warp);
}

void Control::resume_if_empty(WarpContext& warp) {
  SimtStack::Entry call{};
  if (warp.simt.active != 0 || !warp.simt.resume_next(&call)) return;
  warp.depth = call.depth;
  warp.callables = call.callables;
  if (warp.simt.active == 0) return;
  if (call.is_traversal) traversal_.take_rays(warp);
  fill_specials(world_, warp, warp.simt.active, world_.image->shaders[call.shader]);
}

}  // namespace glint::exec

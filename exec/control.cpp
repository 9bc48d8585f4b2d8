// Runs control flow on the SIMT stack.
// SPDX-License-Identifier: Apache-2.0
#include "exec/control.h"

#include <array>
#include <bit>
#include <cstdint>
#include <fmt/format.h>
#include <utility>
#include <vector>

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
      return world_.image->code[simt.pc].may_wait ? branch_back(warp, target) : branch(warp, target);
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
    case Effect::Yield:  // go_round() does it where the loop goes back.
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

// Branches back to the head of a loop in which lanes may wait for others of their warp.
bool Control::branch_back(WarpContext& warp, uint32_t target) {
  const uint32_t pc = warp.simt.pc;
  if (!branch(warp, target)) return false;
  if (warp.simt.pc == target) go_round(warp, pc);
  return true;
}

// Lets lanes that go back at the end `pc` of a loop in vain give way to others of their warp, which may hold
// what they wait for. Lanes that have met at a join may go on without those of the loop then. So does
// hardware that schedules threads independently: its compiler puts a yield into such loops, and lanes that
// have yielded are not waited for (Diamos et al., US patent 10,067,768). Choice: a turn is in vain if
// WarpContext::effects did not grow in it. On an H200 a lock goes on as if lanes yielded in each turn
// (bench/probes/locks.cu). Here lanes do so after 16 turns in vain of the same lanes, and then in each turn
// in vain of that loop. So loops that wait for nobody keep their lanes together.
void Control::go_round(WarpContext& warp, uint32_t pc) {
  constexpr uint32_t kTurns = 16;
  SimtStack& simt = warp.simt;
  WaitingLoop& loop = warp.waiting_loop;
  const bool in_vain = loop.effects == warp.effects, is_same = loop.lanes == simt.active && in_vain;
  loop.turns = is_same ? loop.turns + 1 : 0;
  loop.lanes = simt.active;
  loop.effects = warp.effects;
  if (loop.turns < kTurns && !(in_vain && loop.waited == pc)) return;
  const std::vector<SimtStack::Entry>& entries = simt.entries();
  for (size_t i = 0; i < entries.size(); ++i) {
    const size_t index = (loop.next + i) % entries.size();
    const SimtStack::Entry& entry = entries[index];
    const bool may_run = entry.kind == SimtStack::Kind::Join || simt.can_run(index);
    if (!may_run || !entry.lanes || !simt.is_in_frame(index)) continue;
    loop.next = uint32_t(index + 1);
    loop.turns = 0;
    loop.waited = pc;
    return simt.yield_to(index);
  }
}

// Lanes that have gone on while others of their warp waited come to a barrier, or to an op across the lanes
// of a mask, before these. PTX wants all of them there. So they wait, and go on as one path, as on hardware,
// where a barrier counts threads. Where no other path can run, they go on as they are.
bool Control::meet(WarpContext& warp, uint32_t pc) {
  SimtStack& simt = warp.simt;
  const Step& step = world_.image->code[pc];
  const bool is_barrier = step.effect == Effect::Barrier;
  simt.take_waiting(is_barrier);
  LaneMask wanted = simt.live();
  if (!is_barrier && simt.active)
    wanted &= warp.regs.read(step.inst.operand[step.row->operands.count - 1])[std::countr_zero(simt.active)];
  for (size_t i = 0; i < simt.depth(); ++i) {
    if (!(wanted & ~simt.active & simt.entries()[i].lanes) || !simt.can_run(i) || !simt.is_in_frame(i))
      continue;
    simt.wait_for(i);
    return false;
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
  SimtStack& simt = warp.simt;
  const LaneMask exec = warp.regs.exec;
  const uint32_t back = simt.pc + 1;
  if (exec == 0) return simt.pc = back, true;
  if (simt.depth() >= SimtStack::kMaxDepth)
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

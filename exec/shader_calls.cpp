// Calls other shaders and functions: one path for each distinct one that the lanes call.
// SPDX-License-Identifier: Apache-2.0
#include "exec/shader_calls.h"

#include <bit>
#include <fmt/format.h>
#include <memory>
#include <string>

#include "base/num_lanes.h"
#include "exec/hit_records.h"
#include "exec/ray_specials.h"
#include "rtunit/traversal/traversal.h"

namespace glint::exec {

using isa::Effect;
using rt::RayStatus;

bool ShaderCalls::run(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  if (row.effect == Effect::CallFunction) return call_function(warp, inst);
  return row.effect == Effect::CallCallable ? call_callable(warp, inst) : call(warp, row.effect);
}

// Calls the shaders that the lanes' rays ask for.
bool ShaderCalls::call(WarpContext& warp, Effect effect) {
  std::array<uint32_t, kLanes> target;
  if (!call_targets(warp, effect, target)) return false;
  LaneMask callers = 0;
  for_each_lane(warp.regs.exec,
                [&](int lane) { callers |= LaneMask{target[size_t(lane)] != kNoShader} << lane; });
  const uint32_t calls = call_by_shader(warp, target, callers, Callee::RayShader);
  if (effect != Effect::CallHit) {
    counts_.calls += calls;
    counts_.lanes += num_lanes(callers);
  }
  return true;
}

// Calls the callable shaders that the lanes' indices name.
bool ShaderCalls::call_callable(WarpContext& warp, const isa::Inst& inst) {
  if (warp.callables == world_.max_callable_depth)
    return faults_.fail(warp, std::countr_zero(warp.regs.exec),
                        fmt::format("calls a callable shader at depth {}, and the pipeline allows {}",
                                    warp.callables + 1, world_.max_callable_depth));
  if (warp.callable_frames.size() == warp.callables)
    warp.callable_frames.push_back(std::make_unique<CallableFrame>());
  CallableFrame& frame = *warp.callable_frames[warp.callables];
  std::array<uint32_t, kLanes> target;
  LaneMask callers = 0;
  for (LaneMask lanes = warp.regs.exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const size_t i = size_t(lane);
    const uint32_t record = world_.table.callable.number(warp.regs.read(inst.operand[0])[lane]);
    const bool is_inside = is_record(world_.callable, record);
    if (!is_inside && !ray_faults_.let_pass_record(warp, lane, "callable", record, world_.callable.size()))
        [[unlikely]]
      return false;
    target[i] = is_inside ? world_.callable[record] : kNoShader;
    frame.data[i] = warp.regs.read(inst.operand[1])[lane];
    frame.record[i] = warp.regs.access.address[i] = world_.table.callable.address(is_inside ? record : 0);
    callers |= LaneMask{target[i] != kNoShader} << lane;
  }
  call_by_shader(warp, target, callers, Callee::Callable);
  return true;
}

// Calls the functions whose numbers the lanes have.
bool ShaderCalls::call_function(WarpContext& warp, const isa::Inst& inst) {
  const LaneMask callers = warp.regs.exec;
  if (callers && warp.simt.depth() >= SimtStack::kMaxDepth)
    return faults_.fail(warp, std::countr_zero(callers), "calls are nested without end");
  const std::vector<uint32_t>& functions = world_.image->functions;
  const uint32_t* const number = warp.regs.read(inst.operand[0]);
  std::array<uint32_t, kLanes> target;
  for (LaneMask lanes = callers; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const uint32_t n = number[lane];
    target[size_t(lane)] = n < functions.size() ? functions[n] : kNoShader;
    if (target[size_t(lane)] == kNoShader)
      return faults_.fail(warp, lane,
                          n == 0
                              ? std::string("calls through a null address")
                              : fmt::format("calls through the address {:#x}, where no function begins", n));
  }
  call_by_shader(warp, target, callers, Callee::Function);
  return true;
}

// Handles a record that calls nothing like a null group: a candidate triangle is taken, and a candidate box
// reports nothing. Choice: a record outside of the table that is let pass costs what the region's first
// record costs.
void ShaderCalls::call_nothing(WarpContext& warp, int lane, rt::RayState& state, Effect effect) {
  const bool hit = effect != Effect::CallHit || state.committed.valid();
  warp.regs.access.address[size_t(lane)] = (hit ? world_.table.hit : world_.table.miss).address(0);
  if (effect == Effect::CallHit) return;
  if (effect == Effect::CallAnyHit || state.status == RayStatus::NeedsAnyHit)
    rt::accept_candidate(state);
  else
    rt::finish_intersection(state);
}

// Fills `target` with the shader of each calling lane, or kNoShader for a null shader, which is decided here
// at once.
bool ShaderCalls::call_targets(WarpContext& warp, Effect effect, std::array<uint32_t, kLanes>& target) {
  for (LaneMask lanes = warp.regs.exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const size_t i = size_t(lane);
    rt::RayState& state = warp.ray(lane);
    if (state.broken && !ray_faults_.let_pass_broken(warp, lane, state)) [[unlikely]]
      return false;
    if (state.status == RayStatus::Idle) {  // The hit object is empty.
      target[i] = kNoShader;
      continue;
    }
    if (state.status == RayStatus::Gathered &&
        effect != Effect::CallHit) {  // It runs nothing this time and reads no record.
      target[i] = kNoShader;
      warp.regs.exec &= ~(LaneMask{1} << lane);
      continue;
    }
    const bool hit = effect != Effect::CallHit || state.committed.valid();
    uint32_t record = world_.table.miss.number(state.ray.miss_index);
    const HitGroup* group = nullptr;
    if (hit)
      group =
          hit_group(world_, state.ray, effect == Effect::CallHit ? state.committed : state.candidate, record);
    if (hit ? !group : !is_record(world_.miss, record)) [[unlikely]] {
      const bool passes =
          hit ? ray_faults_.let_pass_hit_record(warp, lane, state.ray,
                                                effect == Effect::CallHit ? state.committed : state.candidate)
              : ray_faults_.let_pass_record(warp, lane, "miss", record, world_.miss.size());
      if (!passes) return false;
      call_nothing(warp, lane, state, effect);
      target[i] = kNoShader;
      continue;
    }
    warp.regs.access.address[i] = (hit ? world_.table.hit : world_.table.miss).address(record);
    if (!hit) {
      target[i] = world_.miss[record];
    } else if (effect == Effect::CallHit) {
      target[i] = state.ray.flags & rt::ray_flag::kSkipClosestHit ? kNoShader : group->closest_hit;
    } else if (effect == Effect::CallAnyHit || state.status == RayStatus::NeedsAnyHit) {
      target[i] = group->any_hit;
      if (target[i] == kNoShader) rt::accept_candidate(state);
    } else {
      target[i] = group->intersection;
      if (target[i] == kNoShader) rt::finish_intersection(state);
    }
  }
  return true;
}

// Runs the shader of each calling lane, with one path for each distinct shader, in the order of the lowest
// lane that calls it.
uint32_t ShaderCalls::call_by_shader(WarpContext& warp, const std::array<uint32_t, kLanes>& target,
                                     LaneMask callers, Callee kind) {
  SimtStack& simt = warp.simt;
  const uint32_t caller = world_.image->shader_of[simt.pc];
  ++simt.pc;
  if (!callers) return 0;
  const bool is_function = kind == Callee::Function;
  simt.push_call(simt.pc, simt.active & ~callers, warp.depth, caller, warp.callables, is_function);
  if (kind == Callee::Callable) ++warp.callables;
  uint32_t calls = 0;
  while (callers) {
    const uint32_t shader = target[size_t(std::countr_zero(callers))];
    LaneMask same = 0;
    for_each_lane(callers, [&](int lane) { same |= LaneMask{target[size_t(lane)] == shader} << lane; });
    callers &= ~same;
    const Shader& callee = world_.image->shaders[shader];
    if (!is_function) {
      called_lanes_[size_t(callee.stage)] += num_lanes(same);
      called_.fire([&] { return Called{warp, callee.stage, same}; });
    }
    fill_specials(world_, warp, same, callee);
    if (calls++ == 0) {
      simt.pc = callee.entry;
      simt.active = same;
    } else {
      simt.push_path(callee.entry, same);
    }
  }
  return calls;
}

void ShaderCalls::finish_shader(WarpContext& warp, Effect effect) {
  const isa::Stage stage = world_.image->shaders[world_.image->shader_of[warp.simt.pc]].stage;
  for_each_lane(warp.regs.exec, [&](int lane) {
    if (warp.depth == 0) return;
    rt::RayState& state = warp.ray(lane);
    if (effect == Effect::Ignore)
      rt::ignore_candidate(state);
    else if (effect == Effect::Terminate)
      rt::terminate_candidate(state);
    else if (stage == isa::Stage::AnyHit)
      rt::accept_candidate(state);
    else if (stage == isa::Stage::Intersection)
      rt::finish_intersection(state);
  });
}

}  // namespace glint::exec

// Rays and shader calls: rt.*, call.sbt.*, and the values that called shaders see.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <utility>

#include "base/check.h"
#include "base/num_lanes.h"
#include "exec/executor.h"
#include "exec/ray_values.h"
#include "isa/hit_object.h"
#include "rtunit/traversal.h"

namespace glint::exec {

using isa::Effect;
using isa::Special;
using rt::RayStatus;

namespace {

// A rt.trace's operands after the answer predicate and the structure.
enum TraceOperand : size_t {
  kFlags = 2,
  kMask,
  kSbtOffset,
  kSbtStride,
  kMiss,
  kRay,
  kPayload = kRay + kRayOperands
};

void set_ray(const isa::Warp& regs, const isa::Inst& inst, int lane, rt::Ray& ray) {
  const auto value = [&](size_t operand) { return read_word(regs, inst, operand, lane); };
  ray.structure = read_address(regs, inst, 1, lane);
  ray.flags = value(kFlags);
  ray.cull_mask = value(kMask) & 0xff;
  ray.sbt_offset = value(kSbtOffset) & 15;  // SPV_KHR_ray_tracing: only the 4 low bits count
  ray.sbt_stride = value(kSbtStride) & 15;
  ray.miss_index = value(kMiss) & 0xffff;  // and 16 here
  read_ray(regs, inst, kRay, lane, ray);
}

bool needs_shader(const rt::RayState& state) {
  return state.status == RayStatus::NeedsIntersection || state.status == RayStatus::NeedsAnyHit ||
         state.status == RayStatus::Gathered;
}

}  // namespace

bool Executor::run_rays(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  const LaneMask exec = warp.regs.exec;
  const bool opens = row.effect == Effect::Trace || row.effect == Effect::CallCallable;
  if (!opens && warp.depth == 0) [[unlikely]]
    return fail(warp, std::countr_zero(warp.simt.active), fmt::format("runs {} outside a trace", row.name));
  switch (row.effect) {
    case Effect::Trace:
      return isa::TraceKind(row.detail) == isa::TraceKind::Ray ? trace(warp, inst)
                                                               : begin_hit_object(warp, inst);
    case Effect::Resume:
      warp.waiting_for_rays = exec != 0;
      warp.rays = warp.frame().ray.data();
      warp.ray_lanes = exec;
      warp.ray_answer = inst.operand[0];
      break;
    case Effect::Report:
      return report(warp, inst);
    case Effect::Accepted: {
      LaneMask accepted = 0;
      for_each_lane(exec, [&](int lane) {
        accepted |= LaneMask{warp.frame().ray[size_t(lane)].report_accepted} << lane;
      });
      LaneMask& predicate = warp.regs.predicate[inst.operand[0]];
      predicate = (predicate & ~exec) | accepted;
      break;
    }
    case Effect::EndTrace:
      count_candidates(warp);
      --warp.depth;
      fill_specials(warp, warp.simt.active, world_.image->shaders[world_.image->shader_of[warp.simt.pc]]);
      break;
    case Effect::CallCallable:
      return call_callable(warp, inst);
    default:
      return call(warp, row.effect);
  }
  ++warp.simt.pc;
  return true;
}

// Opens a level with the payloads and attributes of its lanes; no ray travels yet.
bool Executor::open_trace(WarpContext& warp, const isa::Inst& inst, size_t payload_operand) {
  if (warp.depth == world_.max_trace_depth)
    return fail(warp, std::countr_zero(warp.regs.exec),
                fmt::format("traces a ray at depth {}: the pipeline allows {} nested traces", warp.depth + 1,
                            world_.max_trace_depth));
  if (warp.frames.size() == warp.depth) warp.frames.push_back(std::make_unique<TraceFrame>());
  TraceFrame& frame = *warp.frames[warp.depth];
  for_each_lane(warp.regs.exec, [&](int lane) {
    frame.payload[size_t(lane)] = warp.regs.read(inst.operand[payload_operand])[lane];
    frame.attributes[size_t(lane)] = warp.regs.read(inst.operand[payload_operand + 1])[lane];
    frame.time[size_t(lane)] = std::exchange(warp.next_time[size_t(lane)], 0);
  });
  ++warp.depth;
  return true;
}

bool Executor::trace(WarpContext& warp, const isa::Inst& inst) {
  const LaneMask exec = warp.regs.exec;
  if (!open_trace(warp, inst, kPayload)) return false;
  TraceFrame& frame = warp.frame();
  for (LaneMask lanes = exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    rt::RayState& state = frame.ray[size_t(lane)];
    set_ray(warp.regs, inst, lane, state.ray);
    state.rules.end_at_first_hit = !world_.nearest_first_hit;
    state.table = table_of(frame, lane);
    if (!rt::begin(state, *world_.memory) &&
        !let_pass_structure(warp, lane, "traces a ray into", state.ray.structure)) [[unlikely]] {
      --warp.depth;
      return false;
    }
  }
  warp.waiting_for_rays = exec != 0;
  warp.rays = frame.ray.data();
  warp.ray_lanes = exec;
  warp.ray_answer = inst.operand[0];
  ++warp.simt.pc;
  return true;
}

void Executor::finish_rays(WarpContext& warp) const {
  LaneMask waiting = 0, gathered = 0;
  for_each_lane(warp.ray_lanes, [&](int lane) {
    const rt::RayState& state = warp.rays[lane];
    GLINT_DCHECK(state.status != RayStatus::Traversing, "lane {} was given back while traversing", lane);
    waiting |= LaneMask{needs_shader(state)} << lane;
    gathered |= LaneMask{state.status == RayStatus::Gathered} << lane;
  });
  if (gathered) present_candidates(warp, gathered);
  LaneMask& predicate = warp.regs.predicate[warp.ray_answer];
  predicate = (predicate & ~warp.ray_lanes) | waiting;
  warp.waiting_for_rays = false;
}

bool Executor::report(WarpContext& warp, const isa::Inst& inst) {
  const LaneMask exec = warp.regs.exec;
  LaneMask undecided = 0;
  for (LaneMask lanes = exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    rt::RayState& state = warp.frame().ray[size_t(lane)];
    const float t = as_float(warp.regs.read(inst.operand[1])[lane]);
    if (rt::report(state, t, warp.regs.read(inst.operand[2])[lane]) != rt::Report::NeedsAnyHit) continue;
    uint32_t record = 0;
    const HitGroup* group = hit_group(state.ray, state.candidate, record);
    if (!group && !let_pass_hit_record(warp, lane, state.ray, state.candidate)) [[unlikely]]
      return false;
    if (!group || group->any_hit == kNoShader)
      rt::accept_candidate(state);
    else
      undecided |= LaneMask{1} << lane;
  }
  LaneMask& predicate = warp.regs.predicate[inst.operand[0]];
  predicate = (predicate & ~exec) | undecided;
  fill_specials(warp, exec, world_.image->shaders[world_.image->shader_of[warp.simt.pc]]);
  ++warp.simt.pc;
  return true;
}

// Vulkan, "Hit Shader Binding Table Indexing".
uint32_t Executor::hit_record(const rt::Ray& ray, const rt::Hit& hit) const {
  return world_.table.hit.number(hit.sbt_record + hit.geometry * ray.sbt_stride + ray.sbt_offset);
}

const HitGroup* Executor::hit_group(const rt::Ray& ray, const rt::Hit& hit, uint32_t& record) const {
  record = hit_record(ray, hit);
  return record < world_.hit.size() ? &world_.hit[record] : nullptr;
}

// Fills `target` with the shader of each calling lane, or kNoShader: a null shader, decided here at once.
bool Executor::call_targets(WarpContext& warp, Effect effect, std::array<uint32_t, kLanes>& target) {
  for (LaneMask lanes = warp.regs.exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const size_t i = size_t(lane);
    rt::RayState& state = warp.frame().ray[i];
    if (state.broken && !let_pass_broken(warp, lane, state)) [[unlikely]]
      return false;
    if (state.status == RayStatus::Idle) {  // an empty hit object
      target[i] = kNoShader;
      continue;
    }
    if (state.status == RayStatus::Gathered &&
        effect != Effect::CallHit) {  // runs nothing this time, reads no record
      target[i] = kNoShader;
      warp.regs.exec &= ~(LaneMask{1} << lane);
      continue;
    }
    const bool hit = effect != Effect::CallHit || state.committed.valid();
    uint32_t record = world_.table.miss.number(state.ray.miss_index);
    const HitGroup* group = nullptr;
    if (hit)
      group = hit_group(state.ray, effect == Effect::CallHit ? state.committed : state.candidate, record);
    if (hit ? !group : record >= world_.miss.size()) [[unlikely]] {
      const bool passes =
          hit ? let_pass_hit_record(warp, lane, state.ray,
                                    effect == Effect::CallHit ? state.committed : state.candidate)
              : let_pass_record(warp, lane, "miss", record, world_.miss.size());
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

bool Executor::call(WarpContext& warp, Effect effect) {
  std::array<uint32_t, kLanes> target;
  if (!call_targets(warp, effect, target)) return false;
  LaneMask callers = 0;
  for_each_lane(warp.regs.exec,
                [&](int lane) { callers |= LaneMask{target[size_t(lane)] != kNoShader} << lane; });
  const uint32_t calls = call_by_shader(warp, target, callers, false);
  if (effect != Effect::CallHit) {
    candidates_.calls += calls;
    candidates_.lanes += num_lanes(callers);
  }
  return true;
}

bool Executor::call_callable(WarpContext& warp, const isa::Inst& inst) {
  if (warp.callables == world_.max_callable_depth)
    return fail(warp, std::countr_zero(warp.regs.exec),
                fmt::format("calls a callable shader at depth {}: the pipeline allows {}", warp.callables + 1,
                            world_.max_callable_depth));
  if (warp.callable_frames.size() == warp.callables)
    warp.callable_frames.push_back(std::make_unique<CallableFrame>());
  CallableFrame& frame = *warp.callable_frames[warp.callables];
  std::array<uint32_t, kLanes> target;
  LaneMask callers = 0;
  for (LaneMask lanes = warp.regs.exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const size_t i = size_t(lane);
    const uint32_t record = world_.table.callable.number(warp.regs.read(inst.operand[0])[lane]);
    const bool is_inside = record < world_.callable.size();
    if (!is_inside && !let_pass_record(warp, lane, "callable", record, world_.callable.size())) [[unlikely]]
      return false;
    target[i] = is_inside ? world_.callable[record] : kNoShader;
    frame.data[i] = warp.regs.read(inst.operand[1])[lane];
    frame.record[i] = warp.regs.access.address[i] = world_.table.callable.address(is_inside ? record : 0);
    callers |= LaneMask{target[i] != kNoShader} << lane;
  }
  call_by_shader(warp, target, callers, true);
  return true;
}

// Runs the shader of each calling lane, one path a distinct shader, in the order of the lowest lane that
// calls it.
uint32_t Executor::call_by_shader(WarpContext& warp, const std::array<uint32_t, kLanes>& target,
                                  LaneMask callers, bool is_callable) {
  SimtStack& simt = warp.simt;
  const uint32_t caller = world_.image->shader_of[simt.pc];
  ++simt.pc;
  if (!callers) return 0;
  simt.push_call(simt.pc, simt.active & ~callers, warp.depth, caller, warp.callables);
  if (is_callable) ++warp.callables;
  uint32_t calls = 0;
  while (callers) {
    const uint32_t shader = target[size_t(std::countr_zero(callers))];
    LaneMask same = 0;
    for_each_lane(callers, [&](int lane) { same |= LaneMask{target[size_t(lane)] == shader} << lane; });
    callers &= ~same;
    const Shader& callee = world_.image->shaders[shader];
    called_lanes_[size_t(callee.stage)] += num_lanes(same);
    called.fire([&] { return Called{warp, callee.stage, same}; });
    fill_specials(warp, same, callee);
    if (calls++ == 0) {
      simt.pc = callee.entry;
      simt.active = same;
    } else {
      simt.push_path(callee.entry, same);
    }
  }
  return calls;
}

void Executor::finish_shader(WarpContext& warp, Effect effect) {
  const isa::Stage stage = world_.image->shaders[world_.image->shader_of[warp.simt.pc]].stage;
  for_each_lane(warp.regs.exec, [&](int lane) {
    if (warp.depth == 0) return;
    rt::RayState& state = warp.frame().ray[size_t(lane)];
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

// Opens and closes traces, hands rays over and takes them back, and reports hits.
// SPDX-License-Identifier: Apache-2.0
#include "exec/rays.h"

#include <bit>
#include <fmt/format.h>
#include <memory>
#include <utility>

#include "base/check.h"
#include "exec/hit_records.h"
#include "exec/ray_specials.h"
#include "exec/ray_values.h"
#include "rtunit/traversal/traversal.h"

namespace glint::exec {

using isa::Effect;
using rt::RayStatus;

namespace {

// Names the operands of rt.trace after the answer predicate and the structure.
struct TraceOperand {
  enum Slot : size_t {
    kFlags = 2,
    kMask,
    kSbtOffset,
    kSbtStride,
    kMiss,
    kRay,
    kPayload = kRay + kRayOperands
  };
};

void set_ray(const isa::Warp& regs, const isa::Inst& inst, int lane, rt::Ray& ray) {
  const auto value = [&](size_t operand) { return read_word(regs, inst, operand, lane); };
  ray.structure = read_address(regs, inst, 1, lane);
  ray.flags = value(TraceOperand::kFlags);
  ray.cull_mask = value(TraceOperand::kMask) & 0xff;
  ray.sbt_offset = value(TraceOperand::kSbtOffset) & 15;  // by SPV_KHR_ray_tracing only the 4 low bits count
  ray.sbt_stride = value(TraceOperand::kSbtStride) & 15;
  ray.miss_index = value(TraceOperand::kMiss) & 0xffff;  // only the 16 low bits count
  read_ray(regs, inst, TraceOperand::kRay, lane, ray);
}

bool needs_shader(const rt::RayState& state) {
  return state.status == RayStatus::NeedsIntersection || state.status == RayStatus::NeedsAnyHit ||
         state.status == RayStatus::Gathered;
}

}  // namespace

bool Rays::run(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  switch (row.effect) {
    case Effect::Trace:
      return trace(warp, inst);
    case Effect::Resume:
      wait_for(warp, warp.traced->data(), inst.operand[0]);
      return true;
    case Effect::Report:
      return report(warp, inst);
    case Effect::Accepted:
      answer_accepted(warp, inst.operand[0]);
      return true;
    case Effect::EndTrace:
      candidates_.count(warp);
      close_trace(warp);
      refill_specials(world_, warp);
      ++warp.simt.pc;
      return true;
    default:
      GLINT_PANIC("{} is not a ray effect", row.name);
  }
}

// Opens a level with the payloads and attributes of its lanes. No ray travels yet.
bool Rays::open_trace(WarpContext& warp, const isa::Inst& inst, size_t payload_operand) {
  if (warp.depth == world_.max_trace_depth)
    return faults_.fail(warp, std::countr_zero(warp.regs.exec),
                        fmt::format("traces a ray at depth {}, and the pipeline allows {} nested traces",
                                    warp.depth + 1, world_.max_trace_depth));
  if (warp.frames.size() == warp.depth) warp.frames.push_back(std::make_unique<TraceFrame>());
  TraceFrame& frame = *warp.frames[warp.depth];
  if (!warp.traced) warp.traced = std::make_unique<std::array<rt::RayState, kLanes>>();
  frame.kept = 0;
  if (warp.depth > 0 && !keep_outer_rays(warp, frame)) return false;
  for_each_lane(warp.regs.exec, [&](int lane) {
    frame.payload[size_t(lane)] = warp.regs.read(inst.operand[payload_operand])[lane];
    frame.attributes[size_t(lane)] = warp.regs.read(inst.operand[payload_operand + 1])[lane];
    frame.time[size_t(lane)] = std::exchange(warp.next_time[size_t(lane)], 0);
  });
  ++warp.depth;
  return true;
}

// Puts the rays of the executing lanes aside, because their places are taken by those of a new level. Shaders
// that run during a walk trace nothing (isa::kTracingStages), so these rays have ended. That saves the host
// most of a RayState for each level.
bool Rays::keep_outer_rays(WarpContext& warp, TraceFrame& frame) {
  LaneMask under_way = 0;
  for_each_lane(warp.regs.exec, [&](int lane) {
    const rt::RayStatus status = warp.ray(lane).status;
    under_way |= LaneMask{status != rt::RayStatus::Done && status != rt::RayStatus::Idle} << lane;
  });
  if (under_way) [[unlikely]]
    return faults_.fail(warp, std::countr_zero(under_way), "traces a ray before its own ray has ended");
  if (!frame.outer) frame.outer = std::make_unique<std::array<EndedRay, kLanes>>();
  for_each_lane(warp.regs.exec, [&](int lane) {
    const rt::RayState& state = warp.ray(lane);
    (*frame.outer)[size_t(lane)] = {state.ray,    state.committed,      state.table,
                                    state.status, state.attribute_slot, state.broken};
  });
  frame.kept = warp.regs.exec;
  return true;
}

void Rays::close_trace(WarpContext& warp) {
  TraceFrame& frame = warp.frame();
  for_each_lane(std::exchange(frame.kept, 0), [&](int lane) {
    const EndedRay& outer = (*frame.outer)[size_t(lane)];
    rt::RayState& state = warp.ray(lane);
    state.ray = outer.ray;
    state.committed = outer.committed;
    state.table = outer.table;
    state.status = outer.status;
    state.attribute_slot = outer.attribute_slot;
    state.broken = outer.broken;
  });
  --warp.depth;
}

bool Rays::trace(WarpContext& warp, const isa::Inst& inst) {
  const LaneMask exec = warp.regs.exec;
  if (!open_trace(warp, inst, TraceOperand::kPayload)) return false;
  TraceFrame& frame = warp.frame();
  for (LaneMask lanes = exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    rt::RayState& state = warp.ray(lane);
    set_ray(warp.regs, inst, lane, state.ray);
    state.ray.flags = with_added_flags(world_, state.ray.flags);
    state.rules.end_at_first_hit = !world_.nearest_first_hit;
    state.filter = world_.filter.get();
    state.table = candidates_.table_of(frame, lane);
    if (!rt::begin(state, *world_.memory) &&
        !ray_faults_.let_pass_structure(warp, lane, "traces a ray into", state.ray.structure)) [[unlikely]] {
      close_trace(warp);
      return false;
    }
  }
  wait_for(warp, warp.traced->data(), inst.operand[0]);
  return true;
}

void Rays::wait_for(WarpContext& warp, rt::RayState* rays, isa::Slot answer) {
  warp.waiting_for_rays = warp.regs.exec != 0;
  warp.rays = rays;
  warp.ray_lanes = warp.regs.exec;
  warp.ray_answer = answer;
  ++warp.simt.pc;
}

void Rays::finish(WarpContext& warp) const {
  LaneMask waiting = 0, gathered = 0;
  for_each_lane(warp.ray_lanes, [&](int lane) {
    const rt::RayState& state = warp.rays[lane];
    GLINT_DCHECK(state.status != RayStatus::Traversing, "lane {} was given back while traversing", lane);
    waiting |= LaneMask{needs_shader(state)} << lane;
    gathered |= LaneMask{state.status == RayStatus::Gathered} << lane;
  });
  if (gathered) candidates_.present(warp, gathered);
  LaneMask& predicate = warp.regs.predicate[warp.ray_answer];
  predicate = (predicate & ~warp.ray_lanes) | waiting;
  warp.waiting_for_rays = false;
}

bool Rays::report(WarpContext& warp, const isa::Inst& inst) {
  const LaneMask exec = warp.regs.exec;
  LaneMask undecided = 0;
  for (LaneMask lanes = exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    rt::RayState& state = warp.ray(lane);
    const float t = as_float(warp.regs.read(inst.operand[1])[lane]);
    if (rt::report(state, t, warp.regs.read(inst.operand[2])[lane]) != rt::Report::NeedsAnyHit) continue;
    uint32_t record = 0;
    const HitGroup* group = hit_group(world_, state.ray, state.candidate, record);
    if (!group && !ray_faults_.let_pass_hit_record(warp, lane, state.ray, state.candidate)) [[unlikely]]
      return false;
    if (!group || group->any_hit == kNoShader)
      rt::accept_candidate(state);
    else
      undecided |= LaneMask{1} << lane;
  }
  LaneMask& predicate = warp.regs.predicate[inst.operand[0]];
  predicate = (predicate & ~exec) | undecided;
  fill_specials(world_, warp, exec, world_.image->shaders[world_.image->shader_of[warp.simt.pc]]);
  ++warp.simt.pc;
  return true;
}

void Rays::answer_accepted(WarpContext& warp, isa::Slot answer) {
  const LaneMask exec = warp.regs.exec;
  LaneMask accepted = 0;
  for_each_lane(exec, [&](int lane) { accepted |= LaneMask{warp.ray(lane).report_accepted} << lane; });
  LaneMask& predicate = warp.regs.predicate[answer];
  predicate = (predicate & ~exec) | accepted;
  ++warp.simt.pc;
}

}  // namespace glint::exec

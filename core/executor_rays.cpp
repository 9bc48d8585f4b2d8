// Rays and shader calls: rt.*, call.sbt.*, and the values that called shaders see.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "base/check.h"
#include "core/executor.h"
#include "rtunit/structure.h"
#include "rtunit/traversal.h"

namespace glint::core {

using isa::Effect;
using isa::Special;
using rt::RayStatus;

namespace {

constexpr uint32_t kRecordBytes = 32;  // handle of a binding-table record: the published drivers' shaderGroupHandleSize

// A rt.trace's operands after the answer predicate and the structure.
enum TraceOperand : size_t { kFlags = 2, kMask, kSbtOffset, kSbtStride, kMiss, kOrigin, kTmin = 10, kDirection = 11, kTmax = 14, kPayload, kAttributes };

float as_float(uint32_t bits) { return std::bit_cast<float>(bits); }

void set_ray(const isa::Warp& regs, const isa::Inst& inst, size_t lane, rt::Ray& ray) {
  auto value = [&](size_t operand) { return regs.read(inst.operand[operand])[lane]; };
  const uint32_t* high = regs.read(isa::Slot(inst.operand[1] + 1));
  ray.structure = value(1) | Address(high[lane]) << 32;
  ray.flags = value(kFlags);
  ray.cull_mask = value(kMask) & 0xff;
  ray.sbt_offset = value(kSbtOffset) & 15;  // SPV_KHR_ray_tracing: only the 4 low bits count
  ray.sbt_stride = value(kSbtStride) & 15;
  ray.miss_index = value(kMiss) & 0xffff;   // and 16 here
  for (size_t axis = 0; axis < 3; ++axis) {
    ray.origin[axis] = as_float(value(kOrigin + axis));
    ray.direction[axis] = as_float(value(kDirection + axis));
  }
  ray.t_min = as_float(value(kTmin));
  ray.t_max = as_float(value(kTmax));
}

bool needs_shader(const rt::RayState& state) {
  return state.status == RayStatus::NeedsIntersection || state.status == RayStatus::NeedsAnyHit;
}

// What the shaders of one stage see of a ray.
struct Seen {
  const rt::Hit& hit;
  float t;
  bool candidate_attributes;
};
Seen seen_by(isa::Stage stage, const rt::RayState& state) {
  switch (stage) {
    case isa::Stage::AnyHit: return {state.candidate, state.candidate.t, true};
    case isa::Stage::Intersection: return {state.candidate, state.committed.t, true};
    case isa::Stage::Miss: return {state.committed, state.ray.t_max, false};
    case isa::Stage::ClosestHit:
    case isa::Stage::RayGeneration:
    case isa::Stage::Callable:
    case isa::Stage::Compute: break;
  }
  return {state.committed, state.committed.t, false};
}

}  // namespace

bool Executor::run_rays(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  const LaneMask exec = warp.regs.exec;
  switch (row.effect) {
    case Effect::Trace: return trace(warp, inst);
    case Effect::Resume:
      warp.waiting_for_rays = exec != 0;
      warp.rays = warp.frame().ray.data();
      warp.ray_lanes = exec;
      warp.ray_answer = inst.operand[0];
      break;
    case Effect::Report: return report(warp, inst);
    case Effect::Accepted: {
      LaneMask accepted = 0;
      for_each_lane(exec, [&](int lane) { accepted |= LaneMask{warp.frame().ray[size_t(lane)].report_accepted} << lane; });
      LaneMask& predicate = warp.regs.predicate[inst.operand[0]];
      predicate = (predicate & ~exec) | accepted;
      break;
    }
    case Effect::EndTrace:
      --warp.depth;
      fill_specials(warp, warp.simt.active, world_.image->shaders[world_.image->shader_of[warp.simt.pc]]);
      break;
    default: return call(warp, row.effect);
  }
  ++warp.simt.pc;
  return true;
}

bool Executor::trace(WarpContext& warp, const isa::Inst& inst) {
  const LaneMask exec = warp.regs.exec;
  if (warp.depth == world_.max_trace_depth)
    return fail(warp, std::countr_zero(exec), fmt::format("traces a ray at depth {}: the pipeline allows {} nested traces",
                                                          warp.depth + 1, world_.max_trace_depth));
  if (warp.frames.size() == warp.depth) warp.frames.push_back(std::make_unique<TraceFrame>());
  TraceFrame& frame = *warp.frames[warp.depth];
  for (LaneMask lanes = exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    rt::RayState& state = frame.ray[size_t(lane)];
    set_ray(warp.regs, inst, size_t(lane), state.ray);
    frame.payload[size_t(lane)] = warp.regs.read(inst.operand[kPayload])[lane];
    frame.attributes[size_t(lane)] = warp.regs.read(inst.operand[kAttributes])[lane];
    state.end_at_first_hit = !world_.nearest_first_hit;
    if (!rt::begin(state, *world_.memory))
      return fail(warp, lane, fmt::format("traces a ray into {:#x}, which is not a top-level acceleration structure", state.ray.structure));
  }
  ++warp.depth;
  warp.waiting_for_rays = exec != 0;
  warp.rays = frame.ray.data();
  warp.ray_lanes = exec;
  warp.ray_answer = inst.operand[0];
  ++warp.simt.pc;
  return true;
}

void Executor::finish_rays(WarpContext& warp) const {
  LaneMask waiting = 0;
  for_each_lane(warp.ray_lanes, [&](int lane) {
    const rt::RayState& state = warp.rays[lane];
    GLINT_DCHECK(state.status != RayStatus::Traversing, "lane {} was given back while traversing", lane);
    waiting |= LaneMask{needs_shader(state)} << lane;
  });
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
    if (!group) return fail(warp, lane, fmt::format("needs hit record {}: the binding table has {}", record, world_.hit.size()));
    if (group->any_hit == kNoShader)
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

const HitGroup* Executor::hit_group(const rt::Ray& ray, const rt::Hit& hit, uint32_t& record) const {
  // Vulkan, "Hit Shader Binding Table Indexing".
  record = hit.sbt_record + hit.geometry * ray.sbt_stride + ray.sbt_offset;
  return record < world_.hit.size() ? &world_.hit[record] : nullptr;
}

// Fills `target` with the shader of each calling lane, or kNoShader: a null shader, decided here at once.
bool Executor::call_targets(WarpContext& warp, Effect effect, std::array<uint32_t, kLanes>& target) {
  for (LaneMask lanes = warp.regs.exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const size_t i = size_t(lane);
    rt::RayState& state = warp.frame().ray[i];
    if (state.broken) [[unlikely]]
      return fail(warp, lane, "traced a ray through an acceleration structure whose bytes lead outside memory: they were overwritten");
    const bool hit = effect != Effect::CallHit || state.committed.valid();
    uint32_t record = state.ray.miss_index, place = 1 + record;
    const HitGroup* group = nullptr;
    if (hit) {
      group = hit_group(state.ray, effect == Effect::CallHit ? state.committed : state.candidate, record);
      place = 1 + uint32_t(world_.miss.size()) + record;
    }
    if (hit ? !group : record >= world_.miss.size())
      return fail(warp, lane, fmt::format("needs {} record {}: the binding table has {}", hit ? "hit" : "miss", record,
                                          hit ? world_.hit.size() : world_.miss.size()));
    warp.regs.access.address[i] = world_.binding_table + Address(place) * kRecordBytes;
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
  SimtStack& simt = warp.simt;
  std::array<uint32_t, kLanes> target;
  if (!call_targets(warp, effect, target)) return false;
  LaneMask callers = 0;
  for_each_lane(warp.regs.exec, [&](int lane) { callers |= LaneMask{target[size_t(lane)] != kNoShader} << lane; });
  const uint32_t caller = world_.image->shader_of[simt.pc];
  ++simt.pc;
  if (!callers) return true;
  simt.push_call(simt.pc, simt.active & ~callers, warp.depth, caller);
  // One path a distinct shader, in the order of the lowest lane that calls it.
  bool first = true;
  while (callers) {
    const uint32_t shader = target[size_t(std::countr_zero(callers))];
    LaneMask same = 0;
    for_each_lane(callers, [&](int lane) { same |= LaneMask{target[size_t(lane)] == shader} << lane; });
    callers &= ~same;
    const Shader& callee = world_.image->shaders[shader];
    fill_specials(warp, same, callee);
    if (first) {
      simt.pc = callee.entry;
      simt.active = same;
      first = false;
    } else {
      simt.push_path(callee.entry, same);
    }
  }
  return true;
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

void Executor::fill_specials(WarpContext& warp, LaneMask lanes, const Shader& shader) const {
  if (warp.depth == 0 || !shader.uses_ray) return;
  uint32_t* const bank = warp.regs.bank[2];
  const TraceFrame& frame = warp.frame();
  for_each_lane(lanes, [&](int lane) {
    const size_t i = size_t(lane);
    const rt::RayState& state = frame.ray[i];
    const Seen seen = seen_by(shader.stage, state);
    auto set = [&](Special s, uint32_t value) { bank[size_t(s) * kLanes + i] = value; };
    auto set_floats = [&](Special first, const float* from, int count) {
      std::memcpy(&bank[size_t(first) * kLanes + i], from, 4);
      for (int k = 1; k < count; ++k) set(Special(int(first) + k), std::bit_cast<uint32_t>(from[k]));
    };
    set(Special::Payload, frame.payload[i]);
    const uint32_t attributes = frame.attributes[i] + (seen.candidate_attributes != state.attribute_slot ? kAttributeBytes : 0);
    set(Special::Attribute, attributes);
    set(Special::HitT, std::bit_cast<uint32_t>(seen.t));
    set(Special::HitKind, seen.hit.kind);
    set(Special::HitU, std::bit_cast<uint32_t>(seen.hit.u));
    set(Special::HitV, std::bit_cast<uint32_t>(seen.hit.v));
    // Model: the first two words of an intersection shader's attributes come where a triangle's weights come, so that a
    // hit shader with a pair of floats serves both.
    if (seen.hit.valid() && seen.hit.kind < rt::kHitKindFront) {
      set(Special::HitU, warp.local[size_t(attributes / 4) * kLanes + i]);
      set(Special::HitV, warp.local[size_t(attributes / 4 + 1) * kLanes + i]);
    }
    set(Special::HitPrimitive, seen.hit.primitive);
    set(Special::HitGeometry, seen.hit.geometry);
    set(Special::HitInstance, seen.hit.instance);
    set(Special::HitCustomIndex, seen.hit.custom_index);
    set(Special::RayFlags, state.ray.flags);
    set(Special::RayTmin, std::bit_cast<uint32_t>(state.ray.t_min));
    set_floats(Special::RayOriginX, state.ray.origin.data(), 3);
    set_floats(Special::RayDirectionX, state.ray.direction.data(), 3);
    if (!shader.uses_matrices || !seen.hit.valid()) return;
    const rt::InstanceLeaf& leaf = world_.memory->view<rt::InstanceLeaf>(seen.hit.instance_leaf, 1)[0];
    set_floats(Special::ObjectToWorld0, leaf.object_to_world.data(), 12);
    set_floats(Special::WorldToObject0, leaf.world_to_object.data(), 12);
    const auto& m = leaf.world_to_object;
    const auto &o = state.ray.origin, &d = state.ray.direction;
    for (size_t r = 0; r < 3; ++r) {
      const float* row = m.data() + 4 * r;
      set(Special(size_t(Special::ObjectOriginX) + r), std::bit_cast<uint32_t>(row[0] * o[0] + row[1] * o[1] + row[2] * o[2] + row[3]));
      set(Special(size_t(Special::ObjectDirectionX) + r), std::bit_cast<uint32_t>(row[0] * d[0] + row[1] * d[1] + row[2] * d[2]));
    }
  });
}

}  // namespace glint::core

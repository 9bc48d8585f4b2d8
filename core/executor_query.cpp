// Ray queries: rq.*, whose rays a shader walks itself.
// SPDX-License-Identifier: Apache-2.0
#include "isa/ray_query.h"

#include <fmt/format.h>

#include "core/executor.h"
#include "rtunit/structure.h"
#include "rtunit/traversal.h"

namespace glint::core {
namespace {

using isa::Query;
using rt::RayState;
using rt::RayStatus;

// Operands of rq.initialize.
enum InitializeOperand : size_t { kQuery, kStructure, kFlags, kMask, kOrigin, kTmin = 7, kDirection, kTmax = 11 };

uint32_t bits(float x) { return std::bit_cast<uint32_t>(x); }

// Element of a point or direction of the world in the space of a hit's instance.
float object_space(const rt::InstanceLeaf& leaf, const std::array<float, 3>& x, size_t row, bool point) {
  const float* m = leaf.world_to_object.data() + 4 * row;
  const float rotated = m[0] * x[0] + m[1] * x[1] + m[2] * x[2];
  return point ? rotated + m[3] : rotated;
}

uint32_t kind_of_hit(const RayState& state, bool committed) {
  if (!committed) return state.status == RayStatus::NeedsIntersection;
  if (!state.committed.valid()) return 0;
  return state.committed.kind >= rt::kHitKindFront ? 1 : 2;
}

// A value of the ray itself; the element is counted from Query::Tmin.
uint32_t ray_value(const rt::Ray& ray, int element) {
  const int first_origin = int(Query::Origin) - int(Query::Tmin), first_direction = first_origin + 3;
  if (element == 0) return bits(ray.t_min);
  if (element < first_origin) return ray.flags;
  return bits(element < first_direction ? ray.origin[size_t(element - first_origin)]
                                        : ray.direction[size_t(element - first_direction)]);
}

// A value that depends on the instance; of no instance, 0 (Choice: Vulkan leaves it undefined).
uint32_t instance_value(const RayState& state, const rt::Hit& hit, int field, const mem::AddressSpace& memory) {
  if (!hit.valid()) return 0;
  const rt::InstanceLeaf& leaf = memory.view<rt::InstanceLeaf>(hit.instance_leaf, 1)[0];
  if (field >= int(Query::WorldToObject)) return bits(leaf.world_to_object[size_t(field - int(Query::WorldToObject))]);
  if (field >= int(Query::ObjectToWorld)) return bits(leaf.object_to_world[size_t(field - int(Query::ObjectToWorld))]);
  if (field >= int(Query::ObjectDirection))
    return bits(object_space(leaf, state.ray.direction, size_t(field - int(Query::ObjectDirection)), false));
  return bits(object_space(leaf, state.ray.origin, size_t(field - int(Query::ObjectOrigin)), true));
}

uint32_t query_value(const RayState& state, uint16_t detail, const mem::AddressSpace& memory) {
  const bool committed = detail & isa::kCommitted;
  const int field = detail & ~isa::kCommitted;
  const rt::Hit& hit = committed ? state.committed : state.candidate;
  if (field >= int(Query::Tmin)) return ray_value(state.ray, field - int(Query::Tmin));
  if (field >= int(Query::ObjectOrigin)) return instance_value(state, hit, field, memory);
  switch (Query(field)) {
    case Query::Type: return kind_of_hit(state, committed);
    case Query::T: return bits(hit.t);
    case Query::Instance: return hit.instance;
    case Query::CustomIndex: return hit.custom_index;
    case Query::SbtOffset: return hit.sbt_record;
    case Query::Geometry: return hit.geometry;
    case Query::Primitive: return hit.primitive;
    case Query::BarycentricU: return bits(hit.u);
    case Query::BarycentricV: return bits(hit.v);
    case Query::FrontFace: return hit.kind == rt::kHitKindFront;
    default: return state.candidate_opaque;
  }
}

void commit(RayState& state) {
  if (state.status == RayStatus::NeedsAnyHit) rt::accept_candidate(state);
}

// Model: a generated hit passes no any-hit shader; its kind is 0.
void generate(RayState& state, float t) {
  if (state.status != RayStatus::NeedsIntersection) return;
  if (rt::report(state, t, 0) == rt::Report::NeedsAnyHit) rt::accept_candidate(state);
}

// The shader asks for more without having taken the candidate.
void pass_over(RayState& state) {
  if (state.status == RayStatus::NeedsAnyHit) rt::ignore_candidate(state);
  if (state.status == RayStatus::NeedsIntersection) rt::finish_intersection(state);
}

}  // namespace

RayState* Executor::find_query(WarpContext& warp, isa::Slot operand) {
  const uint32_t* index = warp.regs.read(operand);
  const int first = std::countr_zero(warp.regs.exec);
  bool same = true;
  for_each_lane(warp.regs.exec, [&](int lane) { same &= index[lane] == index[first]; });
  if (!same) return fail(warp, first, "the lanes of a warp use different ray queries at once"), nullptr;
  if (index[first] >= kMaxRayQueries)
    return fail(warp, first, fmt::format("uses ray query {}: a shader has at most {}", index[first], kMaxRayQueries)), nullptr;
  // Each nesting level has queries of its own: a hit shader's do not disturb its caller's.
  const size_t place = size_t(warp.depth) * kMaxRayQueries + index[first];
  if (warp.queries.size() <= place) warp.queries.resize(place + 1);
  if (!warp.queries[place]) warp.queries[place] = std::make_unique<std::array<RayState, kLanes>>();
  return warp.queries[place]->data();
}

bool Executor::run_query(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  const LaneMask exec = warp.regs.exec;
  const bool reads = row.operands.kind[0] == isa::OperandKind::Dst32 || row.effect == isa::Effect::QueryProceed;
  if (exec) {
    RayState* const states = find_query(warp, inst.operand[reads ? 1 : 0]);
    if (!states) return false;
    if (row.effect == isa::Effect::QueryProceed) {
      for_each_lane(exec, [&](int lane) { pass_over(states[lane]); });
      warp.waiting_for_rays = true;
      warp.rays = states;
      warp.ray_lanes = exec;
      warp.ray_answer = inst.operand[0];
    } else if (reads) {
      uint32_t* const to = warp.regs.write(inst.operand[0]);
      for_each_lane(exec, [&](int lane) { to[lane] = query_value(states[lane], row.detail, *world_.memory); });
    } else if (row.detail == isa::detail_of(Query::Initialize)) {
      if (!begin_queries(warp, inst, states)) return false;
    } else {
      decide_queries(warp, inst, row, states);
    }
  }
  ++warp.simt.pc;
  return true;
}

bool Executor::begin_queries(WarpContext& warp, const isa::Inst& inst, RayState* states) {
  const auto value = [&](size_t operand, int lane) { return warp.regs.read(inst.operand[operand])[lane]; };
  for (LaneMask lanes = warp.regs.exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    RayState& state = states[lane];
    rt::Ray& ray = state.ray;
    ray = {};
    ray.structure = value(kStructure, lane) | Address(warp.regs.read(isa::Slot(inst.operand[kStructure] + 1))[lane]) << 32;
    ray.flags = value(kFlags, lane);
    ray.cull_mask = value(kMask, lane) & 0xff;
    for (size_t axis = 0; axis < 3; ++axis) {
      ray.origin[axis] = std::bit_cast<float>(value(kOrigin + axis, lane));
      ray.direction[axis] = std::bit_cast<float>(value(kDirection + axis, lane));
    }
    ray.t_min = std::bit_cast<float>(value(kTmin, lane));
    ray.t_max = std::bit_cast<float>(value(kTmax, lane));
    state.end_at_first_hit = !world_.nearest_first_hit;
    if (!rt::begin(state, *world_.memory))
      return fail(warp, lane, fmt::format("starts a ray query in {:#x}, which is not a top-level acceleration structure", ray.structure));
  }
  return true;
}

void Executor::decide_queries(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, RayState* states) {
  for_each_lane(warp.regs.exec, [&](int lane) {
    RayState& state = states[lane];
    switch (Query(row.detail)) {
      case Query::Confirm: commit(state); break;
      case Query::Generate: generate(state, std::bit_cast<float>(warp.regs.read(inst.operand[1])[lane])); break;
      default: state.status = RayStatus::Done; break;
    }
  });
}

}  // namespace glint::core

// Computes the values of ray queries, and what a shader decides about candidates.
// SPDX-License-Identifier: Apache-2.0
#include "exec/ray_queries.h"

#include <bit>

#include "exec/numbered.h"
#include "exec/ray_values.h"
#include "isa/ray_query.h"
#include "rtunit/structure/structure.h"
#include "rtunit/traversal/traversal.h"

namespace glint::exec {
namespace {

using isa::Query;
using rt::RayState;
using rt::RayStatus;

// Names the operands of rq.initialize.
struct InitializeOperand {
  enum Slot : size_t { kQuery, kStructure, kFlags, kMask, kRay };
};

uint32_t kind_of_hit(const RayState& state, bool committed) {
  if (!committed) return state.status == RayStatus::NeedsIntersection;
  if (!state.committed.valid()) return 0;
  return state.committed.kind >= rt::kHitKindFront ? 1 : 2;
}

// Returns a value of the ray itself. The element is counted from Query::Tmin.
uint32_t ray_value(const rt::Ray& ray, int element) {
  const int first_origin = int(Query::Origin) - int(Query::Tmin), first_direction = first_origin + 3;
  if (element == 0) return as_bits(ray.t_min);
  if (element < first_origin) return ray.flags;
  return as_bits(element < first_direction ? ray.origin[size_t(element - first_origin)]
                                           : ray.direction[size_t(element - first_direction)]);
}

// Returns a value that depends on the instance, or 0 when there is none (Choice: Vulkan leaves it undefined).
uint32_t instance_value(const RayState& state, const rt::Hit& hit, int field,
                        const mem::AddressSpace& memory) {
  if (!hit.valid()) return 0;
  const rt::InstanceLeaf& leaf = memory.view<rt::InstanceLeaf>(hit.instance_leaf, 1)[0];
  if (field >= int(Query::WorldToObject))
    return as_bits(leaf.world_to_object[size_t(field - int(Query::WorldToObject))]);
  if (field >= int(Query::ObjectToWorld))
    return as_bits(leaf.object_to_world[size_t(field - int(Query::ObjectToWorld))]);
  if (field >= int(Query::ObjectDirection))
    return as_bits(object_direction(leaf, state.ray.direction, size_t(field - int(Query::ObjectDirection))));
  return as_bits(object_point(leaf, state.ray.origin, size_t(field - int(Query::ObjectOrigin))));
}

uint32_t query_value(const RayState& state, uint16_t detail, const mem::AddressSpace& memory) {
  const bool committed = detail & isa::kCommitted;
  const int field = detail & ~isa::kCommitted;
  const rt::Hit& hit = committed ? state.committed : state.candidate;
  if (field >= int(Query::Tmin)) return ray_value(state.ray, field - int(Query::Tmin));
  if (field >= int(Query::Corner))
    return as_bits(corner_of(hit, uint32_t(field - int(Query::Corner)), memory));
  if (field >= int(Query::ObjectOrigin)) return instance_value(state, hit, field, memory);
  switch (Query(field)) {
    case Query::Type:
      return kind_of_hit(state, committed);
    case Query::T:
      return as_bits(hit.t);
    case Query::Instance:
      return hit.instance;
    case Query::CustomIndex:
      return hit.custom_index;
    case Query::SbtOffset:
      return hit.sbt_record;
    case Query::Geometry:
      return hit.geometry;
    case Query::Primitive:
      return hit.primitive;
    case Query::BarycentricU:
      return as_bits(hit.u);
    case Query::BarycentricV:
      return as_bits(hit.v);
    case Query::FrontFace:
      return hit.kind == rt::kHitKindFront;
    default:
      return state.candidate_opaque;
  }
}

void commit(RayState& state) {
  if (state.status == RayStatus::NeedsAnyHit) rt::accept_candidate(state);
}

// Generates a hit. Model: a generated hit passes no any-hit shader, and its kind is 0.
void generate(RayState& state, float t) {
  if (state.status != RayStatus::NeedsIntersection) return;
  if (rt::report(state, t, 0) == rt::Report::NeedsAnyHit) rt::accept_candidate(state);
}

// Handles a shader that asks for more without having taken the candidate.
void pass_over(RayState& state) {
  if (state.status == RayStatus::NeedsAnyHit) rt::ignore_candidate(state);
  if (state.status == RayStatus::NeedsIntersection) rt::finish_intersection(state);
}

}  // namespace

bool RayQueries::run(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  const LaneMask exec = warp.regs.exec;
  const bool reads =
      row.operands.kind[0] == isa::OperandKind::Dst32 || row.effect == isa::Effect::QueryProceed;
  if (exec) {
    RayState* const states =
        find_numbered(faults_, warp, warp.queries, inst.operand[reads ? 1 : 0], warp.depth, "ray query");
    if (!states) return false;
    // After a ray has been walked, shaders ask for more candidates or for what the ray found.
    const bool asks =
        row.effect == isa::Effect::QueryProceed || row.detail == isa::detail_of(Query::Type, true);
    for (LaneMask lanes = asks ? exec : 0; lanes; lanes &= lanes - 1)
      if (RayState& state = states[std::countr_zero(lanes)];
          state.broken && !ray_faults_.let_pass_broken(warp, std::countr_zero(lanes), state)) [[unlikely]]
        return false;
    if (row.effect == isa::Effect::QueryProceed) {
      for_each_lane(exec, [&](int lane) { pass_over(states[lane]); });
      Rays::wait_for(warp, states, inst.operand[0]);
      return true;
    } else if (reads) {
      uint32_t* const to = warp.regs.write(inst.operand[0]);
      for_each_lane(exec,
                    [&](int lane) { to[lane] = query_value(states[lane], row.detail, *world_.memory); });
    } else if (row.detail == isa::detail_of(Query::Initialize)) {
      if (!begin(warp, inst, states)) return false;
    } else {
      decide(warp, inst, row, states);
    }
  }
  ++warp.simt.pc;
  return true;
}

bool RayQueries::begin(WarpContext& warp, const isa::Inst& inst, RayState* states) {
  for (LaneMask lanes = warp.regs.exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    RayState& state = states[lane];
    rt::Ray& ray = state.ray;
    ray = {};
    ray.structure = read_address(warp.regs, inst, InitializeOperand::kStructure, lane);
    ray.flags = read_word(warp.regs, inst, InitializeOperand::kFlags, lane);
    ray.cull_mask = read_word(warp.regs, inst, InitializeOperand::kMask, lane) & 0xff;
    read_ray(warp.regs, inst, InitializeOperand::kRay, lane, ray);
    state.rules.end_at_first_hit = !world_.nearest_first_hit;
    state.filter = world_.filter.get();
    if (!rt::begin(state, *world_.memory) &&
        !ray_faults_.let_pass_structure(warp, lane, "starts a ray query in", ray.structure))
      return false;
  }
  return true;
}

void RayQueries::decide(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, RayState* states) {
  for_each_lane(warp.regs.exec, [&](int lane) {
    RayState& state = states[lane];
    switch (Query(row.detail)) {
      case Query::Confirm:
        commit(state);
        break;
      case Query::Generate:
        generate(state, as_float(read_word(warp.regs, inst, 1, lane)));
        break;
      default:
        state.status = RayStatus::Done;
        break;
    }
  });
}

}  // namespace glint::exec

// What happens when a program does something wrong: the run stops, or the mistake is noted and the lane goes
// on.
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <fmt/format.h>

#include "exec/executor.h"
#include "rtunit/structure.h"
#include "rtunit/traversal.h"

namespace glint::exec {

Fault no_end_in_sight(const World& world, const WarpContext& warp, uint32_t pc, uint64_t instruction_budget) {
  const int lane = warp.simt.active ? std::countr_zero(warp.simt.active) : 0;
  return {fmt::format("no end in sight: the warp has executed more than {} instructions", instruction_budget),
          world.image->place_of(pc), launch_id(world, warp.warp_index, lane)};
}

bool Executor::fail(WarpContext& warp, int lane, std::string what) {
  fault_ =
      Fault{std::move(what), world_.image->place_of(warp.simt.pc), launch_id(world_, warp.warp_index, lane)};
  return false;
}

bool Executor::let_pass(WarpContext& warp, int lane, FaultKind kind,
                        const std::function<std::string()>& what) {
  if (world_.on_fault == OnFault::Stop) return fail(warp, lane, what());
  const std::array<uint32_t, 3> id = launch_id(world_, warp.warp_index, lane), &size = world_.launch_size;
  const uint64_t index = id[0] + uint64_t{size[0]} * (id[1] + uint64_t{size[1]} * id[2]);
  passed_.note(warp.simt.pc, kind, index, [&] {
    return Fault{what(), world_.image->place_of(warp.simt.pc), id};
  });
  return true;
}

bool Executor::let_pass_record(WarpContext& warp, int lane, std::string_view region, uint32_t record,
                               size_t records, const std::string& how) {
  return let_pass(warp, lane, FaultKind::Record, [&] {
    return fmt::format("needs {} record {}{}: the binding table has {}", region, record, how, records);
  });
}

bool Executor::let_pass_hit_record(WarpContext& warp, int lane, const rt::Ray& ray, const rt::Hit& hit) {
  return let_pass_record(
      warp, lane, "hit", hit_record(ray, hit), world_.hit.size(),
      fmt::format(" (instance {}'s {} + geometry {} x stride {} + offset {})", hit.instance, hit.sbt_record,
                  hit.geometry, ray.sbt_stride, ray.sbt_offset));
}

// As a null group: a candidate of triangles is taken, one of boxes reports nothing. Choice: a record outside
// of the table, which somebody has let pass, costs what the region's first one costs.
void Executor::call_nothing(WarpContext& warp, int lane, rt::RayState& state, isa::Effect effect) {
  using rt::RayStatus;
  const bool hit = effect != isa::Effect::CallHit || state.committed.valid();
  warp.regs.access.address[size_t(lane)] = (hit ? world_.table.hit : world_.table.miss).address(0);
  if (effect == isa::Effect::CallHit) return;
  if (effect == isa::Effect::CallAnyHit || state.status == RayStatus::NeedsAnyHit)
    rt::accept_candidate(state);
  else
    rt::finish_intersection(state);
}

bool Executor::let_pass_structure(WarpContext& warp, int lane, std::string_view verb, Address structure) {
  return let_pass(warp, lane, FaultKind::Structure, [&] {
    return fmt::format("{} {:#x}, which is not a top-level acceleration structure: {}", verb, structure,
                       whereabouts(*world_.memory, structure, sizeof(rt::StructureHeader)));
  });
}

// The ray then has missed.
bool Executor::let_pass_broken(WarpContext& warp, int lane, rt::RayState& state) {
  if (!let_pass(warp, lane, FaultKind::Structure, [&] {
        return fmt::format(
            "traced a ray through {:#x}, an acceleration structure whose bytes lead outside memory: they "
            "were overwritten: {}",
            state.ray.structure,
            whereabouts(*world_.memory, state.ray.structure, sizeof(rt::StructureHeader)));
      }))
    return false;
  state.broken = false;
  state.committed = {};
  state.committed.t = state.ray.t_max;
  return true;
}

}  // namespace glint::exec

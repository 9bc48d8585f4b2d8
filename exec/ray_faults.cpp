// Puts the mistakes of programs that trace rays into words.
// SPDX-License-Identifier: Apache-2.0
#include "exec/ray_faults.h"

#include <fmt/format.h>

#include "exec/hit_records.h"
#include "rtunit/node_format.h"
#include "rtunit/structure/structure.h"

namespace glint::exec {

bool RayFaults::let_pass_record(const WarpContext& warp, int lane, std::string_view region, uint32_t record,
                                size_t records, const std::string& how) {
  return gate_.let_pass(warp, lane, FaultKind::Record, [&] {
    if (record < records)
      return fmt::format("needs {} record {}{}, whose handle is no {} group of this pipeline", region, record,
                         how, region);
    return fmt::format("needs {} record {}{}, and the binding table has {}", region, record, how, records);
  });
}

bool RayFaults::let_pass_hit_record(const WarpContext& warp, int lane, const rt::Ray& ray,
                                    const rt::Hit& hit) {
  return let_pass_record(
      warp, lane, "hit", hit_record(world_, ray, hit), world_.hit.size(),
      fmt::format(" (instance {}'s {} + geometry {} x stride {} + offset {})", hit.instance, hit.sbt_record,
                  hit.geometry, ray.sbt_stride, ray.sbt_offset));
}

namespace {

// Says what is wrong with a structure that no ray can enter.
std::string why_not_entered(const mem::AddressSpace& memory, Address structure) {
  if (const std::byte* bytes = memory.find(structure, sizeof(rt::StructureHeader))) {
    const auto header = rt::load<rt::StructureHeader>(bytes);
    if (header.magic == rt::StructureHeader::kMagic && header.level == 1 && !rt::find_format(header.format))
      return fmt::format("its header names the node format {:#x}, which no policy of bvh.format has",
                         header.format);
  }
  return whereabouts(memory, structure, sizeof(rt::StructureHeader));
}

}  // namespace

bool RayFaults::let_pass_structure(const WarpContext& warp, int lane, std::string_view verb,
                                   Address structure) {
  return gate_.let_pass(warp, lane, FaultKind::Structure, [&] {
    return fmt::format("{} {:#x}, which is not a top-level acceleration structure: {}", verb, structure,
                       why_not_entered(*world_.memory, structure));
  });
}

bool RayFaults::let_pass_broken(const WarpContext& warp, int lane, rt::RayState& state) {
  if (!gate_.let_pass(warp, lane, FaultKind::Structure, [&] {
        return fmt::format(
            "traced a ray through {:#x}, an acceleration structure whose bytes were overwritten and lead "
            "outside memory: {}",
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

// Implements tables of candidates, and the choice of the next one.
// SPDX-License-Identifier: Apache-2.0
#include "exec/candidates.h"

#include "exec/hit_records.h"

namespace glint::exec {

static_assert(rt::AnyHitMode::kNoShader == kNoShader);

rt::CandidateTable* Candidates::table_of(TraceFrame& frame, int lane) const {
  if (table_rows_ == 0) return nullptr;
  if (frame.tables.empty()) {
    frame.tables.resize(kLanes);
    for (rt::CandidateTable& table : frame.tables) table.row.resize(table_rows_);
  }
  return &frame.tables[size_t(lane)];
}

void Candidates::present(WarpContext& warp, LaneMask gathered) const {
  world_.any_hit->present(warp.rays, gathered, [&](int lane, const rt::Candidate& candidate) {
    uint32_t record = 0;
    const HitGroup* group = hit_group(world_, warp.rays[lane].ray, candidate.hit, record);
    if (!group) return kNoShader;  // ShaderCalls reports this.
    return candidate.is_procedural ? group->intersection : group->any_hit;
  });
}

void Candidates::count(const WarpContext& warp) {
  for_each_lane(warp.simt.active, [&](int lane) {
    const rt::CandidateTable* table = warp.ray(lane).table;
    if (!table) return;
    counts_.gathered += table->gathered;
    counts_.dropped += table->dropped;
    counts_.overflows += table->overflows;
  });
}

}  // namespace glint::exec

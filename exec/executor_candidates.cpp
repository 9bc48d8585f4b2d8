// Rays that gather candidates before their shaders run (rtunit/any_hit_mode.h): tables, choices and counts.
// SPDX-License-Identifier: Apache-2.0
#include "exec/executor.h"

namespace glint::exec {

static_assert(rt::AnyHitMode::kNoShader == kNoShader);

// The lane's table in the innermost level; null when the mode has none.
rt::CandidateTable* Executor::table_of(TraceFrame& frame, int lane) const {
  if (table_rows_ == 0) return nullptr;
  if (frame.tables.empty()) {
    frame.tables.resize(kLanes);
    for (rt::CandidateTable& table : frame.tables) table.row.resize(table_rows_);
  }
  return &frame.tables[size_t(lane)];
}

void Executor::present_candidates(WarpContext& warp, LaneMask gathered) const {
  world_.any_hit->present(warp.rays, gathered, [&](int lane, const rt::Candidate& candidate) {
    uint32_t record = 0;
    const HitGroup* group = hit_group(warp.rays[lane].ray, candidate.hit, record);
    if (!group) return kNoShader;  // call_targets() tells of it
    return candidate.is_procedural ? group->intersection : group->any_hit;
  });
}

// At the end of a trace.
void Executor::count_candidates(WarpContext& warp) {
  for_each_lane(warp.simt.active, [&](int lane) {
    const rt::CandidateTable* table = warp.frame().ray[size_t(lane)].table;
    if (!table) return;
    candidates_.gathered += table->gathered;
    candidates_.dropped += table->dropped;
    candidates_.overflows += table->overflows;
  });
}

}  // namespace glint::exec

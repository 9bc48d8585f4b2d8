// Counts an issued instruction.
// SPDX-License-Identifier: Apache-2.0
#include "core/core_counts.h"

#include "base/num_lanes.h"

namespace glint::core {

void CoreCounts::issue(uint32_t scheduler, const IssueRow& row, const exec::Issued& issued) {
  const uint64_t lanes = num_lanes(issued.lanes);
  if (profile) profile->issue(scheduler, issued.pc, lanes);
  ++progress;
  ++stats.instructions;
  stats.lane_instructions += lanes;
  stats.lane_slots += uint64_t(kLanes);
  stats.by_class.add(row.klass);
  stats.lanes_by_class.add(row.klass, lanes);
  StageStats& stage = *stats.stage[size_t(row.stage)];
  stage.instructions.add(row.klass);
  stage.lanes.add(row.klass, lanes);
  ++op_counts[issued.inst->op];
  op_lanes[issued.inst->op] += lanes;
  if (row.is_conditional) {
    ++stats.branches;
    if (issued.lanes != 0 && issued.lanes != issued.active) ++stats.divergent_branches;
  }
  if (row.pipe == Pipe::Const) ++stats.constant_loads;
}

}  // namespace glint::core

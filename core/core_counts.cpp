// Adds up the counts of instructions by class, stage and op.
// SPDX-License-Identifier: Apache-2.0
#include "core/core_counts.h"

namespace glint::core {

void CoreCounts::settle(const IssueTable& table, const exec::Image& image) {
  for (uint32_t pc = 0; pc < by_pc_.size(); ++pc) {
    const auto [issues, lanes, cycles] = by_pc_[pc];
    const IssueRow& row = table.row(pc);
    const isa::Class klass = image.code[pc].row->klass;
    StageStats& stage = *stats.stage[size_t(row.stage)];
    stats.lane_instructions += lanes;
    stats.lane_slots += issues * uint64_t(kLanes);
    stats.by_class.add(klass, issues);
    stats.lanes_by_class.add(klass, lanes);
    stats.latency.add(klass, cycles);
    stage.instructions.add(klass, issues);
    stage.lanes.add(klass, lanes);
    stage.latency.add(klass, cycles);
    op_counts[image.code[pc].inst.op] += issues;
    op_lanes[image.code[pc].inst.op] += lanes;
    if (row.is_conditional) stats.branches += issues;
    if (row.pipe == Pipe::Const) stats.constant_loads += issues;
  }
}

}  // namespace glint::core

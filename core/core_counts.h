// Holds everything that a core counts: statistics, instructions by op, latencies and, when asked for, a
// profile.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/core_stats.h"
#include "core/issue_table.h"
#include "core/profile.h"
#include "exec/executor.h"
#include "memsys/latency.h"

namespace glint::core {

struct CoreCounts {
  CoreCounts(stats::Group* parent, std::string name)
      : stats(parent, std::move(name)), op_counts(isa::op_table().size()), op_lanes(isa::op_table().size()) {}

  // Counts an instruction that a warp of scheduler `scheduler` has issued.
  void issue(uint32_t scheduler, const IssueRow& row, const exec::Issued& issued);
  // Counts an instruction that took `duration` cycles from its issue to its completion.
  void end(const IssueRow& row, uint64_t duration) { stats.add_latency(row.stage, row.klass, duration); }

  CoreStats stats;
  // These count warp instructions and lanes by op, indexed as isa::op_table().
  std::vector<uint64_t> op_counts, op_lanes;
  mem::Latencies latencies;  // cycles from issue to last sector of warp instructions that wait for memory
  std::unique_ptr<Profile> profile;  // counts by instruction; null: nobody has asked for them
  uint64_t progress = 0;             // grows whenever a warp makes progress
};

}  // namespace glint::core

// Holds everything that a core counts: statistics, instructions by op, latencies and, when asked for, a
// profile.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/num_lanes.h"
#include "core/core_stats.h"
#include "core/issue_table.h"
#include "core/profile.h"
#include "core/scheduler.h"
#include "exec/executor.h"
#include "memsys/latency.h"

namespace glint::core {

// What an instruction counts lies together, by its place in the program. The counts by class, stage and op
// are sums over these, and exist when settle() has made them at the end of the run: one instruction would
// otherwise write to ten places of the host's memory.
class CoreCounts {
 public:
  // `num_instructions` is the length of the program.
  CoreCounts(stats::Group* parent, std::string name, size_t num_instructions)
      : stats(parent, std::move(name)),
        op_counts(isa::op_table().size()),
        op_lanes(isa::op_table().size()),
        by_pc_(num_instructions) {}

  // Counts an instruction that a warp of scheduler `scheduler` has issued.
  void issue(uint32_t scheduler, const IssueRow& row, const exec::Issued& issued) {
    const auto lanes = uint64_t(num_lanes(issued.lanes));
    if (profile) [[unlikely]]
      profile->issue(scheduler, issued.pc, lanes);
    ++progress;
    ++stats.instructions;
    ByPc& counts = by_pc_[issued.pc];
    ++counts.issues;
    counts.lanes += lanes;
    if (row.is_conditional) [[unlikely]]
      stats.divergent_branches += issued.lanes != 0 && issued.lanes != issued.active;
  }
  // Counts an instruction that took `duration` cycles, where nobody has asked for a profile and it is no
  // branch.
  void issue_value(uint32_t pc, uint64_t lanes, uint64_t duration) {
    ++progress;
    ++stats.instructions;
    ByPc& counts = by_pc_[pc];
    ++counts.issues;
    counts.lanes += lanes;
    counts.cycles += duration;
  }
  // Counts that the instruction at `pc` took `duration` cycles from its issue to its completion.
  void end(uint32_t pc, uint64_t duration) { by_pc_[pc].cycles += duration; }
  // Brings the counts of the instruction at `pc` near to the host's core.
  void prefetch(uint32_t pc) const { __builtin_prefetch(&by_pc_[pc], 1); }
  // Gives the cycles of the scheduler up to `until` to its reason. It is called before the reason changes.
  void spend(Scheduler& scheduler, Cycle until) {
    const Stall reason = scheduler.reason();
    const Cycle cycles = scheduler.take_unaccounted(until);
    stats.stalls.add(reason, cycles);
    if (profile) [[unlikely]]
      profile->spend(scheduler.index(), reason, cycles);
  }
  // Adds up what was counted by instruction. It is called once, at the end of the run.
  void settle(const IssueTable& table, const exec::Image& image);

  CoreStats stats;
  // These count warp instructions and lanes by op, indexed as isa::op_table().
  std::vector<uint64_t> op_counts, op_lanes;
  mem::Latencies latencies;  // cycles from issue to last sector of warp instructions that wait for memory
  std::unique_ptr<Profile> profile;  // counts by instruction; null: nobody has asked for them
  uint64_t progress = 0;             // grows whenever a warp makes progress

 private:
  // Its alignment keeps it in one cache line of the host.
  struct alignas(32) ByPc {
    uint64_t issues = 0, lanes = 0;
    uint64_t cycles = 0;  // from issue to completion, summed over issues
  };
  std::vector<ByPc> by_pc_;
};

}  // namespace glint::core

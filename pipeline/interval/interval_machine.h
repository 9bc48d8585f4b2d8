// Predicts the cycles of a launch in one functional pass, from the time between waits and the time of the
// waits.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <queue>
#include <string_view>
#include <utility>
#include <vector>

#include "core/issue_table.h"
#include "exec/executor.h"
#include "pipeline/interval/memory_model.h"
#include "pipeline/interval/ray_model.h"
#include "pipeline/params.h"

namespace glint::pipeline {

// Holds what the model says of a launch, and where it comes from.
struct IntervalEstimate {
  Cycle cycles = 0;                      // predicted cycles
  uint64_t instructions = 0, lanes = 0;  // warp and lane instructions
  RayModelCounts rays;                   // summed over all cores
  std::array<CacheCounts, 2> l1;         // counts, indexed by Asker
  CacheCounts l2;
  uint64_t dram_sectors = 0;
  // These are the cycles of work of the busiest resource of each kind. Whatever overlaps, no run is shorter
  // than these. The largest is the bound of throughput; what the prediction exceeds it by is latency that
  // nothing hides.
  double issue = 0, rt_port = 0, rt_tests = 0, rt_slots = 0, l1_ports = 0, l2_slices = 0, dram_buses = 0;
  // Returns the name and the cycles of each of these, in this order.
  std::array<std::pair<std::string_view, double>, 7> bounds() const;
};

// Applies interval analysis (Karkhanis and Smith 2004; Genbrugge, Eyerman, Eeckhout 2010) to warps. From one
// trace of rays to the next, a warp runs alone and in order, against the latencies of its units and of a
// memory model with tags and bandwidths. The issue slots of a scheduler bound what its warps do together.
// Traces go through a model of the RT unit. Nothing is fitted: every number comes from the configuration.
// Model: there are no memory queues and no turns between blocks' launches, and the warps of a scheduler share
// only the work of pipes.
class IntervalMachine {
 public:
  // Throws UnsupportedError, with all reasons, for launches with blocks of threads and for configurations
  // whose mechanisms the model lacks.
  IntervalMachine(const GpuParams& params, const exec::World& world);
  ~IntervalMachine();

  // Runs the launch. Effects on memory are those of the functional machine, and so is Error(Exit::Fault).
  IntervalEstimate run(const std::function<void(uint64_t done, uint64_t total)>& progress);

 private:
  struct Core;
  struct Event {
    Cycle at = 0;
    uint32_t slot = 0;
    bool finished = false;
    bool operator>(const Event& other) const { return at != other.at ? at > other.at : slot > other.slot; }
  };

  bool launch(Core& core, uint32_t slot, Cycle at);
  void run_interval(Core& core, uint32_t slot, Cycle at);
  Cycle access(Core& core, uint32_t slot, const exec::Issued& issued, const core::IssueRow& row, Cycle at);
  Cycle next(const Core& core) const;
  void advance(Core& core);
  IntervalEstimate collect() const;

  const GpuParams& params_;
  const exec::World& world_;
  exec::Executor executor_;
  core::IssueTable table_;
  MemoryModel memory_;
  std::vector<std::unique_ptr<Core>> cores_;
  uint32_t next_warp_ = 0, num_ended_ = 0;
  Cycle end_ = 0;
  IntervalEstimate estimate_;
};

}  // namespace glint::pipeline

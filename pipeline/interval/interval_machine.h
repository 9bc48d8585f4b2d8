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
#include "pipeline/timing_machine.h"

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
  // Adds a later launch with the same memory, whose counts of caches and of their work include this one's.
  void add(const IntervalEstimate& later);
};

// Applies interval analysis (Karkhanis and Smith 2004; Genbrugge, Eyerman, Eeckhout 2010) to warps. From one
// wait to the next, a warp runs alone and in order, against the latencies of its units and of a memory model
// with tags and bandwidths. Waits are traces of rays and, in launches with blocks of threads, barriers and
// loads. The issue slots of a scheduler bound what its warps do together. Traces go through a model of the RT
// unit. Nothing is fitted: every number comes from the configuration.
// Model: there are no memory queues and no turns between blocks' launches, and the warps of a scheduler share
// only the work of pipes.
class IntervalMachine {
 public:
  // Throws UnsupportedError, with all reasons, for configurations whose mechanisms the model lacks.
  IntervalMachine(const GpuParams& params, const exec::World& world);
  // Does the same for a launch that begins at `begin` with memory that earlier launches have used.
  IntervalMachine(const GpuParams& params, const exec::World& world, MemoryModel& memory, Cycle begin);
  ~IntervalMachine();

  // Runs the launch. Effects on memory are those of the functional machine, and so is Error(Exit::Fault).
  IntervalEstimate run(const std::function<void(uint64_t done, uint64_t total)>& progress);

 private:
  struct Core;
  // Says what comes after an interval of a warp.
  enum class Next : uint8_t { Run, Rays, Barrier, End };
  struct Event {
    Cycle at = 0;
    uint32_t slot = 0;
    Next next = Next::Run;
    bool operator>(const Event& other) const { return at != other.at ? at > other.at : slot > other.slot; }
  };

  IntervalMachine(const GpuParams& params, const exec::World& world, std::unique_ptr<MemoryModel> own,
                  MemoryModel* memory, Cycle begin);
  bool launch(Core& core, uint32_t place, Cycle at);
  void run_interval(Core& core, uint32_t slot, Cycle at);
  Next execute(Core& core, uint32_t slot, Cycle& now, Cycle until);
  void come_to_barrier(Core& core, uint32_t slot, Cycle at);
  void pass_barrier(Core& core, uint32_t slot, Cycle at);
  void end_warp(Core& core, uint32_t slot, Cycle at);
  Cycle access(Core& core, uint32_t slot, const exec::Issued& issued, const core::IssueRow& row, Cycle at);
  Cycle access_shared(Core& core, uint32_t passes, bool is_atomic, Cycle at);
  Cycle access_lines(Core& core, const exec::Issued& issued, Cycle begin, bool is_local);
  Cycle next(const Core& core) const;
  void advance(Core& core);
  IntervalEstimate collect() const;

  const GpuParams& params_;
  const exec::World& world_;
  const bool has_blocks_;
  exec::Executor executor_;
  core::IssueTable table_;
  const std::unique_ptr<MemoryModel> own_memory_;
  MemoryModel& memory_;
  Reserves reserves_;
  std::vector<std::unique_ptr<Core>> cores_;
  uint32_t next_block_ = 0, num_ended_ = 0;
  const Cycle begin_;
  Cycle end_ = 0;
  double slots_ = 0;                            // issue slots of the present interval
  std::array<double, core::kNumPipes> work_{};  // work of its pipes
  IntervalEstimate estimate_;
};

// Takes one launch after another, as Device does: a warm one finds in the L2 what those before it have left.
class IntervalDevice {
 public:
  explicit IntervalDevice(const GpuParams& params)
      : params_(params), memory_(params.memory, params.cores, params.clock_mhz) {}
  // Runs a launch as IntervalMachine does, and returns what it is alone, except for the memory's counts,
  // which are those of all launches up to this one.
  IntervalEstimate run(const exec::World& world, bool warm);
  const IntervalEstimate& sum() const { return sum_; }  // of all launches

 private:
  const GpuParams params_;
  MemoryModel memory_;
  Cycle now_ = 0;
  IntervalEstimate sum_;
};

}  // namespace glint::pipeline

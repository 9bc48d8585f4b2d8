// Estimates what a whole launch would have counted from the batches of a sampled run, with intervals.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "pipeline/sampling/batch_counts.h"
#include "pipeline/sampling/estimate.h"
#include "pipeline/sampling/sample_plan.h"

namespace glint::pipeline {

// Holds what the machine has counted between the starts of two segments, when it was full.
struct SampleBatch {
  uint32_t started = 0;  // number of timed blocks that had started at its end
  BatchCounts counts{};
};

// Holds what a block did.
struct BlockWork {
  uint64_t instructions = 0, nodes = 0;
};

// Holds requests between the L2 and DRAM. A request has a sector, or as many as DRAM moves at a time.
struct DramTraffic {
  double reads = 0, writes = 0;
  double unwritten = 0;  // writes that would still have to follow: of sectors that the L2 holds or has lost
  double l2 = 0;         // as many requests have the L2's bytes
  double clocks = 0;     // DRAM clocks in which data of one request move, by the configuration
};

struct SampleCounts {
  const SamplePlan* plan = nullptr;
  std::array<std::vector<BlockWork>, size_t(Stratum::Count)> work;  // of the untimed blocks, in launch order
  std::vector<SampleBatch> batches;
  BatchCounts total{};             // of the sample, from its launch to its end
  bool writes_are_missing = true;  // DRAM does not get the dirty lines that functional blocks displace
  bool stacks_leave_l2 = false;    // those of the whole machine do not fit into it
  DramTraffic traffic{};           // at its end
  // These had been counted when a half of the timed blocks had started.
  BatchCounts half{};
  DramTraffic traffic_of_half{};
};

// Estimates cycles, IPC, hit rates and the use of DRAM.
//
// Cycles are those of the sample and, for the work that it lacks, the batches' cycles for each node visited,
// or for each instruction in a launch without rays (a ratio estimator). The start and the end of a launch,
// when the machine is not full, are so counted once. The work of the launch is summed over strata. Other
// estimates are quotients of the sample's counts, or, where the machine's stacks do not fit into the L2, hit
// rates are those of counts that are estimated as cycles are. A hit rate is left out where the sample has so
// few reads that chance alone could be a larger error than the method's. The use of DRAM also has the writes
// that the sample has left to be done: a whole launch writes back all that it makes dirty, but for what the
// L2 still holds at its end, which is its part of all that went through the L2. An interval has two parts:
// the scatter of the batches, with Student's quantile for their number, and the method's own error
// (docs/sampling.md), since a sample's caches and order are not those of the whole launch.
std::vector<Estimate> estimate(const SampleCounts& counts);

}  // namespace glint::pipeline

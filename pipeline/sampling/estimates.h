// Estimates what a whole launch would have counted from the batches of a sampled run, with intervals.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/stats.h"
#include "pipeline/sampling/sample_plan.h"

namespace glint::pipeline {

// Names what a batch counts.
enum class BatchCount : uint8_t {
  Cycles,
  Instructions,
  Nodes,
  L1Reads,
  L1Hits,
  L2Reads,
  L2Hits,
  DramClocks,
  DramBusy,
  Count
};
using BatchCounts = std::array<double, size_t(BatchCount::Count)>;
inline double at(const BatchCounts& counts, BatchCount which) {
  return counts[size_t(which)];
}

// Holds what the machine has counted between the starts of two segments, when it was full.
struct SampleBatch {
  uint32_t started = 0;  // number of timed blocks that had started at its end
  BatchCounts counts{};
};

// Holds what a block did.
struct BlockWork {
  uint64_t instructions = 0, nodes = 0;
};

struct SampleCounts {
  const SamplePlan* plan = nullptr;
  std::array<std::vector<BlockWork>, size_t(Stratum::Count)> work;  // of the untimed blocks, in launch order
  std::vector<SampleBatch> batches;
  BatchCounts total{};  // of the sample, from its launch to its end
};

struct Estimate {
  std::string_view name, unit, doc;
  double value = 0;
  double low = 0, high = 0;  // a 95 % interval
};

// Estimates cycles, IPC, hit rates and the use of DRAM.
//
// Cycles are those of the sample and, for the work that it lacks, the batches' cycles for each node visited,
// or for each instruction in a launch without rays (a ratio estimator). The start and the end of a launch,
// when the machine is not full, are so counted once. The work of the launch is summed over strata. Other
// estimates are quotients of the sample's counts. An interval has two parts: the scatter of the batches, with
// Student's quantile for their number, and the method's own error (docs/sampling.md), since a sample's caches
// and order are not those of the whole launch.
std::vector<Estimate> estimate(const SampleCounts& counts);

// Holds estimates as statistics: NAME, NAME_low and NAME_high.
class SampleStats : public stats::Group {
 public:
  SampleStats(stats::Group* parent, std::vector<Estimate> estimates);
  const std::vector<Estimate>& estimates() const { return estimates_; }

 private:
  const std::vector<Estimate> estimates_;
  std::vector<std::string> names_, texts_;  // the statistics refer to them
  std::vector<std::unique_ptr<stats::Value>> values_;
};

}  // namespace glint::pipeline

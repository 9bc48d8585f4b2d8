// Estimates what all launches of a run would have counted from those that were timed, with intervals.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pipeline/sampling/batch_counts.h"
#include "pipeline/sampling/estimate.h"

namespace glint::pipeline {

// Holds a launch that was timed for others of its cluster.
struct TimedLaunch {
  uint32_t launch = 0, cluster = 0;
  double weight = 1;  // how many launches it stands for; the weights of a cluster add up to its size
  BatchCounts counts{};
  double functional_instructions = 0, functional_nodes = 0;  // of the same launch
};

// Holds what all launches have done on the functional machine.
struct LaunchTotals {
  double instructions = 0, nodes = 0;
};

// Estimates cycles, IPC, hit rates and the use of DRAM (stratified sampling). A sum over all launches is that
// over the timed ones, each multiplied by its weight; instructions and nodes are those of the functional
// machine, with what timed launches differ from it by. Rates are quotients of sums. The scatter of an
// estimate is that within clusters, of which a cluster whose launches are all timed has none. Student's
// quantile is that for the timed launches less the clusters.
std::vector<Estimate> estimate_launches(std::span<const TimedLaunch> timed, const LaunchTotals& totals);

// Returns the timed launches as a table: cluster and weight, and what each counted.
std::string launches_csv(std::span<const TimedLaunch> timed);

}  // namespace glint::pipeline

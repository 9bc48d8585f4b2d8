// Computes the estimates of a sampled run and their intervals.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/estimates.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/student.h"

namespace glint::pipeline {
namespace {

// These stand for what the method is wrong by beyond the scatter of its batches, as shares of the value for
// counts and as differences for fractions. With them, intervals cover at least 95 % of what whole runs count.
// Source: bench/sampling_table.py over the 46 workloads at 512x512 on `mobile` (docs/sampling.md).
constexpr MethodError kError{.cycles = 0.03, .l1 = 0.01, .l2 = 0.03, .utilisation = 0.04};
// These do where stacks leave the L2. Source: bench/sampling/desktop.csv, 30 workloads at 512x512 on
// `desktop`.
constexpr MethodError kErrorOfFullL2{.cycles = 0.07, .l1 = 0.01, .l2 = 0.03, .utilisation = 0.04};
// These do for launches whose blocks touch lines of their own. Source: the same over the launches of
// bench/sampled_launches.py.
constexpr MethodError kErrorOfOwnLines{.cycles = 0.06, .l1 = 0.05, .l2 = 0.07, .utilisation = 0.05};
// Neighbours in a row of a grid meet in one L1 more often on a part of the machine, where L1s are fewer.
constexpr MethodError kErrorOfGrids{.cycles = 0.06, .l1 = 0.15, .l2 = 0.07, .utilisation = 0.05};

constexpr double kLargestVariance = 0.25;  // of whether a read hits

// Returns the quotient of two counts over the batches, and its variance by the scatter of the batches around
// it.
Uncertain quotient(const SampleCounts& counts, BatchCount above, BatchCount below) {
  double y = 0, x = 0, squares = 0;
  for (const SampleBatch& batch : counts.batches) y += at(batch.counts, above), x += at(batch.counts, below);
  if (x <= 0) return {};
  for (const SampleBatch& batch : counts.batches) {
    const double rest = at(batch.counts, above) - y / x * at(batch.counts, below);
    squares += rest * rest;
  }
  const auto n = double(counts.batches.size());
  return {y / x, n > 1 ? n / (n - 1) * squares / (x * x) : 0};
}

// Returns the launch's sum of something that each block did. Blocks of a stratum are a systematic sample,
// whose variance the differences between neighbours tell (Wolter 1985).
Uncertain sum_over_strata(const SampleCounts& counts, BatchCount timed, uint64_t BlockWork::*of) {
  Uncertain sum{at(counts.total, timed), 0};
  for (size_t s = 0; s < counts.work.size(); ++s) {
    const std::vector<BlockWork>& blocks = counts.work[s];
    const auto n = double(blocks.size()), size = double(counts.plan->sizes[s]);
    if (blocks.empty() || size == 0) continue;
    double total = 0, differences = 0;
    for (size_t i = 0; i < blocks.size(); ++i) {
      total += double(blocks[i].*of);
      if (i > 0) differences += std::pow(double(blocks[i].*of) - double(blocks[i - 1].*of), 2);
    }
    sum.value += size * total / n;
    if (n > 1) sum.variance += size * size * std::max(0.0, 1 - n / size) / n * differences / (2 * (n - 1));
  }
  return sum;
}

// Returns the data clocks that the sample's writes to DRAM lack of its part of a whole launch, in which
// `measure` is counted `work` times. What the machine makes dirty once, such as the stacks of the blocks that
// it holds, is dirty in the second half of the sample. What it makes dirty from then on grows with the work.
double missing_write_clocks(const SampleCounts& counts, BatchCount measure, double work) {
  const DramTraffic &end = counts.traffic, &begin = counts.traffic_of_half;
  const double timed = at(counts.total, measure), later = timed - at(counts.half, measure),
               requests = end.reads + end.writes;
  // A sample may have left all of its writes to be done.
  const double clocks = requests > 0 ? at(counts.total, BatchCount::DramBusy) / requests : end.clocks;
  if (!(clocks > 0) || later <= 0) return 0;
  const double written = work / later * (end.writes + end.unwritten - begin.writes - begin.unwritten),
               read = work / later * (end.reads - begin.reads);
  if (written <= 0) return 0;
  const double held = written * std::min(1.0, end.l2 / (written + read));
  return ((written - held) * timed / work - end.writes) * clocks;
}

}  // namespace

std::vector<Estimate> estimate(const SampleCounts& counts) {
  const double scale = counts.plan->scale;
  const bool has_rays = at(counts.total, BatchCount::Nodes) > 0;
  const BatchCount measure = has_rays ? BatchCount::Nodes : BatchCount::Instructions;
  const MethodError& own = counts.plan->row > 0         ? kErrorOfGrids
                           : !counts.writes_are_missing ? kErrorOfOwnLines
                           : counts.stacks_leave_l2     ? kErrorOfFullL2
                                                        : kError;
  RunSums sums;
  sums.instructions = sum_over_strata(counts, BatchCount::Instructions, &BlockWork::instructions);
  if (has_rays) sums.nodes = sum_over_strata(counts, BatchCount::Nodes, &BlockWork::nodes);
  const Uncertain work = has_rays ? sums.nodes : sums.instructions,
                  slope = quotient(counts, BatchCount::Cycles, measure);
  const double rest = work.value / scale - at(counts.total, measure);
  sums.cycles = {at(counts.total, BatchCount::Cycles) + slope.value * rest,
                 rest * rest * slope.variance + std::pow(slope.value / scale, 2) * work.variance};
  for (size_t i = 0; i < kFractions.size(); ++i) {
    const auto& [which, above, below, error] = kFractions[i];
    const bool is_dram = which == Quantity::DramUtilisation;
    const double of_sample = at(counts.total, below);
    // Choice: where stacks leave the L2, full batches tell what was read of the work that the sample lacks.
    // Other samples, and DRAM's use, do as well or better without (docs/sampling.md).
    const auto count_of = [&](BatchCount count) {
      const double lacking = counts.stacks_leave_l2 && !is_dram ? rest : 0;
      return at(counts.total, count) + lacking * quotient(counts, count, measure).value;
    };
    const double x = count_of(below);
    double y = count_of(above);
    if (is_dram && counts.writes_are_missing) y += missing_write_clocks(counts, measure, work.value);
    // A few reads may all hit, and say nothing of the launch's first ones, which miss. DRAM's clocks are
    // many.
    const bool says_enough = is_dram || of_sample * own.*error * own.*error >= kLargestVariance;
    if (x > 0 && says_enough)
      sums.fractions[i] = {std::clamp(y / x, 0.0, 1.0), quotient(counts, above, below).variance};
  }
  return make_estimates(sums, student_quantile(uint32_t(counts.batches.size()) - 1), own);
}

}  // namespace glint::pipeline

// Computes the estimates of a sampled run and their intervals.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/estimates.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/student.h"

namespace glint::pipeline {
namespace {

// These are the root mean squares of what the method was wrong by beyond the scatter of its batches, as
// shares of the value for counts and as differences for fractions. Source: bench/sampling_table.py over the
// 46 workloads at 512x512 on `mobile` (docs/sampling.md).
constexpr MethodError kError{.cycles = 0.035, .l1 = 0.015, .l2 = 0.03, .utilisation = 0.05};

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
    if (blocks.empty()) continue;
    double total = 0, differences = 0;
    for (size_t i = 0; i < blocks.size(); ++i) {
      total += double(blocks[i].*of);
      if (i > 0) differences += std::pow(double(blocks[i].*of) - double(blocks[i - 1].*of), 2);
    }
    sum.value += size * total / n;
    if (n > 1) sum.variance += size * size * (1 - n / size) / n * differences / (2 * (n - 1));
  }
  return sum;
}

// Makes intervals for one sampled run.
class Estimator {
 public:
  explicit Estimator(const SampleCounts& counts)
      : counts_(counts), student_(student_quantile(uint32_t(counts.batches.size()) - 1)) {}

  std::vector<Estimate> all();

 private:
  void add(Quantity which, Uncertain value, double error) {
    out_.push_back(make_estimate(which, value, student_, error));
  }
  void add_fraction(Quantity which, BatchCount above, BatchCount below, double error) {
    const double x = at(counts_.total, below);
    if (x > 0) add(which, {at(counts_.total, above) / x, quotient(counts_, above, below).variance}, error);
  }

  const SampleCounts& counts_;
  const double student_;
  std::vector<Estimate> out_;
};

std::vector<Estimate> Estimator::all() {
  const double scale = counts_.plan->scale;
  const Uncertain instructions = sum_over_strata(counts_, BatchCount::Instructions, &BlockWork::instructions),
                  nodes = sum_over_strata(counts_, BatchCount::Nodes, &BlockWork::nodes);
  const bool has_rays = at(counts_.total, BatchCount::Nodes) > 0;
  const BatchCount measure = has_rays ? BatchCount::Nodes : BatchCount::Instructions;
  const Uncertain work = has_rays ? nodes : instructions,
                  slope = quotient(counts_, BatchCount::Cycles, measure);
  const double rest = work.value / scale - at(counts_.total, measure);
  const Uncertain cycles = {at(counts_.total, BatchCount::Cycles) + slope.value * rest,
                            rest * rest * slope.variance + std::pow(slope.value / scale, 2) * work.variance};
  add(Quantity::Cycles, cycles, kError.cycles * cycles.value);
  const double ipc = instructions.value / cycles.value;
  add(Quantity::Ipc,
      {ipc, ipc * ipc *
                (cycles.variance / std::pow(cycles.value, 2) +
                 instructions.variance / std::pow(std::max(1.0, instructions.value), 2))},
      kError.cycles * ipc);
  add(Quantity::Instructions, instructions, 0);
  if (has_rays) add(Quantity::Nodes, nodes, 0);
  add_fraction(Quantity::L1HitRate, BatchCount::L1Hits, BatchCount::L1Reads, kError.l1);
  add_fraction(Quantity::L2HitRate, BatchCount::L2Hits, BatchCount::L2Reads, kError.l2);
  add_fraction(Quantity::DramUtilisation, BatchCount::DramBusy, BatchCount::DramClocks, kError.utilisation);
  return std::move(out_);
}

}  // namespace

std::vector<Estimate> estimate(const SampleCounts& counts) {
  return Estimator(counts).all();
}

}  // namespace glint::pipeline

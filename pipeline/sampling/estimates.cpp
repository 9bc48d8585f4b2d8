// Computes the estimates of a sampled run and their intervals.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/estimates.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "base/student.h"

namespace glint::pipeline {
namespace {

// These are the root mean squares of what the method was wrong by beyond the scatter of its batches, as
// shares of the value for counts and as differences for fractions. Source: bench/sampling_table.py over the
// 46 workloads at 512x512 on `mobile` (docs/sampling.md).
struct MethodError {
  double cycles = 0.035, l1 = 0.015, l2 = 0.03, utilisation = 0.05;
};
constexpr MethodError kError;
constexpr double kNormal = 1.96;  // of the method's error, which was measured over many workloads

// Holds a value and its variance.
struct Uncertain {
  double value = 0, variance = 0;
};

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
  void add(std::string_view name, std::string_view unit, std::string_view doc, Uncertain value, double error,
           double most) {
    const double half = std::hypot(student_ * std::sqrt(value.variance), kNormal * error);
    out_.push_back({name, unit, doc, value.value, std::max(0.0, value.value - half),
                    std::min(most, value.value + half)});
  }
  void add_fraction(std::string_view name, std::string_view doc, BatchCount above, BatchCount below,
                    double error) {
    const double x = at(counts_.total, below);
    if (x <= 0) return;
    add(name, "fraction", doc, {at(counts_.total, above) / x, quotient(counts_, above, below).variance},
        error, 1);
  }

  const SampleCounts& counts_;
  const double student_;
  std::vector<Estimate> out_;
};

std::vector<Estimate> Estimator::all() {
  constexpr double kNoLimit = 1e300;
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
  add("cycles", "cycle", "Estimated cycles of the whole launch.", cycles, kError.cycles * cycles.value,
      kNoLimit);
  const double ipc = instructions.value / cycles.value;
  add("ipc", "instruction/cycle", "Estimated warp instructions per cycle of all cores.",
      {ipc, ipc * ipc *
                (cycles.variance / std::pow(cycles.value, 2) +
                 instructions.variance / std::pow(std::max(1.0, instructions.value), 2))},
      kError.cycles * ipc, kNoLimit);
  add("instructions", "instruction", "Estimated warp instructions of the whole launch.", instructions, 0,
      kNoLimit);
  if (has_rays) add("nodes", "node", "Estimated nodes that all rays visit.", nodes, 0, kNoLimit);
  add_fraction("l1_hit_rate", "Estimated fraction of the reads of the L1s that hit.", BatchCount::L1Hits,
               BatchCount::L1Reads, kError.l1);
  add_fraction("l2_hit_rate", "Estimated fraction of the reads of the L2 that hit.", BatchCount::L2Hits,
               BatchCount::L2Reads, kError.l2);
  add_fraction("dram_utilisation", "Estimated fraction of DRAM clocks in which data move.",
               BatchCount::DramBusy, BatchCount::DramClocks, kError.utilisation);
  return std::move(out_);
}

}  // namespace

std::vector<Estimate> estimate(const SampleCounts& counts) {
  return Estimator(counts).all();
}

SampleStats::SampleStats(stats::Group* parent, std::vector<Estimate> estimates)
    : Group(parent, "sample"), estimates_(std::move(estimates)) {
  names_.reserve(3 * estimates_.size());
  const auto add = [&](const Estimate& estimate, const char* ending, double value, std::string doc) {
    texts_.push_back(std::move(doc));
    names_.push_back(std::string(estimate.name) + ending);
    values_.push_back(std::make_unique<stats::Value>(
        this, names_.back(), estimate.unit, [value] { return value; }, texts_.back()));
  };
  texts_.reserve(3 * estimates_.size());
  for (const Estimate& one : estimates_) {
    add(one, "", one.value, std::string(one.doc));
    add(one, "_low", one.low, "Lower end of the 95 % interval of " + std::string(one.name) + ".");
    add(one, "_high", one.high, "Upper end of the 95 % interval of " + std::string(one.name) + ".");
  }
}

}  // namespace glint::pipeline

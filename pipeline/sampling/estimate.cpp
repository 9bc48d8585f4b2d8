// Makes estimates, and shows them as statistics.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/estimate.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace glint::pipeline {
namespace {

struct Described {
  std::string_view name, unit, doc;
};
// They are in the order of Quantity.
constexpr Described kDescribed[] = {
    {"cycles", "cycle", "Estimated cycles of the whole run."},
    {"ipc", "instruction/cycle", "Estimated warp instructions per cycle of all cores."},
    {"instructions", "instruction", "Estimated warp instructions of the whole run."},
    {"nodes", "node", "Estimated nodes that all rays visit."},
    {"l1_hit_rate", "fraction", "Estimated fraction of the reads of the L1s that hit."},
    {"l2_hit_rate", "fraction", "Estimated fraction of the reads of the L2 that hit."},
    {"dram_utilisation", "fraction", "Estimated fraction of DRAM clocks in which data move."}};
static_assert(std::size(kDescribed) == size_t(Quantity::Count));

constexpr double kNormal = 1.96;  // of the method's error, which was measured over many workloads

}  // namespace

std::string_view name_of(Quantity which) {
  return kDescribed[size_t(which)].name;
}

Estimate make_estimate(Quantity which, Uncertain value, double student, double error) {
  const Described& described = kDescribed[size_t(which)];
  const double half = std::hypot(student * std::sqrt(value.variance), kNormal * error);
  const double most = described.unit == "fraction" ? 1 : 1e300;
  return {described.name,
          described.unit,
          described.doc,
          value.value,
          std::max(0.0, value.value - half),
          std::min(most, value.value + half)};
}

std::vector<Estimate> make_estimates(const RunSums& sums, double student, const MethodError& error) {
  std::vector<Estimate> out;
  const auto add = [&](Quantity which, Uncertain value, double own) {
    out.push_back(make_estimate(which, value, student, own));
  };
  const auto relative = [](Uncertain value) {
    return value.variance / std::max(1.0, value.value * value.value);
  };
  add(Quantity::Cycles, sums.cycles, error.cycles * sums.cycles.value);
  const double ipc = sums.instructions.value / sums.cycles.value;
  add(Quantity::Ipc, {ipc, ipc * ipc * (relative(sums.cycles) + relative(sums.instructions))},
      error.cycles * ipc);
  add(Quantity::Instructions, sums.instructions, 0);
  if (sums.nodes.value > 0) add(Quantity::Nodes, sums.nodes, 0);
  for (size_t i = 0; i < kFractions.size(); ++i)
    if (sums.fractions[i]) add(kFractions[i].which, *sums.fractions[i], error.*kFractions[i].error);
  return out;
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

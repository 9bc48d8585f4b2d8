// Computes the estimates of a run whose launches were sampled.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/launch_estimates.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <map>
#include <utility>

#include "base/student.h"

namespace glint::pipeline {
namespace {

// Source: bench/sampling_table.py --launches on `mobile` (docs/sampling.md).
constexpr MethodError kLaunchError{.cycles = 0.01, .l1 = 0.01, .l2 = 0.02, .utilisation = 0.02};

// Says what of a launch is summed up.
using Part = std::function<double(const TimedLaunch&)>;

Part part(BatchCount which) {
  return [which](const TimedLaunch& one) { return at(one.counts, which); };
}

class LaunchEstimator {
 public:
  LaunchEstimator(std::span<const TimedLaunch> timed, const LaunchTotals& totals)
      : timed_(timed), totals_(totals) {
    for (const TimedLaunch& one : timed) clusters_[one.cluster].push_back(&one);
    student_ = student_quantile(uint32_t(timed.size() - clusters_.size()));
  }

  std::vector<Estimate> all();

 private:
  // Returns a sum over all launches.
  Uncertain sum(const Part& of) const;
  // Returns a quotient of such sums, whose scatter is that of its linear part.
  Uncertain quotient(BatchCount above, BatchCount below) const;

  const std::span<const TimedLaunch> timed_;
  const LaunchTotals totals_;
  std::map<uint32_t, std::vector<const TimedLaunch*>> clusters_;
  double student_ = 0;
};

Uncertain LaunchEstimator::sum(const Part& of) const {
  Uncertain out;
  for (const auto& [number, cluster] : clusters_) {
    const auto n = double(cluster.size());
    double size = 0, mean = 0, squares = 0;
    for (const TimedLaunch* one : cluster) {
      size += one->weight, mean += of(*one) / n;
      out.value += one->weight * of(*one);
    }
    for (const TimedLaunch* one : cluster) squares += std::pow(of(*one) - mean, 2);
    if (n > 1) out.variance += size * (size - n) / n * squares / (n - 1);
  }
  return out;
}

Uncertain LaunchEstimator::quotient(BatchCount above, BatchCount below) const {
  const double x = sum(part(below)).value, q = sum(part(above)).value / x;
  return {q, sum([&](const TimedLaunch& one) {
               return (at(one.counts, above) - q * at(one.counts, below)) / x;
             }).variance};
}

std::vector<Estimate> LaunchEstimator::all() {
  // A run whose launches are all timed has no error.
  const MethodError error =
      timed_.size() == size_t(sum([](const TimedLaunch&) { return 1; }).value) ? MethodError{} : kLaunchError;
  const auto with_differences = [&](double all, BatchCount which, double TimedLaunch::*functional) {
    Uncertain out = sum([&](const TimedLaunch& one) { return at(one.counts, which) - one.*functional; });
    out.value += all;
    return out;
  };
  RunSums sums;
  sums.cycles = sum(part(BatchCount::Cycles));
  sums.instructions =
      with_differences(totals_.instructions, BatchCount::Instructions, &TimedLaunch::functional_instructions);
  if (totals_.nodes > 0)
    sums.nodes = with_differences(totals_.nodes, BatchCount::Nodes, &TimedLaunch::functional_nodes);
  for (size_t i = 0; i < kFractions.size(); ++i)
    if (const auto& [which, above, below, own] = kFractions[i]; sum(part(below)).value > 0)
      sums.fractions[i] = quotient(above, below);
  return make_estimates(sums, student_, error);
}

}  // namespace

std::vector<Estimate> estimate_launches(std::span<const TimedLaunch> timed, const LaunchTotals& totals) {
  return LaunchEstimator(timed, totals).all();
}

std::string launches_csv(std::span<const TimedLaunch> timed) {
  std::string out = "launch,cluster,weight," + batch_columns() + "\n";
  for (const TimedLaunch& one : timed)
    out += fmt::format("{},{},{}{}\n", one.launch, one.cluster, one.weight, batch_cells(one.counts));
  return out;
}

}  // namespace glint::pipeline

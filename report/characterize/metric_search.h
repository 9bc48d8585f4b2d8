// The few metrics that tell workloads apart as all of them do, by a genetic algorithm as in MICA (Hoste and
// Eeckhout 2006, 2007).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace glint::report {

// Scores sets of metrics: Pearson's correlation of the distances between workloads in these metrics with
// those in all metrics. Choice: MICA's fitness also falls with the number of metrics; here that number is
// given, so the factor is the same for all sets.
class DistanceFitness {
 public:
  explicit DistanceFitness(const Eigen::MatrixXd& standardised);
  Eigen::Index metrics() const { return squares_.cols(); }
  // -1 to 1; `chosen`: different columns.
  double operator()(const std::vector<int>& chosen) const;

 private:
  Eigen::ArrayXXd squares_;  // pairs of workloads x metrics: squared differences
  Eigen::ArrayXd full_;      // distances in all metrics, centred, of length 1
};

// Choice: MICA names no sizes. With these the best of ten seeds is found by each of them on the LumiBench
// metrics (docs/characterization.md).
struct SearchSettings {
  int count = 8;          // metrics to choose
  uint64_t seed = 1;      // same seed, same result
  int islands = 10;       // populations that evolve apart
  int population = 100;   // sets of an island
  int exchange = 30;      // generations after which each island's best goes to the next one
  int patience = 80;      // generations without a better set that end the search
  int generations = 600;  // most of them
};

struct ChosenMetrics {
  struct Metric {
    int column = 0;
    double fitness_without = 0;  // of the others alone: what this one is worth
  };
  std::vector<Metric> metrics;  // those worth most first
  double fitness = 0;
  int generations = 0;
  int64_t evaluations = 0;
};

// Ends with exchanges of single metrics until none helps: no set that differs in one metric is better.
// `settings.count` is cut to the number of metrics.
ChosenMetrics choose_metrics(const DistanceFitness& fitness, const SearchSettings& settings);

}  // namespace glint::report

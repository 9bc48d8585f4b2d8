// Finds the few metrics that tell workloads apart as all metrics do, by a genetic algorithm as in MICA
// (Hoste, Eeckhout).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace glint::report {

// Scores sets of metrics by Pearson's correlation of the distances between workloads in these metrics with
// those in all metrics. Choice: MICA's fitness also falls with the number of metrics (Hoste and Eeckhout
// 2006, 2007). Here that number is given, so the factor is the same for all sets.
class DistanceFitness {
 public:
  explicit DistanceFitness(const Eigen::MatrixXd& standardised);
  Eigen::Index metrics() const { return squares_.cols(); }
  // Returns -1 to 1. `chosen` holds different columns.
  double operator()(const std::vector<int>& chosen) const;

 private:
  Eigen::ArrayXXd squares_;  // pairs of workloads x metrics: squared differences
  Eigen::ArrayXd full_;      // distances in all metrics, centred, of length 1
};

// Holds the settings of the search. Choice: MICA names no sizes. With these, each of ten seeds finds the best
// set of all ten on the LumiBench metrics (docs/characterization.md).
struct SearchSettings {
  int count = 8;          // number of metrics to choose
  uint64_t seed = 1;      // same seed, same result
  int islands = 10;       // number of populations that evolve apart
  int population = 100;   // number of sets of an island
  int exchange = 30;      // generations after which each island's best goes to the next one
  int patience = 80;      // generations without a better set that end the search
  int generations = 600;  // the most generations
};

struct ChosenMetrics {
  struct Metric {
    int column = 0;
    double fitness_without = 0;  // fitness of the set without this metric, which shows its worth
  };
  std::vector<Metric> metrics;  // ordered by worth, the greatest first
  double fitness = 0;
  int generations = 0;
  int64_t evaluations = 0;
};

// Chooses metrics. It ends with exchanges of single metrics until none helps, so no set that differs in one
// metric is better. `settings.count` is cut to the number of metrics.
ChosenMetrics choose_metrics(const DistanceFitness& fitness, const SearchSettings& settings);

}  // namespace glint::report

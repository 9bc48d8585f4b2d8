// Chooses a representative subset, one workload per cluster, and judges how well it stands for all.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "report/characterize/feature_table.h"

namespace glint::report {

struct Representative {
  int row = 0, cluster = 0;
  double distance = 0;  // distance to the centre of its cluster
};

// Returns one workload of each cluster, ordered by cluster. It is the one nearest to the centre (the mean of
// the cluster's scores) whose scene no other cluster has given yet, or the nearest when all scenes are taken.
// Small clusters choose first, because they have the least choice.
std::vector<Representative> representatives(const FeatureTable& table, const Eigen::MatrixXd& scores,
                                            const std::vector<int>& clusters);

// Returns the mean distance of all workloads to the nearest of `rows`, as a fraction of the mean distance
// between two workloads. 0 says that `rows` has every workload. The value is below 1, and smaller is better.
double coverage_error(const Eigen::MatrixXd& scores, const std::vector<int>& rows);

// Holds the speed-ups of some workloads from one configuration to another, and those of all workloads, as in
// the paper's check of its subset.
struct SpeedUps {
  struct Range {
    double mean = 0, least = 0, most = 0;  // geometric mean
    std::string slowest, fastest;          // workloads of least and most
  };
  Range all, subset;
  double error() const { return subset.mean / all.mean - 1; }
};

// Compares two tables of metrics with a column `cycles`. Throws UserError when one lacks the column or a
// workload of `names`. Workloads that only one of the two tables has are left out.
SpeedUps speed_ups(const std::string& before, const std::string& before_name, const std::string& after,
                   const std::string& after_name, const std::vector<std::string>& names);

}  // namespace glint::report

// The numbers that workloads are compared by: a row a workload, a column a metric that tells them apart.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

namespace glint::report {

struct FeatureTable {
  struct Dropped {
    std::string column, why;
  };
  std::vector<std::string> workloads;  // distinct
  std::vector<std::string> scenes,
      shaders;  // of each workload; from its name (SCENE_SHADER) where the table has no such columns
  std::vector<std::string> metrics;
  Eigen::MatrixXd values;        // workloads x metrics, as they stand in the file
  Eigen::MatrixXd standardised;  // each column with mean 0 and variance 1 (over n, not n - 1)
  std::vector<Dropped> dropped;  // columns that were left out

  Eigen::Index rows() const { return values.rows(); }
  Eigen::Index columns() const { return values.cols(); }
};

// From metrics.csv of `glint bench`, or any table whose first column names the workloads. Columns that say
// which run it was and the host's speed are no metrics; dropped with a reason are: columns of text, with an
// empty cell, constant, or equal to an earlier one. UserError where there are fewer than three workloads,
// fewer than two metrics remain, or a workload stands there twice.
FeatureTable feature_table(const std::string& csv, const std::string& name);

// z-scores of each column. Every column has to vary.
Eigen::MatrixXd standardised(const Eigen::MatrixXd& values);

// Euclidean distances between rows, pair (i, j) with i < j at the place where SciPy's pdist has it.
Eigen::VectorXd pairwise_distances(const Eigen::MatrixXd& rows);

}  // namespace glint::report

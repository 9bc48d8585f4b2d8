// Holds the numbers by which workloads are compared: a row per workload, and a column per metric.
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
  // These are the scene and the shader set of each workload. They come from its name (SCENE_SHADER) when the
  // table has no such columns.
  std::vector<std::string> scenes, shaders;
  std::vector<std::string> metrics;
  Eigen::MatrixXd values;        // workloads x metrics, as they are in the file
  Eigen::MatrixXd standardised;  // each column with mean 0 and variance 1 (over n, not n - 1)
  std::vector<Dropped> dropped;  // columns that were left out

  Eigen::Index rows() const { return values.rows(); }
  Eigen::Index columns() const { return values.cols(); }
};

// Makes the table from metrics.csv of `glint bench`, or from any table whose first column names the
// workloads. Columns that identify the run, and the host's speed, are not metrics. Columns are dropped with a
// reason when they are text, have an empty cell, are constant, or are equal to an earlier one. Throws
// UserError when there are fewer than three workloads, when fewer than two metrics remain, or when a workload
// is in the table twice.
FeatureTable feature_table(const std::string& csv, const std::string& name);

// Returns the z-scores of each column. Every column has to vary.
Eigen::MatrixXd standardised(const Eigen::MatrixXd& values);

// Returns the Euclidean distances between rows. Pair (i, j) with i < j is at the place where SciPy's pdist
// has it.
Eigen::VectorXd pairwise_distances(const Eigen::MatrixXd& rows);

}  // namespace glint::report

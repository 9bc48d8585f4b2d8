// Finds principal components of standardised metrics: the directions in which workloads differ most.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

namespace glint::report {

struct PrincipalComponents {
  // These are the eigenvalues of the correlation matrix, largest first, one per metric. Their sum is the
  // number of metrics.
  Eigen::VectorXd eigenvalues;
  Eigen::Index kept = 0;       // number of those above 1 (Kaiser's criterion), at least one
  Eigen::MatrixXd directions;  // metrics x kept, unit columns; the entry of largest size is positive
  // The rows are metrics and the columns kept components. Each value is a direction times the root of its
  // eigenvalue, which is the correlation of metric and component.
  Eigen::MatrixXd loadings;
  Eigen::MatrixXd scores;  // workloads x kept

  double explained() const {
    return eigenvalues.head(kept).sum() / eigenvalues.sum();
  }  // share of the variance, 0 to 1
};

// Computes the components. `standardised` has workloads x metrics, and every column has mean 0 and variance
// 1.
PrincipalComponents principal_components(const Eigen::MatrixXd& standardised);

}  // namespace glint::report

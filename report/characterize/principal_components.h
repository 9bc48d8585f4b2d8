// Principal components of standardised metrics: the directions in which workloads differ most.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

namespace glint::report {

struct PrincipalComponents {
  Eigen::VectorXd eigenvalues;  // of the correlation matrix, largest first, one a metric; their sum is the
                                // number of metrics
  Eigen::Index kept = 0;        // those above 1 (Kaiser's criterion), at least one
  Eigen::MatrixXd directions;   // metrics x kept, unit columns; the entry of largest size is positive
  Eigen::MatrixXd loadings;  // metrics x kept: directions times the root of the eigenvalue = correlation of
                             // metric and component
  Eigen::MatrixXd scores;    // workloads x kept

  double explained() const {
    return eigenvalues.head(kept).sum() / eigenvalues.sum();
  }  // share of the variance, 0 to 1
};

// `standardised`: workloads x metrics, every column of mean 0 and variance 1.
PrincipalComponents principal_components(const Eigen::MatrixXd& standardised);

}  // namespace glint::report

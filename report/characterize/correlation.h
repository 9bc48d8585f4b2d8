// Computes Pearson's correlation of two series.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>

namespace glint::report {

// Returns -1 to 1, or 0 when one of the two does not vary. Both series have the same length.
inline double correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::ArrayXd x = a.array() - a.mean(), y = b.array() - b.mean();
  const double size = std::sqrt((x * x).sum() * (y * y).sum());
  return size > 0 ? (x * y).sum() / size : 0;
}

}  // namespace glint::report

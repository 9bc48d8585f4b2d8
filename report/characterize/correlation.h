// Pearson's correlation of two series.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>

namespace glint::report {

// -1 to 1; 0 where one of the two does not vary. Both have the same length.
inline double correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::ArrayXd x = a.array() - a.mean(), y = b.array() - b.mean();
  const double size = std::sqrt((x * x).sum() * (y * y).sum());
  return size > 0 ? (x * y).sum() / size : 0;
}

}  // namespace glint::report

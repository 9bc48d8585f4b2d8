// Computes principal components by the eigenvectors of the correlation matrix.
// SPDX-License-Identifier: Apache-2.0
#include "report/characterize/principal_components.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace glint::report {

PrincipalComponents principal_components(const Eigen::MatrixXd& standardised) {
  const Eigen::MatrixXd correlation = standardised.transpose() * standardised / double(standardised.rows());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlation);
  PrincipalComponents out;
  // Rounding leaves some values a little below 0.
  out.eigenvalues = solver.eigenvalues().reverse().cwiseMax(0);
  out.kept = std::max<Eigen::Index>(1, (out.eigenvalues.array() > 1).count());
  out.directions = solver.eigenvectors().rowwise().reverse().leftCols(out.kept);
  for (auto direction : out.directions.colwise()) {
    // A direction and its opposite are the same component. One of them is chosen, so that every machine shows
    // the same picture.
    Eigen::Index largest = 0;
    direction.cwiseAbs().maxCoeff(&largest);
    if (direction[largest] < 0) direction = -direction;
  }
  out.loadings = out.directions * out.eigenvalues.head(out.kept).cwiseSqrt().asDiagonal();
  out.scores = standardised * out.directions;
  return out;
}

}  // namespace glint::report

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace hemi::diagnosis {

/// Least squares by normal equations over columns scaled to one, W'W c + P c = W'y, P diagonal (precision of
/// priors, zero: free). `ridge`, relative to a column's square: columns that say the same share what they
/// explain; a column of zeros gets nothing.
class ScaledNormal {
 public:
  ScaledNormal(const Eigen::MatrixXd& columns, const Eigen::VectorXd& prior, double ridge = 1e-12);
  /// From W'W itself.
  static ScaledNormal of_products(const Eigen::MatrixXd& products, double ridge);

  /// Coefficients for W'y, a column a problem.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;
  Eigen::MatrixXd covariance() const;

 private:
  ScaledNormal(Eigen::VectorXd scale, const Eigen::MatrixXd& products, const Eigen::VectorXd& prior,
               double ridge);

  Eigen::VectorXd scale_;
  Eigen::LDLT<Eigen::MatrixXd> normal_;
};

}  // namespace hemi::diagnosis

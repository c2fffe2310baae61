// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace hemi::rivals {

/// Least squares; dependent columns get no weight of their own.
struct Regression {
  Eigen::VectorXd coefficients;
  double squares = 0.0;  ///< sum of squared residuals
  Eigen::Index rank = 0;
};
Regression regress(const Eigen::MatrixXd& columns, const Eigen::VectorXd& values);

/// n ln(squares / n) + rank ln n: white Gaussian noise.
double bic(const Regression& fit, Eigen::Index samples);

/// Probability of a larger F by chance when `full` has more columns than `part`.
double f_test(const Regression& part, const Regression& full, Eigen::Index samples);

}  // namespace hemi::rivals

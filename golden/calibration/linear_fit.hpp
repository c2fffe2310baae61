// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <stdexcept>
#include <string>
#include <vector>

namespace hemi::calibration {

/// A column of a design matrix is a linear combination of the columns before it.
class RankDeficiencyError : public std::runtime_error {
 public:
  RankDeficiencyError(Eigen::Index column, const std::string& name);
  /// Index of the first dependent column.
  Eigen::Index column() const { return column_; }

 private:
  Eigen::Index column_;
};

/// Least squares y = X b + e with Var(e_i) = s^2 / w_i. All of it refers to the columns as given.
struct LinearFit {
  Eigen::VectorXd coefficients;     ///< b, one a column of X, in units of y over units of the column
  Eigen::VectorXd standard_errors;  ///< square roots of the covariance's diagonal; NaN when dof = 0
  Eigen::MatrixXd covariance;       ///< s^2 (X^T W X)^-1; NaN when dof = 0
  Eigen::VectorXd residuals;        ///< y - X b, unweighted
  double sum_of_squares = 0.0;      ///< sum of w_i residual_i^2
  Eigen::Index dof = 0;             ///< rows - columns
  double r_squared = 0.0;           ///< 1 - sum_of_squares / weighted scatter of y about its weighted mean
};

/// Ordinary least squares by Householder QR on columns scaled to unit norm.
///
/// x: rows x columns, rows >= columns >= 1; y: rows. `names` (empty, or one a column) serve the error
/// message. Throws std::invalid_argument on sizes that do not fit or values that are not finite,
/// RankDeficiencyError where a column lies in the span of those before it to within rounding. Source: Golub
/// and Van Loan, Matrix Computations, section 5.3.
LinearFit fit_linear(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                     const std::vector<std::string>& names = {});

/// The same with weights w_i > 0, inverse variances up to a common factor.
LinearFit fit_linear_weighted(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                              const Eigen::VectorXd& weights, const std::vector<std::string>& names = {});

/// Columns of x that lie in the span of the columns before them, to within rounding.
std::vector<Eigen::Index> dependent_columns(const Eigen::MatrixXd& x);

}  // namespace hemi::calibration

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "golden/calibration/autoregressive_noise.hpp"
#include "golden/calibration/rows.hpp"

namespace hemi::calibration {

/// Partial F-test of one column.
struct PartialTest {
  double coefficient;
  double standard_error;
  double f_statistic;  ///< (coefficient / standard error)^2
  double dof;          ///< Satterthwaite's denominator degrees of freedom
  double p_value;
};

/// Generalised least squares of y on any subset of the columns of x under one noise model, estimated once
/// beside all columns. Everything about a subset comes from a triangle of columns x columns, whatever the
/// number of rows.
class WhitenedRegression {
 public:
  /// x: rows x columns, of full rank, columns of similar size; y: rows. Throws RankDeficiencyError.
  WhitenedRegression(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                     const std::vector<RowRange>& segments, bool assume_white_noise);

  /// Test of column `subset[which]` in the model of the columns `subset`.
  PartialTest test(const std::vector<Eigen::Index>& subset, std::size_t which) const;
  /// Whitened sum of squares that the columns `subset` leave of what all columns explain.
  double sum_of_squares(const std::vector<Eigen::Index>& subset) const;
  const AutoregressiveNoise& noise() const { return noise_; }
  Eigen::Index rows() const { return rows_; }

 private:
  Eigen::MatrixXd information(const Eigen::VectorXd& theta, const LaggedProducts& products) const;
  double variance_factor(const Eigen::MatrixXd& information, const std::vector<Eigen::Index>& subset,
                         std::size_t which) const;

  Eigen::Index rows_;
  AutoregressiveNoise noise_;
  Eigen::MatrixXd basis_change_;                    // x = orthonormal columns * basis_change_
  Eigen::MatrixXd triangle_;                        // whitened x = orthonormal columns * triangle_
  Eigen::VectorXd projection_;                      // whitened y in those columns
  std::vector<Eigen::MatrixXd> information_plus_;   // x^T R^-1 x with one noise parameter moved up
  std::vector<Eigen::MatrixXd> information_minus_;  // and down
  std::vector<double> moved_by_;
};

}  // namespace hemi::calibration

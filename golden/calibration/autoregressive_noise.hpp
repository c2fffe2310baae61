// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "golden/calibration/rows.hpp"

namespace hemi::calibration {

/// Gaussian noise e_t = a_1 e_{t-1} + ... + a_p e_{t-p} + u_t, stationary, u white with variance s^2,
/// independent between segments; held as its partial autocorrelations r_1..r_p, each inside (-1, 1), which
/// map one to one onto the stationary a (Durbin-Levinson).
struct AutoregressiveNoise {
  Eigen::VectorXd partial;            ///< r_1..r_p; empty = white
  double innovation_variance = 0.0;   ///< s^2, squared unit of the data
  Eigen::MatrixXd covariance;         ///< of (atanh r_1..r_p, log s^2), from the likelihood's curvature
  std::vector<double> aic_per_order;  ///< Akaike's criterion for order 0, 1, ..., the largest one tried

  Eigen::Index order() const { return partial.size(); }
  /// a_1..a_p.
  Eigen::VectorXd coefficients() const;
  /// Correlation of neighbouring samples.
  double lag1_correlation() const;
  /// Number of independent samples whose mean is as uncertain as that of `rows` samples of this noise:
  /// rows * variance / (spectral density at zero frequency); rows (1 - r) / (1 + r) for order 1.
  double effective_samples(Eigen::Index rows) const;
};

/// Multiplies each segment by the inverse Cholesky factor of its noise covariance / s^2: what comes out has
/// white noise of variance s^2. The first p rows of a segment are whitened by the shorter predictors, so none
/// is lost. Rows outside the segments are left out; rows come out in the segments' order.
Eigen::MatrixXd whiten(const Eigen::MatrixXd& rows, const std::vector<RowRange>& segments,
                       const Eigen::VectorXd& partial);

/// z^T R^-1 z as a function of the noise, in a time that does not depend on the number of rows: the products
/// of lagged rows are formed once. z: rows x columns; R: noise correlation in units of s^2.
class LaggedProducts {
 public:
  LaggedProducts(const Eigen::MatrixXd& z, std::vector<RowRange> segments, Eigen::Index max_order);
  /// columns x columns; partial.size() <= max_order.
  Eigen::MatrixXd gram(const Eigen::VectorXd& partial) const;
  /// log |R|.
  double log_determinant(const Eigen::VectorXd& partial) const;
  Eigen::Index rows() const { return rows_; }
  Eigen::Index max_order() const { return max_order_; }

 private:
  std::vector<RowRange> segments_;
  Eigen::Index max_order_;
  Eigen::Index rows_;
  std::vector<Eigen::MatrixXd> products_;  // (lag i, lag j >= i), row major over the upper triangle
  Eigen::MatrixXd heads_;                  // the first max_order rows of each segment
  std::vector<RowRange> head_segments_;
};

/// Fits the noise of y = X b + e by restricted maximum likelihood (exact, order chosen by Akaike's
/// criterion).
///
/// Maximum likelihood, or an autoregression fitted to the residuals, takes the columns of X for noise that is
/// missing and finds correlation too small; the restricted likelihood is free of that to first order.
/// products: of z = [X y], X with orthonormal columns for good conditioning. white: order 0 and nothing else.
/// Source: Patterson and Thompson, Biometrika 58 (1971) 545; Cheang and Reinsel, JASA 95 (2000) 1173.
AutoregressiveNoise fit_noise(const LaggedProducts& products, bool white = false);

}  // namespace hemi::calibration

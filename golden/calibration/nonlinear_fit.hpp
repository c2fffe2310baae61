// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "golden/calibration/autoregressive_noise.hpp"
#include "golden/calibration/rows.hpp"

namespace hemi::calibration {

/// y = g(theta) + e with e a stationary autoregression, independent between segments.
struct NonlinearProblem {
  /// y - g(theta) and dg/dtheta.
  std::function<void(const Eigen::VectorXd& theta, Eigen::VectorXd& residual, Eigen::MatrixXd& jacobian)>
      evaluate;
  std::vector<RowRange> segments;
  std::vector<std::string> names;   ///< one a parameter, for messages
  Eigen::VectorXd prior_mean;       ///< what is known beforehand ...
  Eigen::VectorXd prior_deviation;  ///< ... and how well; infinite where nothing is
  /// Autocorrelation at lag 0, 1, ... rows of a noise that must be expected beside a white one, as a function
  /// of theta; empty: none.
  std::function<Eigen::VectorXd(const Eigen::VectorXd& theta)> expected_noise{};
};

struct NonlinearFit {
  Eigen::VectorXd theta;
  Eigen::MatrixXd covariance;
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;
  AutoregressiveNoise noise;
  double dof = 0.0;  ///< rows - parameters

  double standard_error(Eigen::Index i) const;
};

/// Least squares by Levenberg and Marquardt from `start`, then generalised least squares by Gauss and Newton:
/// the noise is fitted beside the Jacobian's columns by restricted likelihood: the expected noise plus a
/// white one, two numbers, unless an autoregression of free order does better by more than ten in Akaike's
/// criterion (long correlation is hard to learn from few correlation times, so what is known of it is used).
/// Residual and columns are whitened by it, until no parameter moves by more than a hundredth of its standard
/// error. Throws RankDeficiencyError where the data do not determine a parameter, std::invalid_argument for
/// fewer rows than twice the parameters. Source: Seber and Wild, Nonlinear Regression, chapters 2, 6 and 14.
NonlinearFit fit_nonlinear(const NonlinearProblem& problem, const Eigen::VectorXd& start);

}  // namespace hemi::calibration

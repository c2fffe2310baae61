// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <utility>

namespace hemi::calibration {

/// Settled points: resonator temperature at rest [degC] and its frequency [Hz].
struct SettledPoints {
  Eigen::VectorXd temperature_degc;
  Eigen::VectorXd frequency_hz;
  double resolution_hz = 0.0;  ///< step of the printed frequencies; 0 where unknown
};

/// f(T) = sum c_i (T - reference)^i, the paper's Eq. (16)-(17), with the range over which it was fitted.
class FrequencyPolynomial {
 public:
  /// coefficients ascending [Hz/degC^i], at least two; min_degc < max_degc. Throws std::invalid_argument.
  FrequencyPolynomial(Eigen::VectorXd coefficients_hz, double reference_degc, double min_degc,
                      double max_degc);

  double frequency_hz(double temperature_degc) const;
  double slope_hz_per_degc(double temperature_degc) const;

  /// Inverse by Newton's method, bisecting whenever a step would leave the bracket; exact to rounding.
  /// Valid over the monotone interval. Throws std::domain_error outside it or where the range is not
  /// monotone.
  double temperature_degc(double frequency_hz) const;

  /// One frequency for every temperature of the range: no zero of f' inside it.
  bool monotone() const { return monotone_; }
  /// The range, widened by up to its own width on each side as far as f' keeps its sign.
  std::pair<double, double> monotone_interval_degc() const { return monotone_interval_degc_; }

  Eigen::Index order() const { return coefficients_hz_.size() - 1; }
  const Eigen::VectorXd& coefficients_hz() const { return coefficients_hz_; }
  double reference_degc() const { return reference_degc_; }
  double min_degc() const { return min_degc_; }
  double max_degc() const { return max_degc_; }

 private:
  Eigen::VectorXd coefficients_hz_;
  double reference_degc_;
  double min_degc_;
  double max_degc_;
  bool monotone_ = true;
  std::pair<double, double> monotone_interval_degc_;
};

/// A fitted f(T) with what least squares says about it.
struct FrequencyFit {
  FrequencyPolynomial polynomial;
  Eigen::VectorXd
      standard_errors;           ///< of the coefficients, same units; NaN where no degree of freedom is left
  Eigen::VectorXd residuals_hz;  ///< measured minus fitted, one a point
  double sum_of_squares_hz2;
  Eigen::Index dof;
  double max_residual_hz;
};

/// Least squares of the given order (1 or more) on the settled points; the paper's Eq. (18) is order 3 about
/// 0 degC. Throws std::invalid_argument where fewer than order + 1 different temperatures are given.
FrequencyFit fit_frequency(const SettledPoints& points, Eigen::Index order, double reference_degc = 0.0);

/// Leave-one-out: each point's temperature as read back from its frequency by a fit to all the others, minus
/// its true temperature [degC]. At the ends that is extrapolation. NaN where the fit without the point cannot
/// be inverted there. Needs order + 2 points.
Eigen::VectorXd leave_one_out_degc(const SettledPoints& points, Eigen::Index order,
                                   double reference_degc = 0.0);

}  // namespace hemi::calibration

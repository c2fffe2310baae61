// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "golden/calibration/autoregressive_noise.hpp"
#include "golden/calibration/rows.hpp"

namespace hemi::calibration {

/// y = sum c_i (T - reference)^i + coloured noise.
struct TemperaturePolynomial {
  double reference_degc = 0.0;
  Eigen::VectorXd coefficients;     ///< ascending
  Eigen::VectorXd standard_errors;  ///< of generalised least squares
  AutoregressiveNoise noise;        ///< of the averaged rows
  Eigen::Index averaged = 1;        ///< samples averaged into one row

  double value(double temperature_degc) const;
};

/// Fits a command (drive, quadrature) over the resonator's temperature, by generalised least squares on about
/// 1000 averages of temperature's powers and command.
///
/// The order is the lowest from 0 to `most` that neither the next power nor the next two improve at 1 %
/// (F-test with Satterthwaite's degrees of freedom, whitened_regression.hpp, in the model of all powers up to
/// the one tested). temperature, value: one a row, finite inside the segments. Throws std::invalid_argument
/// for fewer than 40 rows.
TemperaturePolynomial fit_over_temperature(const Eigen::VectorXd& temperature_degc,
                                           const Eigen::VectorXd& value,
                                           const std::vector<RowRange>& segments, double reference_degc,
                                           Eigen::Index most = 3);

/// Slope of y = s x + B(f, df/dt) + coloured noise: the scale factor, from the rate applied by a turntable.
struct ScaleFit {
  double scale = 1.0;
  double standard_error = 0.0;
};

/// beside: rows x columns that y may also depend on (all terms of the drift model); dependent ones are left
/// out. Throws as above.
ScaleFit fit_scale(const Eigen::VectorXd& applied, const Eigen::MatrixXd& beside, const Eigen::VectorXd& y,
                   const std::vector<RowRange>& segments);

}  // namespace hemi::calibration

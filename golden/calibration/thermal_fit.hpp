// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "golden/calibration/autoregressive_noise.hpp"
#include "golden/calibration/frequency_polynomial.hpp"
#include "golden/calibration/thermal_filter.hpp"

namespace hemi::calibration {

struct ThermalOptions {
  Eigen::Index order = 3;
  double reference_degc = 0.0;
  /// f(T) that is known and not fitted; `order` and `reference_degc` are then its own.
  std::optional<FrequencyPolynomial> known{};
};

/// f(T) and time constant from whole recordings.
struct ThermalFit {
  FrequencyPolynomial polynomial;   ///< over the resonator temperatures that occur
  Eigen::VectorXd standard_errors;  ///< of its coefficients [Hz/degC^i]; zero where f(T) was known
  Eigen::MatrixXd covariance;       ///< of the coefficients
  double time_constant_s;
  double time_constant_error_s;  ///< standard error
  double lag_s;                  ///< nuisance: the case's values are this much older than the frequency
  double lag_error_s;
  Eigen::VectorXd start_degc;  ///< resonator temperature at the first row of each stretch
  AutoregressiveNoise noise;   ///< of the averaged rows, as temperature [degC]
  double residual_rms_hz;      ///< of the averaged rows
  Eigen::Index rows;           ///< averaged rows
  Eigen::Index averaged;       ///< samples averaged into one
  double highest_order_p;      ///< two-sided chance of so large a highest coefficient without one

  /// Resonator temperature of every row of a stretch, by the filter.
  Eigen::VectorXd temperature_degc(const std::vector<ThermalStretch>& stretches, std::size_t which) const;
};

/// Free simulation of f(T) behind the first-order lag, fitted to all stretches at once: coefficients,
/// ln(tau), T[0] of each stretch, and a lag between the case's clock and the frequency's with a prior of one
/// sample's width (uniform over +-1 sample: standard deviation 1 / sqrt(3)).
///
/// The thermometer's noise goes through the filter and comes out with the filter's own time constant; the
/// autoregression, whose order the data choose, carries that beside any colour of the frequency's own. It is
/// fitted to about 1500 averages: the lag is far slower than they are. A start is found on a grid of time
/// constants, where the rest is linear (variable projection). Throws std::invalid_argument where the case
/// temperature hardly moves (1 degC) or rows are too few, RankDeficiencyError. Source: Golub and Pereyra,
/// Inverse Problems 19 (2003) R1, for the start; nonlinear_fit.hpp for the rest.
ThermalFit fit_thermal(const std::vector<ThermalStretch>& stretches, const ThermalOptions& options = {});

/// Lowest order from 1 to `most` that neither the next order nor the next two improve at 5 % in fits to the
/// whole recordings: for recordings with too few settled temperatures to study them.
Eigen::Index order_of_recordings(const std::vector<ThermalStretch>& stretches, double reference_degc,
                                 Eigen::Index most);

}  // namespace hemi::calibration

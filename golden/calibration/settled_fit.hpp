// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "golden/calibration/frequency_polynomial.hpp"
#include "golden/calibration/holds.hpp"
#include "golden/calibration/thermal_fit.hpp"

namespace hemi::calibration {

/// What a hold would end at.
struct SettledValue {
  Hold hold;
  double frequency_hz;        ///< at rest at hold.case_degc
  double frequency_error_hz;  ///< standard error, the case's noise and the time constant's error included
  double to_go_hz;            ///< settled minus simulated frequency at the hold's last row
  /// Both errors as temperature: frequency_error over |df/dT|, and that of the case's mean.
  double temperature_error_degc;
};

struct SettledFit {
  std::vector<SettledValue> values;  ///< one a hold that can be used
  std::vector<RefusedHold> refused;  ///< holds whose settled value these data do not give
  double time_constant_s = 0.0;      ///< from the holds alone
  double time_constant_error_s = 0.0;

  SettledPoints points() const;
};

/// Settled frequency of each hold from the rows of the holds alone.
///
/// f(t) = f_s + p(T(t)) - p(T_h), T(t) behind the first-order lag from an own T[0] at the hold's first row,
/// T_h the hold's case temperature: an exponential approach with one time constant for all holds, the creep
/// of the case in it, and the bend of f(T) over a long approach as p has it (p(T) = polynomial; its level
/// drops out, its slope is carried by T[0], so that an error of p enters in the second order). Noise: an
/// autoregression common to all holds (nonlinear_fit.hpp). A hold whose f_s is not known to 0.02 degC is
/// refused. Throws as fit_nonlinear.
SettledFit fit_settled(const std::vector<ThermalStretch>& stretches, const std::vector<Hold>& holds,
                       const FrequencyPolynomial& polynomial, double time_constant_s, double lag_s);

/// How well temperatures that the fit has not seen are read from the settled frequency.
struct SoakError {
  double case_degc;
  bool end;           ///< coldest or hottest: f(T) is extrapolated
  double error_degc;  ///< T(f_s) - T_h, f(T) from the recordings without the soak; NaN where not invertible
};

/// Leaves out each soak in turn (holds within 1 degC of one another are one soak): all rows from the end of
/// the hold before it to the start of the one after it, the way to it and from it included. f(T) of the given
/// order and time constant are fitted to the rest.
std::vector<SoakError> leave_one_soak_out(const std::vector<ThermalStretch>& stretches,
                                          const std::vector<Hold>& holds, Eigen::Index order,
                                          double reference_degc);

}  // namespace hemi::calibration

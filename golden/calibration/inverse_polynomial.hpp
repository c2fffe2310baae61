// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "golden/calibration/frequency_polynomial.hpp"

namespace hemi::calibration {

/// T(f) = sum c_i x^i [degC], x = (f - reference_hz) / span_hz: the thermometer of the core.
struct InversePolynomial {
  Eigen::VectorXd coefficients_degc;  ///< ascending
  double reference_hz;
  double span_hz;
  double max_error_degc;  ///< largest |T(f(t)) - t| over the fitted range, on 2001 temperatures

  double temperature_degc(double frequency_hz) const;
};

inline constexpr double kDefaultSpanHz = 64.0;
inline constexpr Eigen::Index kMaxInverseOrder = 5;

/// Fits T(f) to the inverse of f(T) over its range, by least squares on Chebyshev nodes in frequency, which
/// comes within a small factor of the smallest possible largest error. order: 1 to 5; span_hz > 0. Throws
/// std::invalid_argument, std::domain_error where f(T) is not monotone. Source: Trefethen, Approximation
/// Theory and Approximation Practice, chapters 4 and 15.
InversePolynomial fit_inverse(const FrequencyPolynomial& polynomial, double reference_hz,
                              Eigen::Index order = kMaxInverseOrder, double span_hz = kDefaultSpanHz);

}  // namespace hemi::calibration

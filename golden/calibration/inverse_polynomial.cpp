// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/inverse_polynomial.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "golden/calibration/linear_fit.hpp"

namespace hemi::calibration {

double InversePolynomial::temperature_degc(double frequency_hz) const {
  const double x = (frequency_hz - reference_hz) / span_hz;
  double sum = 0.0;
  for (Eigen::Index i = coefficients_degc.size() - 1; i >= 0; --i) sum = sum * x + coefficients_degc(i);
  return sum;
}

InversePolynomial fit_inverse(const FrequencyPolynomial& polynomial, double reference_hz, Eigen::Index order,
                              double span_hz) {
  if (order < 1 || order > kMaxInverseOrder) {
    throw std::invalid_argument("inverse polynomial: the order must lie between 1 and 5");
  }
  if (!(span_hz > 0.0) || !std::isfinite(span_hz) || !std::isfinite(reference_hz)) {
    throw std::invalid_argument("inverse polynomial: reference and span must be finite, the span positive");
  }
  constexpr Eigen::Index kNodes = 64;
  const double ends_hz[] = {polynomial.frequency_hz(polynomial.min_degc()),
                            polynomial.frequency_hz(polynomial.max_degc())};
  const double centre_hz = 0.5 * (ends_hz[0] + ends_hz[1]);
  const double half_hz = 0.5 * (ends_hz[1] - ends_hz[0]);
  Eigen::MatrixXd design(kNodes, order + 1);
  Eigen::VectorXd temperature(kNodes);
  for (Eigen::Index node = 0; node < kNodes; ++node) {
    const double angle = std::numbers::pi * (static_cast<double>(node) + 0.5) / static_cast<double>(kNodes);
    const double frequency_hz = centre_hz + half_hz * std::cos(angle);
    temperature(node) = polynomial.temperature_degc(frequency_hz);
    for (Eigen::Index i = 0; i <= order; ++i) {
      design(node, i) = std::pow((frequency_hz - reference_hz) / span_hz, static_cast<double>(i));
    }
  }
  InversePolynomial inverse{fit_linear(design, temperature).coefficients, reference_hz, span_hz, 0.0};
  constexpr int kGrid = 2000;
  for (int i = 0; i <= kGrid; ++i) {
    const double t = polynomial.min_degc() +
                     (polynomial.max_degc() - polynomial.min_degc()) * static_cast<double>(i) / kGrid;
    inverse.max_error_degc =
        std::max(inverse.max_error_degc, std::abs(inverse.temperature_degc(polynomial.frequency_hz(t)) - t));
  }
  return inverse;
}

}  // namespace hemi::calibration

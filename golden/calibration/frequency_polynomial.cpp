// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/frequency_polynomial.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <vector>

#include "golden/calibration/linear_fit.hpp"

namespace hemi::calibration {
namespace {

double horner(const Eigen::VectorXd& ascending, double x) {
  double sum = 0.0;
  for (Eigen::Index i = ascending.size() - 1; i >= 0; --i) sum = sum * x + ascending(i);
  return sum;
}

Eigen::VectorXd derivative(const Eigen::VectorXd& ascending) {
  Eigen::VectorXd result(ascending.size() - 1);
  for (Eigen::Index i = 1; i < ascending.size(); ++i) result(i - 1) = static_cast<double>(i) * ascending(i);
  return result;
}

// Real roots as eigenvalues of the companion matrix.
std::vector<double> real_roots(Eigen::VectorXd ascending) {
  Eigen::Index degree = ascending.size() - 1;
  while (degree > 0 && ascending(degree) == 0.0) --degree;
  if (degree < 1) return {};
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(degree, degree);
  companion.diagonal(-1).setOnes();
  companion.col(degree - 1) = -ascending.head(degree) / ascending(degree);
  const Eigen::VectorXcd values = companion.eigenvalues();
  std::vector<double> roots;
  for (const auto& value : values) {
    // A double root splits by the square root of the rounding error.
    if (std::abs(value.imag()) <= 1e-7 * std::max(1.0, std::abs(value))) roots.push_back(value.real());
  }
  return roots;
}

SettledPoints without(const SettledPoints& points, Eigen::Index left_out) {
  SettledPoints rest;
  const Eigen::Index size = points.temperature_degc.size() - 1;
  rest.temperature_degc.resize(size);
  rest.frequency_hz.resize(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const Eigen::Index source = i < left_out ? i : i + 1;
    rest.temperature_degc(i) = points.temperature_degc(source);
    rest.frequency_hz(i) = points.frequency_hz(source);
  }
  rest.resolution_hz = points.resolution_hz;
  return rest;
}

}  // namespace

FrequencyPolynomial::FrequencyPolynomial(Eigen::VectorXd coefficients_hz, double reference_degc,
                                         double min_degc, double max_degc)
    : coefficients_hz_(std::move(coefficients_hz)),
      reference_degc_(reference_degc),
      min_degc_(min_degc),
      max_degc_(max_degc) {
  if (coefficients_hz_.size() < 2 || !coefficients_hz_.allFinite() || !std::isfinite(reference_degc) ||
      !(min_degc < max_degc) || !std::isfinite(max_degc - min_degc)) {
    throw std::invalid_argument("f(T): at least two finite coefficients and a range are needed");
  }
  const double width = max_degc - min_degc;
  monotone_interval_degc_ = {min_degc - width, max_degc + width};
  // In units of the range, so that the coefficients of the derivative are of similar size.
  Eigen::VectorXd scaled = coefficients_hz_;
  for (Eigen::Index i = 0; i < scaled.size(); ++i) scaled(i) *= std::pow(width, static_cast<double>(i));
  for (const double root : real_roots(derivative(scaled))) {
    const double at_degc = reference_degc + root * width;
    if (at_degc >= min_degc && at_degc <= max_degc) {
      monotone_ = false;
    } else if (at_degc < min_degc) {
      monotone_interval_degc_.first = std::max(monotone_interval_degc_.first, at_degc);
    } else {
      monotone_interval_degc_.second = std::min(monotone_interval_degc_.second, at_degc);
    }
  }
  if (slope_hz_per_degc(min_degc) == 0.0) monotone_ = false;
}

double FrequencyPolynomial::frequency_hz(double temperature_degc) const {
  return horner(coefficients_hz_, temperature_degc - reference_degc_);
}

double FrequencyPolynomial::slope_hz_per_degc(double temperature_degc) const {
  return horner(derivative(coefficients_hz_), temperature_degc - reference_degc_);
}

double FrequencyPolynomial::temperature_degc(double target_hz) const {
  if (!monotone_) {
    throw std::domain_error(
        fmt::format("f(T) turns back between {:g} and {:g} degC: a frequency does not give one temperature",
                    min_degc_, max_degc_));
  }
  auto [low, high] = monotone_interval_degc_;
  const double sign = frequency_hz(high) > frequency_hz(low) ? 1.0 : -1.0;
  if (!(sign * (target_hz - frequency_hz(low)) >= 0.0 && sign * (frequency_hz(high) - target_hz) >= 0.0)) {
    throw std::domain_error(
        fmt::format("{:.6f} Hz lies outside f(T) from {:g} to {:g} degC", target_hz, low, high));
  }
  double temperature = 0.5 * (min_degc_ + max_degc_);
  // Bisection alone would need about 60 steps to reach the last digit.
  for (int step = 0; step < 100; ++step) {
    const double error_hz = frequency_hz(temperature) - target_hz;
    (sign * error_hz > 0.0 ? high : low) = temperature;
    double next = temperature - error_hz / slope_hz_per_degc(temperature);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double moved = std::abs(next - temperature);
    temperature = next;
    if (moved <= 4.0 * std::numeric_limits<double>::epsilon() * std::max(1.0, std::abs(temperature))) break;
  }
  return temperature;
}

FrequencyFit fit_frequency(const SettledPoints& points, Eigen::Index order, double reference_degc) {
  const Eigen::VectorXd& t = points.temperature_degc;
  const std::set<double> different(t.begin(), t.end());
  if (order < 1 || static_cast<Eigen::Index>(different.size()) < order + 1) {
    throw std::invalid_argument(
        fmt::format("f(T) of order {}: {} different temperatures are given, {} are needed", order,
                    different.size(), order + 1));
  }
  const double scale =
      std::max(std::abs(*different.begin() - reference_degc), std::abs(*different.rbegin() - reference_degc));
  Eigen::MatrixXd design(t.size(), order + 1);
  for (Eigen::Index i = 0; i <= order; ++i) {
    design.col(i) = ((t.array() - reference_degc) / scale).pow(static_cast<double>(i));
  }
  const LinearFit fit = fit_linear(design, points.frequency_hz);
  Eigen::VectorXd units(order + 1);
  for (Eigen::Index i = 0; i <= order; ++i) units(i) = std::pow(scale, static_cast<double>(-i));
  return {FrequencyPolynomial(fit.coefficients.cwiseProduct(units), reference_degc, *different.begin(),
                              *different.rbegin()),
          fit.standard_errors.cwiseProduct(units),
          fit.residuals,
          fit.sum_of_squares,
          fit.dof,
          fit.residuals.cwiseAbs().maxCoeff()};
}

Eigen::VectorXd leave_one_out_degc(const SettledPoints& points, Eigen::Index order, double reference_degc) {
  const Eigen::Index size = points.temperature_degc.size();
  Eigen::VectorXd errors(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const FrequencyFit fit = fit_frequency(without(points, i), order, reference_degc);
    try {
      errors(i) = fit.polynomial.temperature_degc(points.frequency_hz(i)) - points.temperature_degc(i);
    } catch (const std::domain_error&) {
      errors(i) = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return errors;
}

}  // namespace hemi::calibration

// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/voltage_fit.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "golden/calibration/linear_fit.hpp"
#include "golden/calibration/whitened_regression.hpp"

namespace hemi::calibration {
namespace {

constexpr Eigen::Index kVoltageRows = 1000;
constexpr Eigen::Index kLeastVoltageRows = 40;
constexpr double kVoltageLevel = 0.01;

// Column means over blocks; what is left of a segment after its last whole block is not used.
struct Averaged {
  Eigen::MatrixXd x;
  Eigen::VectorXd y;
  std::vector<RowRange> segments;
  Eigen::Index length;
};

Averaged average(const Eigen::MatrixXd& x, const Eigen::VectorXd& y, const std::vector<RowRange>& segments) {
  const Eigen::Index total = total_rows(segments);
  if (total < kLeastVoltageRows) throw std::invalid_argument("fewer than 40 usable rows");
  Averaged out;
  out.length = std::max<Eigen::Index>(1, total / kVoltageRows);
  Eigen::Index rows = 0;
  for (const RowRange& range : segments) {
    const Eigen::Index blocks = range.count / out.length;
    if (blocks > 0) out.segments.push_back({rows, blocks});
    rows += blocks;
  }
  out.x.resize(rows, x.cols());
  out.y.resize(rows);
  Eigen::Index next = 0;
  for (const RowRange& range : segments) {
    for (Eigen::Index block = 0; block < range.count / out.length; ++block, ++next) {
      const Eigen::Index first = range.begin + block * out.length;
      out.x.row(next) = x.middleRows(first, out.length).colwise().mean();
      out.y[next] = y.segment(first, out.length).mean();
    }
  }
  return out;
}

std::vector<Eigen::Index> first_columns(Eigen::Index count) {
  std::vector<Eigen::Index> columns;
  for (Eigen::Index i = 0; i < count; ++i) columns.push_back(i);
  return columns;
}

Eigen::Index choose_order(const WhitenedRegression& regression, Eigen::Index most) {
  const auto matters = [&](Eigen::Index power) {
    return regression.test(first_columns(power + 1), static_cast<std::size_t>(power)).p_value < kVoltageLevel;
  };
  Eigen::Index order = 0;
  while (order < most && (matters(order + 1) || (order + 2 <= most && matters(order + 2)))) ++order;
  return order;
}

}  // namespace

double TemperaturePolynomial::value(double temperature_degc) const {
  double y = 0.0;
  for (Eigen::Index k = coefficients.size() - 1; k >= 0; --k)
    y = y * (temperature_degc - reference_degc) + coefficients[k];
  return y;
}

TemperaturePolynomial fit_over_temperature(const Eigen::VectorXd& temperature_degc,
                                           const Eigen::VectorXd& value,
                                           const std::vector<RowRange>& segments, double reference_degc,
                                           Eigen::Index most) {
  Eigen::MatrixXd powers = Eigen::MatrixXd::Ones(temperature_degc.size(), most + 1);
  for (Eigen::Index k = 1; k <= most; ++k)
    powers.col(k) = powers.col(k - 1).cwiseProduct((temperature_degc.array() - reference_degc).matrix());
  Averaged data = average(powers, value, segments);
  // Powers that a narrow range of temperature does not tell apart are not tried.
  const auto dependent = dependent_columns(data.x);
  const Eigen::Index determined = dependent.empty() ? most : std::max<Eigen::Index>(0, dependent.front() - 1);
  const Eigen::VectorXd scales = data.x.leftCols(determined + 1).cwiseAbs().colwise().maxCoeff().transpose();
  const WhitenedRegression regression(data.x.leftCols(determined + 1) * scales.cwiseInverse().asDiagonal(),
                                      data.y, data.segments, false);
  const auto columns = first_columns(choose_order(regression, determined) + 1);
  TemperaturePolynomial fit;
  fit.reference_degc = reference_degc;
  fit.noise = regression.noise();
  fit.averaged = data.length;
  const auto size = static_cast<Eigen::Index>(columns.size());
  fit.coefficients.resize(size);
  fit.standard_errors.resize(size);
  for (Eigen::Index k = 0; k < size; ++k) {
    const PartialTest test = regression.test(columns, static_cast<std::size_t>(k));
    fit.coefficients[k] = test.coefficient / scales[k];
    fit.standard_errors[k] = test.standard_error / scales[k];
  }
  return fit;
}

ScaleFit fit_scale(const Eigen::VectorXd& applied, const Eigen::MatrixXd& beside, const Eigen::VectorXd& y,
                   const std::vector<RowRange>& segments) {
  Eigen::MatrixXd x(applied.size(), beside.cols() + 1);
  x << applied, beside;
  const Averaged data = average(x, y, segments);
  Eigen::VectorXd scales = data.x.cwiseAbs().colwise().maxCoeff().transpose();
  scales = scales.unaryExpr([](double s) { return s > 0.0 ? s : 1.0; });
  const Eigen::MatrixXd scaled = data.x * scales.cwiseInverse().asDiagonal();
  const auto dependent = dependent_columns(scaled);
  std::vector<Eigen::Index> columns;
  for (Eigen::Index i = 0; i < scaled.cols(); ++i)
    if (std::find(dependent.begin(), dependent.end(), i) == dependent.end()) columns.push_back(i);
  const WhitenedRegression regression(scaled(Eigen::all, columns), data.y, data.segments, false);
  const PartialTest test = regression.test(first_columns(static_cast<Eigen::Index>(columns.size())), 0);
  return {test.coefficient / scales[0], test.standard_error / scales[0]};
}

}  // namespace hemi::calibration

// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/linear_fit.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <cmath>
#include <limits>

namespace hemi::calibration {
namespace {

// A unit column's distance from the span of the others is computed to about rows * epsilon; a hundred times
// that still leaves every column that carries ten digits of its own.
double rank_tolerance(Eigen::Index rows) {
  return 100.0 * static_cast<double>(rows) * std::numeric_limits<double>::epsilon();
}

std::string column_label(Eigen::Index column, const std::string& name) {
  return name.empty() ? fmt::format("column {}", column) : fmt::format("column {} ('{}')", column, name);
}

void check_sizes(const Eigen::MatrixXd& x, const Eigen::VectorXd& y, const std::vector<std::string>& names) {
  if (x.cols() < 1 || x.rows() < x.cols()) {
    throw std::invalid_argument(
        fmt::format("least squares: {} rows cannot determine {} columns", x.rows(), x.cols()));
  }
  if (y.size() != x.rows()) {
    throw std::invalid_argument(fmt::format("least squares: {} values for {} rows", y.size(), x.rows()));
  }
  if (!names.empty() && static_cast<Eigen::Index>(names.size()) != x.cols()) {
    throw std::invalid_argument(
        fmt::format("least squares: {} names for {} columns", names.size(), x.cols()));
  }
  if (!x.allFinite() || !y.allFinite())
    throw std::invalid_argument("least squares: values are not all finite");
}

Eigen::VectorXd column_scales(const Eigen::MatrixXd& x) {
  return x.colwise().norm().transpose().unaryExpr([](double norm) { return norm > 0.0 ? norm : 1.0; });
}

}  // namespace

RankDeficiencyError::RankDeficiencyError(Eigen::Index column, const std::string& name)
    : std::runtime_error(fmt::format("least squares: {} is a linear combination of the columns before it",
                                     column_label(column, name))),
      column_(column) {}

std::vector<Eigen::Index> dependent_columns(const Eigen::MatrixXd& x) {
  const Eigen::MatrixXd scaled = x * column_scales(x).cwiseInverse().asDiagonal();
  std::vector<Eigen::Index> dependent;
  Eigen::MatrixXd basis(x.rows(), 0);
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    Eigen::VectorXd rest = scaled.col(j);
    // Twice is enough: the second projection removes what rounding left in the first.
    for (int pass = 0; pass < 2; ++pass) rest -= basis * (basis.transpose() * rest).eval();
    if (rest.norm() <= rank_tolerance(x.rows())) {
      dependent.push_back(j);
      continue;
    }
    basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
    basis.rightCols(1) = rest.normalized();
  }
  return dependent;
}

LinearFit fit_linear_weighted(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                              const Eigen::VectorXd& weights, const std::vector<std::string>& names) {
  check_sizes(x, y, names);
  if (weights.size() != y.size() || !weights.allFinite() || !(weights.minCoeff() > 0.0)) {
    throw std::invalid_argument("least squares: weights must be positive, finite and one a row");
  }
  const Eigen::VectorXd root_weights = weights.cwiseSqrt();
  const Eigen::MatrixXd weighted = root_weights.asDiagonal() * x;
  const Eigen::VectorXd scales = column_scales(weighted);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(weighted * scales.cwiseInverse().asDiagonal());
  const Eigen::Index columns = x.cols();
  const Eigen::MatrixXd r = qr.matrixQR().topRows(columns).triangularView<Eigen::Upper>();
  for (Eigen::Index j = 0; j < columns; ++j) {
    if (std::abs(r(j, j)) <= rank_tolerance(x.rows())) {
      throw RankDeficiencyError(j, names.empty() ? std::string() : names[static_cast<std::size_t>(j)]);
    }
  }

  LinearFit fit;
  const Eigen::VectorXd weighted_y = root_weights.cwiseProduct(y);
  fit.coefficients = qr.solve(weighted_y).cwiseQuotient(scales);
  fit.residuals = y - x * fit.coefficients;
  fit.sum_of_squares = root_weights.cwiseProduct(fit.residuals).squaredNorm();
  fit.dof = x.rows() - columns;
  const double variance = fit.dof > 0 ? fit.sum_of_squares / static_cast<double>(fit.dof)
                                      : std::numeric_limits<double>::quiet_NaN();
  const Eigen::MatrixXd inverse_r =
      r.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(columns, columns));
  const Eigen::MatrixXd unscaled = scales.cwiseInverse().asDiagonal() * inverse_r;
  fit.covariance = variance * unscaled * unscaled.transpose();
  fit.standard_errors = fit.covariance.diagonal().cwiseSqrt();
  const double mean = weights.dot(y) / weights.sum();
  const double scatter = root_weights.cwiseProduct((y.array() - mean).matrix()).squaredNorm();
  fit.r_squared = scatter > 0.0 ? 1.0 - fit.sum_of_squares / scatter : 1.0;
  return fit;
}

LinearFit fit_linear(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                     const std::vector<std::string>& names) {
  return fit_linear_weighted(x, y, Eigen::VectorXd::Ones(y.size()), names);
}

}  // namespace hemi::calibration

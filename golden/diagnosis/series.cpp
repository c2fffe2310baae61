// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/series.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace hemi::diagnosis {

using Eigen::ArrayXd;

ArrayXd lag(const ArrayXd& x, double step_s, double tau_s, double start) {
  if (tau_s <= 0.0) return x;
  const double gain = -std::expm1(-step_s / tau_s);
  ArrayXd y(x.size());
  double state = start;
  if (x.size() > 0) y[0] = state;
  for (Eigen::Index i = 1; i < x.size(); ++i) y[i] = state += gain * (x[i] - state);
  return y;
}

double span(const ArrayXd& x) {
  return x.size() == 0 ? 0.0 : x.maxCoeff() - x.minCoeff();
}

ArrayXd slope_in_time(const ArrayXd& x, double step_s) {
  const Eigen::Index n = x.size();
  ArrayXd slope = ArrayXd::Zero(n);
  if (n < 2) return slope;
  slope.segment(1, n - 2) = (x.tail(n - 2) - x.head(n - 2)) / (2.0 * step_s);
  slope[0] = (x[1] - x[0]) / step_s;
  slope[n - 1] = (x[n - 1] - x[n - 2]) / step_s;
  return slope;
}

ArrayXd smoothed(const ArrayXd& x, double step_s, double half_width_s) {
  const auto half = std::min(static_cast<Eigen::Index>(half_width_s / step_s), (x.size() - 1) / 2);
  if (half < 2) return x;
  const Eigen::Index width = 2 * half + 1;
  const ArrayXd u = ArrayXd::LinSpaced(width, -1.0, 1.0);
  Eigen::MatrixXd powers(width, 4);
  for (Eigen::Index i = 0; i < 4; ++i) powers.col(i) = u.pow(static_cast<double>(i));
  // The normal equations, since four rows are wanted and not a square as wide as the window; their condition
  // is below 200 for these powers.
  const Eigen::MatrixXd fit = (powers.transpose() * powers).ldlt().solve(powers.transpose());
  const Eigen::VectorXd centre = fit.row(0);
  ArrayXd y(x.size());
  for (Eigen::Index i = half; i + half < x.size(); ++i)
    y[i] = centre.dot(x.segment(i - half, width).matrix());
  y.head(half) = (powers * (fit * x.head(width).matrix())).head(half);
  y.tail(half) = (powers * (fit * x.tail(width).matrix())).tail(half);
  return y;
}

ArrayXd running_median(const ArrayXd& x, Eigen::Index half) {
  ArrayXd y(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Eigen::Index begin = std::max<Eigen::Index>(0, i - half), end = std::min(x.size(), i + half + 1);
    y[i] = median(std::vector<double>(x.data() + begin, x.data() + end));
  }
  return y;
}

ArrayXd late(const ArrayXd& x, double rows) {
  ArrayXd y(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double at = std::max(static_cast<double>(i) - rows, 0.0);
    const auto before = std::min(static_cast<Eigen::Index>(at), x.size() - 2);
    const double share = at - static_cast<double>(before);
    y[i] = (1.0 - share) * x[before] + share * x[before + 1];
  }
  return y;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double median(const Eigen::VectorXd& values) {
  return median(std::vector<double>(values.begin(), values.end()));
}

double rms(const Eigen::VectorXd& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

double robust_deviation(std::vector<double> values) {
  for (double& value : values) value = std::abs(value);
  return median(std::move(values)) / 0.674489750196082;
}

}  // namespace hemi::diagnosis

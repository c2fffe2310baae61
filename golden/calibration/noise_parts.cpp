// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/noise_parts.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>

#include "golden/calibration/allan.hpp"

namespace hemi::calibration {
namespace {

constexpr Eigen::Index kLeastNoiseRows = 64;
constexpr double kPrice = 12.0;

struct Pooled {
  double variance_times_dof = 0.0;
  double dof = 0.0;
};

// Allan variances of all segments at each averaging time, pooled by their degrees of freedom.
std::map<Eigen::Index, Pooled> pooled_variances(const Eigen::VectorXd& residual,
                                                const std::vector<RowRange>& segments, double interval_s,
                                                double longest_tau_s) {
  std::map<Eigen::Index, Pooled> pooled;
  for (const RowRange& range : segments) {
    if (range.count < kLeastNoiseRows) continue;
    const auto allan = allan_deviation(residual.segment(range.begin, range.count), interval_s);
    for (const AllanPoint& point : allan.points) {
      if (8 * point.averaged > range.count || point.tau_s > longest_tau_s * (1.0 + 1e-9)) continue;
      Pooled& sum = pooled[point.averaged];
      sum.variance_times_dof += point.degrees_of_freedom * point.deviation * point.deviation;
      sum.dof += point.degrees_of_freedom;
    }
  }
  return pooled;
}

}  // namespace

std::array<double, 4> allan_of_parts(double tau_s, double interval_s) {
  constexpr double pi = std::numbers::pi;
  return {1.0 / (2.0 * tau_s), 2.0 * std::numbers::ln2, 4.0 * pi * pi * tau_s / 6.0,
          3.0 / (8.0 * pi * pi * interval_s * tau_s * tau_s)};
}

NoiseParts fit_noise_parts(const Eigen::VectorXd& residual, const std::vector<RowRange>& segments,
                           double interval_s, double longest_tau_s) {
  const auto pooled = pooled_variances(residual, segments, interval_s, longest_tau_s);
  if (pooled.empty()) throw std::invalid_argument("no stretch of 64 rows and more, so no noise density");
  const auto rows = static_cast<Eigen::Index>(pooled.size());
  Eigen::MatrixXd x(rows, 4);
  Eigen::VectorXd y(rows);
  Eigen::Index row = 0;
  for (const auto& [averaged, sum] : pooled) {
    const double variance = sum.variance_times_dof / sum.dof;
    // A variance of d degrees of freedom has the relative variance 2 / d.
    const double weight = std::sqrt(sum.dof / 2.0) / variance;
    const auto parts = allan_of_parts(static_cast<double>(averaged) * interval_s, interval_s);
    for (Eigen::Index k = 0; k < 4; ++k) x(row, k) = weight * parts[static_cast<std::size_t>(k)];
    y[row++] = weight * variance;
  }
  double least = std::numeric_limits<double>::infinity();
  Eigen::Vector4d best = Eigen::Vector4d::Zero();
  for (unsigned set = 1; set < 16; ++set) {
    std::vector<Eigen::Index> columns;
    for (Eigen::Index k = 0; k < 4; ++k)
      if ((set >> k & 1U) != 0) columns.push_back(k);
    if (static_cast<Eigen::Index>(columns.size()) > rows) continue;
    const Eigen::MatrixXd part = x(Eigen::all, columns);
    const Eigen::VectorXd b = part.colPivHouseholderQr().solve(y);
    if (b.minCoeff() < 0.0) continue;
    const double cost = (y - part * b).squaredNorm() + kPrice * static_cast<double>(columns.size());
    if (!(cost < least)) continue;
    least = cost;
    best.setZero();
    best(columns) = b;
  }
  return {std::sqrt(best[0]), std::sqrt(best[1]), std::sqrt(best[2]), std::sqrt(best[3]),
          static_cast<double>(pooled.rbegin()->first) * interval_s};
}

}  // namespace hemi::calibration

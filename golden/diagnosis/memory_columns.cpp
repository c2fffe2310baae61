// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/memory_columns.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hemi::diagnosis {
namespace {

constexpr Eigen::Index kLeastRows = 256;
constexpr Eigen::Index kSlopeShare = 128;  // the first slope is taken over a 128th of the rows

// Slope of a straight line through the first rows [degC/s].
double first_slope(const CaseRows& rows) {
  const Eigen::Index n = std::max<Eigen::Index>(8, rows.time_s.size() / kSlopeShare);
  const Eigen::ArrayXd t = rows.time_s.head(n).array() - rows.time_s.head(n).mean();
  return (t * rows.case_degc.head(n).array()).sum() / t.square().sum();
}

// The case's temperature with the assumed time before the first row put in front, one step of the mean width
// a row.
CaseRows with_past(const CaseRows& rows, double before_s) {
  const Eigen::Index n = rows.time_s.size();
  const double step = (rows.time_s[n - 1] - rows.time_s[0]) / static_cast<double>(n - 1);
  const auto past = static_cast<Eigen::Index>(std::lround(before_s / step));
  const double slope = past > 0 ? first_slope(rows) : 0.0;
  CaseRows all{Eigen::VectorXd(past + n), Eigen::VectorXd(past + n), {}};
  for (Eigen::Index i = 0; i < past; ++i) {
    const double ago = step * static_cast<double>(past - i);
    all.time_s[i] = rows.time_s[0] - ago;
    all.case_degc[i] = rows.case_degc[0] - slope * ago;
  }
  all.time_s.tail(n) = rows.time_s;
  all.case_degc.tail(n) = rows.case_degc;
  return all;
}

}  // namespace

Eigen::VectorXd node_degc(const Eigen::VectorXd& time_s, const Eigen::VectorXd& degc, double tau_s) {
  Eigen::VectorXd x(degc.size());
  x[0] = degc[0];
  for (Eigen::Index i = 1; i < degc.size(); ++i)
    x[i] = x[i - 1] - std::expm1(-(time_s[i] - time_s[i - 1]) / tau_s) * (degc[i] - x[i - 1]);
  return x;
}

Eigen::VectorXd play_degc(const Eigen::VectorXd& degc, double threshold_degc) {
  Eigen::VectorXd p(degc.size());
  p[0] = degc[0];
  for (Eigen::Index i = 1; i < degc.size(); ++i)
    p[i] = std::clamp(p[i - 1], degc[i] - threshold_degc, degc[i] + threshold_degc);
  return p;
}

MemoryColumns memory_columns(const CaseRows& rows, double before_s) {
  using C = MemoryColumns;
  const Eigen::Index n = rows.time_s.size();
  if (n < kLeastRows)
    throw std::invalid_argument("memory of the temperature: fewer than 256 rows of temperature and rate");
  MemoryColumns columns;
  columns.middle_degc = 0.5 * (rows.case_degc.maxCoeff() + rows.case_degc.minCoeff());
  columns.half_degc = 0.5 * (rows.case_degc.maxCoeff() - rows.case_degc.minCoeff());
  if (!(columns.half_degc > 0.0))
    throw std::invalid_argument("memory of the temperature: the temperature does not move");
  const double duration = rows.time_s[n - 1] - rows.time_s[0];
  const CaseRows all = with_past(rows, before_s);
  const auto scaled = [&](const Eigen::VectorXd& degc) -> Eigen::ArrayXd {
    return (degc.tail(n).array() - columns.middle_degc) / columns.half_degc;
  };
  const Eigen::ArrayXd u = scaled(rows.case_degc);
  columns.values.resize(n, C::count());
  columns.values.col(0).setOnes();
  for (Eigen::Index d = 1; d < C::kDegrees; ++d)
    columns.values.col(C::power(d)) = (columns.values.col(d - 1).array() * u).matrix();
  for (Eigen::Index k = 0; k < C::kNodes; ++k)
    columns.tau_s.push_back(duration / std::pow(4.0, static_cast<double>(k)));
  Eigen::Index pair = 0;
  for (Eigen::Index k = 0; k < C::kNodes; ++k) {
    const Eigen::VectorXd node =
        node_degc(all.time_s, all.case_degc, columns.tau_s[static_cast<std::size_t>(k)]);
    columns.values.col(C::lag(k)) = (u - scaled(node)).matrix();
    // The last one is the pole alone.
    for (Eigen::Index j = k + 1; j <= C::kNodes; ++j, ++pair) {
      const Eigen::ArrayXd behind =
          j == C::kNodes ? scaled(node)
                         : scaled(node_degc(all.time_s, node, columns.tau_s[static_cast<std::size_t>(j)]));
      for (Eigen::Index d = 1; d <= C::kCube; ++d)
        columns.values.col(C::two_poles(pair, d)) = behind.pow(static_cast<double>(d)).matrix();
    }
  }
  for (Eigen::Index k = 0; k < C::kPlays; ++k) {
    columns.threshold_degc.push_back(columns.half_degc / std::pow(2.0, static_cast<double>(k + 1)));
    const Eigen::ArrayXd play = u - scaled(play_degc(all.case_degc, columns.threshold_degc.back()));
    columns.values.col(C::play(k, 0)) = play.matrix();
    columns.values.col(C::play(k, 1)) = (play * u).matrix();
  }
  const Eigen::ArrayXd time = (rows.time_s.array() - rows.time_s[0]) / duration;
  for (Eigen::Index k = 0; k < C::kDrifts; ++k) {
    const Eigen::ArrayXd drift =
        k == 0 ? time : Eigen::ArrayXd((-std::pow(4.0, static_cast<double>(k - 1)) * time).exp());
    columns.values.col(C::drift(k, 0)) = drift.matrix();
    columns.values.col(C::drift(k, 1)) = (drift * u).matrix();
  }
  return columns;
}

}  // namespace hemi::diagnosis

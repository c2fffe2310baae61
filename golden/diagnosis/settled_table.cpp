// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/settled_table.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <boost/math/tools/fraction.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "golden/calibration/linear_fit.hpp"
#include "golden/diagnosis/series.hpp"

namespace hemi::diagnosis {
namespace {

using calibration::FrequencyFit;
using calibration::SettledPoints;
using Index = Eigen::Index;
constexpr double kLevel = 0.01;
constexpr double kSigmas = 5.0;
constexpr std::uint64_t kTableSeed = 1;

// Gamma(a, z) = exp(-z) z^a / (z + 1 - a - 1 (1 - a) / (z + 3 - a - 2 (2 - a) / ...)), for z > a + 1.
struct UpperGamma {
  using result_type = std::pair<double, double>;
  double a, z;
  double k = 0.0;
  result_type operator()() {
    const double numerator = k == 0.0 ? 1.0 : -k * (k - a);
    const double denominator = z + 2.0 * k + 1.0 - a;
    k += 1.0;
    return {numerator, denominator};
  }
};

// |divided difference| over the sum of its weights' magnitudes: what no polynomial of the order can get below
// on the picked points. Two of one temperature have no divided difference and give 0.
double levelled_error(const Eigen::VectorXd& x, const Eigen::VectorXd& y, const std::vector<char>& picked) {
  const Index n = x.size();
  double sum = 0.0, weight_sum = 0.0;
  for (Index i = 0; i < n; ++i) {
    if (picked[static_cast<std::size_t>(i)] == 0) continue;
    double weight = 1.0;
    for (Index j = 0; j < n; ++j)
      if (j != i && picked[static_cast<std::size_t>(j)] != 0) weight /= x[i] - x[j];
    if (!std::isfinite(weight)) return 0.0;
    sum += weight * y[i];
    weight_sum += std::abs(weight);
  }
  return std::abs(sum) / weight_sum;
}

SettledPoints without(const SettledPoints& points, Index out) {
  const Index n = points.temperature_degc.size();
  std::vector<Index> kept;
  for (Index i = 0; i < n; ++i)
    if (i != out) kept.push_back(i);
  return {points.temperature_degc(kept), points.frequency_hz(kept), points.resolution_hz};
}

Eigen::VectorXd left_out_hz(const SettledPoints& points, Index order) {
  Eigen::VectorXd error(points.frequency_hz.size());
  for (Index i = 0; i < error.size(); ++i)
    error[i] = points.frequency_hz[i] - calibration::fit_frequency(without(points, i), order)
                                            .polynomial.frequency_hz(points.temperature_degc[i]);
  return error;
}

// Scatter s of the temperatures at which sum r^2 / (rounding^2 + (f' s)^2) comes to the degrees of freedom.
double chamber_error(const SettledPoints& points, const FrequencyFit& fit, double rounding_rms_hz) {
  const auto weighted = [&](double s) {
    double sum = 0.0;
    for (Index i = 0; i < fit.residuals_hz.size(); ++i) {
      const double slope = fit.polynomial.slope_hz_per_degc(points.temperature_degc[i]);
      sum += fit.residuals_hz[i] * fit.residuals_hz[i] /
             (rounding_rms_hz * rounding_rms_hz + slope * slope * s * s);
    }
    return sum;
  };
  const auto dof = static_cast<double>(fit.dof);
  double low = 1e-9, high = 1e3;
  if (weighted(low) <= dof) return 0.0;
  for (int i = 0; i < 200; ++i) {
    const double middle = std::sqrt(low * high);
    (weighted(middle) > dof ? low : high) = middle;
  }
  return std::sqrt(low * high);
}

// Peak to peak over the range of what two polynomials differ by [Hz].
double span_between(const FrequencyFit& a, const FrequencyFit& b) {
  constexpr Index steps = 1000;
  const double from = a.polynomial.min_degc(), to = a.polynomial.max_degc();
  Eigen::VectorXd difference(steps + 1);
  for (Index i = 0; i <= steps; ++i) {
    const double t = from + (to - from) * static_cast<double>(i) / static_cast<double>(steps);
    difference[i] = a.polynomial.frequency_hz(t) - b.polynomial.frequency_hz(t);
  }
  return difference.maxCoeff() - difference.minCoeff();
}

// The power after the baseline's, its baseline part taken off: norm for the standard error, span for ppm.
void set_limits(const SettledPoints& points, TableDiagnosis& result) {
  if (!(result.rounding_rms_hz > 0.0)) return;
  const Eigen::ArrayXd t = points.temperature_degc.array();
  const Eigen::VectorXd top = t.pow(static_cast<double>(result.baseline + 1)).matrix();
  Eigen::MatrixXd lower(t.size(), result.baseline + 1);
  for (Index d = 0; d <= result.baseline; ++d) lower.col(d) = t.pow(static_cast<double>(d)).matrix();
  const Eigen::VectorXd own = calibration::fit_linear(lower, top).residuals;
  result.smallest_top = kSigmas * result.rounding_rms_hz / own.norm();
  result.smallest_ppm =
      1e6 * result.smallest_top * (own.maxCoeff() - own.minCoeff()) / points.frequency_hz.mean();
}

void compare_fits(const SettledPoints& points, TableDiagnosis& result) {
  const FrequencyFit& before = result.study.report(result.baseline).fit;
  const FrequencyFit& after = result.study.report(result.chosen).fit;
  std::vector<calibration::RowRange> each;
  for (Index i = 0; i < points.frequency_hz.size(); ++i) each.push_back({i, 1});
  result.train = bootstrap_gain(before.residuals_hz, after.residuals_hz, each, kTableSeed);
  result.left_out = bootstrap_gain(left_out_hz(points, result.baseline), left_out_hz(points, result.chosen),
                                   each, kTableSeed);
  result.top_coefficient = after.polynomial.coefficients_hz()[result.chosen];
  const boost::math::students_t_distribution<double> student(static_cast<double>(after.dof));
  result.top_half_width95 = boost::math::quantile(student, 0.975) * after.standard_errors[result.chosen];
  result.ppm_span = 1e6 * span_between(after, before) / points.frequency_hz.mean();
  result.residual_degc =
      rms(before.residuals_hz.binaryExpr(points.temperature_degc, [&](double hz, double degc) {
        return hz / before.polynomial.slope_hz_per_degc(degc);
      }));
  result.chamber_error_degc = chamber_error(points, before, result.rounding_rms_hz);
}

}  // namespace

double log10_chi_square_tail(double x, double dof) {
  const double a = 0.5 * dof, z = 0.5 * x;
  if (z <= a + 1.0) return std::log10(boost::math::gamma_q(a, z));
  UpperGamma terms{a, z};
  const double fraction =
      boost::math::tools::continued_fraction_a(terms, std::numeric_limits<double>::epsilon());
  return (a * std::log(z) - z - std::lgamma(a) + std::log(fraction)) / std::numbers::ln10;
}

double minimax_residual(const Eigen::VectorXd& x, const Eigen::VectorXd& y, Index order) {
  constexpr Index most_points = 20;  // 184 756 subsets at most
  const Index n = x.size(), size = order + 2;
  if (n < size) return 0.0;
  double largest = 0.0;
  for (Index from = 0; from == 0 || from + most_points <= n; ++from) {
    const Index count = std::min(n, most_points);
    std::vector<char> picked(static_cast<std::size_t>(count), 0);
    std::fill_n(picked.begin(), size, 1);
    do {
      const double level = levelled_error(x.segment(from, count), y.segment(from, count), picked);
      largest = std::max(largest, level);
    } while (std::prev_permutation(picked.begin(), picked.end()));
  }
  return largest;
}

TableDiagnosis diagnose_table(const SettledPoints& points, Index baseline) {
  TableDiagnosis result;
  result.study = calibration::study_order(points);
  result.baseline = baseline;
  const auto largest = static_cast<Index>(result.study.orders.size());
  if (baseline < 1 || largest <= baseline)
    throw std::invalid_argument("settled points: too few to test one order more than the model's");
  result.rounding_rms_hz = points.resolution_hz / std::sqrt(12.0);
  for (Index order = 1; order <= largest; ++order) {
    const auto& report = result.study.report(order);
    TableOrder row{order, rms(report.fit.residuals_hz),    report.fit.max_residual_hz,   0.0,
                   0.0,   rms(left_out_hz(points, order)), report.leave_one_out_max_degc};
    if (report.chi_square)
      row.log10_p = log10_chi_square_tail(*report.chi_square, static_cast<double>(report.fit.dof));
    row.minimax_hz = minimax_residual(points.temperature_degc, points.frequency_hz, order);
    result.orders.push_back(row);
  }
  result.chosen = std::max(baseline, result.study.chosen);
  const auto& next = result.study.report(baseline).next;
  if (next) {
    result.f_statistic = next->f_statistic;
    result.f_p = next->p_value;
  }
  const bool by_rounding = result.rounding_rms_hz > 0.0 && result.at(baseline).log10_p < std::log10(kLevel);
  const bool by_order = result.f_p < kLevel;
  if (!by_order && !by_rounding) result.chosen = baseline;
  if (by_rounding || by_order)
    result.verdict = result.chosen > baseline ? Verdict::ambiguous : Verdict::unknown;
  compare_fits(points, result);
  set_limits(points, result);
  return result;
}

}  // namespace hemi::diagnosis

// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/order_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

namespace hemi::calibration {
namespace {

constexpr double kLevel = 0.05;
constexpr Eigen::Index kMaxOrder = 6;

std::string order_name(Eigen::Index order) {
  static const char* const names[] = {"straight line", "quadratic", "cubic", "quartic", "quintic"};
  return order <= 5 ? names[order - 1] : fmt::format("polynomial of order {}", order);
}

// Every leave-one-out fit needs order + 1 different temperatures, so a point whose temperature occurs once
// costs one.
Eigen::Index largest_order(const SettledPoints& points) {
  std::map<double, int> occurrences;
  for (const double t : points.temperature_degc) ++occurrences[t];
  const bool any_single = std::any_of(occurrences.begin(), occurrences.end(),
                                      [](const auto& entry) { return entry.second == 1; });
  const auto different = static_cast<Eigen::Index>(occurrences.size());
  return std::min({kMaxOrder, points.temperature_degc.size() - 2, different - (any_single ? 2 : 1)});
}

OrderTest compare(const FrequencyFit& lower, const FrequencyFit& higher) {
  const auto extra = static_cast<double>(lower.dof - higher.dof);
  const auto dof = static_cast<double>(higher.dof);
  const double gain = std::max(0.0, lower.sum_of_squares_hz2 - higher.sum_of_squares_hz2);
  const double f = gain / extra / (higher.sum_of_squares_hz2 / dof);
  // Points that lie on the higher polynomial exactly.
  if (!std::isfinite(f)) return {higher.polynomial.order(), f, gain > 0.0 ? 0.0 : 1.0};
  const boost::math::fisher_f_distribution<double> distribution(extra, dof);
  return {higher.polynomial.order(), f, boost::math::cdf(boost::math::complement(distribution, f))};
}

void judge_rounding(OrderReport& report, double resolution_hz) {
  if (!(resolution_hz > 0.0)) return;
  report.chi_square = report.fit.sum_of_squares_hz2 / (resolution_hz * resolution_hz / 12.0);
  const boost::math::chi_squared_distribution<double> distribution(static_cast<double>(report.fit.dof));
  report.chi_square_p = boost::math::cdf(boost::math::complement(distribution, *report.chi_square));
}

bool improved(const OrderReport& report) {
  return (report.next && report.next->p_value < kLevel) ||
         (report.next_but_one && report.next_but_one->p_value < kLevel);
}

std::string residual_sentence(const OrderReport& report, double rounding_hz) {
  const Eigen::Index order = report.fit.polynomial.order();
  std::string text =
      fmt::format("The {} leaves up to {:.3f} Hz", order_name(order), report.fit.max_residual_hz);
  if (rounding_hz > 0.0 && report.chi_square_p) {
    const bool explained = *report.chi_square_p >= kLevel;
    text += fmt::format("{} the table's rounding explains {:.3f} Hz (chi-square {:.3g} on {}, p = {:.2g}{})",
                        explained ? ";" : " where", rounding_hz, *report.chi_square, report.fit.dof,
                        *report.chi_square_p, explained ? ": rounding alone can do that" : "");
  }
  return text + ".\n";
}

std::string test_sentence(const OrderReport& report) {
  if (!report.next) return {};
  const OrderTest& test = *report.next;
  return fmt::format("Order {} is {}supported against order {}: F = {:.3g}, p = {:.2g}.\n",
                     test.against_order, test.p_value < kLevel ? "" : "not ", report.fit.polynomial.order(),
                     test.f_statistic, test.p_value);
}

std::string leave_one_out_sentence(const OrderReport& report) {
  const std::string name = order_name(report.fit.polynomial.order());
  if (std::isnan(report.leave_one_out_max_degc)) {
    return fmt::format("Leave-one-out, {}: cannot be inverted at every point.\n", name);
  }
  return fmt::format("Leave-one-out temperature error, {}: up to {:.2f} degC.\n", name,
                     report.leave_one_out_max_degc);
}

std::string describe(const OrderStudy& study) {
  std::string text;
  // The step that settled it is told from the order below; where a straight line is enough, from that alone.
  const Eigen::Index first = std::max<Eigen::Index>(1, study.chosen - 1);
  for (Eigen::Index order = first; order <= study.chosen; ++order) {
    text += residual_sentence(study.report(order), study.rounding_hz);
    text += test_sentence(study.report(order));
    text += leave_one_out_sentence(study.report(order));
  }
  const FrequencyPolynomial& polynomial = study.report(study.chosen).fit.polynomial;
  text += fmt::format("Chosen: order {} ({}), {} from {:g} to {:g} degC.\n", study.chosen,
                      order_name(study.chosen), polynomial.monotone() ? "monotone" : "NOT monotone",
                      polynomial.min_degc(), polynomial.max_degc());
  return text;
}

}  // namespace

OrderStudy study_order(const SettledPoints& points, double reference_degc) {
  const Eigen::Index largest = largest_order(points);
  if (largest < 1) {
    throw std::invalid_argument(
        "f(T): at least three settled points at three different temperatures are needed");
  }
  OrderStudy study;
  study.rounding_hz = 0.5 * points.resolution_hz;
  for (Eigen::Index order = 1; order <= largest; ++order) {
    OrderReport report{fit_frequency(points, order, reference_degc), {}, {}, {}, {}, {}, 0.0};
    judge_rounding(report, points.resolution_hz);
    report.leave_one_out_degc = leave_one_out_degc(points, order, reference_degc);
    report.leave_one_out_max_degc = report.leave_one_out_degc.array().isNaN().any()
                                        ? std::numeric_limits<double>::quiet_NaN()
                                        : report.leave_one_out_degc.cwiseAbs().maxCoeff();
    study.orders.push_back(std::move(report));
  }
  for (std::size_t i = 0; i < study.orders.size(); ++i) {
    if (i + 1 < study.orders.size())
      study.orders[i].next = compare(study.orders[i].fit, study.orders[i + 1].fit);
    if (i + 2 < study.orders.size()) {
      study.orders[i].next_but_one = compare(study.orders[i].fit, study.orders[i + 2].fit);
    }
  }
  while (study.chosen < largest && improved(study.report(study.chosen))) ++study.chosen;
  study.verdict = describe(study);
  return study;
}

}  // namespace hemi::calibration

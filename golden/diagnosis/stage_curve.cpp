// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/stage_curve.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <functional>
#include <numbers>

namespace hemi::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kLeavesNothing = 1e-3;
constexpr double kTakesAll = 0.995;
constexpr double kTakesFlatTop = 0.9;
constexpr double kLowestLevel = 0.7;  // a clipped top below this is no top
constexpr int kGrid = 2048;

double tail(double chi2, int freedom) {
  if (freedom <= 0) return 1.0;
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(freedom), std::max(chi2, 0.0)));
}

// Harmonics of r(cos phase): c0, c_k of the orders, zeros for the sines. By Chebyshev's nodes.
class Shapes {
 public:
  explicit Shapes(const Harmonics& h)
      : rows_(h.value_lsb.size()), nodes_(kGrid), transform_(kGrid, h.order.size() + 1) {
    for (int i = 0; i < kGrid; ++i) {
      const double phase = std::numbers::pi * (i + 0.5) / kGrid;
      nodes_[i] = std::cos(phase);
      transform_(i, 0) = 1.0 / kGrid;
      for (std::size_t k = 0; k < h.order.size(); ++k)
        transform_(i, static_cast<Index>(k) + 1) = 2.0 / kGrid * std::cos(h.order[k] * phase);
    }
  }
  VectorXd of(const std::function<double(double)>& curve) const {
    VectorXd value = VectorXd::Zero(rows_);
    value.head(transform_.cols()) = transform_.transpose() * nodes_.unaryExpr(curve);
    return value;
  }

 private:
  Index rows_;
  VectorXd nodes_;
  MatrixXd transform_;
};

struct Linear {
  VectorXd coefficient;
  MatrixXd covariance;
  double chi2 = 0.0;
};

Linear fit_columns(const Harmonics& h, const MatrixXd& columns) {
  const MatrixXd weighted = h.information * columns;
  // scaled to unit diagonal: columns may differ by orders of magnitude
  MatrixXd normal = columns.transpose() * weighted;
  const VectorXd scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  normal = scale.asDiagonal() * normal * scale.asDiagonal();
  const VectorXd right = scale.asDiagonal() * (weighted.transpose() * h.value_lsb);
  const auto solver = normal.ldlt();
  Linear fit;
  fit.coefficient = scale.asDiagonal() * solver.solve(right);
  fit.covariance = scale.asDiagonal() * solver.solve(MatrixXd::Identity(normal.rows(), normal.cols())) *
                   scale.asDiagonal();
  const VectorXd left = h.value_lsb - columns * fit.coefficient;
  fit.chi2 = left.dot(h.information * left);
  return fit;
}

CurveFit rate(Curve curve, int parameters, double chi2, double chi2_none, Index rows) {
  CurveFit fit{.curve = curve, .parameters = parameters, .chi2 = chi2};
  fit.p = tail(chi2, static_cast<int>(rows) - parameters);
  fit.explained = chi2_none > 0.0 ? 1.0 - chi2 / chi2_none : 0.0;
  return fit;
}

CurveFit fit_one(Curve curve, const Harmonics& h, const Shapes& shapes, double chi2_none,
                 const std::function<double(double)>& shape) {
  const Linear fit = fit_columns(h, shapes.of(shape));
  CurveFit result = rate(curve, 1, fit.chi2, chi2_none, h.value_lsb.size());
  result.strength = fit.coefficient[0];
  result.strength_sigma = std::sqrt(fit.covariance(0, 0));
  return result;
}

CurveFit fit_smooth(const Harmonics& h, const Shapes& shapes, double chi2_none, bool offset) {
  MatrixXd columns(h.value_lsb.size(), offset ? 5 : 4);
  for (int degree = 2; degree <= 5; ++degree)
    columns.col(degree - 2) = shapes.of([degree](double u) { return std::pow(u, degree); });
  if (offset) columns.col(4) = shapes.of([](double) { return 1.0; });
  const Linear fit = fit_columns(h, columns);
  CurveFit result =
      rate(Curve::smooth, static_cast<int>(columns.cols()), fit.chi2, chi2_none, h.value_lsb.size());
  result.second = fit.coefficient[0] / h.amplitude_lsb;
  result.third = fit.coefficient[1] / h.amplitude_lsb;
  const int larger = std::abs(result.second) >= std::abs(result.third) ? 0 : 1;
  result.strength = fit.coefficient[larger] / h.amplitude_lsb;
  result.strength_sigma = std::sqrt(fit.covariance(larger, larger)) / h.amplitude_lsb;
  if (offset) {
    result.offset_lsb = fit.coefficient[4];
    result.offset_sigma_lsb = std::sqrt(fit.covariance(4, 4));
  }
  return result;
}

// The excess over a level, bent over a width: w log(1 + exp((u - level) / w)).
double excess(double u, double level, double width) {
  const double z = (u - level) / width;
  return z > 30.0 ? u - level : width * std::log1p(std::exp(z));
}

struct Top {
  double upper, lower, log_width;
};

Linear fit_top(const Harmonics& h, const Shapes& shapes, const Top& top) {
  const double width = std::exp(top.log_width);
  MatrixXd columns(h.value_lsb.size(), 3);
  columns.col(0) = shapes.of([&](double u) { return -excess(u, top.upper, width); });
  columns.col(1) = shapes.of([&](double u) { return excess(-u, top.lower, width); });
  columns.col(2) = shapes.of([](double) { return 1.0; });
  return fit_columns(h, columns);
}

// Levels and width by a grid and then a compass search; a cut bends towards zero on both sides, or on one.
CurveFit fit_flat_top(const Harmonics& h, const Shapes& shapes, double chi2_none) {
  Top best{0.95, 0.95, std::log(1e-3)};
  Linear fit = fit_top(h, shapes, best);
  const auto consider = [&](const Top& top) {
    if (top.upper < kLowestLevel || top.lower < kLowestLevel || top.upper > 1.0 || top.lower > 1.0)
      return false;
    if (top.log_width < std::log(2e-4) || top.log_width > std::log(0.1)) return false;
    const Linear trial = fit_top(h, shapes, top);
    if (!(trial.chi2 < fit.chi2)) return false;
    fit = trial;
    best = top;
    return true;
  };
  for (const double width : {1e-3, 1e-2, 5e-2})
    for (double beyond = 0.3; beyond > 1e-4; beyond *= 0.7)
      consider({1.0 - beyond, 1.0 - beyond, std::log(width)});
  // steps are relative to what is beyond the level
  for (double step = 0.4; step > 1e-3; step *= 0.5) {
    bool better = true;
    for (int round = 0; round < 20 && better; ++round) {
      better = false;
      const double up = (1.0 - best.upper) * step + 1e-7, down = (1.0 - best.lower) * step + 1e-7;
      for (const double sign : {1.0, -1.0}) {
        better |= consider({best.upper + sign * up, best.lower, best.log_width});
        better |= consider({best.upper, best.lower + sign * down, best.log_width});
        better |= consider({best.upper + sign * up, best.lower + sign * down, best.log_width});
        better |= consider({best.upper, best.lower, best.log_width + sign * 4.0 * step});
      }
    }
  }
  CurveFit result = rate(Curve::flat_top, 6, fit.chi2, chi2_none, h.value_lsb.size());
  const bool both_inward = fit.coefficient.head(2).minCoeff() > -0.1 * fit.coefficient.head(2).maxCoeff();
  if (!both_inward) result.explained = result.p = 0.0;
  result.strength = fit.coefficient[0] > fit.coefficient[1] ? best.upper : best.lower;
  result.offset_lsb = fit.coefficient[2];
  result.offset_sigma_lsb = std::sqrt(fit.covariance(2, 2));
  return result;
}

bool leaves_nothing(const CurveFit& fit) {
  return fit.p > kLeavesNothing;
}

}  // namespace

std::string_view name(Curve curve) {
  constexpr std::array names = {"none", "offset", "stiffness", "smooth", "flat_top", "codes"};
  return names[static_cast<std::size_t>(curve)];
}

CurveChoice choose_curve(const Harmonics& h, double significance) {
  CurveChoice choice;
  choice.freedom = static_cast<int>(h.value_lsb.size());
  choice.chi2 = h.value_lsb.dot(h.information * h.value_lsb);
  choice.p = tail(choice.chi2, choice.freedom);
  const Index sines = static_cast<Index>(h.order.size());
  const VectorXd sine = h.value_lsb.tail(sines);
  const MatrixXd covariance = h.information.ldlt().solve(MatrixXd::Identity(choice.freedom, choice.freedom));
  choice.in_quadrature_p =
      tail(sine.dot(covariance.bottomRightCorner(sines, sines).ldlt().solve(sine)), static_cast<int>(sines));
  choice.chosen = rate(Curve::none, 0, choice.chi2, choice.chi2, choice.freedom);
  if (choice.p >= significance) return choice;

  const Shapes shapes(h);
  choice.tried.push_back(fit_one(Curve::offset, h, shapes, choice.chi2, [](double) { return 1.0; }));
  choice.tried.push_back(
      fit_one(Curve::stiffness, h, shapes, choice.chi2, [](double u) { return -2.0 / 3.0 + u * u / 3.0; }));
  choice.tried.push_back(fit_smooth(h, shapes, choice.chi2, false));
  choice.tried.push_back(fit_smooth(h, shapes, choice.chi2, true));
  choice.tried.push_back(fit_flat_top(h, shapes, choice.chi2));
  choice.tried[1].strength /= h.amplitude_lsb;
  choice.tried[1].strength_sigma /= h.amplitude_lsb;
  CurveFit codes = rate(Curve::codes, static_cast<int>(sines) + 1, 0.0, choice.chi2, choice.freedom);
  const VectorXd cosine = h.value_lsb.head(sines + 1);
  codes.strength = std::sqrt(cosine[0] * cosine[0] + 0.5 * cosine.tail(sines).squaredNorm());
  codes.explained = 1.0;

  const auto taken = std::ranges::find_if(choice.tried, leaves_nothing);
  if (taken != choice.tried.end()) {
    choice.chosen = *taken;
  } else {
    const auto best = std::ranges::max_element(choice.tried, {}, &CurveFit::explained);
    const double enough = best->curve == Curve::flat_top ? kTakesFlatTop : kTakesAll;
    choice.chosen = best->explained >= enough ? *best : codes;
  }
  choice.tried.push_back(codes);
  return choice;
}

}  // namespace hemi::diagnosis

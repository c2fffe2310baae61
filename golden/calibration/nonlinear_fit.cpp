// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/nonlinear_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <stdexcept>

#include "golden/calibration/linear_fit.hpp"

namespace hemi::calibration {
namespace {

constexpr int kMostSteps = 100;
constexpr int kMostWhitenedSteps = 12;
// The noise is estimated anew while the parameters still move, and then held, so that the iteration ends.
constexpr int kNoiseEstimates = 3;
// By this much in Akaike's criterion a free autoregression must beat the noise that is expected.
constexpr double kFreeNoiseGain = 10.0;

struct State {
  Eigen::VectorXd theta;
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;
};

State evaluate(const NonlinearProblem& problem, const Eigen::VectorXd& theta) {
  State state{theta, {}, {}};
  problem.evaluate(theta, state.residual, state.jacobian);
  return state;
}

// Weighted distance from what was known beforehand, per unit of noise variance.
double prior_cost(const NonlinearProblem& problem, const Eigen::VectorXd& theta) {
  return ((theta - problem.prior_mean).array() / problem.prior_deviation.array()).matrix().squaredNorm();
}

State least_squares(const NonlinearProblem& problem, const Eigen::VectorXd& start) {
  State now = evaluate(problem, start);
  double damping = 1e-3;
  const auto rows = static_cast<double>(now.residual.size());
  for (int step = 0; step < kMostSteps; ++step) {
    const double variance = now.residual.squaredNorm() / rows;
    const Eigen::VectorXd precision = variance * problem.prior_deviation.cwiseAbs2().cwiseInverse();
    Eigen::MatrixXd normal = now.jacobian.transpose() * now.jacobian;
    const Eigen::VectorXd gradient =
        now.jacobian.transpose() * now.residual + precision.cwiseProduct(problem.prior_mean - now.theta);
    normal.diagonal() += precision;
    const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt().cwiseMax(1e-300);
    normal = scale.cwiseInverse().asDiagonal() * normal * scale.cwiseInverse().asDiagonal();
    normal.diagonal().array() += damping;
    const Eigen::VectorXd scaled = normal.ldlt().solve(gradient.cwiseQuotient(scale));
    State next = evaluate(problem, now.theta + scaled.cwiseQuotient(scale));
    const auto cost = [&](const State& s) {
      return s.residual.squaredNorm() + variance * prior_cost(problem, s.theta);
    };
    const double before = cost(now), after = cost(next);
    if (!(after <= before)) {
      damping *= 10.0;
      if (damping > 1e12) return now;
      continue;
    }
    now = std::move(next);
    damping = std::max(damping / 10.0, 1e-12);
    if (before - after <= 1e-9 * before) return now;
  }
  return now;
}

// Partial autocorrelations of an autocorrelation, by Levinson and Durbin.
Eigen::VectorXd partial_of(const Eigen::VectorXd& r) {
  const Eigen::Index order = r.size() - 1;
  Eigen::VectorXd partial(order), a = Eigen::VectorXd::Zero(order);
  double variance = r[0];
  for (Eigen::Index k = 0; k < order; ++k) {
    double sum = r[k + 1];
    for (Eigen::Index j = 0; j < k; ++j) sum -= a[j] * r[k - j];
    partial[k] = sum / variance;
    const Eigen::VectorXd before = a.head(k);
    for (Eigen::Index j = 0; j < k; ++j) a[j] = before[j] - partial[k] * before[k - 1 - j];
    a[k] = partial[k];
    variance *= 1.0 - partial[k] * partial[k];
  }
  return partial;
}

// Minus twice the restricted log likelihood, its scale profiled out, up to a constant.
struct Deviance {
  double value;
  double innovation_variance;
};

Deviance deviance_of(const LaggedProducts& products, const Eigen::VectorXd& partial) {
  const Eigen::MatrixXd gram = products.gram(partial);
  const Eigen::Index columns = gram.rows() - 1;
  const Eigen::LDLT<Eigen::MatrixXd> inner(gram.topLeftCorner(columns, columns));
  const Eigen::VectorXd cross = gram.col(columns).head(columns);
  const double squares = gram(columns, columns) - cross.dot(inner.solve(cross));
  const auto dof = static_cast<double>(products.rows() - columns);
  return {
      dof * std::log(squares / dof) + products.log_determinant(partial) + inner.vectorD().array().log().sum(),
      squares / dof};
}

// Expected noise plus white: the share of white that the data like best, by Brent's method over its
// logarithm.
AutoregressiveNoise expected_and_white(const LaggedProducts& products, const Eigen::VectorXd& expected,
                                       double& deviance) {
  const auto partial_at = [&](double log_white) {
    Eigen::VectorXd r = expected.head(std::min<Eigen::Index>(expected.size(), products.max_order() + 1));
    r[0] += std::exp(log_white);
    return partial_of(r);
  };
  const auto found = boost::math::tools::brent_find_minima(
      [&](double log_white) { return deviance_of(products, partial_at(log_white)).value; }, -16.0, 12.0, 20);
  AutoregressiveNoise noise;
  noise.partial = partial_at(found.first);
  const Deviance best = deviance_of(products, noise.partial);
  noise.innovation_variance = best.innovation_variance;
  deviance = best.value;
  return noise;
}

AutoregressiveNoise noise_beside(const NonlinearProblem& problem, const State& state) {
  const Eigen::Index columns = state.jacobian.cols();
  const Eigen::VectorXd norms = state.jacobian.colwise().norm().transpose();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(state.jacobian * norms.cwiseInverse().asDiagonal());
  Eigen::MatrixXd z(state.jacobian.rows(), columns + 1);
  z.leftCols(columns) = qr.householderQ() * Eigen::MatrixXd::Identity(z.rows(), columns);
  z.col(columns) = state.residual;
  const Eigen::Index order = std::clamp<Eigen::Index>(z.rows() / 30, 1, 8);
  const LaggedProducts products(z, problem.segments, order);
  AutoregressiveNoise free = fit_noise(products);
  if (!problem.expected_noise) return free;
  double deviance = 0.0;
  AutoregressiveNoise expected = expected_and_white(products, problem.expected_noise(state.theta), deviance);
  const double gain = deviance - deviance_of(products, free.partial).value;
  // Parameters beside the scale: one share of white, or the partial autocorrelations.
  return gain - 2.0 * static_cast<double>(free.order() - 1) > kFreeNoiseGain ? free : expected;
}

// One step of Gauss and Newton under a given noise; the covariance comes with it.
struct Step {
  Eigen::VectorXd move;
  Eigen::MatrixXd covariance;
  double cost;  ///< squares in units of the innovation variance
};

double whitened_cost(const NonlinearProblem& problem, const State& state, const AutoregressiveNoise& noise) {
  return whiten(state.residual, problem.segments, noise.partial).squaredNorm() / noise.innovation_variance +
         prior_cost(problem, state.theta);
}

Step whitened_step(const NonlinearProblem& problem, const State& state, const AutoregressiveNoise& noise) {
  const Eigen::Index columns = state.jacobian.cols();
  Eigen::MatrixXd joined(state.jacobian.rows(), columns + 1);
  joined << state.jacobian, state.residual;
  const Eigen::MatrixXd white = whiten(joined, problem.segments, noise.partial);
  const double deviation = std::sqrt(noise.innovation_variance);
  Eigen::MatrixXd x(white.rows() + columns, columns);
  x.topRows(white.rows()) = white.leftCols(columns) / deviation;
  x.bottomRows(columns) = problem.prior_deviation.cwiseInverse().asDiagonal();
  Eigen::VectorXd y(x.rows());
  y.head(white.rows()) = white.col(columns) / deviation;
  y.tail(columns) = (problem.prior_mean - state.theta).cwiseQuotient(problem.prior_deviation);
  const Eigen::VectorXd norms = x.colwise().norm().transpose();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(x * norms.cwiseInverse().asDiagonal());
  const Eigen::MatrixXd r = qr.matrixQR().topRows(columns).triangularView<Eigen::Upper>();
  const Eigen::MatrixXd inverse =
      norms.cwiseInverse().asDiagonal() *
      r.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(columns, columns));
  return {qr.solve(y).cwiseQuotient(norms), inverse * inverse.transpose(), y.squaredNorm()};
}

void refuse_dependent(const NonlinearProblem& problem, const State& state) {
  const auto dependent = dependent_columns(state.jacobian);
  for (const Eigen::Index column : dependent) {
    if (std::isinf(problem.prior_deviation[column]))
      throw RankDeficiencyError(column, problem.names[static_cast<std::size_t>(column)]);
  }
}

}  // namespace

double NonlinearFit::standard_error(Eigen::Index i) const {
  return std::sqrt(covariance(i, i));
}

NonlinearFit fit_nonlinear(const NonlinearProblem& problem, const Eigen::VectorXd& start) {
  if (total_rows(problem.segments) < 2 * start.size()) {
    throw std::invalid_argument(fmt::format("{} averaged rows cannot determine {} parameters",
                                            total_rows(problem.segments), start.size()));
  }
  State now = least_squares(problem, start);
  refuse_dependent(problem, now);
  NonlinearFit fit;
  for (int i = 0; i < kMostWhitenedSteps; ++i) {
    if (i < kNoiseEstimates) fit.noise = noise_beside(problem, now);
    Step step = whitened_step(problem, now, fit.noise);
    fit.covariance = step.covariance;
    const Eigen::VectorXd errors = step.covariance.diagonal().cwiseSqrt();
    State next = evaluate(problem, now.theta + step.move);
    for (int halving = 0; halving < 6 && !(whitened_cost(problem, next, fit.noise) <= step.cost * (1 + 1e-9));
         ++halving) {
      step.move *= 0.5;
      next = evaluate(problem, now.theta + step.move);
    }
    now = std::move(next);
    if (i + 1 >= kNoiseEstimates && step.move.cwiseQuotient(errors).cwiseAbs().maxCoeff() < 0.01) break;
  }
  fit.theta = now.theta;
  fit.residual = now.residual;
  fit.jacobian = now.jacobian;
  fit.dof = static_cast<double>(now.residual.size() - start.size());
  return fit;
}

}  // namespace hemi::calibration

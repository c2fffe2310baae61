// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/simulation_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace hemi::diagnosis {
namespace {

using calibration::RowRange;
constexpr int kMostSteps = 60;
constexpr double kRelativeGain = 1e-9;

struct Normal {
  Eigen::MatrixXd matrix;    // J' J
  Eigen::VectorXd gradient;  // J' r
};

Normal normal_of(const SimulationFit& fit, const RowRange& rows) {
  const auto j = fit.jacobian.middleRows(rows.begin, rows.count);
  return {j.transpose() * j, j.transpose() * fit.residual.segment(rows.begin, rows.count)};
}

// matrix^-1 right after scaling to a unit diagonal, with Marquardt's damping.
Eigen::MatrixXd solve_scaled(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right, double damping) {
  const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
  Eigen::MatrixXd scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  scaled.diagonal().array() += damping;
  return scale.asDiagonal() * scaled.ldlt().solve(scale.asDiagonal() * right);
}

Eigen::MatrixXd sandwich(const SimulationFit& fit, const std::vector<RowRange>& blocks) {
  const Eigen::Index p = fit.form.size();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(p, p), meat = matrix;
  for (const RowRange& block : blocks) {
    const Normal normal = normal_of(fit, block);
    matrix += normal.matrix;
    meat += normal.gradient * normal.gradient.transpose();
  }
  const auto count = static_cast<double>(blocks.size());
  const Eigen::MatrixXd bread = solve_scaled(matrix, Eigen::MatrixXd::Identity(p, p), 0.0);
  return bread * (meat * count / (count - 1.0)) * bread.transpose();
}

}  // namespace

std::vector<RowRange> equal_blocks(Eigen::Index rows, Eigen::Index count) {
  std::vector<RowRange> blocks;
  for (Eigen::Index b = 0; b < count; ++b) {
    const Eigen::Index begin = rows * b / count;
    blocks.push_back({begin, rows * (b + 1) / count - begin});
  }
  return blocks;
}

double SimulationFit::rms() const {
  return std::sqrt(residual.squaredNorm() / static_cast<double>(residual.size()));
}

double SimulationFit::half_width95(Eigen::Index place, Eigen::Index blocks) const {
  const boost::math::students_t student(static_cast<double>(blocks - 1));
  return boost::math::quantile(student, 0.975) * std::sqrt(covariance(place, place));
}

SimulationFit fit_simulation(const BenchInput& input, const Eigen::VectorXd& displacement_v,
                             const BenchForm& form, const Eigen::VectorXd& start,
                             const std::vector<RowRange>& blocks, const std::function<void()>& tick) {
  SimulationFit fit{.form = form, .parameters = start, .covariance = {}, .residual = {}, .jacobian = {}};
  fit.residual = displacement_v - simulate(input, form, start, fit.jacobian);
  double cost = fit.residual.squaredNorm(), damping = 1e-3;
  for (int step = 0; step < kMostSteps && damping < 1e12; ++step) {
    tick();
    const Normal normal = normal_of(fit, {0, fit.residual.size()});
    const Eigen::VectorXd next = fit.parameters + solve_scaled(normal.matrix, normal.gradient, damping);
    const Eigen::VectorXd residual = displacement_v - simulate(input, form, next);
    const double after = residual.squaredNorm();
    if (!(after <= cost)) {
      damping *= 10.0;
      continue;
    }
    fit.parameters = next;
    fit.residual = displacement_v - simulate(input, form, next, fit.jacobian);
    damping = std::max(damping / 10.0, 1e-14);
    fit.converged = cost - after <= kRelativeGain * cost;
    cost = after;
    if (fit.converged) break;
  }
  fit.converged = (fit.converged || damping >= 1e12) && std::isfinite(cost);
  fit.covariance = sandwich(fit, blocks);
  return fit;
}

Eigen::VectorXd held_out_residual(const BenchInput& input, const Eigen::VectorXd& displacement_v,
                                  const SimulationFit& fit, const std::vector<RowRange>& folds,
                                  const std::function<void()>& tick) {
  const Normal whole = normal_of(fit, {0, fit.residual.size()});
  Eigen::VectorXd result(fit.residual.size());
  const Eigen::Index free = fit.form.size() - 2;
  for (const RowRange& fold : folds) {
    tick();
    const Normal own = normal_of(fit, fold);
    const Eigen::MatrixXd matrix = (whole.matrix - own.matrix).topLeftCorner(free, free);
    Eigen::VectorXd without = fit.parameters;
    without.head(free) += solve_scaled(matrix, (whole.gradient - own.gradient).head(free), 0.0);
    result.segment(fold.begin, fold.count) =
        (displacement_v - simulate(input, fit.form, without)).segment(fold.begin, fold.count);
  }
  return result;
}

Eigen::VectorXd parameters_from(const SimulationFit& fit, const std::vector<RowRange>& rows) {
  const Eigen::Index p = fit.form.size();
  Normal sum{Eigen::MatrixXd::Zero(p, p), Eigen::VectorXd::Zero(p)};
  for (const RowRange& range : rows) {
    const Normal normal = normal_of(fit, range);
    sum.matrix += normal.matrix;
    sum.gradient += normal.gradient;
  }
  // The first state is seen by the first rows only; it is held.
  const Eigen::Index free = p - 2;
  Eigen::VectorXd parameters = fit.parameters;
  parameters.head(free) +=
      solve_scaled(sum.matrix.topLeftCorner(free, free), sum.gradient.head(free), 0.0).col(0);
  return parameters;
}

}  // namespace hemi::diagnosis

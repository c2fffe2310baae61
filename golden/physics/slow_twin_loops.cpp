// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/slow_twin_loops.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/MatrixFunctions>
#include <utility>

namespace hemi::physics {

namespace {

/// Transition over a time and the covariance that white noise adds meanwhile.
template <typename Square>
std::pair<Square, Square> discretise(const Square& rates, const Square& noise, double dt_s) {
  // Over a step that is short against everything the series converges at once; then the step is doubled,
  // which adds positive terms only and so loses no digits however long it gets.
  const double fastest_per_s = rates.template lpNorm<1>();
  int doublings = 0;
  while (std::ldexp(dt_s, -doublings) * fastest_per_s > 1e-2) ++doublings;
  const double h = std::ldexp(dt_s, -doublings);
  Square transition = (rates * h).exp();
  Square term = noise * h;  // h^n/n! times the n-th derivative of the covariance
  Square covariance = term;
  for (int n = 2; n <= 8; ++n) {
    term = ((h / n) * (rates * term + term * rates.transpose())).eval();
    covariance += term;
  }
  for (int i = 0; i < doublings; ++i) {
    covariance = (covariance + transition * covariance * transition.transpose()).eval();
    transition = (transition * transition).eval();
  }
  return {transition, covariance};
}

template <typename Square>
Square root_of(const Square& covariance) {
  // Correlated by the scales of the states first: they differ by many orders of magnitude.
  const auto scales = covariance.diagonal().cwiseSqrt().cwiseMax(1e-300).eval();
  const auto inverse = scales.cwiseInverse().eval();
  const Square correlation = inverse.asDiagonal() * covariance * inverse.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Square> solver(correlation);
  return scales.asDiagonal() * solver.eigenvectors() *
         solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

}  // namespace

LoopGains LoopGains::of_bandwidth(double closed_loop_3db_hz) {
  const double ratio = 0.1 * std::sqrt(1.01);  // z/K
  const double b = 1.0 + 2.0 * ratio;
  const double x = std::sqrt(0.5 * (b + std::sqrt(b * b + 4.0 * ratio * ratio)));
  const double k_per_s = 2.0 * std::numbers::pi * closed_loop_3db_hz / x;
  return {k_per_s, ratio * k_per_s};
}

LoopResponse::LoopResponse(LoopGains gains, double dt_s) : dt_s_(dt_s) {
  const double k = gains.k_per_s;
  const double z = gains.z_per_s;
  const double root = std::sqrt(k * k - 4.0 * k * z);
  const std::array<double, 2> rates = {0.5 * (k + root), 2.0 * k * z / (k + root)};
  for (std::size_t i = 0; i < 2; ++i) {
    const double other = rates[1 - i];
    modes_[i] = {rates[i], k * (z - rates[i]) / (other - rates[i]), std::exp(-rates[i] * dt_s), 0.0};
  }
}

void LoopResponse::settle(double input) {
  for (Mode& mode : modes_) mode.state = input / mode.rate_per_s;
  start_ = mean_ = end_ = input;
}

void LoopResponse::advance(double middle, double slope) {
  const double first = middle - 0.5 * slope * dt_s_;
  start_ = end_;
  mean_ = 0.0;
  end_ = 0.0;
  for (Mode& mode : modes_) {
    const double rate = mode.rate_per_s;
    const double arrived = (1.0 - mode.decay) / rate;
    const double next = mode.decay * mode.state + first * arrived + slope * (dt_s_ - arrived) / rate;
    mean_ += mode.residue_per_s * (middle - (next - mode.state) / dt_s_) / rate;
    end_ += mode.residue_per_s * next;
    mode.state = next;
  }
}

LoopNoise::LoopNoise(LoopGains gains, double dt_s, double force_density_per_s_rthz,
                     double pickoff_density_rthz, std::uint64_t seed, std::uint64_t stream)
    : dt_s_(dt_s), gaussian_(seed, stream) {
  const double k = gains.k_per_s;
  Square rates = Square::Zero();
  rates(0, 0) = -k;
  rates(0, 1) = -k * gains.z_per_s;
  rates(1, 0) = 1.0;
  rates(2, 0) = 1.0;
  Eigen::Matrix<double, kStates, 2> inputs;  // of F and n
  inputs << 1.0, -k, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0;
  const Eigen::Vector2d two_sided(0.5 * force_density_per_s_rthz * force_density_per_s_rthz,
                                  0.5 * pickoff_density_rthz * pickoff_density_rthz);
  const Square noise = inputs * two_sided.asDiagonal() * inputs.transpose();
  const auto [transition, covariance] = discretise(rates, noise, dt_s);
  transition_ = transition;
  kick_ = root_of(covariance);

  // Start in the steady state: forty times the slower time constant, which is about 1/z.
  const auto [unused, settled] = discretise(rates, noise, 40.0 / gains.z_per_s);
  const Eigen::LLT<Eigen::Matrix2d> stationary(settled.template topLeftCorner<2, 2>());
  state_.head<2>() = stationary.matrixL() * Eigen::Vector2d(gaussian_(), gaussian_());
}

void LoopNoise::advance() {
  const double former = state_[0];
  Vector white;
  for (int i = 0; i < kStates; ++i) white[i] = gaussian_();
  state_.tail<3>().setZero();
  state_ = (transition_ * state_ + kick_ * white).eval();
  measured_ = (state_[2] + state_[3]) / dt_s_;
  command_per_s_ = (state_[0] - former - state_[4]) / dt_s_;
}

}  // namespace hemi::physics

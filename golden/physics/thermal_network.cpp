// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/thermal_network.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

namespace hemi::physics {

double Pole::advance(double x, double u0, double u1, double dt_s) {
  if (tau_s_ <= 0.0) return u1;
  if (dt_s <= 0.0) return x;
  if (!same_step(dt_s, dt_s_)) {
    const double h = dt_s / tau_s_;
    dt_s_ = dt_s;
    decay_ = std::exp(-h);
    slope_gain_ = 1.0 + std::expm1(-h) / h;
  }
  return u0 + decay_ * (x - u0) + slope_gain_ * (u1 - u0);
}

void PowerOnRise::start(double time_s, double power_on_s) {
  time_s_ = time_s;
  const double tau_s = pole_.tau_s();
  const double on_s = time_s - power_on_s;
  value_degc_ = on_s < 0.0 ? 0.0 : tau_s > 0.0 ? -rise_degc_ * std::expm1(-on_s / tau_s) : rise_degc_;
}

void PowerOnRise::advance(double time_s, double power_on_s) {
  // Off until power_on_s, on from there: the step falls into at most two pieces.
  const double switched_s = std::clamp(power_on_s, time_s_, time_s);
  value_degc_ = pole_.advance(value_degc_, 0.0, 0.0, switched_s - time_s_);
  if (time_s >= power_on_s) {
    value_degc_ = pole_.advance(value_degc_, rise_degc_, rise_degc_, time_s - switched_s);
  }
  time_s_ = time_s;
}

ThermalNetwork::ThermalNetwork(const Instrument& instrument, double start_degc) : chamber_degc_(start_degc) {
  nodes_.fill(start_degc);
  tau_s_.fill(0.0);
  set_time_constants(instrument);
}

void ThermalNetwork::set_time_constants(const Instrument& instrument) {
  const std::array<double, kNodes> wanted = {instrument.case_time_constant_s, instrument.stem_time_constant_s,
                                             instrument.shell_time_constant_s};
  if (wanted == tau_s_) return;
  tau_s_ = wanted;
  dt_s_ = 0.0;
}

void ThermalNetwork::prepare(double dt_s) {
  // State: the nodes that lag, the chamber and its slope. A node without lag is its predecessor.
  Eigen::Matrix<double, kNodes + 2, kNodes + 2> rates = Eigen::Matrix<double, kNodes + 2, kNodes + 2>::Zero();
  constexpr int chamber = kNodes;
  constexpr int rise = kNodes + 1;
  rates(chamber, rise) = 1.0 / dt_s;
  std::array<int, kNodes> source{};
  int upstream = chamber;
  for (int k = 0; k < kNodes; ++k) {
    const double tau_s = tau_s_[static_cast<std::size_t>(k)];
    if (tau_s > 0.0) {
      rates(k, k) = -1.0 / tau_s;
      rates(k, upstream) = 1.0 / tau_s;
      upstream = k;
    }
    source[static_cast<std::size_t>(k)] = upstream;
  }
  const Eigen::Matrix<double, kNodes + 2, kNodes + 2> step = (rates * dt_s).exp();
  for (std::size_t k = 0; k < kNodes; ++k) {
    for (int j = 0; j < kNodes + 2; ++j) {
      transition_[k][static_cast<std::size_t>(j)] = step(source[k], j);
    }
  }
  dt_s_ = dt_s;
}

void ThermalNetwork::advance(double chamber_degc, double dt_s) {
  if (dt_s > 0.0) {
    if (dt_s_ == 0.0 || !same_step(dt_s, dt_s_)) prepare(dt_s);
    const double rise = chamber_degc - chamber_degc_;
    const std::array<double, kNodes> old = nodes_;
    for (std::size_t k = 0; k < kNodes; ++k) {
      const auto& row = transition_[k];
      nodes_[k] =
          row[0] * old[0] + row[1] * old[1] + row[2] * old[2] + row[3] * chamber_degc_ + row[4] * rise;
    }
    if (tau_s_[2] > 0.0) {
      slope_degc_s_ = (nodes_[1] - nodes_[2]) / tau_s_[2];
    } else if (tau_s_[1] > 0.0) {
      slope_degc_s_ = (nodes_[0] - nodes_[1]) / tau_s_[1];
    } else if (tau_s_[0] > 0.0) {
      slope_degc_s_ = (chamber_degc - nodes_[0]) / tau_s_[0];
    } else {
      slope_degc_s_ = rise / dt_s;
    }
  }
  chamber_degc_ = chamber_degc;
}

}  // namespace hemi::physics

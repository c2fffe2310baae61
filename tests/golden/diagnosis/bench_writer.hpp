// SPDX-License-Identifier: Apache-2.0
// Writes bench recordings on its own: Dormand and Prince's integrator with step control, a force that is a
// sum of sines known at every instant, coloured noise. Nothing of the diagnosis is used.
#pragma once

#include <Eigen/Core>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

namespace hemi::diagnosis::testing {

struct Written {
  Eigen::VectorXd force_v;
  Eigen::VectorXd displacement_v;
};

struct BenchWriter {
  double gain = 180000.0;
  double damping_per_s = 40.0;
  double stiffness_per_s2 = 185000.0;  ///< 68.5 Hz
  double constant = -900.0;
  double rate_hz = 600.0;
  Eigen::Index rows = 8192;
  double force_rms_v = 0.03;
  double noise_v = 2e-4;
  double noise_pole = 0.9;  ///< correlation of neighbouring samples
  unsigned seed = 1;
  /// Force beside the linear ones, of displacement and velocity [V/s^2].
  std::function<double(double y, double v)> extra = [](double, double) { return 0.0; };

  Written write() const {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> turn(0.0, 2.0 * std::numbers::pi);
    std::vector<double> w, phase;
    for (int k = 1; k <= 80; ++k) {
      w.push_back(2.0 * std::numbers::pi * (2.5 * k + 0.01 * turn(random)));
      phase.push_back(turn(random));
    }
    const double each = force_rms_v * std::sqrt(2.0 / static_cast<double>(w.size()));
    const auto force = [&](double t) {
      double sum = 0.0;
      for (std::size_t k = 0; k < w.size(); ++k) sum += std::sin(w[k] * t + phase[k]);
      return each * sum;
    };
    using State = std::vector<double>;
    const auto motion = [&](const State& s, State& d, double t) {
      d[0] = s[1];
      d[1] = gain * force(t) + constant - damping_per_s * s[1] - stiffness_per_s2 * s[0] - extra(s[0], s[1]);
    };
    Written out{Eigen::VectorXd(rows), Eigen::VectorXd(rows)};
    std::normal_distribution<double> normal;
    double noise = 0.0;
    Eigen::Index row = 0;
    State state = {0.0, 0.0};
    namespace odeint = boost::numeric::odeint;
    odeint::integrate_n_steps(
        odeint::make_dense_output(1e-8, 1e-8, odeint::runge_kutta_dopri5<State>()), motion, state, 0.0,
        1.0 / rate_hz, static_cast<std::size_t>(rows - 1), [&](const State& s, double t) {
          noise = noise_pole * noise + std::sqrt(1.0 - noise_pole * noise_pole) * noise_v * normal(random);
          out.force_v[row] = force(t);
          out.displacement_v[row++] = s[0] + noise;
        });
    return out;
  }
};

}  // namespace hemi::diagnosis::testing

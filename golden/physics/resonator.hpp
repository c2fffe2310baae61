// SPDX-License-Identifier: Apache-2.0
// The two-mode resonator in steps of one sample.
#pragma once

#include <array>
#include <cmath>

#include "golden/physics/propagator.hpp"

namespace hemi::physics {

/// Displacements [nominal amplitudes] and velocities [1/s] of both modes.
struct Motion {
  double x = 0.0;
  double x_rate_per_s = 0.0;
  double y = 0.0;
  double y_rate_per_s = 0.0;
};

/// Integrates the equations of Parameters (docs/physics.md). A step is K D L D K: the linear part L exact,
/// over half a step each K, velocity changes by the quadrature command's stiffness and the nonlinear springs,
/// and D, nonlinear damping, each exact as well. Strang, SIAM J. Numer. Anal. 5 (1968) 506: error of order
/// h^2, here times the small terms alone.
class Resonator {
 public:
  /// velocity_scale_rad_s: about the natural frequency; step_s: one sample.
  Resonator(const Parameters& parameters, double step_s, double velocity_scale_rad_s);

  /// From the next step on. The state stays.
  void set(const Parameters& parameters, double step_s);

  void set_motion(const Motion& motion);
  Motion motion() const { return {z_[0], z_[1] * scale_rad_s_, z_[2], z_[3] * scale_rad_s_}; }
  double x() const { return z_[0]; }
  double y() const { return z_[2]; }
  /// y' over the velocity scale.
  double scaled_y_rate() const { return z_[3]; }
  /// Of the primary's vibration: sqrt(x^2 + (x'/w)^2).
  double amplitude() const;

  /// One step with the forces per mass fx, fy [nominal amplitudes/s^2] and the quadrature command [full
  /// scale] held.
  void step(double fx, double fy, double quadrature) {
    const double coupling = half_coupling_ * quadrature;
    kick(coupling);
    if (springs_ || nonlinear_damping_) nonlinear_half_step(true);
    // Number by number: packed loads of numbers that were just stored singly wait for the store.
    const State z = z_;
    for (int i = 0; i < 4; ++i) {
      const auto row = [this, i](int column) { return propagator_.change(i, column); };
      z_[i] = z[i] + ((row(0) * z[0] + row(1) * z[1]) + (row(2) * z[2] + row(3) * z[3]) +
                      (propagator_.response(i, 0) * fx + propagator_.response(i, 1) * fy));
    }
    if (springs_ || nonlinear_damping_) nonlinear_half_step(false);
    kick(coupling);
  }

  /// Velocity jumps, over the velocity scale.
  void push_x(double change) { z_[1] += change; }
  void push_y(double change) { z_[3] += change; }

 private:
  using State = std::array<double, 4>;  // x, x'/s, y, y'/s

  void kick(double coupling) {
    const double x_kick = coupling * z_[2];
    z_[3] += coupling * z_[0];
    z_[1] += x_kick;
  }
  void nonlinear_half_step(bool springs_first);
  void springs_half_step();
  void damping_half_step(bool quadratic_first);

  State z_{};
  Propagator propagator_;
  double half_coupling_ = 0.0;
  bool springs_ = false;
  bool nonlinear_damping_ = false;
  double scale_rad_s_;
  double omega_rad_s_ = 0.0;
  // over half a step, in the state's units
  double half_cubic_ = 0.0;
  double half_quadratic_ = 0.0;
  double half_quadratic_damping_ = 0.0;
  double half_cubic_damping_ = 0.0;
};

}  // namespace hemi::physics

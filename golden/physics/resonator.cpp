// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/resonator.hpp"

#include <numbers>

namespace hemi::physics {

Resonator::Resonator(const Parameters& parameters, double step_s, double velocity_scale_rad_s)
    : scale_rad_s_(velocity_scale_rad_s) {
  set(parameters, step_s);
}

void Resonator::set(const Parameters& p, double step_s) {
  const double s = scale_rad_s_;
  const double w = p.omega_rad_s;
  const double half_s = step_s / 2.0;
  omega_rad_s_ = w;
  propagator_ = make_propagator(p, step_s, s);
  half_coupling_ = half_s * w * p.quadrature_span_rad_s / s;
  half_cubic_ = half_s * w * w * p.cubic_stiffness / s;
  half_quadratic_ = half_s * w * w * p.quadratic_stiffness / s;
  half_quadratic_damping_ =
      half_s * 2.0 * p.damping_per_s * (3.0 * std::numbers::pi / 8.0) * p.quadratic_damping * s / w;
  half_cubic_damping_ = half_s * (8.0 / 3.0) * p.cubic_damping_per_s * (s / w) * (s / w);
  springs_ = half_cubic_ != 0.0 || half_quadratic_ != 0.0;
  nonlinear_damping_ = half_quadratic_damping_ != 0.0 || half_cubic_damping_ != 0.0;
}

void Resonator::set_motion(const Motion& motion) {
  z_ = {motion.x, motion.x_rate_per_s / scale_rad_s_, motion.y, motion.y_rate_per_s / scale_rad_s_};
}

double Resonator::amplitude() const {
  return std::hypot(z_[0], z_[1] * scale_rad_s_ / omega_rad_s_);
}

void Resonator::nonlinear_half_step(bool springs_first) {
  if (springs_ && springs_first) springs_half_step();
  if (nonlinear_damping_) damping_half_step(springs_first);
  if (springs_ && !springs_first) springs_half_step();
}

void Resonator::springs_half_step() {
  const double x = z_[0];
  const double y = z_[2];
  const double cubic = half_cubic_ * (x * x + y * y);
  z_[1] -= cubic * x + half_quadratic_ * x * x;
  z_[3] -= cubic * y + half_quadratic_ * y * y;
}

// v' = -c |v| v and v' = -c |v|^2 v shrink v along itself: v / (1 + c |v| t) and v / sqrt(1 + 2 c |v|^2 t).
void Resonator::damping_half_step(bool quadratic_first) {
  const auto shrink = [this](double factor) {
    z_[1] *= factor;
    z_[3] *= factor;
  };
  const auto speed_squared = [this] { return z_[1] * z_[1] + z_[3] * z_[3]; };
  const auto quadratic = [&] { shrink(1.0 / (1.0 + half_quadratic_damping_ * std::sqrt(speed_squared()))); };
  const auto cubic = [&] { shrink(1.0 / std::sqrt(1.0 + 2.0 * half_cubic_damping_ * speed_squared())); };
  if (quadratic_first) quadratic();
  cubic();
  if (!quadratic_first) quadratic();
}

}  // namespace hemi::physics

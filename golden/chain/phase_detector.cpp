// SPDX-License-Identifier: Apache-2.0
#include "golden/chain/phase_detector.hpp"

#include <numbers>

namespace hemi::golden {
namespace {

// In units of 2^-32, in which every word of the CORDIC is a whole number.
Polar vectoring(double x, double y) {
  const double unit = power_of_two(config::cordic.fraction);
  static const Eigen::Array<double, config::cordic_iterations, 1> angles = [] {
    Eigen::Array<double, config::cordic_iterations, 1> a;
    for (int i = 0; i < config::cordic_iterations; ++i) {
      a[i] = round_to(
          std::atan(power_of_two(-i)) / (2.0 * std::numbers::pi) * power_of_two(config::angle.fraction), 0);
    }
    return a;
  }();
  x *= unit;
  y *= unit;
  double z = 0.0;
  if (x < 0.0) {
    x = -x;
    y = -y;
    z = -0.5 * power_of_two(config::angle.fraction);
  }
  for (int i = 0; i < config::cordic_iterations; ++i) {
    const double direction = y < 0.0 ? -1.0 : 1.0;
    const double dx = std::floor(y * power_of_two(-i));
    const double dy = std::floor(x * power_of_two(-i));
    x += direction * dx;
    y -= direction * dy;
    z += direction * angles[i];  // wrapped once at the end: additions modulo one turn
  }
  return {x / unit, modulo(z * power_of_two(-config::angle.fraction), 1.0)};
}

}  // namespace

double cordic_gain() {
  double gain = 1.0;
  for (int i = 0; i < config::cordic_iterations; ++i) gain *= std::sqrt(1.0 + power_of_two(-2 * i));
  return gain;
}

Polar polar(const Arithmetic& arithmetic, double in_phase, double quadrature) {
  if (arithmetic.quantised()) return vectoring(in_phase, quadrature);
  static const double gain = cordic_gain();
  return {gain * std::hypot(in_phase, quadrature),
          modulo(std::atan2(quadrature, in_phase) / (2.0 * std::numbers::pi), 1.0)};
}

Secondary rotate(const Arithmetic& arithmetic, double yi, double yq, double c, double s) {
  Secondary result{0.0, 0.0, false};
  const auto word = [&](double sum) {
    return arithmetic.saturate(arithmetic.round(sum, config::baseband.fraction), config::baseband,
                               result.clipped);
  };
  result.in_phase = word(yi * c + yq * s);
  result.quadrature = word(yq * c - yi * s);
  return result;
}

}  // namespace hemi::golden

// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/instrument.hpp"

#include <cmath>
#include <numbers>

namespace hemi::physics {

namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

double polynomial(const std::vector<double>& ascending, double argument) {
  double value = 0.0;
  for (auto coefficient = ascending.rbegin(); coefficient != ascending.rend(); ++coefficient) {
    value = value * argument + *coefficient;
  }
  return value;
}

}  // namespace

Parameters Instrument::at(double shell_degc) const {
  const auto omega = [&](double degc) {
    return kTwoPi * polynomial(frequency_hz, degc - frequency_reference_degc);
  };
  const double nominal_damping_per_s = omega(kReferenceDegc) / (2.0 * quality_factor);

  Parameters p;
  p.omega_rad_s = omega(shell_degc);
  p.damping_per_s = nominal_damping_per_s * polynomial(relative_damping, shell_degc - kReferenceDegc);
  const double mismatch_per_s = damping_mismatch * p.damping_per_s;
  p.mismatch_cos_per_s = mismatch_per_s * std::cos(2.0 * damping_axis_deg * kRadPerDeg);
  p.mismatch_sin_per_s = mismatch_per_s * std::sin(2.0 * damping_axis_deg * kRadPerDeg);
  const double split_rad_s = kTwoPi * split_hz * polynomial(relative_split, shell_degc - kReferenceDegc);
  p.split_cos_rad_s = split_rad_s * std::cos(2.0 * split_axis_deg * kRadPerDeg);
  p.split_sin_rad_s = split_rad_s * std::sin(2.0 * split_axis_deg * kRadPerDeg);
  p.kappa = kappa;
  p.centrifugal = centrifugal;
  p.drive_per_s = drive_full_scale_over_steady * nominal_damping_per_s;
  p.rebalance_per_s = kappa * rebalance_full_scale_dps * kRadPerDeg;
  p.quadrature_span_rad_s = kTwoPi * quadrature_full_scale_hz;
  return p;
}

}  // namespace hemi::physics

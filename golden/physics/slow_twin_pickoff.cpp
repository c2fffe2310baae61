// SPDX-License-Identifier: Apache-2.0
#include "golden/physics/slow_twin_pickoff.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "golden/physics/converters.hpp"

namespace hemi::physics {

namespace {

constexpr double kLsbPerFullScale = 32768.0;
constexpr double kTwoOverPi = 2.0 / std::numbers::pi;

/// Level of step k, fraction of full scale.
double level(int k) {
  return (k + 1 - 8) / 8.0;
}

}  // namespace

PickoffCurve::PickoffCurve(const Instrument& instrument)
    : full_scale_per_amplitude_(instrument.pickoff_full_scale_per_amplitude) {
  // The curve is straight between the steps: two points tell the slope, and the rest at each step is its
  // height.
  constexpr double kHalf = 1.0 / 32.0;
  const double slope = (integral_nonlinearity(1.5 * kHalf) - integral_nonlinearity(0.5 * kHalf)) / kHalf;
  inl_slope_ = 0.5 * slope;
  for (int k = 0; k < kSteps; ++k) {
    const double position = 0.5 + 0.5 * level(k);
    inl_step_[static_cast<std::size_t>(k)] = integral_nonlinearity(position + 0.5 * kHalf) -
                                             integral_nonlinearity(position - 0.5 * kHalf) - slope * kHalf;
  }
}

double PickoffCurve::converted(double fraction, const Parameters& p) const {
  double u = fraction;
  if (u > p.adc_clip) {
    const double c = p.adc_clip / u;
    u *= kTwoOverPi * (std::asin(c) + c * std::sqrt(1.0 - c * c));
  }
  if (p.adc_inl_lsb == 0.0) return u;
  double inl = inl_slope_ * u;
  for (int k = 0; k < kSteps; ++k) {
    const double l = level(k) / u;
    if (std::abs(l) < 1.0)
      inl += inl_step_[static_cast<std::size_t>(k)] * kTwoOverPi * std::sqrt(1.0 - l * l);
  }
  return u + inl * p.adc_inl_lsb / kLsbPerFullScale;
}

double PickoffCurve::measured(double amplitude, const Parameters& p) const {
  const double pickoff =
      p.pickoff_gain_x * amplitude * (1.0 + 0.75 * p.pickoff_cubic * amplitude * amplitude);
  return converted(full_scale_per_amplitude_ * pickoff, p) / full_scale_per_amplitude_;
}

double PickoffCurve::amplitude(double measured_amplitude, const Parameters& p) const {
  const double linear = measured_amplitude / p.pickoff_gain_x;
  const bool straight = p.pickoff_cubic == 0.0 && p.adc_inl_lsb == 0.0 &&
                        full_scale_per_amplitude_ * std::abs(measured_amplitude) <= p.adc_clip;
  if (straight) return linear;
  // The fundamental of a square wave is what clipping leaves at most. Close below it the amplitude runs away.
  const double reach = 0.99 * 2.0 * kTwoOverPi * p.adc_clip / full_scale_per_amplitude_;
  if (measured_amplitude > reach) {
    throw std::invalid_argument(fmt::format(
        "an amplitude of {} cannot be held: the front end clips at {} of full scale, which allows {} at most",
        measured_amplitude, p.adc_clip, reach));
  }
  // Newton's method; the slope by a difference is good enough for its quadratic convergence near the
  // solution.
  double guess = linear;
  for (int i = 0; i < 30; ++i) {
    const double error = measured(guess, p) - measured_amplitude;
    const double h = 1e-6 * guess;
    const double slope = (measured(guess + h, p) - measured(guess - h, p)) / (2.0 * h);
    const double step = error / slope;
    guess -= step;
    if (std::abs(step) < 1e-13 * guess) break;
  }
  return guess;
}

}  // namespace hemi::physics

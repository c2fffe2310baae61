// SPDX-License-Identifier: Apache-2.0
// Runs an effect beside the nominal instrument and compares channel by channel.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "golden/physics/slow_twin.hpp"

namespace hemi::physics {

using Channel = double TelemetrySample::*;

inline const std::map<std::string, Channel>& measured_channels() {
  static const std::map<std::string, Channel> channels = {
      {"frequency_hz", &TelemetrySample::frequency_hz},
      {"amplitude", &TelemetrySample::amplitude},
      {"drive_v", &TelemetrySample::drive_v},
      {"quadrature_v", &TelemetrySample::quadrature_v},
      {"rate_dph", &TelemetrySample::rate_dph},
      {"case_temp_degc", &TelemetrySample::case_temp_degc},
      {"board_temp_degc", &TelemetrySample::board_temp_degc}};
  return channels;
}

/// Damping and split that do not depend on temperature, so that a temperature shows in the frequency alone.
inline Instrument plain_instrument() {
  Instrument instrument;
  instrument.relative_damping = {1.0};
  instrument.relative_split = {1.0};
  return instrument;
}

/// Two hours with everything in motion: chamber down and up again, turntable, supply, acceleration and
/// quadrature trim in steps; the amplitude stays.
inline Environment everything_moves(double t_s, double amplitude) {
  Environment e;
  e.chamber_degc = t_s < 3600.0 ? 20.0 - 40.0 * t_s / 3600.0 : -20.0 + 60.0 * (t_s - 3600.0) / 3600.0;
  e.rate_dph = t_s < 2000.0 ? 0.0 : t_s < 4000.0 ? 1e5 : -5e4;
  e.accel_g = t_s < 1500.0 ? 0.0 : t_s < 5000.0 ? 1.0 : -1.0;
  e.supply_v = t_s < 3000.0 ? 5.0 : 5.05;
  e.quadrature_trim_v = t_s < 2500.0 ? 0.0 : t_s < 4500.0 ? 0.1 : -0.05;
  e.amplitude_setpoint = amplitude;
  return e;
}

/// Inputs, the nominal instrument's telemetry and the world's temperatures along them.
struct Scene {
  Instrument instrument = plain_instrument();
  std::vector<Environment> inputs;
  std::vector<TelemetrySample> nominal;
  std::vector<Conditions> world;

  explicit Scene(double amplitude = 1.0) {
    constexpr double kIntervalS = 10.0;
    inputs = sample_inputs([amplitude](double t_s) { return everything_moves(t_s, amplitude); }, 0.0,
                           kIntervalS, 720);
    nominal = run({});
    World state(instrument, {}, inputs.front(), 0);
    for (const Environment& input : inputs) {
      state.advance(input, amplitude);
      world.push_back(state.conditions());
    }
  }

  std::vector<TelemetrySample> run(const std::vector<ActiveEffect>& effects) const {
    SlowTwinOptions options;
    options.noise = false;
    return simulate_slow(instrument, effects, inputs, options);
  }
};

/// What the equation predicts to be added to a channel at sample i.
using Prediction = std::function<double(std::size_t i)>;

/// Largest drive that the change of the frequency's slope against the nominal run asks for.
inline double adiabatic_drive_v(const Scene& scene, const std::vector<TelemetrySample>& changed) {
  const Parameters p = scene.instrument.at(20.0);
  double largest = 0.0;
  for (std::size_t i = 1; i < changed.size(); ++i) {
    const auto change = [&](std::size_t k) {
      return changed[k].frequency_hz - scene.nominal[k].frequency_hz;
    };
    const double slope_hz_s = (change(i) - change(i - 1)) / (changed[i].time_s - changed[i - 1].time_s);
    largest = std::max(largest, 0.5 * std::abs(slope_hz_s) / changed[i].frequency_hz);
  }
  return largest / p.drive_per_s * scene.instrument.drive_full_scale_v;
}

/// The channels named change by their predictions, within `tolerance` of the largest of them (and the
/// rounding of doubles); all others do not change.
inline void expect_signature(const Scene& scene, const ActiveEffect& effect,
                             const std::map<std::string, Prediction>& predictions, double tolerance = 1e-9) {
  SCOPED_TRACE(effect.id);
  const std::vector<TelemetrySample> changed = scene.run({effect});
  ASSERT_EQ(changed.size(), scene.nominal.size());
  const std::vector<std::string>& named = catalogue().find(effect.id)->second.description.channels;
  for (const auto& [name, channel] : measured_channels()) {
    SCOPED_TRACE(name);
    double scale = 0.0;
    for (const TelemetrySample& sample : scene.nominal) scale = std::max(scale, std::abs(sample.*channel));
    const auto prediction = predictions.find(name);
    std::vector<double> expected(changed.size(), 0.0);
    double size = 0.0;
    double allowed = 1e-12 * scale;
    if (prediction != predictions.end()) {
      EXPECT_TRUE(std::find(named.begin(), named.end(), name) != named.end()) << "not in the description";
      for (std::size_t i = 0; i < changed.size(); ++i) {
        expected[i] = prediction->second(i);
        size = std::max(size, std::abs(expected[i]));
      }
      allowed = tolerance * size + 8.0 * std::numeric_limits<double>::epsilon() * scale;
      EXPECT_GT(size, 3.0 * allowed) << "the signature is lost in the tolerance";
    }
    double worst = 0.0;
    std::size_t where = 0;
    for (std::size_t i = 0; i < changed.size(); ++i) {
      const double error = std::abs(changed[i].*channel - scene.nominal[i].*channel - expected[i]);
      if (error > worst) {
        worst = error;
        where = i;
      }
    }
    // Whatever moves the frequency moves the drive a little: w'/(2 w) of amplitude growth (docs/effects.md).
    if (name == "drive_v" && prediction == predictions.end())
      allowed += 1.05 * adiabatic_drive_v(scene, changed);
    EXPECT_LE(worst, allowed) << "sample " << where << ": expected a change of " << expected[where]
                              << ", got " << changed[where].*channel - scene.nominal[where].*channel;
  }
}

}  // namespace hemi::physics

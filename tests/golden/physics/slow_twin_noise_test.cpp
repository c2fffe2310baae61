// SPDX-License-Identifier: Apache-2.0
// The slow twin's noise against the densities it comes from, integrated over frequency.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "golden/physics/slow_twin.hpp"
#include "golden/physics/slow_twin_loops.hpp"

namespace hemi::physics {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr std::size_t kCount = 40000;

/// Variance of averages over dt of a noise of density S(f): integral of S sinc^2(pi f dt), by a sum in ln f.
double averaged_variance(const std::function<double(double f_hz)>& density, double dt_s) {
  double sum = 0.0;
  constexpr double kStep = 1e-5;
  for (double u = std::log(1e-6); u < std::log(2e4); u += kStep) {
    const double f = std::exp(u);
    const double x = std::numbers::pi * f * dt_s;
    const double sinc = x < 1e-8 ? 1.0 : std::sin(x) / x;
    sum += density(f) * sinc * sinc * f * kStep;
  }
  return sum;
}

double t_squared(LoopGains g, double f_hz) {
  const double w = kTwoPi * f_hz;
  const double kz = g.k_per_s * g.z_per_s;
  return (g.k_per_s * g.k_per_s * w * w + kz * kz) /
         (std::pow(kz - w * w, 2) + g.k_per_s * g.k_per_s * w * w);
}

/// |1 - T|^2 = w^4/|w^2 - K z - j K w|^2
double s_squared(LoopGains g, double f_hz) {
  const double w = kTwoPi * f_hz;
  const double kz = g.k_per_s * g.z_per_s;
  return std::pow(w, 4) / (std::pow(kz - w * w, 2) + g.k_per_s * g.k_per_s * w * w);
}

double sample_variance(const std::vector<TelemetrySample>& telemetry, double TelemetrySample::*channel) {
  double mean = 0.0;
  for (const TelemetrySample& sample : telemetry)
    mean += sample.*channel / static_cast<double>(telemetry.size());
  double sum = 0.0;
  for (const TelemetrySample& sample : telemetry) sum += std::pow(sample.*channel - mean, 2);
  return sum / static_cast<double>(telemetry.size());
}

std::vector<TelemetrySample> hold(const Instrument& instrument, double dt_s, std::uint64_t seed = 11) {
  SlowTwinOptions options;
  options.seed = seed;
  return simulate_slow(instrument, {}, sample_inputs([](double) { return Environment{}; }, 0.0, dt_s, kCount),
                       options);
}

TEST(SlowTwinNoise, VariancesFollowFromForceAndPickoffNoise) {
  Instrument instrument;
  instrument.oscillator_noise_rthz = 0.0;
  instrument.pickoff_noise_lsb = 20.0;  // so that each channel has its share of both
  const double s_f = std::pow(0.554 * 0.5 * kRadPerSecondPerDph, 2);
  const double s_n = 4.0 * (20.0 * 20.0 + 1.0 / 12.0) / std::pow(32768.0 * 0.8, 2) / 1e5;
  const double drive_per_v = 400.0 * std::numbers::pi * 4432.067 / 1e7 / 10.0;
  const double quadrature_per_v = 0.5 * kTwoPi * 0.05 / 10.0;
  for (const double dt_s : {0.02, 1.0}) {
    SCOPED_TRACE(dt_s);
    const auto telemetry = hold(instrument, dt_s);
    // Five standard deviations of a sample variance; neighbours are correlated, by less than a factor 2 in
    // number.
    const double allowed = 5.0 * std::sqrt(2.0 * 2.0 / kCount);
    const auto command = [&](double bandwidth_hz) {
      const LoopGains g = LoopGains::of_bandwidth(bandwidth_hz);
      return averaged_variance(
          [&](double f) { return t_squared(g, f) * (s_f + std::pow(kTwoPi * f, 2) * s_n); }, dt_s);
    };
    const double rate = sample_variance(telemetry, &TelemetrySample::rate_dph);
    EXPECT_NEAR(rate / (command(40.0) / std::pow(0.554 * kRadPerSecondPerDph, 2)), 1.0, allowed);
    const double drive = sample_variance(telemetry, &TelemetrySample::drive_v);
    const double quadrature = sample_variance(telemetry, &TelemetrySample::quadrature_v);
    // slow loops at fast telemetry: neighbours within the loop's time are one number
    const double slow = allowed * std::sqrt(1.0 + 0.5 / dt_s);
    EXPECT_NEAR(drive / (command(0.5) / std::pow(drive_per_v, 2)), 1.0, slow);
    EXPECT_NEAR(quadrature / (command(1.0) / std::pow(quadrature_per_v, 2)), 1.0, slow);
    const LoopGains g = LoopGains::of_bandwidth(0.5);
    const double amplitude = averaged_variance(
        [&](double f) { return s_squared(g, f) * (s_f / std::pow(kTwoPi * f, 2) + s_n); }, dt_s);
    EXPECT_NEAR(sample_variance(telemetry, &TelemetrySample::amplitude) / amplitude, 1.0, slow);
    const double frequency =
        s_f / (kTwoPi * kTwoPi) / (2.0 * dt_s) + 2.0 * s_n / (2.0 * 0.005) / std::pow(kTwoPi * dt_s, 2);
    EXPECT_NEAR(sample_variance(telemetry, &TelemetrySample::frequency_hz) / frequency, 1.0, allowed);
  }
}

TEST(SlowTwinNoise, FrequencyNoiseOfPickoffsIsAPhaseThatDoesNotAddUp) {
  Instrument instrument;
  instrument.force_noise_dph_rthz = 0.0;
  instrument.pickoff_noise_lsb = 20.0;
  const auto telemetry = hold(instrument, 0.1);
  SlowTwinOptions silent;
  silent.noise = false;
  const double f0 = simulate_slow(instrument, {}, {Environment{}}, silent).front().frequency_hz;
  double turns = 0.0;
  double largest = 0.0;
  for (const TelemetrySample& sample : telemetry) {
    turns += (sample.frequency_hz - f0) * 0.1;
    largest = std::max(largest, std::abs(turns));
  }
  const double s_n = 4.0 * 400.0 / std::pow(32768.0 * 0.8, 2) / 1e5;
  const double phase_turns = std::sqrt(s_n / (2.0 * 0.005)) / kTwoPi;
  // the difference of two phases, the largest of 4e4: six deviations; a sum of independent numbers would
  // reach 200
  EXPECT_LT(largest, 6.0 * std::sqrt(2.0) * phase_turns + 4e4 * 1e-13);
  EXPECT_GT(largest, 2.0 * phase_turns);
}

TEST(SlowTwinNoise, RoundingOfTheConverterIsAllThatASilentPickoffHas) {
  Instrument instrument;
  instrument.force_noise_dph_rthz = 0.0;
  instrument.pickoff_noise_lsb = 0.0;
  const LoopGains g = LoopGains::of_bandwidth(40.0);
  const double s_n = 4.0 / 12.0 / std::pow(32768.0 * 0.8, 2) / 1e5;
  const double expected =
      averaged_variance([&](double f) { return t_squared(g, f) * std::pow(kTwoPi * f, 2) * s_n; }, 0.1);
  const double rate = sample_variance(hold(instrument, 0.1), &TelemetrySample::rate_dph);
  EXPECT_NEAR(rate * std::pow(0.554 * kRadPerSecondPerDph, 2) / expected, 1.0,
              5.0 * std::sqrt(2.0 * 2.0 / kCount));
}

TEST(SlowTwinNoise, OscillatorThermometerAndFlicker) {
  Instrument instrument;
  instrument.force_noise_dph_rthz = 0.0;
  instrument.oscillator_noise_rthz = 1e-9;
  instrument.rate_flicker_dph = 0.05;
  const auto telemetry = hold(instrument, 1.0);
  const double allowed = 5.0 * std::sqrt(2.0 / kCount);
  const double expected = std::pow(4432.066 * 1e-9, 2) / 2.0;
  EXPECT_NEAR(sample_variance(telemetry, &TelemetrySample::frequency_hz) / expected, 1.0, allowed);
  // Rounding to steps of 0.01 degC of a deviation of 0.005: variances add up to 1e-2 (Sheppard).
  const double thermometer = 0.005 * 0.005 + 0.01 * 0.01 / 12.0;
  EXPECT_NEAR(sample_variance(telemetry, &TelemetrySample::case_temp_degc) / thermometer, 1.0,
              allowed + 0.01);
  for (const TelemetrySample& sample : telemetry) {
    EXPECT_NEAR(sample.case_temp_degc * 100.0, std::round(sample.case_temp_degc * 100.0), 1e-9);
  }
  // Allan deviation over 64 s: the floor (pickoff noise is far below it); 40000/64 pairs, correlated
  double allan = 0.0;
  constexpr std::size_t kAverage = 64;
  const std::size_t pairs = kCount / kAverage - 1;
  for (std::size_t k = 0; k < pairs; ++k) {
    double difference = 0.0;
    for (std::size_t i = 0; i < kAverage; ++i) {
      difference += telemetry[(k + 1) * kAverage + i].rate_dph - telemetry[k * kAverage + i].rate_dph;
    }
    allan += 0.5 * std::pow(difference / kAverage, 2) / static_cast<double>(pairs);
  }
  EXPECT_NEAR(allan / (0.05 * 0.05), 1.0, 5.0 * std::sqrt(3.0 / static_cast<double>(pairs)) + 1.0 / kAverage);
}

TEST(SlowTwinNoise, SameSeedSameTelemetry) {
  const auto a = hold(Instrument{}, 1.0, 3);
  const auto b = hold(Instrument{}, 1.0, 3);
  const auto c = hold(Instrument{}, 1.0, 4);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].rate_dph, b[i].rate_dph);
    EXPECT_EQ(a[i].frequency_hz, b[i].frequency_hz);
    EXPECT_NE(a[i].rate_dph, c[i].rate_dph);
  }
}

}  // namespace
}  // namespace hemi::physics

// SPDX-License-Identifier: Apache-2.0
// Noise of the plant. Limits on means and variances are four standard deviations of theirs.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "golden/physics/noise.hpp"
#include "tests/golden/physics/plant_support.hpp"

namespace hemi::physics {
namespace {

using Complex = std::complex<double>;

constexpr double kPi = std::numbers::pi;

using testing::lossless;
using testing::ringing;
using testing::silent;

// A normal variable rounded to whole numbers about zero.
double rounded_variance(double deviation) {
  double variance = 0.0;
  for (int k = 1; k < 12.0 * deviation + 2.0; ++k) {
    const auto above = [&](double limit) {
      return 0.5 * std::erfc(limit / (deviation * std::numbers::sqrt2));
    };
    variance += 2.0 * k * k * (above(k - 0.5) - above(k + 0.5));
  }
  return variance;
}

// 0.5 LSB of 16 bit at 100 kS/s; at 250 kS/s the same density has 2.5 times the variance, in LSB a quarter as
// large
TEST(Noise, OfThePickoffsIsThatOfTheDataSheet) {
  const double deviations[] = {0.5, 0.5 * 4.0 * std::sqrt(2.5)};
  const AdcConfiguration adcs[] = {AdcConfiguration::reference(), AdcConfiguration::wide()};
  for (int i = 0; i < 2; ++i) {
    PlantConfiguration configuration;
    configuration.adc = adcs[i];
    configuration.seed = 11;
    Plant plant(Instrument{}, lossless(silent()), configuration);
    constexpr int kCount = 400000;
    double xx = 0.0;
    double yy = 0.0;
    double xy = 0.0;
    for (int n = 0; n < kCount; ++n) {
      const auto [x, y] = plant.sample();
      xx += static_cast<double>(x) * x;
      yy += static_cast<double>(y) * y;
      xy += static_cast<double>(x) * y;
    }
    const double expected = rounded_variance(deviations[i]);
    // the rounded variable's fourth moment is no larger than 3.5 variances squared
    const double relative = 4.0 * std::sqrt(2.5 / kCount);
    EXPECT_NEAR(xx / kCount / expected, 1.0, relative);
    EXPECT_NEAR(yy / kCount / expected, 1.0, relative);
    EXPECT_NEAR(xy / kCount / expected, 0.0, 4.0 / std::sqrt(kCount));
  }
}

// White rate noise of one-sided density N integrates to an angle of variance N^2 t / 2 (in-phase part of the
// amplitude over kappa), and a white force has as much in quadrature, on either axis.
TEST(Noise, OfTheForcesHasItsDensityAsRate) {
  Instrument instrument = silent();
  instrument.force_noise_dph_rthz = 200.0;
  const double density = 200.0 * kRadPerSecondPerDph;
  for (const AdcConfiguration adc : {AdcConfiguration::reference(), AdcConfiguration::wide()}) {
    PlantConfiguration configuration;
    configuration.adc = adc;
    configuration.seed = 3;
    const Parameters p = lossless(instrument);
    Plant plant(instrument, p, configuration);
    constexpr int kBlocks = 4000;
    constexpr int kSamples = 200;
    const double step_s = 1.0 / adc.rate_hz;
    double sums[4] = {};
    Complex last_x;
    Complex last_y;
    for (int block = 1; block <= kBlocks; ++block) {
      for (int n = 0; n < kSamples; ++n) plant.act({});
      const Motion m = plant.motion();
      const Complex frame = std::polar(1.0, -std::fmod(p.omega_rad_s * step_s * kSamples * block, 2.0 * kPi));
      const Complex x = Complex(m.x, -m.x_rate_per_s / p.omega_rad_s) * frame;
      const Complex y = Complex(m.y, -m.y_rate_per_s / p.omega_rad_s) * frame;
      sums[0] += std::pow((x - last_x).real(), 2);
      sums[1] += std::pow((x - last_x).imag(), 2);
      sums[2] += std::pow((y - last_y).real(), 2);
      sums[3] += std::pow((y - last_y).imag(), 2);
      last_x = x;
      last_y = y;
    }
    const double expected = p.kappa * p.kappa * density * density / 2.0 * kSamples * step_s;
    // 50 pushes a block meet the carrier at phases that cover it to within a fiftieth
    for (const double sum : sums)
      EXPECT_NEAR(sum / kBlocks / expected, 1.0, 4.0 * std::sqrt(2.0 / kBlocks) + 0.02);
  }
}

TEST(Noise, RepeatsWithItsSeedAndOnlyWithIt) {
  const auto record = [](std::uint64_t seed) {
    PlantConfiguration configuration = ringing();
    configuration.seed = seed;
    const Instrument instrument;
    Plant plant(instrument, instrument.at(20.0), configuration);
    std::vector<std::int32_t> words;
    for (int n = 0; n < 1000; ++n) {
      const auto [x, y] = plant.sample();
      words.insert(words.end(), {x, y});
      plant.act({static_cast<std::int16_t>(y), static_cast<std::int16_t>(x), 100});
    }
    return words;
  };
  EXPECT_EQ(record(5), record(5));
  // noise of half an LSB, drawn anew, leaves a rounded word as it was in less than three cases of four
  const std::vector<std::int32_t> words = record(5);
  const std::vector<std::int32_t> others = record(6);
  std::size_t differing = 0;
  for (std::size_t i = 0; i < words.size(); ++i) differing += words[i] != others[i] ? 1 : 0;
  EXPECT_GT(differing, words.size() / 4);
}

TEST(Noise, OfRateAndOscillatorChangesTheParametersFromUpdateToUpdate) {
  Instrument instrument = silent();
  instrument.rate_flicker_dph = 0.01;
  instrument.oscillator_noise_rthz = 1e-9;
  Plant plant(instrument, lossless(instrument), PlantConfiguration{});
  constexpr int kUpdates = 4000;
  double oscillator = 0.0;
  double rate = 0.0;
  for (int update = 0; update < kUpdates; ++update) {
    for (int n = 0; n < 100; ++n) plant.act({});
    oscillator += std::pow(plant.parameters().oscillator_error, 2);
    rate = std::max(rate, std::abs(plant.parameters().rate_rad_s));
  }
  // white up to half of 1 kHz
  EXPECT_NEAR(oscillator / kUpdates / (1e-18 * 500.0), 1.0, 4.0 * std::sqrt(2.0 / kUpdates));
  // the flicker's whole deviation: 21 poles
  const double deviation =
      std::sqrt(21.0 * std::log(10.0) / 2.0 * FlickerNoise::h_of_floor(0.01)) * kRadPerSecondPerDph;
  EXPECT_GT(rate, 0.3 * deviation);
  EXPECT_LT(rate, 6.0 * deviation);
}

}  // namespace
}  // namespace hemi::physics

// SPDX-License-Identifier: Apache-2.0
// Effects that show in the raw samples: the full-rate plant with the effect switched on against the equation,
// channel by channel. A ringing resonator without noise; harmonics by least squares over whole milliseconds.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <vector>

#include "golden/physics/plant.hpp"

namespace hemi::physics {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr int kSamples = 50000;
constexpr double kLsb = 32768.0;

struct Capture {
  std::vector<double> x, y;
};

/// Half a second of both ADCs; `drive` stands on the drive DAC the whole time.
Capture capture(const std::vector<ActiveEffect>& effects, double amplitude, std::int16_t drive = 0,
                double second_mode = 0.5) {
  Instrument instrument;
  instrument.pickoff_noise_lsb = 0.0;
  instrument.force_noise_dph_rthz = 0.0;
  const Environment start;
  auto world = std::make_shared<World>(instrument, effects, start, 1);
  PlantConfiguration configuration;
  configuration.start = {amplitude, 0.4, second_mode * amplitude, 1.9};
  Plant plant(instrument, follow(world, [](double) { return Environment{}; }), configuration);
  Capture result;
  for (int n = 0; n < kSamples; ++n) {
    const AdcPair adc = plant.sample();
    plant.act({drive, 0, 0});
    result.x.push_back(adc.x);
    result.y.push_back(adc.y);
  }
  return result;
}

/// Amplitudes [LSB] of the constant and of the harmonics 1 to 4 of the resonator's frequency.
std::vector<double> harmonics(const std::vector<double>& v, double relative_shift = 0.0) {
  const double hz = Instrument{}.at(20.0).omega_rad_s / kTurn * (1.0 + relative_shift);
  Eigen::MatrixXd basis(kSamples, 9);
  for (int n = 0; n < kSamples; ++n) {
    basis(n, 0) = 1.0;
    for (int k = 1; k <= 4; ++k) {
      const double phase = kTurn * std::fmod(k * hz * n / 1e5, 1.0);
      basis(n, 2 * k - 1) = std::cos(phase);
      basis(n, 2 * k) = std::sin(phase);
    }
  }
  const Eigen::Map<const Eigen::VectorXd> values(v.data(), kSamples);
  const Eigen::VectorXd fit = (basis.transpose() * basis).ldlt().solve(basis.transpose() * values);
  std::vector<double> result = {fit[0]};
  for (int k = 1; k <= 4; ++k) result.push_back(std::hypot(fit[2 * k - 1], fit[2 * k]));
  return result;
}

/// Rounding of kSamples words is white but for a sine's own harmonics of the steps; each is below a hundredth
/// of a step at an amplitude of 26 000 steps.
constexpr double kRounding_lsb = 0.02;

TEST(RawChannels, NothingButTheFundamentalWithoutAnEffect) {
  const auto h = harmonics(capture({}, 1.0).x);
  // Half a second of a ring-down of 719 s, and of a split of 1 mHz, leaves 5e-4 of the amplitude.
  EXPECT_NEAR(h[1], 0.8 * kLsb, 1e-3 * 0.8 * kLsb);
  for (const int k : {0, 2, 3, 4}) EXPECT_LT(h[static_cast<std::size_t>(k)], kRounding_lsb) << k;
}

TEST(RawChannels, PickoffNonlinearityMakesHarmonicsThatGoWithTheAmplitude) {
  const double a2 = 2.0, a3 = 3.0, gap = 0.02;
  for (const double amplitude : {1.0, 0.5}) {
    const auto c =
        capture({{"pickoff_nonlinearity", {{"a2", a2}, {"a3", a3}, {"gap_ratio", gap}}}}, amplitude);
    const double full_lsb = 0.8 * kLsb;
    for (const auto* v : {&c.x, &c.y}) {
      const double a = v == &c.x ? amplitude : 0.5 * amplitude;
      const auto h = harmonics(*v);
      // g a2 A^2/2 at 0 and 2f, g a3 A^3/4 at 3f; the ring-down takes 3.5e-4 in the mean, with the third
      // power 1e-3.
      const double second = full_lsb * a2 * gap * a * a / 2.0,
                   third = full_lsb * a3 * gap * gap * a * a * a / 4.0;
      EXPECT_NEAR(h[0], second, 4e-3 * second + kRounding_lsb);
      EXPECT_NEAR(h[2], second, 4e-3 * second + kRounding_lsb);
      EXPECT_NEAR(h[3], third, 4e-3 * third + kRounding_lsb);
      EXPECT_LT(h[4], kRounding_lsb);
    }
  }
}

TEST(RawChannels, DuffingMakesAThirdHarmonic) {
  // x'' + w^2 x + w^2 k3 x^3 = 0: third harmonic k3 A^3/32, df/f = (3/8) k3 A^2, to first order in k3 A^2 =
  // 8e-3. The plant's splitting adds (3 w h)^2/24 at the third harmonic. The frequency follows the ring-down
  // by 4e-6, 0.05 rad of the fundamental over the capture, whose skirt reaches the even harmonics at 1e-5 of
  // it.
  const double shift = 3e-3;
  const auto c = capture({{"duffing", {{"relative_shift", shift}}}}, 1.0, 0, 0.0);
  const auto h = harmonics(c.x, shift);
  const double expected_lsb = 0.8 * kLsb * (8.0 / 3.0 * shift) / 32.0;
  const double splitting = std::pow(3.0 * Instrument{}.at(20.0).omega_rad_s * 1e-5, 2) / 24.0;
  EXPECT_NEAR(h[3], expected_lsb, (0.01 + splitting) * expected_lsb + kRounding_lsb);
  EXPECT_LT(h[2], 1e-5 * 0.8 * kLsb);
  EXPECT_LT(h[0], kRounding_lsb);
}

TEST(RawChannels, QuadraticStiffnessMakesAMeanAndASecondHarmonic) {
  const double k2 = 3e6;
  const double omega_rad_s = Instrument{}.at(20.0).omega_rad_s;
  const double volts = catalogue().at("quadratic_stiffness").description.parameters[1].typical;
  const double relative = k2 * volts / (omega_rad_s * omega_rad_s);
  const auto c = capture({{"quadratic_stiffness", {{"k2", k2}}}}, 1.0, 0, 0.0);
  const auto h = harmonics(c.x);
  const double full_lsb = 0.8 * kLsb;
  EXPECT_NEAR(h[0], -full_lsb * relative / 2.0, 0.01 * full_lsb * relative + kRounding_lsb);
  EXPECT_NEAR(h[2], full_lsb * relative / 6.0, 0.01 * full_lsb * relative + kRounding_lsb);
  EXPECT_GT(full_lsb * relative / 6.0, 1.0);
}

TEST(RawChannels, OffsetIsAConstantAndNothingElse) {
  const auto clean = capture({}, 1.0);
  const auto c = capture({{"adc_offset", {{"x", 37.0}, {"y", -12.0}}}}, 1.0);
  for (int n = 0; n < kSamples; ++n) {
    ASSERT_EQ(c.x[static_cast<std::size_t>(n)] - clean.x[static_cast<std::size_t>(n)], 37.0);
    ASSERT_EQ(c.y[static_cast<std::size_t>(n)] - clean.y[static_cast<std::size_t>(n)], -12.0);
  }
}

TEST(RawChannels, SaturationCutsTheTopsAtItsLevel) {
  const double level = 0.75;
  const auto clean = capture({}, 1.0);
  const auto c = capture({{"adc_saturation", {{"level", level}}}}, 1.0);
  int cut = 0;
  for (std::size_t n = 0; n < clean.x.size(); ++n) {
    const double expected = std::clamp(clean.x[n], -level * kLsb, level * kLsb);
    ASSERT_NEAR(c.x[n], expected, 0.5 + 1e-9);
    ASSERT_EQ(c.y[n], clean.y[n]);  // half the amplitude stays below
    cut += std::abs(clean.x[n]) > level * kLsb ? 1 : 0;
  }
  // A sine of 0.8 is beyond 0.75 for 2/pi acos(0.75/0.8) of the time.
  EXPECT_NEAR(static_cast<double>(cut) / kSamples, 2.0 / std::numbers::pi * std::acos(level / 0.8), 0.005);
}

TEST(RawChannels, NonlinearityOfTheConverterStaysAtItsCodes) {
  const double peak_lsb = 8.0;
  const auto clean = capture({}, 1.0), half = capture({}, 0.5);
  const auto c = capture({{"adc_nonlinearity", {{"peak", peak_lsb}}}}, 1.0);
  const auto c_half = capture({{"adc_nonlinearity", {{"peak", peak_lsb}}}}, 0.5);
  // The error belongs to the code: what half the amplitude sees at a code, the whole one sees there too.
  constexpr int bins = 256;
  std::vector<double> sum(bins), sum_half(bins), count(bins), count_half(bins);
  const auto bin = [](double code) { return static_cast<std::size_t>((code + kLsb) * bins / (2.0 * kLsb)); };
  double worst = 0.0;
  for (std::size_t n = 0; n < clean.x.size(); ++n) {
    const double error = c.x[n] - clean.x[n];
    worst = std::max(worst, std::abs(error));
    sum[bin(clean.x[n])] += error;
    count[bin(clean.x[n])] += 1.0;
    sum_half[bin(half.x[n])] += c_half.x[n] - half.x[n];
    count_half[bin(half.x[n])] += 1.0;
  }
  EXPECT_NEAR(worst, peak_lsb, 1.0);  // both words are rounded
  int compared = 0;
  for (std::size_t b = 0; b < bins; ++b) {
    if (count[b] < 30.0 || count_half[b] < 30.0) continue;
    // A code's error is constant but where a step falls into the bin; rounding leaves sqrt(1/6/30) each.
    if (std::abs(sum[b] / count[b] - sum_half[b] / count_half[b]) < 4.0 * std::sqrt(2.0 / 6.0 / 30.0))
      ++compared;
  }
  EXPECT_GE(compared, 90);  // of about 100 bins within half the amplitude, 16 steps
}

TEST(RawChannels, FeedthroughShowsTheDriveInThePrimaryAlone) {
  const std::int16_t drive =
      8192;  // a quarter of full scale, constant: the resonator, at 4432 Hz, hardly moves by it
  const auto clean = capture({}, 1.0, drive);
  const auto c = capture({{"drive_feedthrough", {{"coupling", 0.05}}}}, 1.0, drive);
  const double expected_lsb = 0.05 * 0.25 * kLsb;
  for (std::size_t n = 10; n < clean.x.size(); ++n) {
    ASSERT_NEAR(c.x[n] - clean.x[n], expected_lsb, 1.0);
    ASSERT_EQ(c.y[n], clean.y[n]);
  }
}

}  // namespace
}  // namespace hemi::physics

// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/allan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <string>

namespace hemi::calibration {
namespace {

Eigen::VectorXd white_noise(Eigen::Index size, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  return Eigen::VectorXd::NullaryExpr(size, [&] { return normal(generator); });
}

// Rates 1 3 2 6: differences 2 -1 4, sum of squares 21 over 2 * 3; averages of two 2 and 4, 4 over 2.
TEST(Allan, AgreesWithTheDefinitionByHand) {
  const AllanResult result = allan_deviation(Eigen::Vector4d(1, 3, 2, 6), 0.5);
  ASSERT_EQ(result.points.size(), 2u);
  EXPECT_EQ(result.points[0].tau_s, 0.5);
  EXPECT_EQ(result.points[0].pairs, 3);
  EXPECT_NEAR(result.points[0].deviation, std::sqrt(3.5), 1e-14);
  EXPECT_EQ(result.points[1].pairs, 1);
  EXPECT_NEAR(result.points[1].deviation, std::sqrt(2.0), 1e-14);
}

// Averages of a ramp of slope d, tau apart, differ by d tau: sigma = d tau / sqrt(2), at every tau.
TEST(Allan, RampIsExact) {
  const double slope = 0.25;
  const double interval_s = 0.1;
  const Eigen::VectorXd rate = Eigen::VectorXd::LinSpaced(1001, 0.0, 100.0 * slope);
  for (const AllanPoint& point : allan_deviation(rate, interval_s, TauSpacing::kDecade).points) {
    const double expected = slope * point.tau_s / std::sqrt(2.0);
    EXPECT_NEAR(point.deviation / expected, 1.0, 1e-9) << point.tau_s;
  }
}

TEST(Allan, TauSpacingAndLongestTau) {
  const Eigen::VectorXd rate = white_noise(1000, 1);
  const AllanResult decades = allan_deviation(rate, 2.0, TauSpacing::kDecade);
  ASSERT_EQ(decades.points.size(), 3u);
  EXPECT_EQ(decades.points[2].averaged, 100);
  const AllanResult octaves = allan_deviation(rate, 2.0);
  ASSERT_EQ(octaves.points.size(), 9u);
  EXPECT_EQ(octaves.points[8].averaged, 256);
  EXPECT_EQ(octaves.points[8].pairs, 489);
}

// sigma(m) = sigma / sqrt(m); each estimate has a relative standard deviation of 1 / sqrt(2 edf): five of
// these.
TEST(Allan, WhiteNoiseFallsAsTheoryWithinItsUncertainty) {
  const AllanResult result = allan_deviation(white_noise(1 << 16, 2), 1.0);
  for (const AllanPoint& point : result.points) {
    if (point.degrees_of_freedom < 20.0) continue;
    const double expected = 1.0 / std::sqrt(static_cast<double>(point.averaged));
    EXPECT_NEAR(point.deviation / expected, 1.0, 5.0 / std::sqrt(2.0 * point.degrees_of_freedom))
        << point.tau_s;
  }
  ASSERT_TRUE(result.angle_random_walk.has_value());
  // Read from all samples of the stretch: not worse than its first point with N / 1.5 degrees of freedom.
  EXPECT_NEAR(result.angle_random_walk->coefficient, 1.0, 5.0 / std::sqrt(2.0 * (1 << 16) / 1.5));
  EXPECT_NEAR(result.angle_random_walk->deg_per_root_hour(), result.angle_random_walk->coefficient / 60.0,
              1e-15);
}

// Neighbouring differences of single samples have correlation -1/2: K^2 / (K + 2 (K - 1) / 4).
TEST(Allan, DegreesOfFreedomAgreeWithClosedFormAndMonteCarlo) {
  EXPECT_NEAR(white_degrees_of_freedom(101, 1), 100.0 * 100.0 / (100.0 + 99.0 / 2.0), 1e-12);
  EXPECT_NEAR(white_degrees_of_freedom(64, 32), 1.0, 1e-12);
  constexpr int kTrials = 20000;
  double sum = 0.0;
  double squares = 0.0;
  const Eigen::VectorXd noise = white_noise(static_cast<Eigen::Index>(kTrials) * 64, 3);
  int covered = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const AllanPoint point = allan_deviation(noise.segment(trial * 64, 64), 1.0).points[3];
    const double variance = point.deviation * point.deviation * 8.0;
    sum += variance;
    squares += variance * variance;
    covered += point.lower * point.lower * 8.0 <= 1.0 && point.upper * point.upper * 8.0 >= 1.0 ? 1 : 0;
  }
  const double mean = sum / kTrials;
  const double variance = squares / kTrials - mean * mean;
  const double edf = white_degrees_of_freedom(64, 8);
  // A variance of kTrials values of kurtosis 3 + 12/edf is known to sqrt((2 + 12/edf) / kTrials); five of
  // these.
  EXPECT_NEAR(variance * edf / 2.0, 1.0, 5.0 * std::sqrt((2.0 + 12.0 / edf) / kTrials));
  // Chi-square with edf degrees matches two moments only: one percent beside five binomial sigma.
  EXPECT_NEAR(covered / static_cast<double>(kTrials), 0.6827, 0.01 + 5.0 * std::sqrt(0.22 / kTrials));
}

// NIST SP 1065, section 12.4: 1000 frequencies n_i / (2^31 - 1), n_0 = 1234567890, n_(i+1) = 16807 n_i mod
// (2^31 - 1).
Eigen::VectorXd thousand_points() {
  constexpr std::uint64_t modulus = 2147483647;
  std::uint64_t n = 1234567890;
  return Eigen::VectorXd::NullaryExpr(1000, [&n] {
    const double value = static_cast<double>(n) / static_cast<double>(modulus);
    n = 16807 * n % modulus;
    return value;
  });
}

std::string seven_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6e", value);
  return text;
}

// Table 31 there, in all printed digits; the same figures are in Riley, The Calculation of Time Domain
// Frequency Stability, table III, from Stable32.
TEST(Allan, AgreesWithThePublishedTestSuiteOfAThousandPoints) {
  const Eigen::VectorXd y = thousand_points();
  EXPECT_EQ(seven_digits(y.mean()), "4.897745e-01");
  EXPECT_EQ(seven_digits(y.maxCoeff()), "9.957453e-01");
  EXPECT_EQ(seven_digits(y.minCoeff()), "1.371760e-03");
  const auto separate = allan_deviation(y, 1.0, TauSpacing::kDecade, AllanEstimator::kSeparate).points;
  const auto overlapping = allan_deviation(y, 1.0, TauSpacing::kDecade).points;
  ASSERT_EQ(separate.size(), 3U);
  ASSERT_EQ(overlapping.size(), 3U);
  EXPECT_EQ(seven_digits(separate[0].deviation), "2.922319e-01");
  EXPECT_EQ(seven_digits(separate[1].deviation), "9.965736e-02");
  EXPECT_EQ(seven_digits(separate[2].deviation), "3.897804e-02");
  EXPECT_EQ(seven_digits(overlapping[0].deviation), "2.922319e-01");
  EXPECT_EQ(seven_digits(overlapping[1].deviation), "9.159953e-02");
  EXPECT_EQ(seven_digits(overlapping[2].deviation), "3.241343e-02");
}

// The nine frequencies of NBS Monograph 140, annex 8.E; SP 1065, table 30: seven printed digits.
TEST(Allan, AgreesWithThePublishedTestSuiteOfNinePoints) {
  const Eigen::VectorXd y = (Eigen::VectorXd(9) << 892, 809, 823, 798, 671, 644, 883, 903, 677).finished();
  const auto separate = allan_deviation(y, 1.0, TauSpacing::kOctave, AllanEstimator::kSeparate).points;
  const auto overlapping = allan_deviation(y, 1.0).points;
  EXPECT_EQ(seven_digits(separate[0].deviation), "9.122945e+01");
  EXPECT_EQ(seven_digits(separate[1].deviation), "1.158082e+02");
  EXPECT_EQ(seven_digits(overlapping[0].deviation), "9.122945e+01");
  EXPECT_EQ(seven_digits(overlapping[1].deviation), "8.595287e+01");
}

// SP 1065, table 5, white frequency noise, overlapping, N phases: [3 (N-1)/(2m) - 2 (N-2)/N] 4 m^2/(4 m^2 +
// 5). It is a fit to exact values; ours are exact. At a hundred averages it is 1.5 % off, below that 0.1 %.
TEST(Allan, DegreesOfFreedomAreThoseOfThePublishedFormula) {
  for (const auto& [m, share] : {std::pair{1.0, 1e-3}, {2.0, 1e-3}, {10.0, 1e-3}, {100.0, 0.015}}) {
    const double n = 1001.0;
    const double published =
        (3.0 * (n - 1.0) / (2.0 * m) - 2.0 * (n - 2.0) / n) * 4.0 * m * m / (4.0 * m * m + 5.0);
    EXPECT_NEAR(white_degrees_of_freedom(1000, static_cast<Eigen::Index>(m)) / published, 1.0, share) << m;
  }
}

// Two stretches: the squares of both, one weight each; what lies between does not enter.
TEST(Allan, GapsAreLeftOut) {
  Eigen::VectorXd rate = white_noise(3000, 8);
  rate.segment(1000, 500).setConstant(NAN);
  rate.tail(1500).array() += 1e6;
  const std::vector<RowRange> stretches = {{0, 1000}, {1500, 1500}};
  const auto both = allan_deviation(rate, stretches, 1.0).points;
  const auto first = allan_deviation(rate.head(1000), 1.0).points;
  const auto second = allan_deviation(rate.tail(1500), 1.0).points;
  ASSERT_EQ(both.size(), second.size());
  for (std::size_t i = 0; i < both.size(); ++i) {
    const double pairs = static_cast<double>(first.size() > i ? first[i].pairs : 0);
    const double squares = first.size() > i ? pairs * first[i].deviation * first[i].deviation : 0.0;
    const double all = pairs + static_cast<double>(second[i].pairs);
    EXPECT_EQ(both[i].pairs, static_cast<Eigen::Index>(all));
    const double expected =
        (squares + static_cast<double>(second[i].pairs) * second[i].deviation * second[i].deviation) / all;
    EXPECT_NEAR(both[i].deviation * both[i].deviation / expected, 1.0, 1e-9);
    // Of a weighted mean: 1/edf = sum of weight^2 / edf.
    const double spread =
        (first.size() > i ? std::pow(pairs / all, 2) / first[i].degrees_of_freedom : 0.0) +
        std::pow(static_cast<double>(second[i].pairs) / all, 2) / second[i].degrees_of_freedom;
    EXPECT_NEAR(both[i].degrees_of_freedom * spread, 1.0, 1e-12);
  }
  EXPECT_THROW(allan_deviation(rate, 1.0), std::invalid_argument);
  EXPECT_THROW(allan_deviation(rate, {{2990, 20}}, 1.0), std::invalid_argument);
  // Averages of 400: two of the first stretch, three of the second, a million above.
  EXPECT_NEAR(bias_stability(rate, stretches, 1.0, 400.0), 1e6 * std::sqrt(0.3), 1.0);
}

// Each term alone is read where theory has it: K of a random walk of steps K sqrt(tau0) is sigma^2 = K^2
// tau/3 from some ten samples on; the estimate of a decade of octaves with the degrees of freedom of its
// longest tau, five sigma.
TEST(Allan, TermsAreReadWhereTheyAre) {
  Eigen::VectorXd walk = white_noise(1 << 18, 9);
  for (Eigen::Index i = 1; i < walk.size(); ++i) walk(i) += walk(i - 1);
  const AllanResult of_walk = allan_deviation(walk, 1.0);
  ASSERT_TRUE(of_walk.rate_random_walk.has_value());
  const double edf =
      white_degrees_of_freedom(walk.size(), static_cast<Eigen::Index>(of_walk.rate_random_walk->to_s));
  EXPECT_NEAR(of_walk.rate_random_walk->coefficient, 1.0, 5.0 / std::sqrt(2.0 * edf));
  EXPECT_FALSE(of_walk.angle_random_walk || of_walk.flicker);

  const AllanResult of_white = allan_deviation(white_noise(1 << 16, 2), 1.0);
  EXPECT_TRUE(of_white.angle_random_walk.has_value());
  EXPECT_FALSE(of_white.flicker || of_white.rate_random_walk);

  // Relaxations at every octave, one variance each, add up to 1/f: S = v/(f ln 2), so that sigma^2 = 2 v and
  // B^2 = pi v/ln 2.
  std::mt19937_64 generator(10);
  std::normal_distribution<double> normal;
  Eigen::VectorXd flicker = Eigen::VectorXd::Zero(1 << 18);
  for (int k = -3; k < 22; ++k) {
    const double keep = std::exp(-std::exp2(-k)), kick = std::sqrt(1.0 - keep * keep);
    double value = normal(generator);
    for (double& sample : flicker) sample += value = keep * value + kick * normal(generator);
  }
  const AllanResult of_flicker = allan_deviation(flicker, 1.0);
  ASSERT_TRUE(of_flicker.flicker.has_value());
  const double level = std::sqrt(std::numbers::pi / std::numbers::ln2);
  const double flicker_edf =
      white_degrees_of_freedom(flicker.size(), static_cast<Eigen::Index>(of_flicker.flicker->to_s));
  EXPECT_NEAR(of_flicker.flicker->coefficient / level, 1.0, 5.0 / std::sqrt(2.0 * flicker_edf));
  EXPECT_FALSE(of_flicker.angle_random_walk || of_flicker.rate_random_walk);
}

// White noise and a random walk have a round minimum, and no flicker.
TEST(Allan, ARoundMinimumIsNoFlicker) {
  const Eigen::VectorXd steps = white_noise(1 << 18, 11);
  Eigen::VectorXd rate = white_noise(1 << 18, 12);
  double walk = 0.0;
  for (Eigen::Index i = 0; i < rate.size(); ++i) rate(i) += walk += 0.01 * steps(i);
  const AllanResult result = allan_deviation(rate, 1.0);
  EXPECT_FALSE(result.flicker.has_value());
  EXPECT_TRUE(result.angle_random_walk.has_value());
}

TEST(Allan, NoRandomWalkIsReadWhereThereIsNone) {
  const Eigen::VectorXd white = white_noise(20001, 4);
  const Eigen::VectorXd differenced = white.tail(20000) - white.head(20000);
  EXPECT_FALSE(allan_deviation(differenced, 1.0).angle_random_walk.has_value());
  Eigen::VectorXd walk = white;
  for (Eigen::Index i = 1; i < walk.size(); ++i) walk(i) += walk(i - 1);
  EXPECT_FALSE(allan_deviation(walk, 1.0).angle_random_walk.has_value());
  EXPECT_FALSE(allan_deviation(Eigen::VectorXd::Ones(1000), 1.0).angle_random_walk.has_value());
}

// White noise on a slow ramp: sigma^2 = 1/m + (d m)^2 / 2 is least at m = d^(-2/3), here 100, with value
// sqrt(1/100 + 1/200); on octaves 64 and 128 lie beside it, within 6 %; estimates are good to 5 sigma of the
// edf.
TEST(Allan, BiasInstabilityIsTheFloor) {
  Eigen::VectorXd rate = white_noise(200000, 5);
  rate += Eigen::VectorXd::LinSpaced(rate.size(), 0.0, 1e-3 * static_cast<double>(rate.size() - 1));
  const AllanResult result = allan_deviation(rate, 1.0);
  const double edf = white_degrees_of_freedom(rate.size(), 128);
  EXPECT_NEAR(result.bias_instability * 0.664 / std::sqrt(0.015), 1.0, 0.06 + 5.0 / std::sqrt(2.0 * edf));
  EXPECT_FALSE(result.bias_instability_is_bound);
  EXPECT_GE(result.bias_instability_tau_s, 64.0);
  EXPECT_LE(result.bias_instability_tau_s, 128.0);
}

TEST(BiasStability, IsTheDeviationOfAverages) {
  const Eigen::VectorXd rate = (Eigen::VectorXd(7) << 1, 3, 5, 7, 0, 2, 99).finished();
  // Averages of two: 2 6 1, mean 3, squares 1 + 9 + 4 over 2; the last sample is left out.
  EXPECT_NEAR(bias_stability(rate, 0.5, 1.0), std::sqrt(7.0), 1e-14);
  EXPECT_THROW(bias_stability(rate, 0.5, 0.1), std::invalid_argument);
  EXPECT_THROW(bias_stability(rate, 0.5, 3.0), std::invalid_argument);
}

TEST(Allan, RefusesWhatItCannotUse) {
  EXPECT_THROW(allan_deviation(Eigen::Vector2d(1, 2), 1.0), std::invalid_argument);
  EXPECT_THROW(allan_deviation(Eigen::Vector3d(1, NAN, 2), 1.0), std::invalid_argument);
  EXPECT_THROW(allan_deviation(Eigen::Vector3d(1, 2, 3), 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace hemi::calibration

// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/allan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

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

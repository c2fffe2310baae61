// SPDX-License-Identifier: Apache-2.0
// Statistics of seeded generators: limits are four to five standard deviations of the statistic, from its
// theory.
#include "golden/physics/noise.hpp"

#include <gtest/gtest.h>

#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace hemi::physics {
namespace {

std::vector<double> draw(Gaussian gaussian, std::size_t count) {
  std::vector<double> values(count);
  for (double& value : values) value = gaussian();
  return values;
}

constexpr std::size_t kCount = 4'000'000;
const double kRootCount = std::sqrt(static_cast<double>(kCount));

// Variances of the sample moments of a normal variable: 1, 2, 15 and 96 over N.
TEST(Gaussian, HasTheMomentsOfANormalVariable) {
  double sums[4] = {};
  for (const double v : draw(Gaussian(1), kCount)) {
    sums[0] += v;
    sums[1] += v * v;
    sums[2] += v * v * v;
    sums[3] += v * v * v * v;
  }
  EXPECT_NEAR(sums[0] / kCount, 0.0, 4.0 / kRootCount);
  EXPECT_NEAR(sums[1] / kCount, 1.0, 4.0 * std::sqrt(2.0) / kRootCount);
  EXPECT_NEAR(sums[2] / kCount, 0.0, 4.0 * std::sqrt(15.0) / kRootCount);
  EXPECT_NEAR(sums[3] / kCount, 3.0, 4.0 * std::sqrt(96.0) / kRootCount);
}

// Chi-square over equally probable bins: mean B - 1, variance 2 (B - 1).
TEST(Gaussian, FillsEquallyProbableBinsEqually) {
  constexpr int kBins = 400;
  std::vector<double> counts(kBins);
  const boost::math::normal normal;
  for (const double v : draw(Gaussian(2), kCount)) {
    ++counts[std::min(kBins - 1, static_cast<int>(boost::math::cdf(normal, v) * kBins))];
  }
  const double expected = static_cast<double>(kCount) / kBins;
  double chi_square = 0.0;
  for (const double count : counts) chi_square += (count - expected) * (count - expected) / expected;
  EXPECT_NEAR(chi_square, kBins - 1, 4.0 * std::sqrt(2.0 * (kBins - 1)));
}

TEST(Gaussian, HasTheTailsOfANormalVariable) {
  const std::vector<double> values = draw(Gaussian(3), kCount);
  for (const double limit : {3.0, 3.4, 4.0, 4.5}) {
    const double expected = std::erfc(limit / std::numbers::sqrt2) * kCount;
    double count = 0.0;
    for (const double v : values) count += std::abs(v) > limit ? 1.0 : 0.0;
    EXPECT_NEAR(count, expected, 4.0 * std::sqrt(expected)) << limit;
  }
}

double correlation(const std::vector<double>& a, const std::vector<double>& b, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t i = lag; i < a.size(); ++i) sum += a[i] * b[i - lag];
  return sum / static_cast<double>(a.size() - lag);
}

TEST(Gaussian, IsIndependentOfItsPastAndOfOtherStreams) {
  const std::vector<double> a = draw(Gaussian(4, 0), kCount);
  for (std::size_t lag = 1; lag <= 20; ++lag)
    EXPECT_NEAR(correlation(a, a, lag), 0.0, 4.5 / kRootCount) << lag;
  std::vector<double> squares = a;
  for (double& v : squares) v = (v * v - 1.0) / std::numbers::sqrt2;
  for (std::size_t lag = 1; lag <= 4; ++lag) {
    EXPECT_NEAR(correlation(squares, squares, lag), 0.0, 4.5 / kRootCount) << lag;
  }
  EXPECT_NEAR(correlation(a, draw(Gaussian(4, 1), kCount), 0), 0.0, 4.5 / kRootCount);
  EXPECT_NEAR(correlation(a, draw(Gaussian(5, 0), kCount), 0), 0.0, 4.5 / kRootCount);
}

TEST(Gaussian, RepeatsWithItsSeed) {
  EXPECT_EQ(draw(Gaussian(7, 3), 100), draw(Gaussian(7, 3), 100));
  EXPECT_NE(draw(Gaussian(7, 3), 100), draw(Gaussian(7, 4), 100));
  EXPECT_NE(draw(Gaussian(1, 0), 100), draw(Gaussian(0, 1), 100));
}

TEST(WhiteDeviation, SpreadsTheDensityUpToHalfTheRate) {
  // density^2 over rate / 2 is the variance
  EXPECT_DOUBLE_EQ(white_deviation(3.0, 200.0), 30.0);
}

// The ripple of two poles a decade, and at the ends what the missing poles leave.
TEST(FlickerNoise, DensityFallsAsOneOverF) {
  const FlickerNoise noise(2.5, 1e-4, 10.0, 1);
  for (double f = 1e-4; f < 10.0; f *= 1.07) {
    const bool inside = f > 1e-3 && f < 1.0;
    EXPECT_NEAR(noise.density(f) * f / 2.5, 1.0, inside ? 3e-3 : 1.3e-2) << f;
  }
}

// sigma^2 = 2 ln 2 h whatever the averaging time. N / m clusters leave 0.77 N/m degrees of freedom (IEEE Std
// 1139).
TEST(FlickerNoise, HasAFlatAllanDeviation) {
  const double floor = 0.3;
  FlickerNoise noise(FlickerNoise::h_of_floor(floor), 1e-4, 100.0, 5);
  std::vector<double> clusters(1 << 19);
  for (double& value : clusters) value = noise.advance(0.01);
  for (int doubling = 1; clusters.size() > 256; ++doubling) {
    std::vector<double> wider(clusters.size() / 2);
    for (std::size_t i = 0; i < wider.size(); ++i) wider[i] = (clusters[2 * i] + clusters[2 * i + 1]) / 2.0;
    clusters = wider;
    if (doubling < 6) continue;  // below 0.64 s the sampling shows
    double sum = 0.0;
    for (std::size_t i = 1; i < clusters.size(); ++i) sum += std::pow(clusters[i] - clusters[i - 1], 2);
    const double variance = sum / (2.0 * static_cast<double>(clusters.size() - 1));
    const double degrees_of_freedom = 0.77 * static_cast<double>(clusters.size());
    EXPECT_NEAR(variance / (floor * floor), 1.0, 4.0 * std::sqrt(2.0 / degrees_of_freedom) + 0.02)
        << doubling;
  }
}

TEST(FlickerNoise, IsStationaryFromTheStartAndAtAnyInterval) {
  constexpr int kRuns = 4000;
  double start = 0.0;
  double later = 0.0;

  for (int run = 0; run < kRuns; ++run) {
    FlickerNoise noise(1.0, 1e-2, 1.0, static_cast<std::uint64_t>(run));
    start += std::pow(noise.advance(0.0), 2);
    later += std::pow(noise.advance(run % 2 == 0 ? 0.1 : 300.0), 2);
  }
  // poles of variance ln(sqrt 10) each, 1.5 decades on either side of the two
  const double total = (2 * (2 + 3) + 1) * std::log(10.0) / 2.0;
  EXPECT_NEAR(start / kRuns / total, 1.0, 4.0 * std::sqrt(2.0 / kRuns));
  EXPECT_NEAR(later / kRuns / total, 1.0, 4.0 * std::sqrt(2.0 / kRuns));
}

TEST(FlickerNoise, RefusesImpossibleBands) {
  EXPECT_THROW(FlickerNoise(1.0, 0.0, 1.0, 1), std::invalid_argument);
  EXPECT_THROW(FlickerNoise(1.0, 1.0, 1.0, 1), std::invalid_argument);
  EXPECT_THROW(FlickerNoise(-1.0, 0.1, 1.0, 1), std::invalid_argument);
}

TEST(RandomWalk, VarianceGrowsWithTime) {
  constexpr int kRuns = 4000;
  double sum = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    RandomWalk walk(0.2, static_cast<std::uint64_t>(run));
    double value = 0.0;
    for (const double dt_s : {1.0, 4.0, 0.5, 3.5}) value = walk.advance(dt_s);
    sum += value * value;
  }
  EXPECT_NEAR(sum / kRuns / (0.04 * 9.0), 1.0, 4.0 * std::sqrt(2.0 / kRuns));
}

}  // namespace
}  // namespace hemi::physics

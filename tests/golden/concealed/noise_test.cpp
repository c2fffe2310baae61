// SPDX-License-Identifier: Apache-2.0
#include "golden/concealed/noise.hpp"

#include <gtest/gtest.h>

#include <complex>
#include <numbers>

namespace hemi::concealed {
namespace {

/// Mean of the periodogram at `lines` neighbouring lines from `first` on, by direct sums.
double measured(const Series& values, Eigen::Index first, Eigen::Index lines) {
  const double n = static_cast<double>(values.size());
  double sum = 0.0;
  for (Eigen::Index k = first; k < first + lines; ++k) {
    std::complex<double> line = 0.0;
    const std::complex<double> turn = std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(k) / n);
    std::complex<double> phase = 1.0;
    for (const double value : values) {
      line += value * phase;
      phase *= turn;
    }
    sum += 2.0 * std::norm(line) / n;
  }
  return sum / static_cast<double>(lines);
}

TEST(Noise, HasTheStatedSpectrum) {
  NoiseLevel level;
  level.white = 2.0;
  level.flicker = 0.3;
  level.differenced = 9.0;
  Random random(5);
  constexpr Eigen::Index kCount = 12000;
  const Series values = noise(level, kCount, random);
  for (const Eigen::Index first : {20, 200, 1500, 4000, 5800}) {
    constexpr Eigen::Index kLines = 160;
    const double middle = static_cast<double>(first + kLines / 2) / kCount;
    double expected = 0.0;
    for (Eigen::Index k = first; k < first + kLines; ++k)
      expected += density(level, static_cast<double>(k) / kCount) / kLines;
    // The mean of 160 exponential deviates: relative deviation 1/sqrt(160); five of them.
    EXPECT_NEAR(measured(values, first, kLines) / expected, 1.0, 5.0 / std::sqrt(160.0)) << middle << " Hz";
  }
}

TEST(Noise, RandomWalkSpreadsWithTheRootOfTime) {
  NoiseLevel level;
  level.random_walk = 1.0;
  // One-sided density 1/f^2 at 1 Hz: increments of variance (2 pi)^2 / 2 a second.
  Random random(6);
  double sum = 0.0;
  constexpr int kRuns = 400;
  constexpr Eigen::Index kLag = 100;
  for (int run = 0; run < kRuns; ++run) {
    const Series walk = noise(level, 1200, random);
    sum += std::pow(walk[1000] - walk[1000 - kLag], 2);
  }
  const double expected = 2.0 * std::numbers::pi * std::numbers::pi * kLag;
  EXPECT_NEAR(sum / kRuns / expected, 1.0, 5.0 * std::sqrt(2.0 / kRuns));
}

TEST(Noise, ShapesHaveOneVarianceAndTheirOwnTails) {
  Random random(7);
  constexpr int kCount = 200000;
  double heavy2 = 0.0, laplace2 = 0.0, laplace4 = 0.0;
  for (int i = 0; i < kCount; ++i) {
    heavy2 += std::pow(random.heavy_tailed(), 2) / kCount;
    const double l = random.laplace();
    laplace2 += l * l / kCount;
    laplace4 += l * l * l * l / kCount;
  }
  // Fourth moments 9 (t5) and 6 (Laplace): deviation of a variance sqrt((m4 - 1) / n); of Laplace's fourth
  // moment sqrt((E x^8 - 36) / n) with E x^8 = 2520.
  EXPECT_NEAR(heavy2, 1.0, 6.0 * std::sqrt(8.0 / kCount));
  EXPECT_NEAR(laplace2, 1.0, 5.0 * std::sqrt(5.0 / kCount));
  EXPECT_NEAR(laplace4, 6.0, 5.0 * std::sqrt(2484.0 / kCount));
}

}  // namespace
}  // namespace hemi::concealed

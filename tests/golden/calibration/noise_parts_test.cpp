// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/noise_parts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace hemi::calibration {
namespace {

constexpr Eigen::Index kRows = 100000;

Eigen::VectorXd normal_rows(std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  return Eigen::VectorXd::NullaryExpr(kRows, [&] { return normal(generator); });
}

// One-sided density N of white samples every d seconds: variance N^2 / (2 d).
TEST(NoiseParts, WhiteAlone) {
  const double interval_s = 0.5;
  const auto parts =
      fit_noise_parts(0.3 / std::sqrt(2.0 * interval_s) * normal_rows(1), {{0, kRows}}, interval_s, 1000.0);
  // The shortest averaging time has about 2/3 of the rows as degrees of freedom: known to 0.4 %.
  EXPECT_NEAR(parts.white, 0.3, 0.3 * 0.02);
  EXPECT_EQ(parts.flicker, 0.0);
  EXPECT_EQ(parts.random_walk, 0.0);
  EXPECT_EQ(parts.differenced, 0.0);
}

// A random walk of density K at 1 Hz: steps of variance (2 pi K)^2 d / 2.
TEST(NoiseParts, WhiteAndRandomWalk) {
  Eigen::VectorXd walk = normal_rows(2) * 2.0 * std::numbers::pi * 0.002 * std::sqrt(0.5);
  for (Eigen::Index i = 1; i < kRows; ++i) walk[i] += walk[i - 1];
  const auto parts = fit_noise_parts(0.3 / std::sqrt(2.0) * normal_rows(3) + walk, {{0, kRows}}, 1.0, 1000.0);
  EXPECT_NEAR(parts.white, 0.3, 0.3 * 0.02);
  // At 512 s the variance has about 100000 / 512 degrees of freedom: deviation known to 5 %.
  EXPECT_NEAR(parts.random_walk, 0.002, 0.002 * 0.2);
}

// Differences of white phase x: density sqrt(8 pi^2 d) s_x at 1 Hz.
TEST(NoiseParts, DifferencedPhase) {
  const Eigen::VectorXd x = normal_rows(4);
  Eigen::VectorXd y = Eigen::VectorXd::Zero(kRows);
  y.tail(kRows - 1) = x.tail(kRows - 1) - x.head(kRows - 1);
  const auto parts = fit_noise_parts(y, {{0, kRows}}, 1.0, 1000.0);
  const double truth = std::sqrt(8.0) * std::numbers::pi;
  EXPECT_NEAR(parts.differenced, truth, 0.02 * truth);
  EXPECT_LT(parts.white, 0.02);
}

TEST(NoiseParts, TooShort) {
  EXPECT_THROW(fit_noise_parts(normal_rows(5), {{0, 60}, {100, 63}}, 1.0, 1000.0), std::invalid_argument);
}

}  // namespace
}  // namespace hemi::calibration

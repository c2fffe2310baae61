// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/block_statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "golden/diagnosis/simulation_fit.hpp"

namespace hemi::diagnosis {
namespace {

constexpr Eigen::Index kRows = 4000;

Eigen::VectorXd coloured(unsigned seed, double pole) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Eigen::VectorXd x(kRows);
  double value = 0.0;
  for (double& each : x) each = value = pole * value + std::sqrt(1.0 - pole * pole) * normal(random);
  return x;
}

Eigen::MatrixXd columns(unsigned seed, Eigen::Index count) {
  Eigen::MatrixXd x(kRows, count);
  for (Eigen::Index j = 0; j < count; ++j) x.col(j) = coloured(seed + static_cast<unsigned>(j), 0.9);
  return x;
}

// 200 nulls at a family-wise 1 %: more than 8 would come by chance once in 4000 times (binomial).
TEST(MaxT, KeepsItsRateUnderColouredNoise) {
  int taken = 0;
  for (unsigned trial = 0; trial < 200; ++trial) {
    const Eigen::VectorXd residual = coloured(100 * trial + 7, 0.95);
    const MaxT test = max_t(residual, columns(100 * trial + 20, 2), columns(100 * trial + 40, 6), 0,
                            whitener_of(residual), 40, trial);
    taken += test.p.minCoeff() <= 0.01 ? 1 : 0;
  }
  EXPECT_LE(taken, 8);
}

// A column of ten standard errors is seen, and its |T| is ten within four of its unit deviations.
TEST(MaxT, SeesAColumn) {
  const Eigen::VectorXd noise = coloured(3, 0.5);
  const Eigen::MatrixXd x = columns(50, 4);
  const MaxT before = max_t(noise, columns(80, 1), x, 0, whitener_of(noise), 40, 1);
  const Eigen::VectorXd residual = noise + 10.0 / before.norm[2] * x.col(2);
  const MaxT test = max_t(residual, columns(80, 1), x, 0, whitener_of(noise), 40, 1);
  EXPECT_NEAR(test.statistic[2], 10.0, 4.0);
  EXPECT_LE(test.p[2], 0.001);
}

TEST(BootstrapGain, HoldsTheTrueGainAndOrders) {
  const Eigen::VectorXd big = 2.0 * coloured(1, 0.0), small = coloured(2, 0.0);
  const auto blocks = equal_blocks(kRows, 40);
  const Gain gain = bootstrap_gain(big, small, blocks, 5);
  // Standard error of a rms over 4000 white samples: 1 / sqrt(8000) of it.
  EXPECT_NEAR(gain.gain(), 1.0, 4.0 * std::sqrt(5.0 / 8000.0));
  EXPECT_LT(gain.low, gain.gain());
  EXPECT_GT(gain.high, gain.gain());
  EXPECT_GT(share_won(small, {big}, blocks, 5), 0.999);
  EXPECT_LT(share_won(big, {small}, blocks, 5), 0.001);
}

TEST(Decoy, KeepsThePowerAndLosesTheTie) {
  const Eigen::VectorXd x = coloured(9, 0.9);
  for (const bool randomise : {false, true}) {
    const Eigen::VectorXd copy = decoy_of(x, randomise, 4);
    EXPECT_NEAR(copy.norm() / x.norm(), 1.0, 1e-9);
    // 4000 samples correlated over 19: 210 independent ones; four standard deviations.
    EXPECT_LT(std::abs(copy.dot(x)) / x.squaredNorm(), 4.0 / std::sqrt(210.0));
  }
}

}  // namespace
}  // namespace hemi::diagnosis

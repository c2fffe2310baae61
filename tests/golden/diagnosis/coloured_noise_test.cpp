// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/coloured_noise.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

namespace hemi::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Covariance written down from the processes' definition.
MatrixXd covariance(const ColouredNoise& noise, const std::vector<Index>& blocks) {
  const auto n = static_cast<Index>(blocks.size());
  MatrixXd c(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) {
      const double apart = std::abs(
          static_cast<double>(blocks[static_cast<std::size_t>(i)] - blocks[static_cast<std::size_t>(j)]));
      c(i, j) = i == j ? noise.white : 0.0;
      for (Index k = 0; k < noise.variance.size(); ++k)
        c(i, j) += noise.variance[k] * std::pow(noise.correlation[k], apart);
      // Of the walk within a block: with itself, and with what the walk is at the start of a later one.
      c(i, j) +=
          i == j ? noise.walk_step / 3.0
                 : 0.5 * noise.walk_step * std::pow(noise.correlation[noise.correlation.size() - 1], apart);
    }
  return c;
}

const std::vector<Index> kWithHoles = {0, 1, 2, 3, 7, 8, 9, 20, 21, 40};

TEST(ColouredNoise, WhitensWhatItsCovarianceSays) {
  const NoiseShape shape{
      .white = 0.7, .flicker = 0.3, .walk = 0.02, .behind = 0.5, .behind_correlation = 0.9};
  const ColouredNoise noise = coloured_noise(shape, 41);
  const MatrixXd c = covariance(noise, kWithHoles);
  const auto n = static_cast<Index>(kWithHoles.size());
  double log_determinant = 0.0;
  const MatrixXd w = whiten(MatrixXd::Identity(n, n), kWithHoles, noise, &log_determinant);
  EXPECT_LT((w * c * w.transpose() - MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff(), 1e-9);
  const MatrixXd l = c.llt().matrixL();
  EXPECT_NEAR(log_determinant, 2.0 * l.diagonal().array().log().sum(), 1e-9);
}

TEST(ColouredNoise, FlickerHasEqualPowerInEqualRatiosOfFrequency) {
  const NoiseShape shape{.white = 0.0, .flicker = 1.0};
  const ColouredNoise noise = coloured_noise(shape, 2000);
  const auto density = [&](double f) {
    double sum = 0.0;
    for (Index k = 0; k < noise.variance.size(); ++k) {
      const double a = noise.correlation[k];
      sum += noise.variance[k] * (1.0 - a * a) / (1.0 - 2.0 * a * std::cos(2.0 * M_PI * f) + a * a);
    }
    return sum;
  };
  // One-sided density h^2 / f with h^2 = 1 / ln 6 of variance: f S is constant within the ripple of a sum of
  // processes a factor 6 apart, 3 % about the mean.
  double low = 1e300, high = 0.0;
  for (double f = 2e-3; f < 0.05; f *= 1.1) {
    const double level = 2.0 * f * density(f);
    low = std::min(low, level);
    high = std::max(high, level);
  }
  EXPECT_NEAR(std::sqrt(low * high), 1.0 / std::log(6.0), 0.05 / std::log(6.0));
  EXPECT_LT(high / low, 1.1);
}

TEST(ColouredNoise, MeansOfAWalkHaveTheCovarianceOfItsIntegrals) {
  // Steps of 1 in each of 50 rows a block, all of a block's rows averaged: variance of a difference of
  // neighbours 2/3 of a block's step, covariance of two such differences in a row 1/6 (Wiener process).
  const NoiseShape shape{.white = 0.0, .walk = 1.0};
  const ColouredNoise noise = coloured_noise(shape, 4);
  const MatrixXd c = covariance(noise, {0, 1, 2});
  EXPECT_NEAR(c(0, 0) - 2.0 * c(0, 1) + c(1, 1), 2.0 / 3.0, 0.01);
  EXPECT_NEAR(c(0, 1) - c(0, 2) - c(1, 1) + c(1, 2), 1.0 / 6.0, 0.01);
}

TEST(ColouredNoise, FindsTheStepOfAWalkThatDrownsTheWhiteNoise) {
  constexpr Index kBlocks = 1500, kWithin = 20;
  std::vector<Index> blocks(kBlocks);
  for (Index i = 0; i < kBlocks; ++i) blocks[static_cast<std::size_t>(i)] = i;
  const MatrixXd x = MatrixXd::Constant(kBlocks, 1, 1.0 / std::sqrt(static_cast<double>(kBlocks)));
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  double state = 0.0, mean = 0.0;
  constexpr int kRuns = 10;
  for (int run = 0; run < kRuns; ++run) {
    VectorXd y = VectorXd::Zero(kBlocks);
    for (Index i = 0; i < kBlocks; ++i)
      for (Index j = 0; j < kWithin; ++j)
        y[i] += ((state += normal(random)) + 0.5 * normal(random)) / static_cast<double>(kWithin);
    mean += fit_noise_shape(x, y, blocks, {}).walk / static_cast<double>(kWithin * kRuns);
  }
  // A variance from 15 000 differences that correlate by a quarter: sqrt(2 (1 + 2 / 16) / 15 000) = 1.2 %;
  // four of them, and 1 % for twenty steps that are no Wiener process.
  EXPECT_NEAR(mean, 1.0, 0.06);
}

TEST(ColouredNoise, FindsNoColourInWhiteNoiseAndTheWalkInAWalk) {
  constexpr Index kRows = 1500;
  std::vector<Index> blocks(kRows);
  for (Index i = 0; i < kRows; ++i) blocks[static_cast<std::size_t>(i)] = i;
  const MatrixXd x = MatrixXd::Constant(kRows, 1, 1.0 / std::sqrt(static_cast<double>(kRows)));
  int coloured = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    VectorXd white(kRows), walk(kRows);
    double state = 0.0;
    for (Index i = 0; i < kRows; ++i) {
      white[i] = normal(random);
      walk[i] = white[i] + (state += 0.1 * normal(random));
    }
    const NoiseShape none = fit_noise_shape(x, white, blocks, {});
    if (none.flicker > 0.0 || none.walk > 0.0) ++coloured;
    // Variance of the mean of 1500 squares: 2 / 1500.
    EXPECT_NEAR(none.white, 1.0, 5.0 * std::sqrt(2.0 / kRows));
    const NoiseShape found = fit_noise_shape(x, walk, blocks, {});
    EXPECT_GT(found.walk + found.flicker, 0.0) << seed;
  }
  // A part that gains log(1500) by chance: chi-squared of one above 7.3, 0.7 % a part.
  EXPECT_LE(coloured, 2);
}

}  // namespace
}  // namespace hemi::diagnosis

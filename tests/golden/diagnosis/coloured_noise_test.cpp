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

// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/autoregressive_noise.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <random>

namespace hemi::calibration {
namespace {

// Correlation matrix of an autoregression of order 2 from the Yule-Walker recursion, in units of the
// innovation.
Eigen::MatrixXd order2_covariance(double r1, double r2, Eigen::Index size) {
  const double a1 = r1 * (1.0 - r2);
  const double a2 = r2;
  std::vector<double> correlation = {1.0, a1 / (1.0 - a2)};
  for (Eigen::Index k = 2; k < size; ++k) {
    correlation.push_back(a1 * correlation[static_cast<std::size_t>(k - 1)] +
                          a2 * correlation[static_cast<std::size_t>(k - 2)]);
  }
  const double variance = 1.0 / (1.0 - a1 * correlation[1] - a2 * correlation[2]);
  return Eigen::MatrixXd::NullaryExpr(size, size, [&](Eigen::Index i, Eigen::Index j) {
    return variance * correlation[static_cast<std::size_t>(std::abs(i - j))];
  });
}

TEST(AutoregressiveNoise, WhiteningAndProductsAgreeWithTheDenseCovariance) {
  const Eigen::Vector2d partial(0.8, -0.4);
  const std::vector<RowRange> segments = {{1, 12}, {15, 1}, {17, 7}};
  const Eigen::MatrixXd z = Eigen::MatrixXd::Random(25, 3);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(3, 3);
  double log_determinant = 0.0;
  for (const RowRange& segment : segments) {
    const Eigen::MatrixXd covariance =
        order2_covariance(0.8, -0.4, 12).topLeftCorner(segment.count, segment.count);
    const Eigen::MatrixXd rows = z.middleRows(segment.begin, segment.count);
    expected += rows.transpose() * covariance.llt().solve(rows);
    log_determinant += std::log(covariance.determinant());
  }
  const Eigen::MatrixXd white = whiten(z, segments, partial);
  ASSERT_EQ(white.rows(), 20);
  EXPECT_TRUE((white.transpose() * white).isApprox(expected, 1e-12));
  for (const Eigen::Index max_order : {2, 5, 9}) {
    const LaggedProducts products(z, segments, max_order);
    EXPECT_TRUE(products.gram(partial).isApprox(expected, 1e-12)) << max_order;
    EXPECT_NEAR(products.log_determinant(partial), log_determinant, 1e-12);
  }
}

TEST(AutoregressiveNoise, EffectiveSamplesOfOrderOne) {
  AutoregressiveNoise noise;
  noise.partial = Eigen::VectorXd::Constant(1, 0.9);
  EXPECT_NEAR(noise.effective_samples(1000), 1000.0 * 0.1 / 1.9, 1e-9);
  noise.partial.resize(0);
  EXPECT_EQ(noise.effective_samples(1000), 1000.0);
}

// Six slow columns beside noise of correlation r = 0.9, 3000 rows. Correlation of the least-squares residuals
// is too small; that of the restricted likelihood is not: the mean of 200 fits agrees with r within four
// standard errors of a single fit's deviation sqrt((1 - r^2) / n), beside the bias of order 1/n that any
// estimate has.
TEST(AutoregressiveNoise, RestrictedLikelihoodFindsTheCorrelationBesideManyColumns) {
  constexpr Eigen::Index kRows = 3000;
  constexpr double kCorrelation = 0.9;
  Eigen::MatrixXd x(kRows, 6);
  for (Eigen::Index i = 0; i < kRows; ++i) {
    for (Eigen::Index j = 0; j < 6; ++j)
      x(i, j) = std::cos(M_PI * static_cast<double>(j) * (static_cast<double>(i) + 0.5) / kRows);
  }
  const Eigen::MatrixXd q =
      Eigen::HouseholderQR<Eigen::MatrixXd>(x).householderQ() * Eigen::MatrixXd::Identity(kRows, 6);
  std::mt19937_64 generator(11);
  std::normal_distribution<double> normal;
  double sum = 0.0;
  double naive = 0.0;
  constexpr int kFits = 200;
  for (int fit = 0; fit < kFits; ++fit) {
    Eigen::MatrixXd z(kRows, 7);
    z.leftCols(6) = q;
    double noise = normal(generator);
    for (Eigen::Index i = 0; i < kRows; ++i) {
      z(i, 6) = noise;
      noise = kCorrelation * noise + std::sqrt(1.0 - kCorrelation * kCorrelation) * normal(generator);
    }
    const Eigen::VectorXd residual = z.col(6) - q * (q.transpose() * z.col(6));
    naive += residual.tail(kRows - 1).dot(residual.head(kRows - 1)) / residual.squaredNorm() / kFits;
    sum += fit_noise(LaggedProducts(z, {{0, kRows}}, 1)).lag1_correlation() / kFits;
  }
  const double deviation = std::sqrt((1.0 - kCorrelation * kCorrelation) / kRows);
  const double allowed = 4.0 * deviation / std::sqrt(kFits) + 1.0 / kRows;
  std::printf("lag-1 correlation 0.9: restricted likelihood %.4f, residuals %.4f\n", sum, naive);
  EXPECT_NEAR(sum, kCorrelation, allowed);
  EXPECT_LT(naive, kCorrelation - allowed);
}

}  // namespace
}  // namespace hemi::calibration

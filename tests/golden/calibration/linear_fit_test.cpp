// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/linear_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hemi::calibration {
namespace {

// Line through (0,1) (1,3) (2,4) (3,6): by hand, slope 8/5, intercept 11/10, residuals -.1 .3 -.3 .1, sum of
// squares 1/5, variance 1/10, Var(slope) = .1/5, Var(intercept) = .1 * 14/20, covariance -.1 * 1.5/5;
// scatter 13.
TEST(LinearFit, AgreesWithALineFittedByHand) {
  Eigen::MatrixXd x(4, 2);
  x << 1, 0, 1, 1, 1, 2, 1, 3;
  const LinearFit fit = fit_linear(x, Eigen::Vector4d(1, 3, 4, 6));
  constexpr double kRounding = 1e-13;
  EXPECT_NEAR(fit.coefficients(0), 1.1, kRounding);
  EXPECT_NEAR(fit.coefficients(1), 1.6, kRounding);
  EXPECT_NEAR(fit.sum_of_squares, 0.2, kRounding);
  EXPECT_EQ(fit.dof, 2);
  EXPECT_NEAR(fit.standard_errors(0), std::sqrt(0.07), kRounding);
  EXPECT_NEAR(fit.standard_errors(1), std::sqrt(0.02), kRounding);
  EXPECT_NEAR(fit.covariance(0, 1), -0.03, kRounding);
  EXPECT_NEAR(fit.r_squared, 1.0 - 0.2 / 13.0, kRounding);
  EXPECT_NEAR(fit.residuals(1), 0.3, kRounding);
}

// A row of weight 2 is the same row twice, but for the degrees of freedom.
TEST(LinearFit, AWeightOfTwoIsARowTwice) {
  Eigen::MatrixXd x(4, 2);
  x << 1, 0, 1, 1, 1, 2, 1, 5;
  const Eigen::Vector4d y(1, 3, 4, 6);
  Eigen::MatrixXd doubled(5, 2);
  doubled << x, x.row(2);
  Eigen::VectorXd doubled_y(5);
  doubled_y << y, y(2);
  const LinearFit weighted = fit_linear_weighted(x, y, Eigen::Vector4d(1, 1, 2, 1));
  const LinearFit repeated = fit_linear(doubled, doubled_y);
  EXPECT_TRUE(weighted.coefficients.isApprox(repeated.coefficients, 1e-13));
  EXPECT_NEAR(weighted.sum_of_squares, repeated.sum_of_squares, 1e-13);
  EXPECT_NEAR(weighted.r_squared, repeated.r_squared, 1e-13);
  EXPECT_TRUE((weighted.covariance * 2.0).isApprox(repeated.covariance * 3.0, 1e-12));
}

TEST(LinearFit, ColumnsOfVeryDifferentSizeKeepTheirDigits) {
  Eigen::MatrixXd x(50, 3);
  for (int i = 0; i < 50; ++i) x.row(i) << 1.0, i * 1e-9, i * i * 1e12;
  const Eigen::Vector3d truth(3.0, -2e9, 5e-12);
  const LinearFit fit = fit_linear(x, x * truth);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(fit.coefficients(i) / truth(i), 1.0, 1e-11) << i;
}

TEST(LinearFit, NamesTheFirstDependentColumn) {
  Eigen::MatrixXd x(10, 4);
  for (int i = 0; i < 10; ++i) x.row(i) << 1.0, i, 1e6 * (3.0 - 2.0 * i), i * i;
  try {
    fit_linear(x, Eigen::VectorXd::Ones(10), {"1", "f", "twice f", "f^2"});
    FAIL() << "the third column depends on the first two";
  } catch (const RankDeficiencyError& error) {
    EXPECT_EQ(error.column(), 2);
    EXPECT_NE(std::string(error.what()).find("'twice f'"), std::string::npos) << error.what();
  }
  EXPECT_EQ(dependent_columns(x), std::vector<Eigen::Index>{2});
}

TEST(LinearFit, RefusesWhatCannotBeFitted) {
  const Eigen::MatrixXd x = Eigen::MatrixXd::Ones(3, 1);
  EXPECT_THROW(fit_linear(Eigen::MatrixXd::Ones(1, 2), Eigen::VectorXd::Ones(1)), std::invalid_argument);
  EXPECT_THROW(fit_linear(x, Eigen::VectorXd::Ones(2)), std::invalid_argument);
  EXPECT_THROW(fit_linear(x, Eigen::Vector3d(1, NAN, 2)), std::invalid_argument);
  EXPECT_THROW(fit_linear_weighted(x, Eigen::Vector3d(1, 1, 2), Eigen::Vector3d(1, 0, 1)),
               std::invalid_argument);
  EXPECT_THROW(fit_linear(Eigen::MatrixXd::Zero(3, 1), Eigen::Vector3d(1, 1, 2)), RankDeficiencyError);
}

}  // namespace
}  // namespace hemi::calibration

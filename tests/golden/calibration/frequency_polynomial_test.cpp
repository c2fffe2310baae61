// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/frequency_polynomial.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "golden/calibration/inverse_polynomial.hpp"
#include "golden/calibration/settled_points.hpp"

namespace hemi::calibration {
namespace {

SettledPoints table1() {
  return read_settled_points(HEMI_SOURCE_DIR "/tests/data/paper_table1.csv", 4);
}

// Least squares on seven equally spaced points by the discrete orthogonal (Gram) polynomials, in exact
// integers until the last division: u = (T - 10)/10 = -3..3, p1 = u, p2 = u^2 - 4, p3 = (u^3 - 7u)/6.
TEST(FrequencyPolynomial, CubicOfTable1AgreesWithGramPolynomials) {
  const SettledPoints points = table1();
  double p[4] = {0, 0, 0, 0};
  const double norm[4] = {7, 28, 84, 6};
  for (int i = 0; i < 7; ++i) {
    const double u = i - 3;
    const double y = points.frequency_hz(i) - 4428.0;
    const double basis[4] = {1, u, u * u - 4, (u * u * u - 7 * u) / 6};
    for (int k = 0; k < 4; ++k) p[k] += basis[k] * y / norm[k];
  }
  // Powers of u, then of T with u = T/10 - 1.
  const double c[4] = {4428.0 + p[0] - 4 * p[2], p[1] - 7.0 / 6.0 * p[3], p[2], p[3] / 6.0};
  const double expected[4] = {c[0] - c[1] + c[2] - c[3], (c[1] - 2 * c[2] + 3 * c[3]) / 10,
                              (c[2] - 3 * c[3]) / 100, c[3] / 1000};
  const FrequencyFit fit = fit_frequency(points, 3);
  for (int i = 0; i < 4; ++i) {
    // 4428 carries rounding of 1e-12, divided by the points' distance to the power.
    EXPECT_NEAR(fit.polynomial.coefficients_hz()(i), expected[i], 2e-11 * std::pow(10.0, -i)) << i;
  }
}

// Eq. (18) as printed: half a unit of each last digit.
TEST(FrequencyPolynomial, CubicOfTable1IsEquation18) {
  const FrequencyFit fit = fit_frequency(table1(), 3);
  const Eigen::VectorXd& c = fit.polynomial.coefficients_hz();
  EXPECT_NEAR(c(0), 4424.901, 0.0005);
  EXPECT_NEAR(c(1), 0.3716, 0.00005);
  EXPECT_NEAR(c(2), -9.702e-4, 0.0005e-4);
  EXPECT_NEAR(c(3), 1.528e-5, 0.0005e-5);
  EXPECT_NEAR(fit.max_residual_hz, 0.0269, 0.00005);
  EXPECT_TRUE(fit.polynomial.monotone());
}

// The paper prints five of the seven to 0.001 degC and two with one digit more or less; 0.005 is what
// unrounded coefficients reach against its rounded ones.
TEST(FrequencyPolynomial, Table2IsReproduced) {
  const FrequencyPolynomial cubic = fit_frequency(table1(), 3).polynomial;
  const double frequency_hz[] = {4416.97, 4421.05, 4424.90, 4428.56, 4432.07, 4435.56, 4439.20};
  const double printed_degc[] = {-19.976, -10.058, -0.0026, 10.070, 20.011, 29.924, 40.031};
  for (int i = 0; i < 7; ++i)
    EXPECT_NEAR(cubic.temperature_degc(frequency_hz[i]), printed_degc[i], 0.005) << i;
}

TEST(FrequencyPolynomial, InverseUndoesThePolynomialToRounding) {
  const FrequencyPolynomial cubic = fit_frequency(table1(), 3).polynomial;
  const auto [low, high] = cubic.monotone_interval_degc();
  for (int i = 0; i <= 1000; ++i) {
    const double t = low + (high - low) * i / 1000.0;
    // Frequencies of 4.4 kHz are spaced by 9e-13 Hz; a few of these, over the slope.
    EXPECT_NEAR(cubic.temperature_degc(cubic.frequency_hz(t)), t, 4e-12 / cubic.slope_hz_per_degc(t));
  }
}

TEST(FrequencyPolynomial, StandardErrorsOfALineAreTheClosedForm) {
  const SettledPoints points = table1();
  const FrequencyFit fit = fit_frequency(points, 1, 10.0);
  const double variance = fit.sum_of_squares_hz2 / 5.0;
  EXPECT_NEAR(fit.standard_errors(0), std::sqrt(variance / 7.0), 1e-12);
  EXPECT_NEAR(fit.standard_errors(1), std::sqrt(variance / 2800.0), 1e-13);
}

TEST(FrequencyPolynomial, TurningBackIsSeenAndNotInverted) {
  // f' = 1 - T/10 has its zero at 10 degC.
  const Eigen::Vector3d coefficients(100.0, 1.0, -0.05);
  const FrequencyPolynomial across(coefficients, 0.0, -20.0, 20.0);
  EXPECT_FALSE(across.monotone());
  EXPECT_THROW(across.temperature_degc(100.0), std::domain_error);
  const FrequencyPolynomial below(coefficients, 0.0, -20.0, 5.0);
  EXPECT_TRUE(below.monotone());
  EXPECT_NEAR(below.monotone_interval_degc().first, -45.0, 1e-12);
  EXPECT_NEAR(below.monotone_interval_degc().second, 10.0, 1e-9);
  EXPECT_THROW(below.temperature_degc(105.1), std::domain_error);
  const FrequencyPolynomial falling(Eigen::Vector2d(100.0, -2.0), 0.0, 0.0, 1.0);
  EXPECT_NEAR(falling.temperature_degc(99.0), 0.5, 1e-13);
}

TEST(FrequencyPolynomial, RefusesMoreCoefficientsThanTemperatures) {
  SettledPoints points;
  points.temperature_degc = Eigen::Vector4d(0, 0, 10, 10);
  points.frequency_hz = Eigen::Vector4d(1, 2, 3, 4);
  EXPECT_NO_THROW(fit_frequency(points, 1));
  EXPECT_THROW(fit_frequency(points, 2), std::invalid_argument);
  EXPECT_THROW(FrequencyPolynomial(Eigen::Vector2d(1, 1), 0.0, 5.0, 5.0), std::invalid_argument);
}

TEST(LeaveOneOut, PointsOnTheCurveAreReadBackExactly) {
  SettledPoints points = table1();
  const FrequencyPolynomial cubic = fit_frequency(points, 3).polynomial;
  for (int i = 0; i < 7; ++i) points.frequency_hz(i) = cubic.frequency_hz(points.temperature_degc(i));
  EXPECT_LT(leave_one_out_degc(points, 3).cwiseAbs().maxCoeff(), 1e-8);
}

// For a straight line the deleted residual has the closed form e / (1 - h); turned into temperature by the
// slope of the line without the point, which follows from the deleted point's influence on it.
TEST(LeaveOneOut, LineAgreesWithTheDeletedResidual) {
  const SettledPoints points = table1();
  const FrequencyFit fit = fit_frequency(points, 1);
  const Eigen::VectorXd errors = leave_one_out_degc(points, 1);
  for (int i = 0; i < 7; ++i) {
    const double offset = points.temperature_degc(i) - 10.0;
    const double leverage = 1.0 / 7.0 + offset * offset / 2800.0;
    const double deleted_hz = fit.residuals_hz(i) / (1.0 - leverage);
    const double slope = fit.polynomial.coefficients_hz()(1) - offset / 2800.0 * deleted_hz;
    EXPECT_NEAR(errors(i), deleted_hz / slope, 1e-9) << i;
  }
}

TEST(InversePolynomial, ErrorFallsWithTheOrderAndIsTheOneReported) {
  const FrequencyPolynomial cubic = fit_frequency(table1(), 3).polynomial;
  double previous = 100.0;
  for (Eigen::Index order = 1; order <= 5; ++order) {
    const InversePolynomial inverse = fit_inverse(cubic, 4428.0, order);
    EXPECT_LT(inverse.max_error_degc, previous) << order;
    previous = inverse.max_error_degc;
    for (int i = 0; i <= 777; ++i) {
      const double t = -20.0 + 60.0 * i / 777.0;
      // Between two grid points the error moves by less than a hundredth of its size.
      EXPECT_LE(std::abs(inverse.temperature_degc(cubic.frequency_hz(t)) - t),
                1.01 * inverse.max_error_degc + 1e-12);
    }
  }
  std::printf("inverse polynomial of order 5: largest error %.2e degC\n", previous);
}

// The inverse of a straight line is a straight line, whatever reference and span.
TEST(InversePolynomial, LineIsInvertedExactly) {
  const FrequencyPolynomial line(Eigen::Vector2d(4425.0, 0.37), 0.0, -20.0, 40.0);
  const InversePolynomial inverse = fit_inverse(line, 4400.0, 3, 32.0);
  EXPECT_NEAR(inverse.coefficients_degc(0), -25.0 / 0.37, 1e-9);
  EXPECT_NEAR(inverse.coefficients_degc(1), 32.0 / 0.37, 1e-9);
  EXPECT_NEAR(inverse.coefficients_degc(2), 0.0, 1e-9);
  EXPECT_THROW(fit_inverse(line, 4400.0, 6), std::invalid_argument);
  EXPECT_THROW(fit_inverse(line, 4400.0, 3, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace hemi::calibration

// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/settled_table.hpp"

#include <gtest/gtest.h>

#include <boost/math/constants/constants.hpp>
#include <boost/math/special_functions/chebyshev.hpp>
#include <cmath>
#include <random>

#include "golden/calibration/settled_points.hpp"

namespace hemi::diagnosis {
namespace {

TableDiagnosis of_table1() {
  return diagnose_table(calibration::read_settled_points(HEMI_SOURCE_DIR "/tests/data/paper_table1.csv", 4));
}

TEST(SettledTable, PaperTableRejectsTheCubic) {
  const TableDiagnosis result = of_table1();
  for (const auto& row : result.orders)
    std::printf("order %ld: up to %.4f Hz (least possible %.4f), log10 p %.2f, left out %.4f Hz, %.3f degC\n",
                static_cast<long>(row.order), row.max_hz, row.minimax_hz, row.log10_p, row.left_out_rms_hz,
                row.left_out_max_degc);
  EXPECT_EQ(result.verdict, Verdict::ambiguous);
  EXPECT_EQ(result.chosen, 4);
  // notes.md of the paper: largest residual 0.0269 Hz; order 1e-55.
  EXPECT_NEAR(result.at(3).max_hz, 0.0269, 5e-5);
  EXPECT_NEAR(result.at(3).log10_p, -55.0, 0.5);
  EXPECT_GT(result.at(4).log10_p, -2.0);
  // No cubic comes within the rounding of all seven points; a quartic does.
  EXPECT_GT(result.at(3).minimax_hz, 0.005);
  EXPECT_LT(result.at(4).minimax_hz, 0.005);
  EXPECT_LT(result.left_out.after_rms, 0.5 * result.left_out.before_rms);
  EXPECT_GT(result.left_out.low, 0.0);
  EXPECT_NEAR(result.residual_degc, 0.05, 0.01);
  std::printf("a4 %.3g +- %.2g, %.3g ppm, chamber %.3f degC rms, scatter %.3f degC; limits %.2g, %.2g ppm\n",
              result.top_coefficient, result.top_half_width95, result.ppm_span, result.residual_degc,
              result.chamber_error_degc, result.smallest_top, result.smallest_ppm);
  EXPECT_GT(std::abs(result.top_coefficient), result.smallest_top);
}

// Cubics rounded to the table's step: at 1 % by the rounding and 1 % by the F-test, 2 % in all; of 400 tables
// 8 are expected and more than 20 come once in 10 000 times.
TEST(SettledTable, RoundedCubicsAreConsistent) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int found = 0;
  for (int trial = 0; trial < 400; ++trial) {
    calibration::SettledPoints points;
    points.temperature_degc = Eigen::VectorXd::LinSpaced(9, -30.0, 50.0);
    points.resolution_hz = 0.01;
    const double offset = uniform(random);
    points.frequency_hz = points.temperature_degc.unaryExpr([&](double t) {
      return std::round(100.0 * (4425.0 + offset + t * (0.37 + t * (-1e-3 + t * 1.5e-5)))) / 100.0;
    });
    found += diagnose_table(points).verdict == Verdict::consistent ? 0 : 1;
  }
  std::printf("%d of 400 cubics not consistent\n", found);
  EXPECT_LE(found, 20);
}

TEST(SettledTable, TailAgreesWithClosedFormsAndGoesBelowDoubles) {
  // dof 2: exp(-x / 2). dof 4: exp(-x / 2) (1 + x / 2).
  for (const double x : {0.5, 3.0, 40.0, 900.0, 20000.0}) {
    EXPECT_NEAR(log10_chi_square_tail(x, 2.0), -0.5 * x / std::log(10.0), 1e-10 * (1.0 + x));
    EXPECT_NEAR(log10_chi_square_tail(x, 4.0), (-0.5 * x + std::log1p(0.5 * x)) / std::log(10.0),
                1e-10 * (1.0 + x));
  }
}

// T_4 over its five extrema has the least possible largest residual of any cubic fit, 1.
TEST(SettledTable, MinimaxOfAChebyshevPolynomial) {
  Eigen::VectorXd x(5), y(5);
  for (Eigen::Index i = 0; i < 5; ++i) {
    x[i] = std::cos(boost::math::constants::pi<double>() * static_cast<double>(i) / 4.0);
    y[i] = boost::math::chebyshev_t(4, x[i]);
  }
  EXPECT_NEAR(minimax_residual(x, y, 3), 1.0, 1e-12);
  EXPECT_NEAR(minimax_residual(x, y, 2), 1.0, 1e-12);
}

TEST(SettledTable, RefusesTooFewPoints) {
  calibration::SettledPoints points;
  points.temperature_degc = Eigen::VectorXd::LinSpaced(5, 0.0, 40.0);
  points.frequency_hz = points.temperature_degc;
  EXPECT_THROW(diagnose_table(points), std::invalid_argument);
}

}  // namespace
}  // namespace hemi::diagnosis

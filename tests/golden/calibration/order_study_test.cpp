// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/order_study.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "golden/calibration/settled_points.hpp"

namespace hemi::calibration {
namespace {

SettledPoints table1() {
  return read_settled_points(HEMI_SOURCE_DIR "/tests/data/paper_table1.csv", 4);
}

TEST(OrderStudy, Table1SupportsTheQuartic) {
  const OrderStudy study = study_order(table1());
  std::printf("%s", study.verdict.c_str());
  EXPECT_EQ(study.chosen, 4);
  EXPECT_NEAR(study.rounding_hz, 0.005, 1e-15);
  ASSERT_TRUE(study.report(3).next.has_value());
  EXPECT_NEAR(study.report(3).next->f_statistic, 105.0, 0.5);
  EXPECT_NEAR(study.report(3).next->p_value, 0.009, 0.0005);
  EXPECT_NEAR(study.report(3).leave_one_out_max_degc, 0.46, 0.005);
  EXPECT_NEAR(study.report(4).leave_one_out_max_degc, 0.12, 0.005);
  // The cubic's largest error lies at an end.
  const Eigen::VectorXd errors = study.report(3).leave_one_out_degc.cwiseAbs();
  EXPECT_EQ(std::max(errors(0), errors(6)), errors.maxCoeff());
  for (const char* part : {"cubic leaves up to 0.027 Hz where the table's rounding explains 0.005 Hz",
                           "Order 4 is supported against order 3: F = 105, p = 0.009",
                           "cubic: up to 0.46 degC", "quartic: up to 0.12 degC", "Chosen: order 4"}) {
    EXPECT_NE(study.verdict.find(part), std::string::npos) << part;
  }
}

// p of F on (1, d): Student's t with d = 2 has P(|t| > x) = 1 - x / sqrt(2 + x^2).
TEST(OrderStudy, PValueAgreesWithStudentsClosedForm) {
  const OrderStudy study = study_order(table1());
  const double t = std::sqrt(study.report(3).next->f_statistic);
  EXPECT_NEAR(study.report(3).next->p_value, 1.0 - t / std::sqrt(2.0 + t * t), 1e-12);
}

// Chi-square on two degrees of freedom has p = exp(-x / 2); the quartic of seven points has two.
TEST(OrderStudy, RoundingTestAgreesWithItsClosedForm) {
  const OrderStudy study = study_order(table1());
  const OrderReport& quartic = study.report(4);
  ASSERT_TRUE(quartic.chi_square.has_value());
  EXPECT_NEAR(*quartic.chi_square, quartic.fit.sum_of_squares_hz2 * 12.0 / 1e-4, 1e-9);
  EXPECT_NEAR(*quartic.chi_square_p, std::exp(-0.5 * *quartic.chi_square), 1e-12);
}

// Cubics with rounding as the only error: a higher order may be chosen at the level of the tests alone, two
// tests of 5 % at order 3, and a lower one never. 400 tables: the share stays below 10 % + 4 sigma = 16 %.
TEST(OrderStudy, RoundedCubicsAreSeldomGivenMore) {
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int higher = 0;
  for (int trial = 0; trial < 400; ++trial) {
    SettledPoints points;
    points.temperature_degc = Eigen::VectorXd::LinSpaced(9, -30.0, 50.0);
    points.frequency_hz.resize(9);
    const double offset = uniform(generator);
    for (int i = 0; i < 9; ++i) {
      const double t = points.temperature_degc(i);
      const double f = 4425.0 + offset + t * (0.37 + t * (-1e-3 + t * 1.5e-5));
      points.frequency_hz(i) = std::round(f * 100.0) / 100.0;
    }
    points.resolution_hz = 0.01;
    const Eigen::Index chosen = study_order(points).chosen;
    EXPECT_GE(chosen, 3);
    higher += chosen > 3 ? 1 : 0;
  }
  std::printf("order above the true 3: %d of 400 tables\n", higher);
  EXPECT_LE(higher, 64);
}

TEST(OrderStudy, NeedsThreeTemperatures) {
  SettledPoints points;
  points.temperature_degc = Eigen::Vector3d(0, 0, 10);
  points.frequency_hz = Eigen::Vector3d(1, 2, 3);
  EXPECT_THROW(study_order(points), std::invalid_argument);
  points.temperature_degc = Eigen::Vector3d(0, 5, 10);
  EXPECT_EQ(study_order(points).chosen, 1);
}

}  // namespace
}  // namespace hemi::calibration

// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/voltage_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "golden/calibration/compensation_score.hpp"
#include "tests/golden/calibration/chamber_recording.hpp"

namespace hemi::calibration {
namespace {

TEST(VoltageFit, OrderAndCoefficients) {
  const auto run = testing::chamber_recording({}, {{0.0, -20.0}, {9000.0, 40.0}}, 20000.0, 1);
  const auto n = static_cast<Eigen::Index>(run.time_s.size());
  const Eigen::VectorXd t = Eigen::VectorXd::Map(run.resonator_degc.data(), n);
  std::mt19937_64 generator(2);
  std::normal_distribution<double> normal;
  Eigen::VectorXd v(n);
  for (Eigen::Index i = 0; i < n; ++i)
    v[i] = 2.0 + 0.004 * (t[i] - 20.0) + 3e-6 * std::pow(t[i] - 20.0, 2) + 2e-4 * normal(generator);
  const auto fit = fit_over_temperature(t, v, {{0, n}}, 20.0);
  ASSERT_EQ(fit.coefficients.size(), 3);
  const double truth[] = {2.0, 0.004, 3e-6};
  for (Eigen::Index k = 0; k < 3; ++k)
    EXPECT_NEAR(fit.coefficients[k], truth[k], 4.0 * fit.standard_errors[k]);
  EXPECT_LT(fit.standard_errors[1], 1e-6);
  EXPECT_THROW(fit_over_temperature(t, v, {{0, 39}}, 20.0), std::invalid_argument);
}

TEST(VoltageFit, ScaleFactorBesideDrift) {
  const auto run = testing::chamber_recording({}, {{0.0, -20.0}}, 12000.0, 3);
  const auto n = static_cast<Eigen::Index>(run.time_s.size());
  Eigen::VectorXd applied(n);
  for (Eigen::Index i = 0; i < n; ++i)
    applied[i] = (i / 600) % 3 == 0 ? 36000.0 : ((i / 600) % 3 == 1 ? -36000.0 : 0.0);
  const Eigen::VectorXd rate = Eigen::VectorXd::Map(run.rate_dph.data(), n) + 1.00002 * applied;
  const Eigen::VectorXd f = Eigen::VectorXd::Map(run.frequency_hz.data(), n).array() - 4432.07;
  const auto fit =
      fit_scale(applied, drift_design(f, Eigen::VectorXd::Map(run.slope_hz_per_s.data(), n)), rate, {{0, n}});
  EXPECT_NEAR(fit.scale, 1.00002, 4.0 * fit.standard_error);
  EXPECT_LT(fit.standard_error, 1e-6);
}

// The squares of the classes add up to those of the whole run.
TEST(CompensationScore, ClassesAddUp) {
  const auto run = testing::chamber_recording({}, {{0.0, -20.0}, {9000.0, 40.0}}, 20000.0, 4);
  const auto n = static_cast<Eigen::Index>(run.time_s.size());
  const Eigen::VectorXd before = Eigen::VectorXd::Map(run.rate_dph.data(), n);
  const Eigen::VectorXd slope = Eigen::VectorXd::Map(run.slope_hz_per_s.data(), n);
  const auto score = score_compensation(before, 0.5 * before, slope, {{0, n}}, 1.0, 10.0, 2e-4);
  EXPECT_EQ(score.all.averages, 2000);
  EXPECT_EQ(score.warming.averages + score.cooling.averages + score.settled.averages, 2000);
  double squares = 0.0;
  for (const StabilityPair* pair : {&score.warming, &score.cooling, &score.settled})
    squares += static_cast<double>(pair->averages) * pair->before_dph * pair->before_dph;
  EXPECT_NEAR(squares, 1999.0 * score.all.before_dph * score.all.before_dph, 1e-9 * squares);
  EXPECT_NEAR(score.all.factor(), 2.0, 1e-9);
}

}  // namespace
}  // namespace hemi::calibration

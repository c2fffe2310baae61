// SPDX-License-Identifier: Apache-2.0
#include "golden/concealed/hysteresis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace hemi::concealed {
namespace {

/// Three cycles between -20 and 40; `steps` samples a leg, from the middle.
Series cycles(Eigen::Index steps) {
  std::vector<double> corners{10.0, 40.0, -20.0, 40.0, -20.0, 40.0};
  Series x((static_cast<Eigen::Index>(corners.size()) - 1) * steps + 1);
  for (std::size_t leg = 0; leg + 1 < corners.size(); ++leg)
    for (Eigen::Index i = 0; i <= steps; ++i)
      x[static_cast<Eigen::Index>(leg) * steps + i] = corners[leg] + (corners[leg + 1] - corners[leg]) *
                                                                         static_cast<double>(i) /
                                                                         static_cast<double>(steps);
  return x;
}

class Hysteresis : public ::testing::TestWithParam<int> {
 protected:
  static Memory memory(const Series& x) {
    switch (GetParam()) {
      case 0:
        return preisach(x, x, 0.3, 0.2);
      case 1:
        return duhem(x, x, 4.0);
      default:
        return bouc_wen(x, x, 3.0, 0.7);
    }
  }
  static Series run(const Series& x) { return memory(x).along; }
};

TEST_P(Hysteresis, DependsOnTheDirectionAndNotOnTheSpeed) {
  constexpr Eigen::Index kSlow = 4000, kFast = 1000;
  const Series slow = run(cycles(kSlow)), fast = run(cycles(kFast));
  for (Eigen::Index i = 0; i < fast.size(); ++i)
    ASSERT_NEAR(fast[i], slow[4 * i], 0.02) << i;  // one relay's weight
  // The second and third cycle meet at the same temperature, heating and cooling: an open, repeated loop.
  const Eigen::Index cooling = kSlow + kSlow / 2, heating = 2 * kSlow + kSlow / 2;
  EXPECT_GT(std::abs(slow[cooling] - slow[heating]), 0.2);
  EXPECT_NEAR(slow[cooling], slow[cooling + 2 * kSlow], 0.02);
  EXPECT_NEAR(slow[heating], slow[heating + 2 * kSlow], 0.02);
}

TEST_P(Hysteresis, HasUnitHeight) {
  const Series y = run(cycles(2000));
  EXPECT_NEAR(y.maxCoeff() - y.minCoeff(), 1.0, 1e-12);
}

// Over whole cycles from end to end the loop of the recording is the full one.
TEST_P(Hysteresis, OpensAsFarAsTheLoopOfARecordingOfTheFullRange) {
  constexpr Eigen::Index kWay = 2000;
  const Series x = cycles(kWay);
  const auto [y, opening] = memory(x);
  const Series cooling = y.segment(3 * kWay, kWay + 1), heating = y.segment(2 * kWay, kWay + 1).reverse();
  EXPECT_NEAR((cooling - heating).abs().maxCoeff(), opening, 0.02);  // one relay's weight
  EXPECT_GT(opening, 0.2);
  EXPECT_LT(opening, 1.0 + 1e-12);
}

TEST(HysteresisOpening, ADuhemLoopOpensByItsClosedForm) {
  // Between u = -1 and 1 the settled loop is y = -+1 +- 2 e^(-c (1 +- u)) / (1 + e^(-2 c)); at u = 0 the ways
  // are 2 (1 - 1 / cosh c) apart, and the loop spans 2 tanh c.
  const double c = 4.0;
  const Series x = cycles(4000);
  EXPECT_NEAR(duhem(x, x, c).opening, (1.0 - 1.0 / std::cosh(c)) / std::tanh(c), 2e-3);
}

TEST_P(Hysteresis, StaysSilentAtRest) {
  EXPECT_TRUE((run(Series::Constant(500, 23.0)) == 0.0).all());
}

INSTANTIATE_TEST_SUITE_P(Operators, Hysteresis, ::testing::Values(0, 1, 2));

}  // namespace
}  // namespace hemi::concealed

// SPDX-License-Identifier: Apache-2.0
#include "golden/concealed/hysteresis.hpp"

#include <gtest/gtest.h>

#include <functional>

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

class Memory : public ::testing::TestWithParam<int> {
 protected:
  static Series run(const Series& x) {
    switch (GetParam()) {
      case 0:
        return preisach(x, x, 0.3, 0.2);
      case 1:
        return duhem(x, x, 4.0);
      default:
        return bouc_wen(x, x, 3.0, 0.7);
    }
  }
};

TEST_P(Memory, DependsOnTheDirectionAndNotOnTheSpeed) {
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

TEST_P(Memory, HasUnitHeight) {
  const Series y = run(cycles(2000));
  EXPECT_NEAR(y.maxCoeff() - y.minCoeff(), 1.0, 1e-12);
}

TEST_P(Memory, StaysSilentAtRest) {
  EXPECT_TRUE((run(Series::Constant(500, 23.0)) == 0.0).all());
}

INSTANTIATE_TEST_SUITE_P(Operators, Memory, ::testing::Values(0, 1, 2));

}  // namespace
}  // namespace hemi::concealed

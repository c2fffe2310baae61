// SPDX-License-Identifier: Apache-2.0
#include "cli/prove/figures.hpp"

#include <gtest/gtest.h>

namespace hemi::prove {
namespace {

TEST(Wilson, AgreesWithPublishedValues) {
  const auto [low, high] = wilson95({8, 10});
  EXPECT_NEAR(low, 0.4902, 5e-5);
  EXPECT_NEAR(high, 0.9433, 5e-5);
  EXPECT_NEAR(wilson95({1, 10}).first, 0.0179, 5e-5);
  EXPECT_NEAR(wilson95({1, 10}).second, 0.4042, 5e-5);
}

TEST(Wilson, BoundsWhatWasNeverSeen) {
  // No success in n: the upper end is z^2 / (n + z^2).
  EXPECT_EQ(wilson95({0, 400}).first, 0.0);
  EXPECT_NEAR(wilson95({0, 400}).second, 3.841459 / 403.841459, 1e-8);
  EXPECT_EQ(wilson95({0, 0}), (std::pair<double, double>(0.0, 1.0)));
}

TEST(Median, AndItsInterval) {
  EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median({4.0, 1.0, 2.0, 3.0}), 2.5);
  EXPECT_EQ(median({}), 0.0);
  std::vector<double> hundred;
  for (int i = 1; i <= 100; ++i) hundred.push_back(i);
  // Ranks 50 -+ 9.8, as binomial tables have it.
  EXPECT_EQ(median_interval95(hundred), (std::pair<double, double>(41.0, 61.0)));
}

TEST(Mean, AndItsInterval) {
  const Mean mean = mean95({1.0, 2.0, 3.0, 4.0});
  EXPECT_DOUBLE_EQ(mean.value, 2.5);
  EXPECT_NEAR(mean.high - mean.value, 1.959964 * std::sqrt(5.0 / 3.0 / 4.0), 1e-6);
}

TEST(CalibrationError, IsTheMeanGapOfTheBins) {
  // Nine of ten right where 0.95 was stated, one of two where 0.55 was: (10 x 0.05 + 2 x 0.05) / 12.
  std::vector<std::pair<double, bool>> stated(9, {0.95, true});
  stated.emplace_back(0.95, false);
  stated.emplace_back(0.55, true);
  stated.emplace_back(0.55, false);
  EXPECT_NEAR(calibration_error(stated), 0.05, 1e-12);
  EXPECT_NEAR(calibration_error({{1.0, true}}), 0.0, 1e-12);
  EXPECT_EQ(calibration_error({}), 0.0);
}

TEST(Overlap, IsIntersectionOverUnion) {
  EXPECT_DOUBLE_EQ(overlap({{0.0, 10.0}}, {{5.0, 15.0}}), 5.0 / 15.0);
  EXPECT_DOUBLE_EQ(overlap({{0.0, 10.0}, {20.0, 30.0}}, {{0.0, 30.0}}), 20.0 / 30.0);
  EXPECT_DOUBLE_EQ(overlap({{0.0, 6.0}, {4.0, 10.0}}, {{0.0, 10.0}}), 1.0);
  EXPECT_EQ(overlap({}, {}), 0.0);
}

}  // namespace
}  // namespace hemi::prove

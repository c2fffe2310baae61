// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/scoring.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hemi::calibration {
namespace {

// Mean of the training rows as model. By hand for 0 1 2 3 4 in blocks {0 1} {2 3 4}: training means 3 and
// 0.5, squares 9 + 4 and 2.25 + 6.25 + 12.25.
TEST(ScoreBlocks, AgreesWithTheMeanByHand) {
  const Eigen::VectorXd observed = Eigen::VectorXd::LinSpaced(5, 0.0, 4.0);
  const auto build = [&](const std::vector<RowRange>& training) -> RowPredictor {
    double sum = 0.0;
    for (const RowRange& range : training) sum += observed.segment(range.begin, range.count).sum();
    const double mean = sum / static_cast<double>(total_rows(training));
    return [mean](Eigen::Index) { return mean; };
  };
  const BlockScore score = score_blocks(observed, 2, build);
  EXPECT_NEAR(score.in_sample_rms, std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(score.held_out_rms, std::sqrt((13.0 + 20.75) / 5.0), 1e-15);
  ASSERT_EQ(score.block_rms.size(), 2u);
  EXPECT_NEAR(score.block_rms[0], std::sqrt(6.5), 1e-15);
  EXPECT_NEAR(score.block_rms[1], std::sqrt(20.75 / 3.0), 1e-15);
  EXPECT_THROW(score_blocks(observed, 1, build), std::invalid_argument);
  EXPECT_THROW(score_blocks(observed, 6, build), std::invalid_argument);
}

// Every row is scored once, by a model that has not seen it or its block.
TEST(ScoreBlocks, HeldOutRowsAreNeverInTheTraining) {
  const Eigen::VectorXd observed = Eigen::VectorXd::Zero(23);
  std::vector<int> scored(23, 0);
  bool whole = true;
  score_blocks(observed, 8, [&](const std::vector<RowRange>& training) -> RowPredictor {
    const bool all = whole;
    whole = false;
    return [&, training, all](Eigen::Index row) {
      if (all) return 0.0;
      ++scored[static_cast<std::size_t>(row)];
      for (const RowRange& range : training)
        EXPECT_FALSE(row >= range.begin && row < range.begin + range.count);
      return 0.0;
    };
  });
  EXPECT_EQ(scored, std::vector<int>(23, 1));
}

}  // namespace
}  // namespace hemi::calibration

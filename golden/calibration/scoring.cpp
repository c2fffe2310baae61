// SPDX-License-Identifier: Apache-2.0
#include "golden/calibration/scoring.hpp"

#include <cmath>
#include <stdexcept>

namespace hemi::calibration {
namespace {

double sum_of_squares(const Eigen::VectorXd& observed, const RowRange& range, const RowPredictor& predict) {
  double sum = 0.0;
  for (Eigen::Index row = range.begin; row < range.begin + range.count; ++row) {
    const double residual = observed(row) - predict(row);
    sum += residual * residual;
  }
  return sum;
}

}  // namespace

BlockScore score_blocks(const Eigen::VectorXd& observed, int blocks, const ModelBuilder& build) {
  const Eigen::Index rows = observed.size();
  if (blocks < 2 || blocks > rows)
    throw std::invalid_argument("scoring: between two blocks and one a row are needed");
  const RowRange whole{0, rows};
  BlockScore score;
  score.in_sample_rms =
      std::sqrt(sum_of_squares(observed, whole, build({whole})) / static_cast<double>(rows));
  double held_out = 0.0;
  for (Eigen::Index block = 0; block < blocks; ++block) {
    const Eigen::Index begin = rows * block / blocks;
    const Eigen::Index end = rows * (block + 1) / blocks;
    std::vector<RowRange> training;
    if (begin > 0) training.push_back({0, begin});
    if (end < rows) training.push_back({end, rows - end});
    const double sum = sum_of_squares(observed, {begin, end - begin}, build(training));
    score.block_rms.push_back(std::sqrt(sum / static_cast<double>(end - begin)));
    held_out += sum;
  }
  score.held_out_rms = std::sqrt(held_out / static_cast<double>(rows));
  return score;
}

}  // namespace hemi::calibration

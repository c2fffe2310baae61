// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "golden/calibration/rows.hpp"

namespace hemi::calibration {

/// Model output for one row of the data set it was built on.
using RowPredictor = std::function<double(Eigen::Index row)>;

/// Builds a model from the given rows alone.
using ModelBuilder = std::function<RowPredictor(const std::vector<RowRange>& training)>;

struct BlockScore {
  double in_sample_rms = 0.0;     ///< built on all rows, scored on the same
  double held_out_rms = 0.0;      ///< every row scored by a model that was built without its block
  std::vector<double> block_rms;  ///< of each block held out
};

/// Cross-validation over contiguous blocks: neighbouring samples of a slow drift are so alike that leaving
/// out single ones would test nothing. observed: rows; blocks: 2 or more, at most the number of rows, equal
/// to within a row. All in the unit of `observed`. Throws std::invalid_argument.
BlockScore score_blocks(const Eigen::VectorXd& observed, int blocks, const ModelBuilder& build);

}  // namespace hemi::calibration

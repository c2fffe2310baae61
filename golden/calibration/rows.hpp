// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace hemi::calibration {

/// Rows [begin, begin + count) of a data set, recorded one after another without a gap.
struct RowRange {
  Eigen::Index begin = 0;
  Eigen::Index count = 0;
};

/// Sum of the counts.
inline Eigen::Index total_rows(const std::vector<RowRange>& ranges) {
  Eigen::Index total = 0;
  for (const RowRange& range : ranges) total += range.count;
  return total;
}

}  // namespace hemi::calibration

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "golden/diagnosis/hypothesis.hpp"

namespace hemi::diagnosis {

/// Baseline, members' columns, then what a hundredth of each shape parameter changes, per unit of its log.
struct ShapedDesign {
  Reduced rows;
  std::vector<Eigen::Index> shapes;  ///< first shape column of each member
};
ShapedDesign shaped_design(Hypotheses& hypotheses, const std::vector<Member>& members,
                           const HypothesisFit& fit);

}  // namespace hemi::diagnosis

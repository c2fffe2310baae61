// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/shaped_design.hpp"

#include <cmath>

namespace hemi::diagnosis {

using Eigen::Index;
using Eigen::VectorXd;

namespace {
constexpr double kShapeStep = 0.01;
}  // namespace

ShapedDesign shaped_design(Hypotheses& h, const std::vector<Member>& members, const HypothesisFit& fit) {
  ShapedDesign result;
  std::vector<Reduced> moved;
  Index next = fit.coefficients.size();
  for (std::size_t m = 0; m < members.size(); ++m) {
    result.shapes.push_back(next);
    const auto& family = h.families()[members[m].family];
    const Reduced& here = h.columns(members[m]);
    const VectorXd c = fit.coefficients.segment(fit.first[m], here[0].cols());
    for (std::size_t d = 0; d < family.spacing.size(); ++d, ++next) {
      Member other = members[m];
      other.shape[d] *= 1.0 + kShapeStep;
      const Reduced there = h.columns(other);
      Reduced column;
      for (std::size_t k = 0; k < kOutputs.size(); ++k)
        column[k] = (there[k] - here[k]) * c / std::log1p(kShapeStep);
      moved.push_back(std::move(column));
    }
  }
  const Reduced design = h.design(members);
  std::vector<const Reduced*> parts = {&design};
  for (const auto& column : moved) parts.push_back(&column);
  result.rows = joined(parts);
  return result;
}

}  // namespace hemi::diagnosis

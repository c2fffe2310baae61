// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "golden/calibration/rows.hpp"

namespace hemi::calibration {

/// Bias stability of one class of averages, before and after compensation [deg/h].
struct StabilityPair {
  Eigen::Index averages = 0;
  double before_dph = 0.0;
  double after_dph = 0.0;
  double factor() const { return before_dph / after_dph; }
};

/// A run that a drift model is scored on.
struct CompensationScore {
  StabilityPair all;  ///< standard deviation of the averages: the paper's figure
  StabilityPair
      warming;  ///< root mean square deviation from the whole run's mean, of the averages in which ...
  StabilityPair cooling;  ///< ... the frequency rises or falls; the classes' squares add up to those of `all`
  StabilityPair settled;
};

/// Averages of average_s each, that do not cross the end of a segment. Warming and cooling: |mean df/dt|
/// above `slope_threshold_hz_per_s`. before, after, slope: one a row. Throws std::invalid_argument for fewer
/// than two averages.
CompensationScore score_compensation(const Eigen::VectorXd& before_dph, const Eigen::VectorXd& after_dph,
                                     const Eigen::VectorXd& slope_hz_per_s,
                                     const std::vector<RowRange>& segments, double interval_s,
                                     double average_s, double slope_threshold_hz_per_s);

}  // namespace hemi::calibration

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string_view>

namespace hemi::diagnosis {

/// What the force does between two samples.
enum class Hold {
  zero_order,    ///< a converter's staircase: constant until the next sample
  linear,        ///< straight lines
  band_limited,  ///< no content above half the sampling rate
};
std::string_view name(Hold hold);

/// The force at 2 `substeps` equidistant instants a sample (starts and midpoints of the substeps), then the
/// last sample: (n - 1) 2 substeps + 1 values. Band-limited: sinc under a Kaiser window over 32 samples, the
/// first and the last value held beyond the ends; passband to 0.88 of half the sampling rate, ripple 1e-4.
Eigen::VectorXd refine(const Eigen::VectorXd& force, int substeps, Hold hold);

}  // namespace hemi::diagnosis

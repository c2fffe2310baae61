// SPDX-License-Identifier: Apache-2.0
// From telemetry to the samples that a drift model is fitted to.
#ifndef HEMI_CLI_DRIFT_DATA_HPP
#define HEMI_CLI_DRIFT_DATA_HPP

#include <optional>
#include <string>
#include <vector>

#include "cli/chain_run.hpp"
#include "golden/calibration/bias_regression.hpp"
#include "golden/calibration/scoring.hpp"

namespace hemi::cli {

/// Rows of a recording that can be fitted: frequency and df/dt as the core sees them (the ideal chain's
/// derivative filter, its lag included), rate less the applied rate.
struct DriftData {
  calibration::DriftSamples samples;
  Eigen::VectorXd time_s;
  std::vector<std::string> notes;
  double derivative_window_s = 0.0;
};

/// `from_s`, `to_s`: the stretch used. The first derivative window after the start or a gap is left out.
DriftData drift_data(const recording::Recording& recording, const recording::InstrumentModel& model,
                     double from_s, double to_s, std::optional<double> window_s);

/// In sample and held out in `blocks` contiguous blocks: Eq. (21) by stepwise regression, and a plain cubic
/// in f.
struct DriftScores {
  calibration::BlockScore stepwise;
  calibration::BlockScore cubic;
};
DriftScores score_drift(const DriftData& data, double reference_hz, int blocks);

}  // namespace hemi::cli

#endif  // HEMI_CLI_DRIFT_DATA_HPP

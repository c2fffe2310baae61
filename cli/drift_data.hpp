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

/// Rows of recordings that can be fitted. df/dt is that of the core's derivative filter (the ideal chain),
/// taken lag_s later, so that it belongs to the row's own time: the drift model is one of df/dt itself.
struct DriftData {
  calibration::DriftSamples samples;    ///< rate less scale factor times the applied rate
  Eigen::VectorXd core_slope_hz_per_s;  ///< df/dt as the core has it at that time, lag and all
  Eigen::VectorXd raw_rate_dph;         ///< as recorded
  Eigen::VectorXd applied_dph;          ///< rate_in_dph
  Eigen::VectorXd time_s;
  std::vector<std::string> notes;
  double derivative_window_s = 0.0;
  double lag_s = 0.0;
  double interval_s = 0.0;

  /// Sets samples.rate_dph for a scale factor.
  void apply_scale(double scale_factor);
};

/// `from_s`, `to_s`: the stretch used. The derivative window after the start or a gap and before the end is
/// left out, and so are two rows on either side of a jump of the applied rate. InputError for fewer than 40.
DriftData drift_data(const recording::Recording& recording, const recording::InstrumentModel& model,
                     double from_s, double to_s, std::optional<double> window_s);

/// Recordings one after another; the first one's window and interval stand for all. InputError where the
/// sample rates differ by more than 1 %.
DriftData join(const std::vector<DriftData>& parts, const std::vector<std::string>& paths);

/// In sample and held out in `blocks` contiguous blocks: Eq. (21) by stepwise regression, and a plain cubic
/// in f.
struct DriftScores {
  calibration::BlockScore stepwise;
  calibration::BlockScore cubic;
};
DriftScores score_drift(const DriftData& data, double reference_hz, int blocks);

}  // namespace hemi::cli

#endif  // HEMI_CLI_DRIFT_DATA_HPP

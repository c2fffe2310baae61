// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace hemi::calibration {

/// Telemetry without a gap that matters: one row a sample.
struct ThermalStretch {
  Eigen::VectorXd time_s;
  Eigen::VectorXd case_degc;     ///< thermometer on the housing, no value missing
  Eigen::VectorXd frequency_hz;  ///< NaN where it is missing or shall not be used
};

/// Resonator temperature behind the case's and what it changes with.
struct FilterResponse {
  Eigen::VectorXd temperature_degc;
  Eigen::VectorXd per_log_tau;  ///< dT / d ln(tau) [degC]
  Eigen::VectorXd per_start;    ///< dT / dT[0], exp(-(t - t[0]) / tau)
};

/// T[0] = start; T[i] = T[i-1] + (1 - exp(-(t[i] - t[i-1]) / tau)) (case[i] - T[i-1]), the first-order lag of
/// the nominal simulation. rows [begin, begin + count) of the stretch; tau_s > 0.
FilterResponse thermal_filter(const ThermalStretch& stretch, Eigen::Index begin, Eigen::Index count,
                              double tau_s, double start_degc);

/// Means over blocks of equal length of the rows that have a frequency; a block with less than half of them
/// is left out and parts the segments.
class RowBlocks {
 public:
  struct Range {
    std::size_t stretch;
    Eigen::Index begin;
    Eigen::Index count;
  };
  /// `ranges`: parts of the stretches that are used; `length` rows a block.
  RowBlocks(const std::vector<ThermalStretch>& stretches, const std::vector<Range>& ranges,
            Eigen::Index length);

  Eigen::Index rows() const { return static_cast<Eigen::Index>(range_of_.size()); }
  /// Runs of blocks without a hole, as [begin, count) in `begins` and `counts`.
  const std::vector<Eigen::Index>& begins() const { return begins_; }
  const std::vector<Eigen::Index>& counts() const { return counts_; }
  /// Block of row `row` of range `range`; -1 where it is left out.
  Eigen::Index block(std::size_t range, Eigen::Index row) const {
    return block_of_[range][static_cast<std::size_t>(row)];
  }
  /// Rows that entered a block.
  Eigen::Index used(Eigen::Index block) const { return used_[static_cast<std::size_t>(block)]; }
  std::size_t range_of(Eigen::Index block) const { return range_of_[static_cast<std::size_t>(block)]; }

 private:
  std::vector<std::vector<Eigen::Index>> block_of_;
  std::vector<Eigen::Index> used_;
  std::vector<std::size_t> range_of_;
  std::vector<Eigen::Index> begins_;
  std::vector<Eigen::Index> counts_;
};

/// Mean step of the clock.
double sample_step_s(const std::vector<ThermalStretch>& stretches);

/// Autocorrelation at lags 0 .. count - 1 blocks of white noise of the case behind the filter, averaged over
/// blocks of `length` rows every step_s: geometric sums of exp(-step / tau).
Eigen::VectorXd filtered_noise(Eigen::Index count, Eigen::Index length, double step_s, double tau_s);

/// Rows a block such that at most about `rows` blocks come out of `total`.
Eigen::Index block_length(Eigen::Index total, Eigen::Index rows);

}  // namespace hemi::calibration

// SPDX-License-Identifier: Apache-2.0
// Allan deviation and spectrum of what a model leaves.
#ifndef HEMI_CLI_REPORT_RESIDUALS_HPP
#define HEMI_CLI_REPORT_RESIDUALS_HPP

#include <optional>
#include <span>
#include <string>

#include "cli/report/report.hpp"

namespace hemi::report {

/// Equally spaced values: the longest run of rows without a missing value or a step of time above 1.5 usual
/// ones. `step_s` is its mean step; 0 where no run has two rows.
struct Run {
  std::size_t first = 0, rows = 0;
  double step_s = 0.0;
};
Run longest_run(std::span<const double> time_s, std::span<const double> values);

/// Overlapping Allan deviation of the longest run over tau [s], with its 68 % interval; nothing for fewer
/// than 16 rows.
std::optional<Series> allan_series(const std::string& name, std::span<const double> time_s,
                                   std::span<const double> values);

/// One-sided amplitude spectral density of the longest run [unit/root Hz] over frequency [Hz]: Welch's mean
/// of periodograms, Hann window, half overlap, each segment without its mean, the longest power of two (at
/// most 8192) that gives at least eight segments. Nothing for fewer than 64 rows. Source: Welch, IEEE Trans.
/// Audio Electroacoustics 15 (1967) 70.
std::optional<Series> spectrum_series(const std::string& name, std::span<const double> time_s,
                                      std::span<const double> values);

}  // namespace hemi::report

#endif  // HEMI_CLI_REPORT_RESIDUALS_HPP

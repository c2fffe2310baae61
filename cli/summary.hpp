// SPDX-License-Identifier: Apache-2.0
// What a run says in words: lock, frequency, drift, amplitude, quality factor.
#ifndef HEMI_CLI_SUMMARY_HPP
#define HEMI_CLI_SUMMARY_HPP

#include <cstdint>
#include <optional>
#include <string>

#include "cli/recording/json.hpp"
#include "cli/recording/recording.hpp"
#include "hls/config.hpp"

namespace hemi::cli {

/// Figures over the outputs between from_s and to_s in which the loop is locked and the frequency valid.
struct RunSummary {
  std::size_t outputs = 0;  ///< used
  double first_s = 0.0, last_s = 0.0;
  double locked_share = 0.0;                          ///< of the outputs in the window
  double frequency_hz = 0.0;                          ///< least squares on the phase over the window
  double start_hz = 0.0, end_hz = 0.0;                ///< the same over its first and last quarter
  double drift_ppm = 0.0;                             ///< end over start
  double start_amplitude = 0.0, end_amplitude = 0.0;  ///< means over the same quarters
  std::optional<double> damping_time_s;        ///< -1 / slope of log amplitude, where the amplitude decays
  std::optional<double> quality_factor;        ///< pi f damping_time
  std::optional<double> quality_factor_error;  ///< one sigma, from the scatter about the line
};

/// Whether an output's `status` says that its frequency can be used.
constexpr bool locked(double status) {
  constexpr auto bit = [](config::StatusBit b) { return std::uint64_t{1} << b; };
  return status >= 0.0 &&
         (static_cast<std::uint64_t>(status) & (bit(config::status_unlocked) | bit(config::status_holdover) |
                                                bit(config::status_frequency_invalid))) == 0;
}

RunSummary summarise_capture(const recording::Recording& output, double from_s, double to_s);
std::string to_text(const RunSummary& summary);
recording::Json to_json(const RunSummary& summary);

}  // namespace hemi::cli

#endif  // HEMI_CLI_SUMMARY_HPP

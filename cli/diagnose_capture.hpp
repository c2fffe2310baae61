// SPDX-License-Identifier: Apache-2.0
// hemi diagnose on raw captures: which stage of the chain holds what the model leaves out.
#ifndef HEMI_CLI_DIAGNOSE_CAPTURE_HPP
#define HEMI_CLI_DIAGNOSE_CAPTURE_HPP

#include <optional>
#include <string>

namespace hemi::cli {

struct CaptureOptions {
  std::string capture;    ///< adc_x, adc_y
  std::string model;      ///< hemi-model/1 of the instrument; empty: the nominal instrument
  std::string telemetry;  ///< records of the same run at the core's output rate, or empty
  std::string directory;
  std::optional<double> adc_rate_hz;
  bool json = false;
};

/// A file of raw samples. InputError where it cannot be read at all.
bool is_capture(const std::string& path);

/// Writes diagnosis.json into the directory and prints a summary. Exit code: 0 consistent, 1 something was
/// found. InputError for files that do not go together. The telemetry's sidecar tells where the capture
/// begins (`raw.start_s`, 0 is the core's reset) and, where the registers are not those of the model's design
/// at 20 degC, which they are (`registers`: names and values in their units).
int diagnose_capture(const CaptureOptions& options);

}  // namespace hemi::cli

#endif  // HEMI_CLI_DIAGNOSE_CAPTURE_HPP

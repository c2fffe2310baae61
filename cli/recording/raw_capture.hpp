// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/recording/recording.hpp"

namespace hemi::recording {

/// Pickoff samples as the ADC gave them, -full_scale_lsb .. full_scale_lsb - 1.
struct RawCapture {
  std::string path{};
  std::string device{};
  double sample_rate_hz = 0.0;
  double full_scale_lsb = 0.0;
  std::vector<std::int32_t> adc_x{};
  std::vector<std::int32_t> adc_y{};  ///< zeros where the file has none
  std::vector<Gap> gaps{};            ///< rows of the vectors; lost samples are not in them
  std::vector<std::string> notes{};
};

/// What the user states on the command line; goes before file, sidecar and clock.
struct RawOptions {
  std::optional<double> sample_rate_hz{};
  std::optional<double> full_scale_lsb{};
};

/// Sound files, files with a channel (dataset, group raw, mapped column) adc_x and no telemetry beside it.
/// InputError where the file cannot be read at all.
bool is_raw(const std::string& path);

/// Reads a capture. Rate: options, else `raw.sample_rate_hz` of the sidecar (or attribute of the group raw),
/// else `sample_rate_hz` of the file's own sidecar, else the sound file's, else time_s. Full scale: options,
/// `raw.full_scale_lsb`, the sound file's sample size, else 32768 with a note. A missing cell counts as a
/// lost sample. InputError: no adc_x, no rate, values that are no integers or beyond full scale.
RawCapture read_raw_capture(const std::string& path, const RawOptions& options = {});

}  // namespace hemi::recording

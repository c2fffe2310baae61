// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "cli/recording/error.hpp"
#include "cli/recording/json.hpp"

namespace hemi::recording {

/// One channel: values at the rows of the recording, NaN where missing, never infinite.
struct Channel {
  std::string name{};
  std::string unit{};
  std::vector<double> values{};
};

/// Samples that are missing between two rows: a step of the clock of more than 1.5 nominal steps.
struct Gap {
  double start_s;               ///< time of the last row before it
  double end_s;                 ///< time of the first row after it
  std::size_t after_row;        ///< index, from 0, of the last row before it
  std::size_t missing_samples;  ///< round(step / nominal step) - 1, at least 1
};

/// Telemetry. Read ones hold time_s first (made from the rate where the file has none, then time_from_rate is
/// true), every channel of one length and with at least one value.
struct Recording {
  std::string path{};
  std::string device{};
  double sample_rate_hz = 0.0;
  bool time_from_rate = false;
  std::vector<Channel> channels{};
  std::vector<Gap> gaps{};
  Json sidecar = Json::object();     ///< all keys; `columns` is gone, for it has been applied
  std::vector<std::string> notes{};  ///< one line each: what was survived or assumed

  std::size_t rows() const { return channels.empty() ? 0 : channels.front().values.size(); }
  /// nullptr where the recording has no such channel.
  const Channel* find(std::string_view name) const;
  /// The values; InputError "no channel NAME, which QUESTION needs" where there are none.
  const std::vector<double>& require(std::string_view name, std::string_view question) const;
  /// The values, or zeros where the channel is absent (rate_in_dph, quadrature_trim_v).
  std::vector<double> or_zero(std::string_view name) const;
};

/// Reads telemetry from CSV or HDF5 with its sidecar. InputError (file, line, channel, problem, remedy) for
/// everything that is not as the format says; raw captures and sound files are refused.
Recording read_recording(const std::string& path);

}  // namespace hemi::recording

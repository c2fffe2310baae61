// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/recording/error.hpp"
#include "cli/recording/json.hpp"

namespace hemi::recording {

inline constexpr const char* kRecordingFormat = "hemi-recording/1";

/// The JSON file beside a recording.
struct Sidecar {
  std::string path{};  ///< where it is, or where it would be
  Json content = Json::object();
  bool exists = false;
  bool shared = false;  ///< NAME.json beside NAME.raw.csv: its sample_rate_hz is that of the telemetry
};

/// NAME.json for NAME.csv, NAME.h5, NAME.wav, ...; for NAME.raw.csv NAME.raw.json where it exists, else
/// NAME.json. Absent: empty content. InputError where it is no sidecar (another format, wrong types).
Sidecar read_sidecar(const std::string& recording_path);

/// What becomes of one column of a file.
struct Target {
  std::string channel{};  ///< empty: the column is ignored
  double scale = 1.0;     ///< channel = scale * cell + offset
  double offset = 0.0;
  bool mapped = false;  ///< by the sidecar: the user has taken charge of units
};

/// Names of a file's columns to channels: through `columns` of the sidecar (text: the channel; object: "name"
/// or "channel", "scale", "offset"; null: ignore), else by the channel's own name, with `[unit]` behind it or
/// not. `place` says where the names stand. InputError for unknown or doubled names and for wrong units.
std::vector<Target> resolve_columns(const std::vector<std::string>& names, const Sidecar& sidecar,
                                    const Place& place);

/// Entries of `columns` that name no column of the file.
std::vector<std::string> unused_mappings(const std::vector<std::string>& names, const Sidecar& sidecar);

}  // namespace hemi::recording

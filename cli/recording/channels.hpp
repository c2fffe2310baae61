// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace hemi::recording {

/// One channel of the recording format.
struct ChannelInfo {
  std::string_view name;
  std::string_view unit;
  std::string_view meaning;
};

/// All channels that a recording may hold: those of the format and those that `hemi run` adds.
std::span<const ChannelInfo> known_channels();

/// nullptr when there is no channel of that name.
const ChannelInfo* find_channel(std::string_view name);

/// The known channel whose name needs the fewest single-letter edits (Levenshtein) to become `name`.
const ChannelInfo& nearest_channel(std::string_view name);

/// value in `to` = scale * (value in `from`) + offset.
struct Conversion {
  double scale = 1.0;
  double offset = 0.0;
};

/// Conversion between two spellings of units, nullopt when either is unknown or the quantities differ.
std::optional<Conversion> conversion(std::string_view from, std::string_view to);

/// Empty when `unit` is the unit of `channel` or another spelling of it; otherwise the remedy: the entry of
/// the sidecar's `columns` that converts `column` (with its scale where the units are of the same quantity).
std::string unit_remedy(std::string_view column, std::string_view unit, const ChannelInfo& channel);

}  // namespace hemi::recording

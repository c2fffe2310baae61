// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

namespace hemi::recording {
namespace {

constexpr std::array kChannels = {
    ChannelInfo{"time_s", "s", "the instrument's own clock"},
    ChannelInfo{"case_temp_degc", "degC", "thermometer on the housing"},
    ChannelInfo{"board_temp_degc", "degC", "thermometer on the electronics board"},
    ChannelInfo{"rate_in_dph", "deg/h", "rate applied along the sensing axis, Earth rate included"},
    ChannelInfo{"accel_g", "g", "specific force along the sensing axis"},
    ChannelInfo{"supply_v", "V", "supply of the electrode bias"},
    ChannelInfo{"quadrature_trim_v", "V", "deliberate offset on the quadrature command"},
    ChannelInfo{"frequency_hz", "Hz", "reference-phase loop's frequency"},
    ChannelInfo{"amplitude", "1", "primary vibration amplitude, 1 = nominal set point"},
    ChannelInfo{"drive_v", "V", "amplitude-control force command"},
    ChannelInfo{"quadrature_v", "V", "quadrature-control force command"},
    ChannelInfo{"rate_dph", "deg/h", "rebalance-loop rate before compensation"},
    ChannelInfo{"force_v", "V", "a driven resonator's input"},
    ChannelInfo{"displacement_v", "V", "a driven resonator's output"},
    ChannelInfo{"adc_x", "LSB", "raw pickoff samples, x"},
    ChannelInfo{"adc_y", "LSB", "raw pickoff samples, y"},
    ChannelInfo{"temperature_degc", "degC", "resonator temperature from its frequency"},
    ChannelInfo{"dfdt_hz_per_s", "Hz/s", "time derivative of the frequency"},
    ChannelInfo{"phase_error_turns", "turn", "remaining phase of the detector"},
    ChannelInfo{"bias_dph", "deg/h", "rate that the bias model predicts"},
    ChannelInfo{"compensated_rate_dph", "deg/h", "rate after temperature compensation"},
    ChannelInfo{"status", "1", "status word of the core"},
};

// A spelling of a unit as a multiple of the unit that the format uses for that quantity.
struct Unit {
  std::string_view spelling;
  std::string_view base;
  double scale = 1.0;
  double offset = 0.0;
};

constexpr double kStandardGravity = 9.80665;  // m/s^2, by definition
constexpr double kRadPerSecond = 3600.0 * 180.0 / std::numbers::pi;

constexpr std::array kUnits = {
    Unit{"s", "s"},
    Unit{"sec", "s"},
    Unit{"seconds", "s"},
    Unit{"ms", "s", 1e-3},
    Unit{"us", "s", 1e-6},
    Unit{"µs", "s", 1e-6},
    Unit{"ns", "s", 1e-9},
    Unit{"min", "s", 60.0},
    Unit{"h", "s", 3600.0},
    Unit{"degC", "degC"},
    Unit{"°C", "degC"},
    Unit{"C", "degC"},
    Unit{"deg C", "degC"},
    Unit{"K", "degC", 1.0, -273.15},
    Unit{"degF", "degC", 5.0 / 9.0, -160.0 / 9.0},
    Unit{"°F", "degC", 5.0 / 9.0, -160.0 / 9.0},
    Unit{"deg/h", "deg/h"},
    Unit{"°/h", "deg/h"},
    Unit{"dph", "deg/h"},
    Unit{"deg/hr", "deg/h"},
    Unit{"deg/s", "deg/h", 3600.0},
    Unit{"°/s", "deg/h", 3600.0},
    Unit{"dps", "deg/h", 3600.0},
    Unit{"rad/s", "deg/h", kRadPerSecond},
    Unit{"g", "g"},
    Unit{"mg", "g", 1e-3},
    Unit{"m/s^2", "g", 1.0 / kStandardGravity},
    Unit{"m/s2", "g", 1.0 / kStandardGravity},
    Unit{"V", "V"},
    Unit{"mV", "V", 1e-3},
    Unit{"uV", "V", 1e-6},
    Unit{"µV", "V", 1e-6},
    Unit{"Hz", "Hz"},
    Unit{"mHz", "Hz", 1e-3},
    Unit{"kHz", "Hz", 1e3},
    Unit{"MHz", "Hz", 1e6},
    Unit{"Hz/s", "Hz/s"},
    Unit{"mHz/s", "Hz/s", 1e-3},
    Unit{"1", "1"},
    Unit{"-", "1"},
    Unit{"%", "1", 0.01},
    Unit{"LSB", "LSB"},
    Unit{"counts", "LSB"},
    Unit{"turn", "turn"},
    Unit{"turns", "turn"},
};

const Unit* find_unit(std::string_view spelling) {
  const auto* found = std::ranges::find(kUnits, spelling, &Unit::spelling);
  return found == kUnits.end() ? nullptr : found;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::span<const ChannelInfo> known_channels() {
  return kChannels;
}

const ChannelInfo* find_channel(std::string_view name) {
  const auto* found = std::ranges::find(kChannels, name, &ChannelInfo::name);
  return found == kChannels.end() ? nullptr : found;
}

const ChannelInfo& nearest_channel(std::string_view name) {
  // Names come from files: a cell of a megabyte must not cost a megabyte times the table.
  const std::string_view head = name.substr(0, 64);
  return *std::ranges::min_element(
      kChannels, {}, [head](const ChannelInfo& channel) { return edit_distance(head, channel.name); });
}

std::optional<Conversion> conversion(std::string_view from, std::string_view to) {
  const Unit* source = find_unit(from);
  const Unit* target = find_unit(to);
  if (source == nullptr || target == nullptr || source->base != target->base) return std::nullopt;
  return Conversion{source->scale / target->scale, (source->offset - target->offset) / target->scale};
}

std::string unit_remedy(std::string_view column, std::string_view unit, const ChannelInfo& channel) {
  const auto factor = conversion(unit, channel.unit);
  if (factor && factor->scale == 1.0 && factor->offset == 0.0) return {};
  std::string entry = fmt::format("{{\"name\": \"{}\"", channel.name);
  entry += factor ? fmt::format(", \"scale\": {}", factor->scale) : ", \"scale\": ...";
  if (factor && factor->offset != 0.0) entry += fmt::format(", \"offset\": {}", factor->offset);
  return fmt::format("convert it, or put \"columns\": {{\"{}\": {}}}}} into the sidecar", column, entry);
}

}  // namespace hemi::recording

// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/recording/channels.hpp"
#include "cli/recording/clock.hpp"
#include "cli/recording/table.hpp"

namespace hemi::recording {
namespace {

// Rates that differ by more than this are told: beyond any oscillator's error.
constexpr double kRateDisagreement = 1e-3;

void refuse_raw(const Table& table) {
  for (const char* name : {"adc_x", "adc_y"}) {
    if (table.find(name) == nullptr) continue;
    throw InputError({.path = table.path, .channel = name}, "a raw capture where telemetry is expected",
                     "run it through an engine first (hemi run), and use what comes out");
  }
}

void take_channels(Table& table, Recording& recording) {
  for (Column& column : table.columns) {
    const bool empty = std::ranges::all_of(column.values, [](double x) { return std::isnan(x); });
    if (empty && column.name != "time_s") {
      recording.notes.push_back(
          fmt::format("{}: {}: every value is missing: treated as absent", table.path, column.name));
      continue;
    }
    recording.channels.push_back(
        {column.name, std::string(find_channel(column.name)->unit), std::move(column.values)});
  }
  const auto time = std::ranges::find(recording.channels, "time_s", &Channel::name);
  if (time != recording.channels.end()) std::rotate(recording.channels.begin(), time, time + 1);
}

void note_clock(const Clock& clock, Recording& recording) {
  std::size_t missing = 0;
  for (const Gap& gap : clock.gaps) missing += gap.missing_samples;
  if (!clock.gaps.empty()) {
    recording.notes.push_back(fmt::format("{}: time_s: {} gap(s), {} samples missing, the first after {} s",
                                          recording.path, clock.gaps.size(), missing,
                                          clock.gaps.front().start_s));
  }
  if (clock.short_steps > 0) {
    recording.notes.push_back(fmt::format("{}: time_s: {} step(s) shorter than half the usual one",
                                          recording.path, clock.short_steps));
  }
}

// The clock of the file where there is one, otherwise one made from the stated rate.
void set_time(const Table& table, std::size_t rows, const Sidecar& sidecar, Recording& recording) {
  const double stated_hz = stated_rate(table.metadata, sidecar.exists ? sidecar.path : table.path);
  const Channel* time = recording.find("time_s");
  if (time == nullptr) {
    if (stated_hz == 0.0) {
      throw InputError({.path = table.path, .channel = "time_s"},
                       "no such channel, and no sample rate either",
                       fmt::format("put {{\"sample_rate_hz\": ...}} into {}", sidecar.path));
    }
    recording.time_from_rate = true;
    recording.sample_rate_hz = stated_hz;
    recording.channels.insert(recording.channels.begin(), {"time_s", "s", time_from_rate(rows, stated_hz)});
    return;
  }
  Clock clock = examine_clock(table, time->values);
  if (clock.rate_hz == 0.0 && stated_hz == 0.0) {
    throw InputError(table.place(0, "time_s"), "a single row tells no sample rate",
                     fmt::format("put {{\"sample_rate_hz\": ...}} into {}", sidecar.path));
  }
  recording.sample_rate_hz = stated_hz > 0.0 ? stated_hz : clock.rate_hz;
  if (stated_hz > 0.0 && clock.rate_hz > 0.0 &&
      std::abs(clock.rate_hz - stated_hz) > kRateDisagreement * stated_hz) {
    recording.notes.push_back(
        fmt::format("{}: time_s: steps as of {:.6g} Hz where sample_rate_hz states {:.6g}", table.path,
                    clock.rate_hz, stated_hz));
  }
  note_clock(clock, recording);
  recording.gaps = std::move(clock.gaps);
}

}  // namespace

const Channel* Recording::find(std::string_view name) const {
  const auto found = std::ranges::find(channels, name, &Channel::name);
  return found == channels.end() ? nullptr : &*found;
}

const std::vector<double>& Recording::require(std::string_view name, std::string_view question) const {
  const Channel* channel = find(name);
  if (channel != nullptr) return channel->values;
  throw InputError({.path = path, .channel = std::string(name)},
                   fmt::format("no such channel with values, which {} needs", question),
                   "record it, or map a column to it under \"columns\" in the sidecar");
}

std::vector<double> Recording::or_zero(std::string_view name) const {
  const Channel* channel = find(name);
  return channel != nullptr ? channel->values : std::vector<double>(rows(), 0.0);
}

Recording read_recording(const std::string& path) {
  const FileKind kind = file_kind(path);
  if (kind == FileKind::kSound) {
    throw InputError({.path = path}, "a sound file is a raw capture, and telemetry is expected",
                     "run it through an engine first (hemi run), and use what comes out");
  }
  const Sidecar sidecar = read_sidecar(path);
  Table table = load_channels(path, kind, sidecar, false);
  refuse_raw(table);
  Recording recording{.path = path, .device = text_or_empty(table.metadata, "device", sidecar.path)};
  recording.sidecar = table.metadata;
  recording.sidecar.erase("columns");
  recording.notes = table.notes;
  const std::size_t rows = table.rows();
  take_channels(table, recording);
  set_time(table, rows, sidecar, recording);
  if (recording.channels.size() == 1 && table.columns.size() > 1) {
    throw InputError({.path = path}, "every value of every channel is missing", "record or export it again");
  }
  return recording;
}

}  // namespace hemi::recording

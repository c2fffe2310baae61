// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/raw_capture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/recording/clock.hpp"
#include "cli/recording/sound_file.hpp"
#include "cli/recording/table.hpp"

namespace hemi::recording {
namespace {

constexpr double kLargestFullScale = 2147483648.0;  // samples are kept in 32 bits
constexpr double kAssumedFullScale = 32768.0;

Json raw_object(const Json& metadata) {
  return metadata.value("raw", Json::object());
}

// Both 0 where nothing states them. Keys at the top level count only where they are the capture's own.
double stated_full_scale(const Json& metadata, bool own, const RawOptions& options, const std::string& path) {
  double lsb = number_or(raw_object(metadata), "full_scale_lsb", 0.0, path, "raw");
  if (lsb == 0.0 && own) lsb = number_or(metadata, "full_scale_lsb", 0.0, path);
  lsb = options.full_scale_lsb.value_or(lsb);
  if (!(lsb >= 0.0 && lsb <= kLargestFullScale) || lsb != std::floor(lsb)) {
    throw InputError({.path = path, .channel = "raw.full_scale_lsb"}, fmt::format("{} is no full scale", lsb),
                     "give a power of two, such as 32768 for 16 bits");
  }
  return lsb;
}

double stated_raw_rate(const Json& metadata, bool own, const RawOptions& options, const std::string& path) {
  if (options.sample_rate_hz) return *options.sample_rate_hz;
  const double rate_hz = stated_rate(raw_object(metadata), path, "raw");
  return rate_hz == 0.0 && own ? stated_rate(metadata, path) : rate_hz;
}

std::int32_t to_sample(double value, const Table& table, std::size_t row, const char* channel,
                       double full_scale_lsb) {
  if (value != std::floor(value)) {
    throw InputError(table.place(row, channel), fmt::format("{} is no integer", value),
                     "raw captures hold ADC words in LSB: divide volts by the ADC's step");
  }
  if (value < -full_scale_lsb || value >= full_scale_lsb) {
    throw InputError(
        table.place(row, channel),
        fmt::format("{} lies outside full scale, {} to {}", value, -full_scale_lsb, full_scale_lsb - 1.0),
        "state the ADC's full scale: {\"raw\": {\"full_scale_lsb\": ...}} in the sidecar");
  }
  return static_cast<std::int32_t>(value);
}

// Samples that the file's clock misses before each row, added up.
class Losses {
 public:
  explicit Losses(const std::vector<Gap>& clock_gaps) : gaps_(clock_gaps) {}
  std::size_t before(std::size_t row) {
    while (next_ < gaps_.size() && gaps_[next_].after_row < row) lost_ += gaps_[next_++].missing_samples;
    return lost_;
  }

 private:
  const std::vector<Gap>& gaps_;
  std::size_t next_ = 0;
  std::size_t lost_ = 0;
};

// Rows with a missing cell leave the vectors; they and the clock's gaps become gaps of the capture.
void take_samples(const Table& table, const Clock& clock, RawCapture& capture) {
  const std::vector<double>& x = table.find("adc_x")->values;
  const Column* y = table.find("adc_y");
  Losses losses(clock.gaps);
  std::size_t expected = 0;  // position in the ideal stream of the next sample
  for (std::size_t row = 0; row < x.size(); ++row) {
    if (std::isnan(x[row]) || (y != nullptr && std::isnan(y->values[row]))) continue;
    const std::size_t position = row + losses.before(row);
    if (position > expected && !capture.adc_x.empty()) {
      capture.gaps.push_back({static_cast<double>(expected - 1) / capture.sample_rate_hz,
                              static_cast<double>(position) / capture.sample_rate_hz,
                              capture.adc_x.size() - 1, position - expected});
    }
    capture.adc_x.push_back(to_sample(x[row], table, row, "adc_x", capture.full_scale_lsb));
    capture.adc_y.push_back(
        y == nullptr ? 0 : to_sample(y->values[row], table, row, "adc_y", capture.full_scale_lsb));
    expected = position + 1;
  }
  if (capture.adc_x.empty()) {
    throw InputError({.path = table.path, .channel = "adc_x"}, "every value is missing",
                     "record or export it again");
  }
}

void note_gaps(RawCapture& capture) {
  if (capture.gaps.empty()) return;
  std::size_t missing = 0;
  for (const Gap& gap : capture.gaps) missing += gap.missing_samples;
  capture.notes.push_back(fmt::format("{}: {} gap(s), {} samples missing, the first after sample {}",
                                      capture.path, capture.gaps.size(), missing,
                                      capture.gaps.front().after_row + 1));
}

void read_table(const Table& table, const Sidecar& sidecar, const RawOptions& options, RawCapture& capture) {
  if (table.find("adc_x") == nullptr) {
    throw InputError({.path = table.path, .channel = "adc_x"}, "no such channel: not a raw capture",
                     "give a capture with adc_x, or map a column to it under \"columns\" in the sidecar");
  }
  const Column* time = table.find("time_s");
  const Clock clock = time != nullptr ? examine_clock(table, time->values) : Clock{};
  const double stated_hz = stated_raw_rate(table.metadata, !sidecar.shared, options, sidecar.path);
  capture.sample_rate_hz = stated_hz > 0.0 ? stated_hz : clock.rate_hz;
  if (capture.sample_rate_hz == 0.0) {
    throw InputError(
        {.path = table.path}, "nothing tells the ADC rate",
        fmt::format("put {{\"raw\": {{\"sample_rate_hz\": ...}}}} into {}, or add time_s", sidecar.path));
  }
  capture.full_scale_lsb = stated_full_scale(table.metadata, !sidecar.shared, options, sidecar.path);
  if (capture.full_scale_lsb == 0.0) {
    capture.full_scale_lsb = kAssumedFullScale;
    capture.notes.push_back(fmt::format("{}: raw.full_scale_lsb is not stated: {} (16 bits) assumed",
                                        table.path, kAssumedFullScale));
  }
  take_samples(table, clock, capture);
}

// The words of a sound file are integers within its own full scale; a stated one may be smaller.
void read_samples(Sound sound, const Sidecar& sidecar, const RawOptions& options, RawCapture& capture) {
  // The file knows its own rate: only one that is stated for raw samples goes before it.
  const double stated_hz = stated_raw_rate(sidecar.content, false, options, sidecar.path);
  const double stated_lsb = stated_full_scale(sidecar.content, false, options, sidecar.path);
  capture.sample_rate_hz = stated_hz > 0.0 ? stated_hz : sound.sample_rate_hz;
  capture.full_scale_lsb = stated_lsb > 0.0 ? stated_lsb : sound.full_scale_lsb;
  if (capture.sample_rate_hz != sound.sample_rate_hz) {
    capture.notes.push_back(fmt::format("{}: sample rate {} Hz as stated, {} Hz in the file itself",
                                        capture.path, capture.sample_rate_hz, sound.sample_rate_hz));
  }
  const Table rows{.path = capture.path};
  const auto check = [&](const std::vector<std::int32_t>& values, const char* name) {
    for (std::size_t i = 0; i < values.size(); ++i)
      to_sample(values[i], rows, i, name, capture.full_scale_lsb);
  };
  check(sound.x, "adc_x");
  check(sound.y, "adc_y");
  capture.adc_x = std::move(sound.x);
  capture.adc_y = std::move(sound.y);
  capture.adc_y.resize(capture.adc_x.size(), 0);
}

// The channel that a column is meant to be, empty where it is ignored.
std::string channel_of(const std::string& name, const Json& columns, const std::string& path) {
  const auto entry = columns.find(name);
  if (entry == columns.end()) return name;
  if (entry->is_string()) return entry->get<std::string>();
  if (!entry->is_object()) return {};
  const std::string channel = text_or_empty(*entry, "channel", path);
  return channel.empty() ? text_or_empty(*entry, "name", path) : channel;
}

}  // namespace

bool is_raw(const std::string& path) {
  const FileKind kind = file_kind(path);
  if (kind == FileKind::kSound) return true;
  const Sidecar sidecar = read_sidecar(path);
  const Json columns = sidecar.content.value("columns", Json::object());
  bool raw = false;
  bool telemetry = false;
  for (const std::string& name : column_names(path, kind)) {
    const std::string channel = channel_of(name, columns, sidecar.path);
    const bool adc = channel.starts_with("adc_x") || channel.starts_with("adc_y");
    if (adc || channel == "raw/adc_x") raw = true;
    if (!adc && !channel.empty() && !channel.starts_with("raw/") && !channel.starts_with("time_s") &&
        channel != "sample_rate_hz" && channel != "full_scale_lsb") {
      telemetry = true;
    }
  }
  return raw && !telemetry;
}

RawCapture read_raw_capture(const std::string& path, const RawOptions& options) {
  if (options.sample_rate_hz && !(*options.sample_rate_hz > 0.0 && std::isfinite(*options.sample_rate_hz))) {
    throw InputError({.path = path}, "the stated sample rate must be above zero", "correct it");
  }
  const FileKind kind = file_kind(path);
  const Sidecar sidecar = read_sidecar(path);
  RawCapture capture{.path = path};
  if (kind == FileKind::kSound) {
    capture.device = text_or_empty(sidecar.content, "device", sidecar.path);
    read_samples(read_sound(path), sidecar, options, capture);
  } else {
    const Table table = load_channels(path, kind, sidecar, true);
    capture.device = text_or_empty(table.metadata, "device", sidecar.path);
    capture.notes = table.notes;
    read_table(table, sidecar, options, capture);
  }
  note_gaps(capture);
  return capture;
}

}  // namespace hemi::recording

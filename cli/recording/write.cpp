// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/write.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <stdexcept>

#include "cli/recording/hdf5_file.hpp"
#include "cli/recording/matlab_file.hpp"
#include "cli/recording/partial_file.hpp"
#include "cli/recording/progress.hpp"
#include "cli/recording/sidecar.hpp"

namespace hemi::recording {
namespace {

constexpr std::size_t kFlush_bytes = std::size_t{1} << 20;

void check_channels(const std::string& path, const std::vector<Channel>& channels) {
  for (const Channel& channel : channels) {
    if (channel.values.size() != channels.front().values.size()) {
      throw std::invalid_argument("channels of unequal length: " + channel.name);
    }
    const auto infinite = std::ranges::find_if(channel.values, [](double x) { return std::isinf(x); });
    if (infinite == channel.values.end()) continue;
    throw OutputError(
        path,
        fmt::format("row {}: {}: an infinite value", infinite - channel.values.begin() + 1, channel.name),
        "look for a division by zero in the settings or the model");
  }
}

void append_header_cell(fmt::memory_buffer& text, std::string_view name) {
  const bool quotes = name.find_first_of(",\"") != std::string_view::npos;
  if (quotes) text.push_back('"');
  for (const char c : name) {
    if (c == '"') text.push_back('"');
    text.push_back(c);
  }
  if (quotes) text.push_back('"');
}

// A blank line would be lost at the end of a file: the only cell of a row says nan.
void append_row(fmt::memory_buffer& text, const std::vector<Channel>& channels, std::size_t row) {
  const char* separator = "";
  for (const Channel& channel : channels) {
    const double value = channel.values[row];
    text.append(std::string_view(separator));
    if (!std::isnan(value)) {
      fmt::format_to(std::back_inserter(text), "{}", value);
    } else if (channels.size() == 1) {
      text.append(std::string_view("nan"));
    }
    separator = ",";
  }
  text.push_back('\n');
}

void write_rows(PartialFile& file, const std::vector<Channel>& channels, const std::string& path) {
  fmt::memory_buffer text;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (i > 0) text.push_back(',');
    append_header_cell(text, channels[i].name);
  }
  text.push_back('\n');
  const std::size_t rows = channels.empty() ? 0 : channels.front().values.size();
  Progress progress("writing " + path, std::max(static_cast<double>(rows), 1.0));
  for (std::size_t row = 0; row < rows; ++row) {
    append_row(text, channels, row);
    if (text.size() < kFlush_bytes) continue;
    file.write({text.data(), text.size()});
    text.clear();
    progress.update(static_cast<double>(row));
  }
  file.write({text.data(), text.size()});
}

Json full_sidecar(const Recording& recording) {
  Json sidecar = Json::object();
  sidecar["format"] = kRecordingFormat;
  if (!recording.device.empty()) sidecar["device"] = recording.device;
  if (recording.sample_rate_hz > 0.0) sidecar["sample_rate_hz"] = recording.sample_rate_hz;
  for (const auto& [key, value] : recording.sidecar.items()) {
    if (!sidecar.contains(key)) sidecar[key] = value;
  }
  return sidecar;
}

bool is_renamable(const std::string& path) {
  std::error_code code;
  const auto status = std::filesystem::status(path, code);
  return !std::filesystem::exists(status) || std::filesystem::is_regular_file(status);
}

// Data and sidecar are both complete on the disk before either gets its name.
void write_pair(const std::string& path, const std::vector<Channel>& channels,
                const std::string& sidecar_path, const Json& sidecar) {
  check_channels(path, channels);
  PartialFile data(path);
  write_rows(data, channels, path);
  if (!is_renamable(path)) {  // a stream has no sidecar
    data.commit();
    return;
  }
  PartialFile beside(sidecar_path);
  beside.write(json_text(sidecar, 2) + "\n");
  data.finish();
  beside.finish();
  beside.commit();
  data.commit();
}

// Positions of the samples in the ideal stream, gaps included.
std::vector<double> raw_time(const RawCapture& capture) {
  std::vector<double> time_s(capture.adc_x.size());
  std::size_t lost = 0;
  auto gap = capture.gaps.begin();
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    while (gap != capture.gaps.end() && gap->after_row < i) lost += (gap++)->missing_samples;
    time_s[i] = static_cast<double>(i + lost) / capture.sample_rate_hz;
  }
  return time_s;
}

Json raw_keys(const RawCapture& capture) {
  Json keys = Json::object();
  keys["sample_rate_hz"] = capture.sample_rate_hz;
  keys["full_scale_lsb"] = capture.full_scale_lsb;
  return keys;
}

// Vectors for the two formats that hold everything in one file; they stay where they are in the recording.
OutputGroup grouped(const std::string& path, const Recording& recording) {
  check_channels(path, recording.channels);
  OutputGroup content{.file_attributes = full_sidecar(recording)};
  for (const Channel& channel : recording.channels) {
    content.arrays.push_back({channel.name, channel.unit, &channel.values});
  }
  return content;
}

// time_s is where a capture with gaps gets its clock from; empty elsewhere.
OutputGroup grouped(const RawCapture& capture, const std::vector<double>& time_s) {
  OutputGroup content{.group = kRawGroup, .group_attributes = raw_keys(capture)};
  content.file_attributes["format"] = kRecordingFormat;
  if (!capture.device.empty()) content.file_attributes["device"] = capture.device;
  if (!time_s.empty()) content.arrays.push_back({"time_s", "s", &time_s});
  content.arrays.push_back({"adc_x", "LSB", &capture.adc_x});
  content.arrays.push_back({"adc_y", "LSB", &capture.adc_y});
  return content;
}

std::vector<double> clock_of(const RawCapture& capture) {
  return capture.gaps.empty() ? std::vector<double>{} : raw_time(capture);
}

}  // namespace

void write_csv(const std::string& path, const Recording& recording) {
  const std::string sidecar_path = std::filesystem::path(path).replace_extension(".json").string();
  write_pair(path, recording.channels, sidecar_path, full_sidecar(recording));
}

void write_hdf5(const std::string& path, const Recording& recording) {
  write_hdf5_file(path, grouped(path, recording));
}

void write_matlab(const std::string& path, const Recording& recording) {
  write_matlab_file(path, grouped(path, recording));
}

void write_csv(const std::string& path, const RawCapture& capture) {
  std::vector<Channel> channels;
  if (!capture.gaps.empty()) channels.push_back({"time_s", "s", raw_time(capture)});
  channels.push_back({"adc_x", "LSB", {capture.adc_x.begin(), capture.adc_x.end()}});
  channels.push_back({"adc_y", "LSB", {capture.adc_y.begin(), capture.adc_y.end()}});
  Sidecar sidecar = is_renamable(path) ? read_sidecar(path) : Sidecar{};
  sidecar.content["format"] = kRecordingFormat;
  if (!capture.device.empty()) sidecar.content["device"] = capture.device;
  sidecar.content["raw"].update(raw_keys(capture));
  write_pair(path, channels, sidecar.path, sidecar.content);
}

void write_hdf5(const std::string& path, const RawCapture& capture) {
  const std::vector<double> time_s = clock_of(capture);
  write_hdf5_file(path, grouped(capture, time_s));
}

void write_matlab(const std::string& path, const RawCapture& capture) {
  const std::vector<double> time_s = clock_of(capture);
  write_matlab_file(path, grouped(capture, time_s));
}

OutputKind output_kind(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension == ".mat") return OutputKind::kMatlab;
  return extension == ".h5" || extension == ".hdf5" ? OutputKind::kHdf5 : OutputKind::kCsv;
}

void write_file(const std::string& path, const Recording& recording) {
  const OutputKind kind = output_kind(path);
  if (kind == OutputKind::kMatlab) return write_matlab(path, recording);
  kind == OutputKind::kHdf5 ? write_hdf5(path, recording) : write_csv(path, recording);
}

void write_file(const std::string& path, const RawCapture& capture) {
  const OutputKind kind = output_kind(path);
  if (kind == OutputKind::kMatlab) return write_matlab(path, capture);
  kind == OutputKind::kHdf5 ? write_hdf5(path, capture) : write_csv(path, capture);
}

void write_text(const std::string& path, std::string_view text) {
  PartialFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace hemi::recording

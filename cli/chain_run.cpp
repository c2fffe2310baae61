// SPDX-License-Identifier: Apache-2.0
#include "cli/chain_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include "cli/output.hpp"
#include "cli/recording/csv_file.hpp"
#include "cli/recording/error.hpp"
#include "cli/recording/interrupt.hpp"
#include "cli/recording/progress.hpp"
#include "cli/recording/table.hpp"

namespace hemi::cli {
namespace {

constexpr std::size_t samples_a_chunk = 20000;
constexpr std::size_t rows_a_chunk = 4096;

/// InputError for a telemetry value that the core's word cannot hold; NaN passes.
void check_word(double value, config::Format format, const recording::Recording& recording, std::size_t row,
                const char* channel) {
  const double limit = std::ldexp(1.0, format.width - 1 - format.fraction);
  const double half_lsb = std::ldexp(0.5, -format.fraction);
  if (std::isnan(value) || (value >= -limit && value < limit - half_lsb)) return;
  throw recording::InputError({recording.path, 0, row + 1, channel},
                              fmt::format("{:g} is more than the core's word holds, +-{:g}", value, limit),
                              "correct it, or leave the cell empty: missing values are survived");
}

}  // namespace

void print_notes(const std::vector<std::string>& notes) {
  for (const auto& note : notes) fmt::print(stderr, "note: {}\n", note);
}

void print_gaps(const std::vector<recording::Gap>& gaps) {
  constexpr std::size_t most = 5;
  for (std::size_t i = 0; i < std::min(most, gaps.size()); ++i) {
    fmt::print(stderr, "note: gap of {} samples between {} s and {} s\n", gaps[i].missing_samples,
               gaps[i].start_s, gaps[i].end_s);
  }
  if (gaps.size() > most) fmt::print(stderr, "note: and {} more gaps\n", gaps.size() - most);
}

bool holds_settled_points(const std::string& path) {
  recording::require_readable(path);
  if (recording::file_kind(path) != recording::FileKind::kCsv) return false;
  const auto names = recording::read_csv_header(path);
  return std::find(names.begin(), names.end(), "settled_degc") != names.end();
}

void refuse_settled_points(const std::string& path) {
  if (!holds_settled_points(path)) return;
  throw recording::InputError({path, 0, 0, "settled_degc"}, "settled points where a recording is expected",
                              "give them to hemi calibrate");
}

void refuse_compensated(const recording::Recording& recording, const std::string& doing) {
  const auto& keys = recording.sidecar;
  const auto state = keys.find("compensated");
  if (state == keys.end()) return;
  // MATLAB's truth values may arrive as numbers.
  const bool compensated = state->is_number() ? *state != 0 : *state == true;
  if (!compensated) return;
  const std::string model = recording::text_or_empty(keys, "model", recording.path);
  const std::string source = recording::text_or_empty(keys, "source", recording.path);
  throw recording::InputError(
      {recording.path, 0, 0, "compensated"},
      fmt::format("is compensated already{}: {} it again would count the drift twice",
                  model.empty() ? "" : " (with " + model + ")", doing),
      source.empty() ? "give the recording that it was made from" : "give what it was made from: " + source);
}

void refuse_overwriting(const std::vector<std::string>& written, const std::vector<std::string>& read) {
  namespace fs = std::filesystem;
  for (const auto& output : written) {
    for (const auto& input : read) {
      std::error_code code;
      if (!fs::is_regular_file(output, code) || !fs::equivalent(output, input, code)) continue;
      throw recording::InputError({output}, fmt::format("writing it would replace {}, which is read", input),
                                  "give the output another name");
    }
  }
}

void make_directory(const std::string& directory) {
  std::error_code code;
  std::filesystem::create_directories(directory, code);
  if (code || !std::filesystem::is_directory(directory))
    throw recording::OutputError(directory, code ? code.message() : "is no directory", "name another one");
}

void require_an_output(const recording::RawCapture& capture, const Setup& setup) {
  const auto needed = static_cast<std::size_t>(sampling(setup.wide).decimation * config::ticks_per_output);
  if (capture.adc_x.size() >= needed) return;
  throw recording::InputError({capture.path},
                              fmt::format("{} sample pairs end before the first output, which takes {}",
                                          capture.adc_x.size(), needed),
                              "check that the capture is complete, or record longer");
}

std::vector<tb::SamplePair> sample_pairs(const recording::RawCapture& capture) {
  std::vector<tb::SamplePair> pairs(capture.adc_x.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] = {capture.adc_x[i], capture.adc_y[i], false};
  for (const auto& gap : capture.gaps) {
    if (gap.after_row + 1 < pairs.size()) pairs[gap.after_row + 1].gap = true;
  }
  return pairs;
}

TelemetryInput telemetry_input(const recording::Recording& recording,
                               const recording::InstrumentModel& model) {
  TelemetryInput input;
  input.sample_rate_hz = recording.sample_rate_hz;
  input.time_s = recording.require("time_s", "the output");
  input.notes = recording.notes;
  const auto* frequency = recording.find("frequency_hz");
  const auto& rate = recording.require("rate_dph", "compensation");
  std::vector<double> stand_in;
  if (frequency == nullptr) {
    const auto& degc = recording.require("case_temp_degc", "a stand-in for frequency_hz");
    for (const double t : degc) {
      double f = 0.0;
      const auto& c = model.frequency->coefficients_hz;
      for (auto k = c.rbegin(); k != c.rend(); ++k) f = f * (t - model.frequency->reference_degc) + *k;
      stand_in.push_back(f);
    }
    input.notes.push_back("no frequency_hz in the recording: f(T) of case_temp_degc stands in for it");
  }
  const std::vector<double>& f = frequency != nullptr ? frequency->values : stand_in;
  std::set<std::size_t> after_gap;
  for (const auto& gap : recording.gaps) after_gap.insert(gap.after_row + 1);
  const auto first = std::find_if(f.begin(), f.end(), [](double v) { return !std::isnan(v); });
  double last = first != f.end() ? *first : 0.0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    if (!std::isnan(f[i])) last = f[i];
    input.frequency_hz.push_back(last);
    check_word(last, config::frequency, recording, i,
               frequency != nullptr ? "frequency_hz" : "case_temp_degc, through f(T): frequency_hz");
    check_word(rate[i], config::rate, recording, i, "rate_dph");
    input.frequency_valid.push_back(!std::isnan(f[i]) && after_gap.count(i) == 0);
    input.rate_dph.push_back(std::isnan(rate[i]) ? 0.0 : rate[i]);
    input.rate_valid.push_back(!std::isnan(rate[i]));
  }
  return input;
}

std::vector<tb::Record> run_samples(tb::Engine& engine, const std::vector<tb::SamplePair>& pairs) {
  std::vector<tb::Record> records;
  recording::Progress progress(engine.name(), static_cast<double>(pairs.size()));
  for (std::size_t i = 0; i < pairs.size(); i += samples_a_chunk) {
    const std::size_t n = std::min(samples_a_chunk, pairs.size() - i);
    engine.samples({pairs.data() + i, n}, records);
    progress.update(static_cast<double>(i + n));
    recording::check_interrupt();
  }
  return records;
}

std::vector<tb::Record> run_telemetry(tb::Engine& engine, const TelemetryInput& input, const Setup& setup) {
  std::vector<tb::Record> records;
  recording::Progress progress(engine.name(), static_cast<double>(input.time_s.size()));
  for (std::size_t i = 0; i < input.time_s.size(); ++i) {
    engine.telemetry(input.frequency_hz[i] * setup.rate_ratio, input.rate_dph[i], input.frequency_valid[i],
                     records);
    if (i % rows_a_chunk != 0) continue;
    progress.update(static_cast<double>(i));
    recording::check_interrupt();
  }
  return records;
}

recording::Recording telemetry_output(const std::vector<tb::Record>& records, const TelemetryInput& input,
                                      const Setup& setup) {
  recording::Recording out = to_recording(records, input.time_s, setup, true);
  for (auto& channel : out.channels) {
    if (channel.name != "rate_dph" && channel.name != "compensated_rate_dph") continue;
    for (std::size_t i = 0; i < channel.values.size(); ++i) {
      if (!input.rate_valid[i]) channel.values[i] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return out;
}

}  // namespace hemi::cli

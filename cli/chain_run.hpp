// SPDX-License-Identifier: Apache-2.0
// Recordings through one engine: what run, compare and calibrate share.
#ifndef HEMI_CLI_CHAIN_RUN_HPP
#define HEMI_CLI_CHAIN_RUN_HPP

#include <optional>
#include <string>
#include <vector>

#include "cli/recording/raw_capture.hpp"
#include "cli/recording/recording.hpp"
#include "cli/settings.hpp"
#include "tb/engine.hpp"

namespace hemi::cli {

/// One line each on stderr.
void print_notes(const std::vector<std::string>& notes);

/// Where samples are missing, on stderr: the first few gaps, and how many more there are.
void print_gaps(const std::vector<recording::Gap>& gaps);

/// A CSV file with a column settled_degc; InputError where it cannot be read.
bool holds_settled_points(const std::string& path);

/// InputError for a file of settled points where a recording is expected.
void refuse_settled_points(const std::string& path);

/// InputError for a recording whose metadata say that it is compensated; `doing` is what must not be done to
/// it again.
void refuse_compensated(const recording::Recording& recording, const std::string& doing);

/// InputError where writing one of the files would replace one that is read.
void refuse_overwriting(const std::vector<std::string>& written, const std::vector<std::string>& read);

/// Makes a directory for results, its parents too; OutputError where that is impossible.
void make_directory(const std::string& directory);

/// InputError for a capture that ends before its first output.
void require_an_output(const recording::RawCapture& capture, const Setup& setup);

/// A capture as sample pairs, gap flags included.
std::vector<tb::SamplePair> sample_pairs(const recording::RawCapture& capture);

/// Telemetry as the core takes it: one entry a row.
struct TelemetryInput {
  std::vector<double> time_s;
  std::vector<double> frequency_hz;   ///< the last good value where the recording has none
  std::vector<double> rate_dph;       ///< 0 where the recording has none
  std::vector<bool> frequency_valid;  ///< false for missing values and right after a gap
  std::vector<bool> rate_valid;
  double sample_rate_hz = 0.0;
  std::vector<std::string> notes;
};

/// frequency_hz and rate_dph; f(T) of the case stands in for a frequency that was not recorded (with a note).
TelemetryInput telemetry_input(const recording::Recording& recording,
                               const recording::InstrumentModel& model);

/// Feeds all pairs, with progress and Ctrl-C; records come back in order.
std::vector<tb::Record> run_samples(tb::Engine& engine, const std::vector<tb::SamplePair>& pairs);
std::vector<tb::Record> run_telemetry(tb::Engine& engine, const TelemetryInput& input, const Setup& setup);

/// Output of a telemetry run as a recording; NaN where the input was missing.
recording::Recording telemetry_output(const std::vector<tb::Record>& records, const TelemetryInput& input,
                                      const Setup& setup);

}  // namespace hemi::cli

#endif  // HEMI_CLI_CHAIN_RUN_HPP

// SPDX-License-Identifier: Apache-2.0
#ifndef HEMI_TESTS_CLI_PROGRAM_PROGRAM_HPP
#define HEMI_TESTS_CLI_PROGRAM_PROGRAM_HPP

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "cli/recording/json.hpp"
#include "cli/recording/raw_capture.hpp"
#include "tests/cli/recording/scratch.hpp"

namespace hemi::cli::testing {

/// What a run of the program left.
struct Outcome {
  int code = -1;  ///< exit code, or minus the signal that ended it
  std::string out;
  std::string err;
  recording::Json json() const;  ///< of `out`; a failed expectation where it does not parse
};

using Arguments = std::vector<std::string>;

/// Runs build/hemi in a directory of its own, whose files a test names without a path.
class ProgramTest : public recording::testing::ScratchTest {
 protected:
  /// To its end; five minutes at most, which sanitizers need.
  Outcome hemi(const Arguments& arguments) const;
  /// SIGINT `delay_ms` after the start.
  Outcome hemi_interrupted(const Arguments& arguments, int delay_ms) const;
  /// Exit code 0.
  Outcome good(const Arguments& arguments) const;
  /// Exit code 2, nothing on stdout, one line on stderr that holds all the parts and a remedy, and the same
  /// files as before.
  void expect_bad(const Arguments& arguments, std::initializer_list<std::string_view> parts) const;

  /// tone.raw.csv: 100 kS/s, 16 bit, 4425 Hz, 0.8 of full scale, 0.5 LSB of noise, a hundredth of it in y.
  void write_tone(std::size_t pairs) const;
  /// hrg.model.json: the paper's f(T), some drift terms.
  void write_model() const;
  /// chamber.csv: 10 Hz, a slow ramp of the frequency, drift and noise; `skip_from` .. `skip_to` left out.
  void write_telemetry(std::size_t rows, std::size_t skip_from = 0, std::size_t skip_to = 0) const;

 private:
  Outcome start(const Arguments& arguments, int interrupt_after_ms) const;
};

/// Noisy tone: frequency over sampling rate, LSB.
recording::RawCapture tone(std::size_t pairs, double sample_rate_hz, double frequency_hz);

/// The model of write_model() with a part replaced or added.
std::string model_text(std::string_view key, std::string_view value);

/// A real struck bell where there is one, else empty: Debian's sonic-pi-samples or the shared recordings.
std::string bell();

}  // namespace hemi::cli::testing

#endif  // HEMI_TESTS_CLI_PROGRAM_PROGRAM_HPP

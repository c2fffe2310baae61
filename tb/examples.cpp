// SPDX-License-Identifier: Apache-2.0
// hemi_examples: writes recordings that the program can be tried on.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>
#include <string>

#include "cli/recording/error.hpp"
#include "cli/recording/interrupt.hpp"
#include "cli/recording/write.hpp"
#include "tb/example_data.hpp"

namespace {

using hemi::examples::CaptureOptions;
using hemi::examples::ChamberProfile;

constexpr int exit_bad_input = 2;

void add_capture(CLI::App& app, CaptureOptions& options, std::string& output) {
  auto* command = app.add_subcommand("capture", "A ringing resonator as raw ADC samples (NAME.raw.csv, .h5)");
  command->add_option("--instrument", options.wide, "reference (16 bit, 100 kS/s) or wide (18 bit, 250 kS/s)")
      ->transform(CLI::Transformer(std::map<std::string, bool>{{"reference", false}, {"wide", true}}))
      ->default_str("reference");
  command->add_option("--seconds", options.seconds, "length [s]")
      ->check(CLI::Range(0.01, 600.0))
      ->capture_default_str();
  command->add_option("--seed", options.seed, "of noise and gaps")->capture_default_str();
  command->add_option("--noise-lsb", options.noise_lsb, "white noise of each pickoff, rms [LSB]")
      ->check(CLI::Range(0.0, 1e5))
      ->capture_default_str();
  command->add_option("--offset-hz", options.offset_hz, "frequency at the start less 4425 Hz")
      ->check(CLI::Range(-1000.0, 1000.0))
      ->capture_default_str();
  command->add_option("--drift-hz-per-s", options.drift_hz_per_s, "drift of the frequency")
      ->check(CLI::Range(-10.0, 10.0))
      ->capture_default_str();
  command->add_option("--damping-s", options.damping_s, "time constant of a ring-down [s]; default: none")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--gaps-per-s", options.gaps_per_s,
                   "mean number of places a second where samples are lost")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
  command->add_option("-o,--output", output, "file to write: .raw.csv, or .h5 for HDF5")->required();
  command->footer("Example: hemi_examples capture --seconds 6 --noise-lsb 3 --gaps-per-s 2 -o noisy.raw.csv");
}

void add_chamber(CLI::App& app, ChamberProfile& profile, std::uint64_t& seed, std::string& output) {
  auto* command = app.add_subcommand("chamber", "Five hours in a temperature chamber as telemetry (1 Hz)");
  command
      ->add_option("--profile", profile,
                   "cool: 23 to -20 degC; cycle: 23 to -10 degC and back; warm: -20 to 40 degC")
      ->transform(CLI::Transformer(std::map<std::string, ChamberProfile>{
          {"cool", ChamberProfile::cool}, {"cycle", ChamberProfile::cycle}, {"warm", ChamberProfile::warm}}))
      ->required();
  command->add_option("--seed", seed, "of the noise")->capture_default_str();
  command->add_option("-o,--output", output, "file to write: .csv, or .h5 for HDF5")->required();
  command->footer("Example: hemi_examples chamber --profile cool -o chamber.csv");
}

}  // namespace

int main(int argc, char** argv) {
  using namespace hemi;
  CLI::App app{"hemi_examples: recordings to try hemi on"};
  app.require_subcommand(1);
  CaptureOptions capture;
  ChamberProfile profile{};
  std::uint64_t seed = 1;
  std::string output;
  add_capture(app, capture, output);
  add_chamber(app, profile, seed, output);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : exit_bad_input;
  }
  recording::install_interrupt_handler();
  try {
    if (app.got_subcommand("capture"))
      recording::write_file(output, examples::make_capture(capture));
    else
      recording::write_file(output, examples::make_chamber_run(profile, seed));
  } catch (const recording::Interrupted&) {
    fmt::print(stderr, "hemi_examples: interrupted; nothing half-written is left\n");
    return recording::kInterruptedExitCode;
  } catch (const std::exception& error) {
    fmt::print(stderr, "hemi_examples: {}\n", error.what());
    return exit_bad_input;
  }
  return 0;
}

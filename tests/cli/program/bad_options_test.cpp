// SPDX-License-Identifier: Apache-2.0
#include "tests/cli/program/program.hpp"

namespace hemi::cli::testing {
namespace {

class BadOptions : public ProgramTest {
 protected:
  void SetUp() override {
    write_model();
    write_telemetry(200);
    write_tone(2000);
  }
  void expect_bad_run(const Arguments& options, std::initializer_list<std::string_view> parts) const {
    Arguments arguments = {"run", "tone.raw.csv", "-o", "o.csv"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    expect_bad(arguments, parts);
  }
};

TEST_F(BadOptions, Commands) {
  expect_bad({}, {"subcommand is required", "--help"});
  expect_bad({"invent"}, {"no command 'invent'", "--help"});
  expect_bad({"run"}, {"recording is required", "hemi run --help"});
  expect_bad({"calibrate"}, {"inputs", "hemi calibrate --help"});
  expect_bad({"allan"}, {"recording is required", "hemi allan --help"});
  for (const char* command : {"run", "compare", "calibrate", "allan", "info", "bench"})
    expect_bad({command, "--bogus"}, {"--help"});
  expect_bad({"info", "--bogus"}, {"--bogus", "hemi info --help"});
}

TEST_F(BadOptions, NumbersThatAreNone) {
  for (const char* value : {"-5", "0", "nan", "inf", "abc", ""}) {
    expect_bad_run({"-f", value}, {"--frequency"});
    expect_bad_run({"-f", "4425", "--adc-rate", value}, {"--adc-rate"});
    expect_bad_run({"-f", "4425", "--window", value}, {"--window"});
    expect_bad({"compare", "tone.raw.csv", "-f", value}, {"--frequency"});
    expect_bad({"compare", "tone.raw.csv", "-f", "4425", "--adc-rate", value}, {"--adc-rate"});
    expect_bad({"calibrate", "chamber.csv", "--base", "hrg.model.json", "--window", value}, {"--window"});
    expect_bad({"calibrate", "chamber.csv", "--base", "hrg.model.json", "--reference-hz", value},
               {"--reference-hz"});
    expect_bad({"allan", "chamber.csv", "--average", value}, {"--average"});
    expect_bad({"bench", "--seconds", value}, {"--seconds"});
  }
  for (const char* value : {"-0.1", "1", "nan", "abc"}) {
    expect_bad({"compare", "tone.raw.csv", "-f", "4425", "--gaps", value}, {"--gaps"});
    expect_bad({"compare", "tone.raw.csv", "-f", "4425", "--back-pressure", value}, {"--back-pressure"});
  }
  for (const char* value : {"nan", "-300", "1e300"})
    expect_bad({"calibrate", "chamber.csv", "--reference-degc", value}, {"--reference-degc"});
  for (const char* value : {"0", "9", "3.5", "x"})
    expect_bad({"calibrate", "chamber.csv", "--order", value}, {"--order"});
}

TEST_F(BadOptions, StretchesThatHoldNothing) {
  expect_bad_run({"-f", "4425", "--from", "2", "--to", "1"}, {"from 2 s to 1 s", "--from below --to"});
  expect_bad_run({"-f", "4425", "--from", "nan"}, {"--from below --to"});
  expect_bad_run({"-f", "4425", "--to", "nan"}, {"--from below --to"});
  const Arguments calibrate = {"calibrate", "chamber.csv", "--base", "hrg.model.json",
                               "--from",    "2",           "--to",   "1"};
  expect_bad(calibrate, {"--from below --to"});
  expect_bad({"calibrate", "chamber.csv", "--base", "hrg.model.json", "--from", "1e6"},
             {"chamber.csv", "0 usable rows"});
}

// 16 blocks of 2^k outputs, k to 12; "about" reaches to the middle, by ratio, between two windows. The
// shortest has a gain below 1: 6 * 2^4 / (4080 * 4^k * period * 0.125) is 37.6 / 4^k at 200 Hz and 1.88 / 4^k
// at 10 Hz.
TEST_F(BadOptions, WindowOfTheDerivative) {
  expect_bad_run({"-f", "4425", "--window", "0.4"}, {"0.4 s", "0.64 s to 327.68 s"});
  expect_bad_run({"-f", "4425", "--window", "500"}, {"500 s", "0.64 s to 327.68 s"});
  expect_bad({"run", "chamber.csv", "-m", "hrg.model.json", "--window", "2"}, {"3.2 s to 6553.6 s"});
  good({"run", "tone.raw.csv", "-f", "4425", "--window", "0.5"});
  good({"run", "tone.raw.csv", "-f", "4425", "--window", "450"});
  const auto summary =
      good({"run", "chamber.csv", "-m", "hrg.model.json", "--window", "2.4", "--json"}).json();
  EXPECT_DOUBLE_EQ(summary["derivative_window_s"].get<double>(), 3.2);
}

TEST_F(BadOptions, Engines) {
  expect_bad_run({"-f", "4425", "-e", "vhdl"}, {"no engine 'vhdl'", "ideal, golden, hls, rtl, systemc"});
  expect_bad({"compare", "tone.raw.csv", "-f", "4425", "-e", "golden,vhdl"}, {"no engine 'vhdl'"});
  expect_bad({"compare", "tone.raw.csv", "-f", "4425", "-e", "golden"},
             {"one engine", "--engines golden,hls"});
  expect_bad({"compare", "tone.raw.csv", "-f", "4425", "-e", "ideal,ideal"}, {"ideal is named twice"});
  expect_bad({"bench", "-e", "vhdl"}, {"--engines", "vhdl"});
}

TEST_F(BadOptions, AllanChannelAndAverage) {
  expect_bad({"allan", "chamber.csv", "-c", "rate"}, {"chamber.csv: rate: no such channel"});
  expect_bad({"allan", "chamber.csv", "-c", "drive_v"}, {"chamber.csv: drive_v: no such channel"});
  expect_bad({"allan", "chamber.csv", "--average", "0.01"}, {"chamber.csv", "0.01", "--average"});
}

// With a reference that far off, every power of f is the same column.
TEST_F(BadOptions, ReferenceFarFromTheData) {
  write_telemetry(3000);
  expect_bad(
      {"calibrate", "chamber.csv", "--base", "hrg.model.json", "--reference-hz", "1e9", "-o", "o.model.json"},
      {"1e+09 Hz"});
}

TEST_F(BadOptions, WavesNeedTheRtlEngineAndADirectory) {
  const Arguments compare = {"compare", "tone.raw.csv", "-f", "4425", "--waves"};
  const auto with = [&](std::initializer_list<const char*> more) {
    Arguments arguments = compare;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  expect_bad(with({"no/such/a.fst"}), {"no/such/a.fst", "directory"});
  expect_bad(with({"."}), {"cannot be written"});
  expect_bad(with({"a.fst", "-e", "golden,hls"}), {"--waves", "add rtl"});
  expect_bad(with({"tone.raw.csv"}), {"would replace tone.raw.csv"});
  good(with({"a.fst", "-e", "golden,rtl"}));
  EXPECT_GT(content("a.fst").size(), 1000U);
}

}  // namespace
}  // namespace hemi::cli::testing

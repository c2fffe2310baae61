// SPDX-License-Identifier: Apache-2.0
// Outputs appear whole or not at all, and never in the place of an input.
#include <algorithm>
#include <filesystem>

#include "cli/recording/write.hpp"
#include "tests/cli/program/program.hpp"

namespace hemi::cli::testing {
namespace {

class Output : public ProgramTest {
 protected:
  void SetUp() override {
    write_model();
    write_telemetry(3000);
    write_tone(20000);
  }
};

TEST_F(Output, PlacesThatCannotBeWritten) {
  for (const char* place : {"no/such/o.csv", "no/such/o.h5", "no/such/o.mat", ".", "/dev/full"}) {
    expect_bad({"run", "tone.raw.csv", "-f", "4425", "-o", place}, {place});
    expect_bad({"run", "chamber.csv", "-m", "hrg.model.json", "-o", place}, {place});
    expect_bad({"calibrate", "chamber.csv", "--base", "hrg.model.json", "-o", place}, {place});
  }
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST_F(Output, FailureLeavesTheFormerFileAlone) {
  file("o.csv", "kept");
  expect_bad({"run", "tone.raw.csv", "-f", "4", "-o", "o.csv"}, {"0.005"});
  EXPECT_EQ(content("o.csv"), "kept");
}

TEST_F(Output, InputsAreNotReplaced) {
  const auto tone_before = content("tone.raw.csv"), chamber_before = content("chamber.csv");
  const auto model_before = content("hrg.model.json");
  expect_bad({"run", "tone.raw.csv", "-f", "4425", "-o", "tone.raw.csv"}, {"would replace tone.raw.csv"});
  expect_bad({"run", "chamber.csv", "-m", "hrg.model.json", "-o", "./chamber.csv"},
             {"would replace chamber.csv"});
  expect_bad({"run", "chamber.csv", "-m", "hrg.model.json", "-o", "hrg.model.csv"},
             {"would replace hrg.model.json"});
  expect_bad({"calibrate", "chamber.csv", "--base", "hrg.model.json", "-o", "chamber.csv"},
             {"would replace chamber.csv"});
  expect_bad({"run", "tone.raw.csv", "-f", "4425", "-o", "o.json"}, {"o.json", ".csv, .h5 or .mat"});
  EXPECT_EQ(content("tone.raw.csv"), tone_before);
  EXPECT_EQ(content("chamber.csv"), chamber_before);
  EXPECT_EQ(content("hrg.model.json"), model_before);
}

// tone.json speaks of tone.raw.csv (its ADC rate) and, once it is there, of tone.csv.
TEST_F(Output, SharedSidecarKeepsTheInputsKeys) {
  for (int round = 0; round < 2; ++round) good({"run", "tone.raw.csv", "-f", "4425", "-o", "tone.csv"});
  const auto sidecar = recording::Json::parse(content("tone.json"));
  EXPECT_EQ(sidecar["raw"]["sample_rate_hz"], 100000.0);
  EXPECT_EQ(sidecar["sample_rate_hz"], 200.0);
  EXPECT_EQ(sidecar["engine"], "hls");
  file("tone.json", R"({"sample_rate_hz": 10, "raw": {"sample_rate_hz": 100000, "full_scale_lsb": 32768}})");
  expect_bad({"run", "tone.raw.csv", "-f", "4425", "-o", "tone.csv"},
             {"tone.json: sample_rate_hz", "200 Hz"});
}

TEST_F(Output, StandardOutputOnAFullDisk) {
  const std::string program = HEMI_PROGRAM;
  for (const char* command : {" info", " info --json"}) {
    const int status = std::system((program + command + " > /dev/full 2> " + path("err")).c_str());
    EXPECT_EQ(WEXITSTATUS(status), 2);
    EXPECT_EQ(content("err"), "hemi: standard output: No space left on device; free some space\n");
  }
}

TEST_F(Output, Hdf5AndMatlabHoldTheValuesOfTheCsv) {
  const auto compare = [&](Arguments arguments, const char* other) {
    arguments.insert(arguments.end(), {"-o", "o.csv"});
    good(arguments);
    arguments.back() = other;
    good(arguments);
    const auto csv = recording::read_recording(path("o.csv")), one = recording::read_recording(path(other));
    ASSERT_EQ(csv.channels.size(), one.channels.size());
    EXPECT_GT(csv.rows(), 30U);
    for (std::size_t i = 0; i < csv.channels.size(); ++i) {
      EXPECT_EQ(csv.channels[i].name, one.channels[i].name);
      EXPECT_EQ(csv.channels[i].unit, one.channels[i].unit);
      EXPECT_TRUE(recording::testing::same_values(csv.channels[i].values, one.channels[i].values))
          << csv.channels[i].name;
    }
    EXPECT_EQ(csv.sidecar["engine"], one.sidecar["engine"]);
  };
  for (const char* other : {"o.h5", "o.mat"}) {
    compare({"run", "tone.raw.csv", "-f", "4425", "-m", "hrg.model.json"}, other);
    compare({"run", "chamber.csv", "-m", "hrg.model.json"}, other);
  }
}

// The same in all three formats: the file says so, and is neither compensated nor calibrated nor scored
// again.
TEST_F(Output, CompensatedOnceOnly) {
  for (const char* output : {"o.csv", "o.h5", "o.mat"}) {
    good({"run", "chamber.csv", "-m", "hrg.model.json", "-o", output});
    const auto sidecar = recording::read_recording(path(output)).sidecar;
    EXPECT_EQ(sidecar["compensated"], true);
    EXPECT_EQ(sidecar["model"], "hrg.model.json");
    const auto refused = [&](const Arguments& arguments, const char* doing) {
      expect_bad(arguments, {output, "compensated already (with hrg.model.json)", doing,
                             "give what it was made from: chamber.csv"});
    };
    refused({"run", output, "-m", "hrg.model.json", "-o", "p.csv"}, "compensating it again");
    refused({"calibrate", output, "--base", "hrg.model.json", "-o", "n.model.json"}, "calibrating it again");
    refused({"calibrate", "chamber.csv", "--base", "hrg.model.json", "--heldout", output},
            "scoring it again");
    good({"allan", output, "-c", "compensated_rate_dph"});
  }
}

// Where no model was given, nothing has been taken away: the recording may be calibrated.
TEST_F(Output, WithoutModelNothingIsCompensated) {
  good({"run", "tone.raw.csv", "-f", "4425", "-o", "o.mat"});
  EXPECT_EQ(recording::read_recording(path("o.mat")).sidecar["compensated"], false);
  file("foreign.json", R"({"compensated": true})");
  file("foreign.csv", content("chamber.csv"));
  expect_bad({"calibrate", "foreign.csv", "--base", "hrg.model.json"},
             {"compensated already", "the recording that it was made from"});
}

class Interrupted : public ProgramTest {
 protected:
  /// The signal comes in the middle of the work; where the machine was too fast or too slow, at another time.
  void expect_interrupted(const Arguments& arguments) const {
    SCOPED_TRACE(arguments[0]);
    const auto before = names();
    const Outcome outcome = hemi_interrupted(arguments, 1500);
    EXPECT_EQ(outcome.code, 130) << outcome.out << outcome.err;
    EXPECT_EQ(outcome.err, "hemi: interrupted; nothing half-written is left\n");
    EXPECT_EQ(names(), before);
  }
};

TEST_F(Interrupted, LeavesNothing) {
  // Two million pairs take the rtl engine more than ten seconds.
  std::string text = "adc_x\n";
  for (int i = 0; i < 2000000; ++i) text += i % 4 < 2 ? "20000\n" : "-20000\n";
  file("long.raw.csv", text);
  file("long.json", R"({"raw": {"sample_rate_hz": 100000, "full_scale_lsb": 32768}})");
  expect_interrupted({"run", "long.raw.csv", "-f", "25000", "-e", "rtl", "-o", "o.csv"});
  expect_interrupted({"compare", "long.raw.csv", "-f", "25000", "-e", "hls,rtl", "--waves", "o.fst"});
}

}  // namespace
}  // namespace hemi::cli::testing

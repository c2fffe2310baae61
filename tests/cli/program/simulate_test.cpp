// SPDX-License-Identifier: Apache-2.0
// hemi simulate and hemi effects as a user meets them: files, messages, Ctrl-C; every scenario that ships.
#include <algorithm>
#include <filesystem>

#include "cli/recording/raw_capture.hpp"
#include "tests/cli/program/program.hpp"

namespace hemi::cli::testing {
namespace {

namespace fs = std::filesystem;

class Simulate : public ProgramTest {
 protected:
  std::vector<std::string> files_in(const std::string& directory) const {
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(path(directory)))
      found.push_back(entry.path().filename());
    std::ranges::sort(found);
    return found;
  }
  /// A scenario that ships, made short by replacing each first text by the second.
  void ship(const std::string& name,
            std::initializer_list<std::pair<std::string_view, std::string_view>> changes) const {
    fs::copy_file(fs::path(HEMI_SOURCE_DIR) / "scripts/scenarios" / (name + ".toml"), path("whole.toml"),
                  fs::copy_options::overwrite_existing);
    std::string text = content("whole.toml");
    for (const auto& [from, to] : changes) {
      const auto at = text.find(from);
      ASSERT_NE(at, std::string::npos) << name << " has no " << from;
      text.replace(at, from.size(), to);
    }
    file(name + ".toml", text);
  }
};

const std::string kShort =
    "[scenario]\nduration = \"10 min\"\ntelemetry_rate_hz = 10\n[chamber]\n"
    "profile = [[0, 20], [60, 10]]\n[instrument]\ncase_time_constant_s = 10\n"
    "shell_time_constant_s = 50\n[instrument.bias]\n\"f\" = -0.6\n\"df\" = 90\n";

TEST_F(Simulate, WritesRecordingModelAndTruth) {
  file("a.toml", kShort + "[[effect]]\nid = \"duffing\"\nrelative_shift = 1e-6\n");
  const Outcome outcome = good({"simulate", "a.toml", "-o", "out", "--truth"});
  EXPECT_EQ(files_in("out"), (std::vector<std::string>{"a.csv", "a.json", "a.model.json", "a.truth.json"}));
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.out,
            "a: 600 s, 6000 rows at 10 Hz, 1 effects; wrote out/a.csv, out/a.json, out/a.model.json, "
            "out/a.truth.json\n");
  const auto recording = recording::read_recording(path("out/a.csv"));
  EXPECT_EQ(recording.rows(), 6000U);
  EXPECT_TRUE(recording.gaps.empty());
  const auto truth = recording::Json::parse(content("out/a.truth.json"));
  EXPECT_EQ(truth["effects"][0]["id"], "duffing");
  EXPECT_EQ(truth["effects"][0]["parameters"]["relative_shift"], 1e-6);
  EXPECT_FALSE(recording::Json::parse(content("out/a.model.json")).contains("effects"));
}

// What is written is read by the other commands, and the nominal model compensates what the instrument
// drifts.
TEST_F(Simulate, OtherCommandsTakeTheFiles) {
  file("a.toml", kShort);
  good({"simulate", "a.toml", "-o", "."});
  const auto run = good({"run", "a.csv", "-m", "a.model.json", "--json"}).json();
  EXPECT_EQ(run["rows"], 6000);
  EXPECT_LT(run["compensated_deviation_dph"].get<double>(), run["rate_deviation_dph"].get<double>());
  good({"calibrate", "a.csv", "--base", "a.model.json", "-o", "b.model.json"});
  good({"allan", "a.csv"});
}

TEST_F(Simulate, SameSeedSameFiles) {
  file("a.toml", kShort);
  for (const char* directory : {"one", "two"}) good({"simulate", "a.toml", "-o", directory});
  good({"simulate", "a.toml", "-o", "three", "--seed", "9"});
  EXPECT_EQ(content("one/a.csv"), content("two/a.csv"));
  EXPECT_EQ(content("one/a.model.json"), content("two/a.model.json"));
  EXPECT_NE(content("one/a.csv"), content("three/a.csv"));
}

TEST_F(Simulate, Hdf5AndMatlabHoldTheValuesOfTheCsv) {
  file("a.toml", kShort);
  good({"simulate", "a.toml"});
  good({"simulate", "a.toml", "--hdf5", "-o", "h"});
  good({"simulate", "a.toml", "--matlab", "-o", "m"});
  EXPECT_EQ(files_in("h"), (std::vector<std::string>{"a.h5", "a.model.json"}));
  EXPECT_EQ(files_in("m"), (std::vector<std::string>{"a.mat", "a.model.json"}));
  const auto csv = recording::read_recording(path("a.csv"));
  for (const char* name : {"h/a.h5", "m/a.mat"}) {
    const auto other = recording::read_recording(path(name));
    ASSERT_EQ(csv.channels.size(), other.channels.size());
    for (const auto& channel : csv.channels)
      EXPECT_TRUE(recording::testing::same_values(channel.values, other.find(channel.name)->values))
          << channel.name;
  }
  expect_bad({"simulate", "a.toml", "--hdf5", "--matlab"}, {"--hdf5", "--matlab"});
}

TEST_F(Simulate, BadInputs) {
  file("a.toml", "[scenario]\nduration = \"5 kg\"\n");
  expect_bad({"simulate", "a.toml", "-o", "out"}, {"a.toml:2: scenario.duration", "'kg'"});
  file("b.toml", "[scenario]\nduration = 10\n[instrument]\nqualityfactor = 1\n");
  expect_bad({"simulate", "b.toml", "-o", "out"}, {"b.toml:4: instrument", "did you mean 'quality_factor'"});
  expect_bad({"simulate", "none.toml"}, {"none.toml: No such file", "room_to_minus_20"});
  file("c.toml", "[scenario]\nduration = 10\n");
  file("plain", "x");
  expect_bad({"simulate", "c.toml", "-o", "plain"}, {"plain", "no directory"});
  expect_bad({"simulate", "c.toml", "-o", "no/such"}, {"no/such", "directory above"});
  file("m.model.json", model_text("device", "\"a\""));
  file("m.toml", "[scenario]\nduration = 10\n[instrument]\nmodel = \"m.model.json\"\n");
  expect_bad({"simulate", "m.toml"}, {"would replace", "m.model.json"});
}

TEST_F(Simulate, Interrupted) {
  file("a.toml", "[scenario]\nduration = \"1000000 s\"\ntelemetry_rate_hz = 10\n");
  const auto before = names();
  const Outcome outcome = hemi_interrupted({"simulate", "a.toml", "-o", "out"}, 500);
  EXPECT_EQ(outcome.code, 130) << outcome.out << outcome.err;
  EXPECT_EQ(outcome.err, "hemi: interrupted; nothing half-written is left\n");
  const auto after = names();
  for (const auto& name : after) EXPECT_EQ(name.find(".partial"), std::string::npos) << name;
}

// By name, with or without its ending, from any directory; a file of that name goes before it, a directory
// does not.
TEST_F(Simulate, ShippedScenariosByName) {
  fs::create_directory(path("constant"));
  for (const std::string name : {"constant", "constant.toml"}) {
    const auto json = good({"simulate", name, "-o", "out", "--json"}).json();
    EXPECT_EQ(json["name"], "constant");
    EXPECT_EQ(json["rows"], 18000);
  }
  file("constant.toml", "[scenario]\nduration = \"20 min\"\n");
  EXPECT_EQ(good({"simulate", "constant.toml", "-o", "out", "--json"}).json()["rows"], 1200);
  expect_bad({"simulate", "elsewhere/constant"}, {"elsewhere/constant: No such file"});
}

TEST_F(Simulate, ShippedScenarios) {
  ship("paper_soaks", {{R"(period = "5 h", ramp = 1.0)", R"(period = "2 min", ramp = 60)"}});
  ship("room_to_minus_20", {{R"(duration = "5 h")", R"(duration = "15 min")"}});
  ship("cycles", {{R"(hold = "2 h", ramp = 0.5)", R"(hold = "2 min", ramp = 60)"}});
  ship("hysteresis", {{R"(hold = "2 h", ramp = 0.5)", R"(hold = "2 min", ramp = 60)"}});
  ship("rate_table", {{R"(hold = "60 s")", R"(hold = "6 s")"}});
  ship("constant", {{R"(duration = "5 h")", R"(duration = "15 min")"}});
  for (const std::string name :
       {"paper_soaks", "room_to_minus_20", "cycles", "hysteresis", "rate_table", "constant"}) {
    good({"simulate", name + ".toml", "-o", "out"});
    const auto recording = recording::read_recording(path("out/" + name + ".csv"));
    EXPECT_GT(recording.rows(), 400U) << name;
    good({"run", "out/" + name + ".csv", "-m", "out/" + name + ".model.json"});
  }
  const auto shipped = fs::directory_iterator(HEMI_SOURCE_DIR "/scripts/scenarios");
  EXPECT_EQ(std::distance(begin(shipped), end(shipped)), 7) << "a scenario that no test runs";
}

// Start-up at a tenth of the amplitude, locked and closed within 4 s; then the rate that the scenario turns
// at.
TEST_F(Simulate, WholeInstrument) {
  ship("rate_step_full", {{R"(duration = "10 s")", R"(duration = "5 s")"},
                          {R"(from = "9.5 s", to = "10 s")", R"(from = "4.9 s", to = "5 s")"},
                          {R"([["6 s", "100 deg/s"]])", R"([["4 s", "100 deg/s"]])"}});
  good({"simulate", "rate_step_full.toml", "-o", "out"});
  EXPECT_EQ(files_in("out"),
            (std::vector<std::string>{"rate_step_full.csv", "rate_step_full.json",
                                      "rate_step_full.model.json", "rate_step_full.raw.csv"}));
  const auto recording = recording::read_recording(path("out/rate_step_full.csv"));
  EXPECT_EQ(recording.rows(), 999U);
  EXPECT_TRUE(recording.gaps.empty());
  // rate_dph is the rate before compensation, which the core's own stands beside: it may be calibrated.
  EXPECT_NE(recording.find("compensated_rate_dph"), nullptr);
  EXPECT_FALSE(recording.sidecar.contains("compensated"));
  EXPECT_EQ(recording::read_raw_capture(path("out/rate_step_full.raw.csv")).adc_x.size(), 10000U);
  // 0.4 s after a step of a loop of 40 Hz with its zero at 4 Hz, e^-10 is left of 360 000 deg/h: 16 deg/h.
  // Pickoff noise is 0.32 deg/h/rtHz at 1 Hz and rises with frequency to the loop's K / 2 pi = 36 Hz; from
  // there to 100 Hz it is flat: 0.32 x 36 sqrt(100 - 36 atan(100/36)) = 86 deg/h rms before the rate filter.
  // Drift: a few deg/h.
  const auto& rate = recording.find("rate_dph")->values;
  // The force that holds the rate goes with the amplitude, which its slower loop still settles.
  const double amplitude = recording.find("amplitude")->values[950];
  EXPECT_NEAR(rate[950], 360000.0 * amplitude, 16.0 + 4.0 * 86.0 + 5.0);
  EXPECT_NEAR(amplitude, 1.0, 1e-3);
  good({"simulate", "rate_step_full.toml", "-o", "again"});
  EXPECT_EQ(content("out/rate_step_full.csv"), content("again/rate_step_full.csv"));
  EXPECT_EQ(content("out/rate_step_full.raw.csv"), content("again/rate_step_full.raw.csv"));
}

TEST_F(Simulate, Effects) {
  const std::string list = good({"effects"}).out;
  for (const char* id : {"duffing", "thermal_hysteresis", "oscillator_temperature", "rate_random_walk"})
    EXPECT_NE(list.find(id), std::string::npos) << id;
  const std::string one = good({"effects", "thermal_hysteresis"}).out;
  for (const char* part : {"loop_height", "deg/h", "Mistaken for", "Separated by", "[[effect]]"})
    EXPECT_NE(one.find(part), std::string::npos) << part << " is not in\n" << one;
  const auto json = good({"effects", "--json"}).json();
  EXPECT_GE(json.size(), 30U);
  EXPECT_EQ(good({"effects", "duffing", "--json"}).json()["parameters"][0]["name"], "relative_shift");
  expect_bad({"effects", "dufing"}, {"'dufing'", "did you mean 'duffing'"});
}

}  // namespace
}  // namespace hemi::cli::testing

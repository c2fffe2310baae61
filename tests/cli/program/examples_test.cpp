// SPDX-License-Identifier: Apache-2.0
// What --help promises, done; and --json of every command.
#include <filesystem>
#include <regex>
#include <sstream>

#include "cli/recording/write.hpp"
#include "tests/cli/program/program.hpp"

namespace hemi::cli::testing {
namespace {

class Examples : public ProgramTest {
 protected:
  /// The files that the examples name.
  void SetUp() override {
    const auto ring = recording::testing::ring_down(60000, 16, 3621.0 / 44100.0, 1);
    recording::testing::write_sound(path("bell.wav"), 0x010002, 16, 44100, ring, {});
    write_tone(5000);
    std::filesystem::rename(path("tone.raw.csv"), path("capture.raw.csv"));
    std::filesystem::rename(path("tone.json"), path("capture.json"));
    file("capture.json", R"({"raw": {"sample_rate_hz": 100000, "full_scale_lsb": 32768}})");
    write_telemetry(2000);
    write_model();
    std::filesystem::create_directories(path("tests/data"));
    std::filesystem::copy(HEMI_SOURCE_DIR "/tests/data/paper_table1.csv",
                          path("tests/data/paper_table1.csv"));
    good({"run", "chamber.csv", "-m", "hrg.model.json", "-o", "out.csv"});
  }
  /// The lines behind "Example:" in the help of a command, as arguments.
  std::vector<Arguments> examples(const std::string& command) const {
    const std::string help = good({command, "--help"}).out;
    const auto at = help.find("Example: ");
    EXPECT_NE(at, std::string::npos) << command;
    std::istringstream lines(at == std::string::npos ? "" : help.substr(at + 9));
    std::vector<Arguments> found;
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      Arguments arguments;
      for (std::string word; words >> word;) arguments.push_back(word);
      if (arguments.empty() || arguments.front() != "hemi") continue;
      arguments.erase(arguments.begin());
      found.push_back(arguments);
    }
    EXPECT_FALSE(found.empty()) << command;
    return found;
  }
};

TEST_F(Examples, OfEveryCommandWork) {
  for (const char* command : {"run", "compare", "calibrate", "allan", "info"}) {
    for (const Arguments& arguments : examples(command)) {
      EXPECT_EQ(arguments.front(), command);
      EXPECT_NE(good(arguments).out, "");
    }
  }
}

TEST_F(Examples, OfBenchWorksInLessTime) {
  Arguments arguments = examples("bench").front();
  const auto seconds = std::find(arguments.begin(), arguments.end(), "--seconds");
  ASSERT_NE(seconds, arguments.end());
  *(seconds + 1) = "0.1";
  const std::string out = good(arguments).out;
  for (const char* engine : {"hls ", "rtl ", "sc_fixed "})
    EXPECT_NE(out.find(engine), std::string::npos) << out;
}

TEST_F(Examples, BenchPrintsTheEnginesThatAreNamed) {
  const std::string out = good({"bench", "--seconds", "0.1", "--engines", "hls,golden"}).out;
  const std::regex line(R"((hls|golden) +(\d+) sample pairs/s)");
  std::size_t lines = 0;
  for (std::sregex_iterator m(out.begin(), out.end(), line), end; m != end; ++m, ++lines)
    EXPECT_GT(std::stod((*m)[2]), 0.0);
  EXPECT_EQ(lines, 2U) << out;
}

TEST_F(Examples, HelpAndVersion) {
  for (const char* command : {"run", "compare", "calibrate", "allan", "info", "bench"})
    EXPECT_NE(good({"--help"}).out.find(command), std::string::npos);
  EXPECT_TRUE(std::regex_match(good({"--version"}).out, std::regex(R"(\d+\.\d+\.\d+\n)")));
}

TEST_F(Examples, JsonOfEveryCommand) {
  const auto bell_run = good({"run", "bell.wav", "-f", "3621", "-o", "b.csv", "--json"}).json();
  EXPECT_EQ(bell_run["output"], "b.csv");
  EXPECT_NEAR(bell_run["frequency_hz"].get<double>(), 3621.0, 0.01);
  EXPECT_EQ(good({"run", "chamber.csv", "-m", "hrg.model.json", "--json"}).json()["rows"], 2000);
  EXPECT_EQ(
      good({"compare", "capture.raw.csv", "-f", "4425", "-e", "golden,hls,ideal", "--json"}).json().size(),
      2U);
  EXPECT_EQ(
      good({"calibrate", "tests/data/paper_table1.csv", "chamber.csv", "--json"}).json()["scores"]["blocks"],
      8);
  EXPECT_EQ(good({"allan", "out.csv", "--json"}).json()["channel"], "rate_dph");
  EXPECT_EQ(good({"info", "--json"}).json()["engines"].size(), 5U);
  EXPECT_GT(good({"bench", "--seconds", "0.1", "-e", "hls", "--json"})
                .json()["engines"]["hls"]["median_pairs_per_s"]
                .get<double>(),
            0.0);
}

// The Allan deviation of an output of `run`: white noise of 0.5 deg/h falls as 1 / sqrt(m) over the first
// octaves.
TEST_F(Examples, AllanOfAnOutput) {
  file("white.model.json",
       model_text("bias", R"({"reference_hz": 4432.07, "terms_dph": {"1": 2.0, "f": -0.31}})"));
  good({"run", "chamber.csv", "-m", "white.model.json", "-o", "out.csv"});
  const auto json = good({"allan", "out.csv", "-c", "compensated_rate_dph", "--json"}).json();
  EXPECT_EQ(json["unit"], "deg/h");
  EXPECT_NEAR(json["interval_s"].get<double>(), 0.1, 1e-9);
  for (int octave = 0; octave < 3; ++octave) {
    const auto& point = json["points"][octave];
    const double expected = 0.5 / std::sqrt(std::ldexp(1.0, octave));
    // Five times the half width of the 68 % interval that the program states.
    const double sigma = 0.5 * (point["upper"].get<double>() - point["lower"].get<double>());
    EXPECT_NEAR(point["deviation"].get<double>(), expected, 5.0 * sigma) << octave;
  }
}

}  // namespace
}  // namespace hemi::cli::testing

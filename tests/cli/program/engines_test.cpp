// SPDX-License-Identifier: Apache-2.0
// The same bytes from every engine and from every kind of file.
#include <sndfile.h>

#include <cmath>

#include "cli/recording/write.hpp"
#include "tests/cli/program/program.hpp"

namespace hemi::cli::testing {
namespace {

class Engines : public ProgramTest {
 protected:
  /// Output CSVs of the four fixed-point engines; `rows` at least.
  void expect_equal_bytes(const Arguments& input, std::size_t rows) const {
    std::string first;
    for (const char* engine : {"golden", "hls", "rtl", "systemc"}) {
      Arguments arguments = input;
      arguments.insert(arguments.end(), {"-e", engine, "-o", "o.csv"});
      good(arguments);
      if (first.empty()) first = content("o.csv");
      EXPECT_EQ(content("o.csv"), first) << engine;
    }
    EXPECT_GE(recording::read_recording(path("o.csv")).rows(), rows);
    // Not a file that would be the same whatever the engine does.
    Arguments ideal = input;
    ideal.insert(ideal.end(), {"-e", "ideal", "-o", "o.csv"});
    good(ideal);
    EXPECT_NE(content("o.csv"), first);
  }
  void write_forms(const recording::RawCapture& capture) const {
    recording::write_csv(path("c.raw.csv"), capture);
    recording::write_hdf5(path("c.h5"), capture);
    recording::testing::write_sound(path("c.wav"), SF_FORMAT_WAV | SF_FORMAT_PCM_16, 16,
                                    static_cast<int>(capture.sample_rate_hz), capture.adc_x, capture.adc_y);
  }
  void expect_equal_forms(const char* frequency, const std::vector<std::string>& files) const {
    std::string first;
    for (const auto& name : files) {
      good({"run", name, "-f", frequency, "-o", "o.csv"});
      if (first.empty()) first = content("o.csv");
      EXPECT_EQ(content("o.csv"), first) << name;
    }
    EXPECT_GT(recording::read_recording(path("o.csv")).rows(), 80U);
  }
};

TEST_F(Engines, CaptureOf44100SamplesASecond) {
  recording::write_csv(path("a.raw.csv"), tone(44100, 44100.0, 3621.3));
  expect_equal_bytes({"run", "a.raw.csv", "-f", "3621"}, 88);
}

TEST_F(Engines, WideCapture) {
  recording::RawCapture capture = tone(50000, 250e3, 4425.0);
  capture.full_scale_lsb = 131072.0;
  for (auto& x : capture.adc_x) x *= 4;
  recording::write_csv(path("a.raw.csv"), capture);
  expect_equal_bytes({"run", "a.raw.csv", "-f", "4424"}, 40);
}

TEST_F(Engines, Telemetry) {
  write_model();
  write_telemetry(2000, 500, 520);
  expect_equal_bytes({"run", "chamber.csv", "-m", "hrg.model.json"}, 1980);
}

TEST_F(Engines, WavCsvAndHdf5OfATone) {
  write_forms(tone(44100, 44100.0, 3621.3));
  expect_equal_forms("3621", {"c.raw.csv", "c.h5", "c.wav"});
}

TEST_F(Engines, WavCsvAndHdf5OfABell) {
  if (bell().empty()) GTEST_SKIP() << "no bell: neither sonic-pi-samples nor shared recordings";
  write_forms(recording::read_raw_capture(bell()));
  expect_equal_forms("3621", {bell(), "c.raw.csv", "c.h5", "c.wav"});
}

TEST_F(Engines, CompareWithGapsAndBackPressure) {
  write_tone(60000);
  const Arguments compare = {"compare", "tone.raw.csv",    "-f", "4425", "--gaps",
                             "0.2",     "--back-pressure", "0.3"};
  const Outcome outcome = good(compare);
  for (const char* engine : {"hls", "rtl", "systemc"}) {
    EXPECT_NE(outcome.out.find(std::string("golden = ") + engine + ": no differing bit in 120 records"),
              std::string::npos)
        << outcome.out;
  }
}

TEST_F(Engines, CompareTelemetryAndIdeal) {
  write_model();
  write_telemetry(500);
  const auto json = good({"compare", "chamber.csv", "-m", "hrg.model.json", "--json"}).json();
  ASSERT_EQ(json.size(), 3U);
  for (const auto& pair : json) {
    EXPECT_EQ(pair["equal"], true);
    EXPECT_EQ(pair["records"], 500);
    EXPECT_EQ(pair["words"], 500 * 7) << "seven blocks' words a record behind the tracker";
  }
  const auto ideal =
      good({"compare", "chamber.csv", "-m", "hrg.model.json", "-e", "ideal,hls", "--json"}).json();
  ASSERT_EQ(ideal.size(), 1U);
  // Half a step of the frequency word, 2^-29 Hz, is all that rounding can do there; and it does something.
  const double largest_hz = ideal[0]["differences"]["frequency"]["largest"];
  EXPECT_GT(largest_hz, 0.0);
  EXPECT_LE(largest_hz, std::ldexp(0.5, -29) * 1.001);
}

}  // namespace
}  // namespace hemi::cli::testing

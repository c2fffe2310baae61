// SPDX-License-Identifier: Apache-2.0
// Samples that are missing are told on stderr, flagged in the status, and survived.
#include <cmath>

#include "cli/recording/write.hpp"
#include "hls/config.hpp"
#include "tests/cli/program/program.hpp"

namespace hemi::cli::testing {
namespace {

using Gaps = ProgramTest;

bool live(double status, config::StatusBit bit) {
  return ((static_cast<std::uint64_t>(status) >> bit) & 1) != 0;
}
bool sticky(double status, config::StatusBit bit) {
  return ((static_cast<std::uint64_t>(status) >> (bit + config::status_shift)) & 1) != 0;
}

TEST_F(Gaps, InACapture) {
  recording::RawCapture capture = tone(60000, 100e3, 4425.0);
  // 113 samples are lost after number 30000, which falls into output 60.
  capture.adc_x.erase(capture.adc_x.begin() + 30000, capture.adc_x.begin() + 30113);
  capture.adc_y.erase(capture.adc_y.begin() + 30000, capture.adc_y.begin() + 30113);
  const double before_s = 29999e-5, after_s = 30113e-5;
  capture.gaps = {{before_s, after_s, 29999, 113}};
  recording::write_csv(path("tone.raw.csv"), capture);
  std::string first;
  for (const char* engine : {"golden", "hls", "rtl", "systemc"}) {
    const Outcome outcome = good({"run", "tone.raw.csv", "-f", "4425", "-e", engine, "-o", "o.csv"});
    EXPECT_NE(outcome.err.find("1 gap(s), 113 samples missing"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("gap of 113 samples between 0.29999 s and 0.30113 s"), std::string::npos);
    if (first.empty()) first = content("o.csv");
    EXPECT_EQ(content("o.csv"), first) << engine;
  }
  const auto out = recording::read_recording(path("o.csv"));
  const auto& status = out.find("status")->values;
  const auto& frequency_hz = out.find("frequency_hz")->values;
  ASSERT_EQ(status.size(), (60000U - 113U) / 500U);
  for (std::size_t i = 0; i < status.size(); ++i) {
    EXPECT_EQ(live(status[i], config::status_sample_gap), i == 60) << i;
    EXPECT_EQ(sticky(status[i], config::status_sample_gap), i >= 60) << i;
  }
  // Relocked at the end: 0.25 s later, the loop's 10 Hz leaves exp(-2 pi 10 / 2.48 * 0.25), 2e-3 of a jump by
  // less than a turn; the ADC's noise is far below.
  EXPECT_FALSE(live(status.back(), config::status_unlocked));
  EXPECT_NEAR(frequency_hz.back(), 4425.0, 1e-2);
}

TEST_F(Gaps, ManyInACaptureAreSummarised) {
  recording::RawCapture capture = tone(10000, 100e3, 4425.0);
  for (std::size_t i = 1; i <= 20; ++i) capture.gaps.push_back({0.0, 0.0, 400 * i, 1});
  recording::write_csv(path("tone.raw.csv"), capture);
  const Outcome outcome = good({"run", "tone.raw.csv", "-f", "4425"});
  EXPECT_NE(outcome.err.find("20 gap(s), 20 samples missing"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("and 15 more gaps"), std::string::npos) << outcome.err;
}

TEST_F(Gaps, InTelemetry) {
  write_model();
  write_telemetry(1500, 700, 730);
  for (const char* command : {"run", "compare"}) {
    const Outcome outcome = good({command, "chamber.csv", "-m", "hrg.model.json"});
    EXPECT_NE(outcome.err.find("1 gap(s), 30 samples missing"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("gap of 30 samples between 69.9 s and 73 s"), std::string::npos);
  }
  good({"run", "chamber.csv", "-m", "hrg.model.json", "-o", "o.csv"});
  const auto out = recording::read_recording(path("o.csv"));
  const auto& status = out.find("status")->values;
  const auto& slope = out.find("dfdt_hz_per_s")->values;
  ASSERT_EQ(status.size(), 1470U);
  // 16 blocks of 16 rows make the window of 25.6 s; the row after the gap is not used and the filter
  // restarts.
  constexpr std::size_t window = 256, gap = 700;
  for (std::size_t i = 0; i < status.size(); ++i) {
    const bool full = (i + 1 >= window && i < gap) || i >= gap + window;
    EXPECT_EQ(live(status[i], config::status_derivative_invalid), !full) << i;
    EXPECT_EQ(slope[i] == 0.0, !full) << i;
    EXPECT_EQ(live(status[i], config::status_frequency_invalid), i == gap) << i;
  }
}

TEST_F(Gaps, MissingCellsInTelemetry) {
  write_model();
  std::string text = "time_s,frequency_hz,rate_dph\n";
  for (int i = 0; i < 100; ++i)
    text += i == 40 ? "40,,1\n" : i == 60 ? "60,4430,\n" : std::to_string(i) + ",4430,1\n";
  file("a.csv", text);
  good({"run", "a.csv", "-m", "hrg.model.json", "-o", "o.csv"});
  good({"compare", "a.csv", "-m", "hrg.model.json"});
  const auto out = recording::read_recording(path("o.csv"));
  ASSERT_EQ(out.rows(), 100U);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(live(out.find("status")->values[i], config::status_frequency_invalid), i == 40) << i;
    EXPECT_EQ(std::isnan(out.find("rate_dph")->values[i]), i == 60) << i;
    EXPECT_EQ(std::isnan(out.find("compensated_rate_dph")->values[i]), i == 60) << i;
  }
}

// 2000 rows, 300 of them missing, and one value: all others enter, none across a gap.
TEST_F(Gaps, InAnAllanDeviation) {
  write_telemetry(2000, 700, 1000);
  auto telemetry = recording::read_recording(path("chamber.csv"));
  for (auto& channel : telemetry.channels)
    if (channel.name == "rate_dph") channel.values[1200] = std::nan("");
  recording::write_file(path("holes.csv"), telemetry);
  const auto json = good({"allan", "holes.csv", "--json"}).json();
  EXPECT_EQ(json["samples"], 1699);
  EXPECT_EQ(json["stretches"], 3);
  EXPECT_EQ(json["points"][0]["pairs"], 1699 - 3);
  // 700 and 500 and 499 rows: twice 256 fit into the first alone.
  EXPECT_EQ(json["points"].back()["pairs"], 700 - 2 * 256 + 1);
  EXPECT_EQ(json["rate_random_walk"], nullptr);
  const std::string text = good({"allan", "holes.csv", "--separate", "--report", "a.html"}).out;
  EXPECT_NE(text.find("separate Allan deviation of rate_dph [deg/h], 1699 of 1700 samples"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("in 3 stretches"), std::string::npos);
  EXPECT_NE(text.find("rate random walk: no stretch of slope +1/2 over a decade, so none is given"),
            std::string::npos);
  EXPECT_NE(content("a.html").find("1699"), std::string::npos);
}

}  // namespace
}  // namespace hemi::cli::testing

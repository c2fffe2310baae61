// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "tests/cli/recording/scratch.hpp"

namespace hemi::recording::testing {
namespace {

using Gaps = ScratchTest;

std::string rows_at(const std::vector<double>& times) {
  std::string text = "time_s,rate_dph\n";
  for (const double time : times) text += fmt::format("{},1\n", time);
  return text;
}

TEST_F(Gaps, CountedAndSurvived) {
  // 10 Hz; 3 samples missing after row 2, 1 after row 4.
  const Recording recording =
      read_recording(file("a.csv", rows_at({0.0, 0.1, 0.2, 0.6, 0.7, 0.9, 1.0, 1.1, 1.2})));
  ASSERT_EQ(recording.gaps.size(), 2U);
  EXPECT_EQ(recording.gaps[0].after_row, 2U);
  EXPECT_EQ(recording.gaps[0].missing_samples, 3U);
  EXPECT_EQ(recording.gaps[0].start_s, 0.2);
  EXPECT_EQ(recording.gaps[0].end_s, 0.6);
  EXPECT_EQ(recording.gaps[1].after_row, 4U);
  EXPECT_EQ(recording.gaps[1].missing_samples, 1U);
  // 8 steps and 4 missing samples in 1.2 s.
  EXPECT_DOUBLE_EQ(recording.sample_rate_hz, 10.0);
  ASSERT_EQ(recording.notes.size(), 1U);
  EXPECT_NE(recording.notes[0].find("2 gap(s), 4 samples missing"), std::string::npos);
}

TEST_F(Gaps, JitterIsNone) {
  const Recording recording = read_recording(file("a.csv", rows_at({0.0, 1.2, 2.0, 3.1, 4.0, 4.8, 6.0})));
  EXPECT_TRUE(recording.gaps.empty());
  EXPECT_TRUE(recording.notes.empty());
}

TEST_F(Gaps, ShortStepsAreNoted) {
  const Recording recording = read_recording(file("a.csv", rows_at({0.0, 1.0, 1.2, 2.0, 3.0, 4.0})));
  ASSERT_EQ(recording.notes.size(), 1U);
  EXPECT_NE(recording.notes[0].find("1 step(s) shorter"), std::string::npos);
}

TEST_F(Gaps, StatedRateThatDisagreesIsNoted) {
  const std::string csv = file("a.csv", rows_at({0, 1, 2, 3}));
  file("a.json", R"({"sample_rate_hz": 10})");
  const Recording recording = read_recording(csv);
  EXPECT_EQ(recording.sample_rate_hz, 10.0);
  ASSERT_EQ(recording.notes.size(), 1U);
  EXPECT_NE(recording.notes[0].find("1 Hz where sample_rate_hz states 10"), std::string::npos);
}

}  // namespace
}  // namespace hemi::recording::testing

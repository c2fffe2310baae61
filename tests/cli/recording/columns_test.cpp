// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "cli/recording/channels.hpp"
#include "tests/cli/recording/scratch.hpp"

namespace hemi::recording::testing {
namespace {

using Columns = ScratchTest;

constexpr const char* kForeign =
    "t [ms],gyro z [deg/s],T,stamp,note\n0,1,300,2024-01-01,x\n100,-2,,2024-01-02,y\n";

TEST_F(Columns, MapScaleOffsetAndIgnore) {
  const std::string csv = file("a.csv", kForeign);
  file("a.json", R"({"device": "bench", "operator": "K", "columns": {
    "t [ms]": {"name": "time_s", "scale": 0.001},
    "gyro z [deg/s]": {"channel": "rate_dph", "scale": 3600},
    "T": {"name": "case_temp_degc", "scale": 0.5, "offset": -100},
    "stamp": null, "note": null, "absent": "drive_v"}})");
  const Recording recording = read_recording(csv);
  EXPECT_EQ(recording.device, "bench");
  ASSERT_EQ(recording.channels.size(), 3U);
  EXPECT_TRUE(same_values(recording.find("time_s")->values, {0.0, 0.001 * 100.0}));
  EXPECT_TRUE(same_values(recording.find("rate_dph")->values, {3600.0, -7200.0}));
  EXPECT_TRUE(same_values(recording.find("case_temp_degc")->values,
                          {0.5 * 300.0 - 100.0, std::numeric_limits<double>::quiet_NaN()}));
  EXPECT_EQ(recording.find("rate_dph")->unit, "deg/h");
  // 0.1 s a step; nothing states the rate.
  EXPECT_DOUBLE_EQ(recording.sample_rate_hz, 10.0);
  // Applied once: writing the recording again must not apply it twice. Unknown keys stay.
  EXPECT_FALSE(recording.sidecar.contains("columns"));
  EXPECT_EQ(recording.sidecar["operator"], "K");
  ASSERT_EQ(recording.notes.size(), 1U);
  EXPECT_NE(recording.notes[0].find("columns.absent"), std::string::npos);
}

TEST_F(Columns, ShortFormAndAbsentChannels) {
  const std::string csv = file("a.csv", "sec,z\n0,1\n1,2\n");
  file("a.json", R"({"columns": {"sec": "time_s", "z": "rate_dph"}})");
  const Recording recording = read_recording(csv);
  EXPECT_TRUE(same_values(recording.require("rate_dph", "the test"), {1.0, 2.0}));
  EXPECT_TRUE(same_values(recording.or_zero("rate_in_dph"), {0.0, 0.0}));
  EXPECT_EQ(recording.find("rate_in_dph"), nullptr);
}

TEST_F(Columns, BadMappings) {
  const std::string csv = file("a.csv", "time_s,z\n0,1\n1,2\n");
  const auto read = [&] { read_recording(csv); };
  file("a.json", R"({"columns": {"z": "rate_dps"}})");
  expect_input_error(read, {"a.json: columns.z", "no channel 'rate_dps'", "'rate_dph'"});
  file("a.json", R"({"columns": {"z": 7}})");
  expect_input_error(read, {"a.json: columns.z", "expected a channel name"});
  file("a.json", R"({"columns": {"z": {"name": "rate_dph", "scale": "3600"}}})");
  expect_input_error(read, {"a.json: columns.z.scale", "expected a number"});
  file("a.json", R"({"columns": {"z": {"name": "rate_dph", "scale": 0}}})");
  expect_input_error(read, {"a.json: columns.z", "scale of 0"});
  file("a.json", R"({"columns": {"z": "time_s"}})");
  expect_input_error(read, {"a.csv:1: time_s", "two columns"});
  file("a.json", R"({"columns": {"z": null, "time_s": null}})");
  expect_input_error(read, {"a.csv:1", "no column is left"});
}

TEST_F(Columns, RightUnitInTheHeader) {
  const Recording recording =
      read_recording(file("a.csv", "time_s [s],rate_dph (°/h),case_temp_degc [C]\n0,1,2\n1,2,3\n"));
  EXPECT_EQ(recording.channels.size(), 3U);
  EXPECT_NE(recording.find("case_temp_degc"), nullptr);
}

TEST_F(Columns, TimeFromTheStatedRate) {
  const std::string csv = file("a.csv", "rate_dph\n1\n\n3\n");
  file("a.json", R"({"sample_rate_hz": 4})");
  const Recording recording = read_recording(csv);
  EXPECT_TRUE(recording.time_from_rate);
  EXPECT_TRUE(same_values(recording.channels[0].values, {0.0, 0.25, 0.5}));
  // In a file of one column an empty line is an empty cell.
  EXPECT_TRUE(
      same_values(recording.channels[1].values, {1.0, std::numeric_limits<double>::quiet_NaN(), 3.0}));
}

TEST_F(Columns, TimeComesFirstWhereverItStands) {
  const Recording recording = read_recording(file("a.csv", "rate_dph,time_s\n5,0\n6,1\n"));
  EXPECT_EQ(recording.channels[0].name, "time_s");
  EXPECT_EQ(recording.channels[1].name, "rate_dph");
}

TEST(Units, Conversions) {
  const auto check = [](const char* from, const char* to, double value, double expected) {
    const auto factor = conversion(from, to);
    ASSERT_TRUE(factor) << from;
    EXPECT_DOUBLE_EQ(factor->scale * value + factor->offset, expected) << from;
  };
  check("deg/s", "deg/h", 1.0, 3600.0);
  check("rad/s", "deg/h", 7.2921150e-5, 7.2921150e-5 * 3600.0 * 180.0 / 3.14159265358979323846);
  check("degF", "degC", 212.0, 100.0);
  check("K", "degC", 273.15, 0.0);
  check("m/s^2", "g", 9.80665, 1.0);
  check("mV", "V", 2500.0, 2.5);
  EXPECT_FALSE(conversion("V", "degC"));
  EXPECT_FALSE(conversion("MHZ", "Hz"));
}

}  // namespace
}  // namespace hemi::recording::testing

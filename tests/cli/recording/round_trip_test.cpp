// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <limits>
#include <random>

#include "cli/recording/matlab_file.hpp"
#include "cli/recording/matlab_handle.hpp"
#include "cli/recording/matlab_version.hpp"
#include "cli/recording/raw_capture.hpp"
#include "cli/recording/write.hpp"
#include "tests/cli/recording/scratch.hpp"

namespace hemi::recording::testing {
namespace {

using RoundTrip = ScratchTest;

// Doubles of every exponent, NaN and the edges of the range.
std::vector<double> hard_values(std::size_t count) {
  std::mt19937_64 random(20240229);
  std::vector<double> values = {0.0,
                                -0.0,
                                0.1,
                                1.0 / 3.0,
                                5e-324,
                                std::numeric_limits<double>::min(),
                                std::numeric_limits<double>::max(),
                                std::numeric_limits<double>::lowest(),
                                std::numeric_limits<double>::quiet_NaN(),
                                4425.123456789012};
  while (values.size() < count) {
    const double value = std::bit_cast<double>(random());
    if (std::isfinite(value)) values.push_back(value);
  }
  return values;
}

Recording hard_recording() {
  constexpr std::size_t kRows = 20000;
  Recording recording{.device = "HRG-Ä1"};
  std::vector<double> time_s(kRows);
  for (std::size_t i = 0; i < kRows; ++i) time_s[i] = static_cast<double>(i) / 200.0;
  recording.sample_rate_hz = 200.0;
  recording.channels = {{"time_s", "s", time_s}, {"rate_dph", "deg/h", hard_values(kRows)}};
  recording.channels.push_back({"drive_v", "V", std::vector<double>(kRows, std::nan(""))});
  recording.channels.back().values[7] = -2.5;
  recording.sidecar = Json{{"notes", "line one\nline \"two\""},
                           {"started", "2024-05-01T12:00:00Z"},
                           {"x-own", {{"list", {1, 2.5, nullptr}}, {"flag", true}}},
                           {"flag", true},
                           {"count", 42}};
  return recording;
}

void expect_same(const Recording& read, const Recording& written) {
  EXPECT_EQ(read.device, written.device);
  EXPECT_EQ(read.sample_rate_hz, written.sample_rate_hz);
  ASSERT_EQ(read.channels.size(), written.channels.size());
  for (std::size_t i = 0; i < read.channels.size(); ++i) {
    EXPECT_EQ(read.channels[i].name, written.channels[i].name);
    EXPECT_EQ(read.channels[i].unit, written.channels[i].unit);
    EXPECT_TRUE(same_values(read.channels[i].values, written.channels[i].values)) << read.channels[i].name;
  }
  for (const auto& [key, value] : written.sidecar.items()) EXPECT_EQ(read.sidecar[key], value) << key;
  EXPECT_TRUE(read.notes.empty());
}

TEST_F(RoundTrip, CsvIsExact) {
  const Recording written = hard_recording();
  write_csv(path("a.csv"), written);
  expect_same(read_recording(path("a.csv")), written);
  EXPECT_EQ(names(), (std::vector<std::string>{"a.csv", "a.json"}));
}

TEST_F(RoundTrip, Hdf5IsExact) {
  const Recording written = hard_recording();
  write_hdf5(path("a.h5"), written);
  expect_same(read_recording(path("a.h5")), written);
  EXPECT_EQ(names(), (std::vector<std::string>{"a.h5"}));
}

TEST_F(RoundTrip, MatlabIsExact) {
  const Recording written = hard_recording();
  write_matlab(path("a.mat"), written);
  EXPECT_EQ(matlab_version(path("a.mat")), MatlabVersion::k5);
  expect_same(read_recording(path("a.mat")), written);
  EXPECT_EQ(names(), (std::vector<std::string>{"a.mat"}));
}

// The version that is written above 2 GB.
TEST_F(RoundTrip, Matlab73IsExact) {
  const Recording written = hard_recording();
  OutputGroup group{.file_attributes = written.sidecar};
  group.file_attributes["device"] = written.device;
  group.file_attributes["sample_rate_hz"] = written.sample_rate_hz;
  for (const Channel& channel : written.channels)
    group.arrays.push_back({channel.name, channel.unit, &channel.values});
  write_matlab_file(path("a.mat"), group, 0);
  EXPECT_EQ(matlab_version(path("a.mat")), MatlabVersion::k73);
  Recording read = read_recording(path("a.mat"));
  // MATLAB keeps variables by name.
  std::ranges::sort(read.channels, {}, [&written](const Channel& channel) {
    return std::ranges::find(written.channels, channel.name, &Channel::name) - written.channels.begin();
  });
  expect_same(read, written);
  const std::string first = content("a.mat");
  write_matlab_file(path("a.mat"), group, 0);
  EXPECT_TRUE(content("a.mat") == first);
  // As another library sees it: a column of doubles, a row of characters.
  const MatlabFile file(Mat_Open(path("a.mat").c_str(), MAT_ACC_RDONLY));
  ASSERT_TRUE(file);
  const MatlabVariable rate(Mat_VarRead(file.get(), "rate_dph"));
  ASSERT_TRUE(rate);
  EXPECT_EQ(rate->class_type, MAT_C_DOUBLE);
  ASSERT_EQ(rate->rank, 2);
  EXPECT_EQ(rate->dims[0], written.rows());
  EXPECT_EQ(rate->dims[1], 1U);
  const auto* values = static_cast<const double*>(rate->data);
  EXPECT_TRUE(same_values({values, values + written.rows()}, written.channels[1].values));
  const MatlabVariable sidecar(Mat_VarRead(file.get(), "sidecar"));
  ASSERT_TRUE(sidecar);
  EXPECT_EQ(sidecar->class_type, MAT_C_CHAR);
  EXPECT_EQ(sidecar->dims[0], 1U);
}

// The struct `raw` of v7.3, by both libraries.
TEST_F(RoundTrip, RawCaptureInMatlab73) {
  const std::vector<std::int32_t> x = {-32768, 0, 32767}, y = {1, 2, 3};
  OutputGroup group{.group = "raw", .group_attributes = {{"sample_rate_hz", 1e5}, {"full_scale_lsb", 32768}}};
  group.file_attributes["device"] = "HRG";
  group.arrays = {{"adc_x", "LSB", &x}, {"adc_y", "LSB", &y}};
  write_matlab_file(path("a.mat"), group, 0);
  const RawCapture capture = read_raw_capture(path("a.mat"));
  EXPECT_EQ(capture.adc_x, x);
  EXPECT_EQ(capture.adc_y, y);
  EXPECT_EQ(capture.sample_rate_hz, 1e5);
  EXPECT_EQ(capture.full_scale_lsb, 32768.0);
  EXPECT_EQ(capture.device, "HRG");
  EXPECT_TRUE(is_raw(path("a.mat")));
  const MatlabFile file(Mat_Open(path("a.mat").c_str(), MAT_ACC_RDONLY));
  ASSERT_TRUE(file);
  const MatlabVariable raw(Mat_VarRead(file.get(), "raw"));
  ASSERT_TRUE(raw);
  EXPECT_EQ(raw->class_type, MAT_C_STRUCT);
  const matvar_t* field = Mat_VarGetStructFieldByName(raw.get(), "adc_x", 0);
  ASSERT_NE(field, nullptr);
  EXPECT_EQ(field->class_type, MAT_C_INT32);
  EXPECT_EQ(field->dims[0], 3U);
}

TEST_F(RoundTrip, WrittenAgainTheBytesAreTheSame) {
  const Recording written = hard_recording();
  write_file(path("a.csv"), written);
  write_file(path("b.csv"), read_recording(path("a.csv")));
  EXPECT_EQ(content("a.csv"), content("b.csv"));
  EXPECT_EQ(content("a.json"), content("b.json"));
  write_file(path("a.h5"), read_recording(path("a.csv")));
  write_file(path("b.h5"), read_recording(path("a.h5")));
  EXPECT_EQ(content("a.h5"), content("b.h5"));
  write_file(path("a.mat"), read_recording(path("a.csv")));
  write_file(path("b.mat"), read_recording(path("a.mat")));
  EXPECT_EQ(content("a.mat"), content("b.mat"));
}

TEST_F(RoundTrip, ShortestNumbersAndEmptyCells) {
  Recording recording{.sample_rate_hz = 2.0};
  recording.channels = {{"time_s", "s", {0.0, 0.5}}, {"rate_dph", "deg/h", {0.1, std::nan("")}}};
  write_csv(path("a.csv"), recording);
  EXPECT_EQ(content("a.csv"), "time_s,rate_dph\n0,0.1\n0.5,\n");
}

TEST_F(RoundTrip, OneColumnWithMissingValueAtTheEnd) {
  Recording recording{.sample_rate_hz = 2.0};
  recording.channels = {{"rate_dph", "deg/h", {1.0, std::nan(""), std::nan("")}}};
  write_csv(path("a.csv"), recording);
  EXPECT_TRUE(
      same_values(read_recording(path("a.csv")).find("rate_dph")->values, recording.channels[0].values));
}

TEST_F(RoundTrip, LongNotesFitIntoHdf5) {
  Recording recording = hard_recording();
  recording.sidecar["notes"] = std::string(200000, 'n');
  write_hdf5(path("a.h5"), recording);
  EXPECT_EQ(read_recording(path("a.h5")).sidecar["notes"], recording.sidecar["notes"]);
}

}  // namespace
}  // namespace hemi::recording::testing

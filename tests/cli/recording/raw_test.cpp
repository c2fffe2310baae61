// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/raw_capture.hpp"

#include <sndfile.h>

#include <filesystem>

#include "cli/recording/write.hpp"
#include "tests/cli/recording/scratch.hpp"

namespace hemi::recording::testing {
namespace {

using Raw = ScratchTest;

void expect_same(const RawCapture& a, const RawCapture& b) {
  EXPECT_EQ(a.sample_rate_hz, b.sample_rate_hz);
  EXPECT_EQ(a.full_scale_lsb, b.full_scale_lsb);
  EXPECT_TRUE(a.adc_x == b.adc_x);
  EXPECT_TRUE(a.adc_y == b.adc_y);
  EXPECT_EQ(a.gaps.size(), b.gaps.size());
}

struct Form {
  const char* name;
  int format;
  int bits;
};

class SoundForms : public ScratchTest, public ::testing::WithParamInterface<Form> {};

// The words that were written come back unchanged, and the same through every other kind of file.
TEST_P(SoundForms, SoundCsvHdf5AndMatlabAgree) {
  const auto x = ring_down(30000, GetParam().bits, 0.0821, 1);
  const auto y = ring_down(30000, GetParam().bits, 0.0822, 2);
  const std::string sound = path(GetParam().name);
  write_sound(sound, GetParam().format, GetParam().bits, 44100, x, y);
  const RawCapture capture = read_raw_capture(sound);
  EXPECT_TRUE(capture.adc_x == x);
  EXPECT_TRUE(capture.adc_y == y);
  EXPECT_EQ(capture.sample_rate_hz, 44100.0);
  EXPECT_EQ(capture.full_scale_lsb, static_cast<double>(std::int64_t{1} << (GetParam().bits - 1)));
  EXPECT_TRUE(capture.notes.empty());
  EXPECT_TRUE(is_raw(sound));
  write_file(path("c.raw.csv"), capture);
  write_file(path("c.h5"), capture);
  write_file(path("c.mat"), capture);
  expect_same(read_raw_capture(path("c.raw.csv")), capture);
  expect_same(read_raw_capture(path("c.mat")), capture);
  EXPECT_TRUE(is_raw(path("c.mat")));
  expect_same(read_raw_capture(path("c.h5")), capture);
  EXPECT_TRUE(is_raw(path("c.raw.csv")));
  EXPECT_TRUE(is_raw(path("c.h5")));
}

INSTANTIATE_TEST_SUITE_P(Forms, SoundForms,
                         ::testing::Values(Form{"a.wav", SF_FORMAT_WAV | SF_FORMAT_PCM_16, 16},
                                           Form{"b.wav", SF_FORMAT_WAV | SF_FORMAT_PCM_24, 24},
                                           Form{"c.wav", SF_FORMAT_WAV | SF_FORMAT_PCM_32, 32},
                                           Form{"d.wav", SF_FORMAT_WAV | SF_FORMAT_PCM_U8, 8},
                                           Form{"e.flac", SF_FORMAT_FLAC | SF_FORMAT_PCM_16, 16},
                                           Form{"f.flac", SF_FORMAT_FLAC | SF_FORMAT_PCM_24, 24},
                                           Form{"g.aiff", SF_FORMAT_AIFF | SF_FORMAT_PCM_16, 16}),
                         [](const auto& made) { return std::string(1, made.param.name[0]); });

TEST_F(Raw, PackagedBellAgreesInAllForms) {
  const std::string bell = "/usr/share/sonic-pi/samples/perc_bell.flac";
  if (!std::filesystem::exists(bell)) GTEST_SKIP() << "sonic-pi-samples is not installed";
  const RawCapture capture = read_raw_capture(bell);
  EXPECT_EQ(capture.sample_rate_hz, 44100.0);
  EXPECT_GT(capture.adc_x.size(), 44100U);
  write_csv(path("bell.raw.csv"), capture);
  write_hdf5(path("bell.h5"), capture);
  expect_same(read_raw_capture(path("bell.raw.csv")), capture);
  expect_same(read_raw_capture(path("bell.h5")), capture);
  if (const auto shared = shared_recordings()) {
    expect_same(read_raw_capture(*shared + "/real/bell.wav"), capture);
  }
}

TEST_F(Raw, OneChannelGivesZerosForY) {
  write_sound(path("m.wav"), SF_FORMAT_WAV | SF_FORMAT_PCM_16, 16, 8000, {1, -2, 3}, {});
  EXPECT_EQ(read_raw_capture(path("m.wav")).adc_y, (std::vector<std::int32_t>{0, 0, 0}));
  file("m.raw.csv", "adc_x\n1\n-2\n3\n");
  file("m.json", R"({"raw": {"sample_rate_hz": 8000, "full_scale_lsb": 32768}})");
  const RawCapture capture = read_raw_capture(path("m.raw.csv"));
  EXPECT_EQ(capture.adc_x, (std::vector<std::int32_t>{1, -2, 3}));
  EXPECT_EQ(capture.adc_y, (std::vector<std::int32_t>{0, 0, 0}));
}

TEST_F(Raw, RateFromOptionsSidecarAndClock) {
  // Steps of 1/44100 s printed to a microsecond: the median step is 44 kHz off, the span is not.
  std::string text = "time_s,adc_x\n";
  for (int i = 0; i < 44101; ++i) text += std::to_string(i / 44100.0).substr(0, 8) + ",7\n";
  const std::string csv = file("a.raw.csv", text);
  const RawCapture capture = read_raw_capture(csv);
  EXPECT_NEAR(capture.sample_rate_hz, 44100.0, 44100.0 * 1e-6);  // one microsecond in one second
  EXPECT_TRUE(capture.gaps.empty());
  EXPECT_EQ(capture.full_scale_lsb, 32768.0);
  ASSERT_EQ(capture.notes.size(), 1U);
  EXPECT_NE(capture.notes[0].find("full_scale_lsb is not stated"), std::string::npos);
  // A sidecar shared with telemetry: its own rate is not the ADC's.
  file("a.json", R"({"sample_rate_hz": 10, "raw": {"full_scale_lsb": 131072}})");
  EXPECT_NEAR(read_raw_capture(csv).sample_rate_hz, 44100.0, 0.05);
  EXPECT_EQ(read_raw_capture(csv).full_scale_lsb, 131072.0);
  file("a.json", R"({"sample_rate_hz": 10, "raw": {"sample_rate_hz": 44100}})");
  EXPECT_EQ(read_raw_capture(csv).sample_rate_hz, 44100.0);
  EXPECT_EQ(read_raw_capture(csv, {.sample_rate_hz = 250000.0, .full_scale_lsb = 8.0}).sample_rate_hz,
            250000.0);
  EXPECT_EQ(read_raw_capture(csv, {.sample_rate_hz = 250000.0, .full_scale_lsb = 8.0}).full_scale_lsb, 8.0);
}

TEST_F(Raw, GapsFromClockAndEmptyCells) {
  const std::string csv = file("a.raw.csv",
                               "time_s,adc_x,adc_y\n"
                               "0,1,1\n1,2,2\n"                        // three samples missing on the clock
                               "5,3,3\n6,,4\n7,5,5\n8,6,6\n9,7,7\n");  // one lost cell
  const RawCapture capture = read_raw_capture(csv, {.sample_rate_hz = 1.0, .full_scale_lsb = 32768.0});
  EXPECT_EQ(capture.adc_x, (std::vector<std::int32_t>{1, 2, 3, 5, 6, 7}));
  ASSERT_EQ(capture.gaps.size(), 2U);
  EXPECT_EQ(capture.gaps[0].after_row, 1U);
  EXPECT_EQ(capture.gaps[0].missing_samples, 3U);
  EXPECT_EQ(capture.gaps[1].after_row, 2U);
  EXPECT_EQ(capture.gaps[1].missing_samples, 1U);
  EXPECT_EQ(capture.gaps[1].start_s, 5.0);
  EXPECT_EQ(capture.gaps[1].end_s, 7.0);
  ASSERT_EQ(capture.notes.size(), 1U);
  EXPECT_NE(capture.notes[0].find("2 gap(s), 4 samples missing"), std::string::npos);
  for (const char* name : {"b.raw.csv", "b.h5"}) {
    write_file(path(name), capture);
    const RawCapture again = read_raw_capture(path(name));
    expect_same(again, capture);
    EXPECT_EQ(again.gaps[0].missing_samples, 3U);
    EXPECT_EQ(again.gaps[1].after_row, 2U);
  }
}

TEST_F(Raw, TopLevelAndMappedHdf5) {
  write_hdf5_items(path("a.h5"), {{"adc_x", {3}, {1, 2, 3}}, {"adc_y", {3}, {4, 5, 6}}},
                   {{"sample_rate_hz", 1e5}, {"full_scale_lsb", 131072}});
  EXPECT_TRUE(is_raw(path("a.h5")));
  const RawCapture capture = read_raw_capture(path("a.h5"));
  EXPECT_EQ(capture.sample_rate_hz, 1e5);
  EXPECT_EQ(capture.full_scale_lsb, 131072.0);
  EXPECT_EQ(capture.adc_y, (std::vector<std::int32_t>{4, 5, 6}));
}

TEST_F(Raw, TelemetryBesideItMakesTheFileTelemetry) {
  write_hdf5_items(path("a.h5"),
                   {{"time_s", {2}, {0, 1}}, {"rate_dph", {2}, {0, 1}}, {"raw/adc_x", {3}, {1, 2, 3}}});
  EXPECT_FALSE(is_raw(path("a.h5")));
  EXPECT_EQ(read_recording(path("a.h5")).channels.size(), 2U);
  EXPECT_EQ(read_raw_capture(path("a.h5"), {.sample_rate_hz = 1e5, .full_scale_lsb = {}}).adc_x.size(), 3U);
  EXPECT_FALSE(is_raw(file("t.csv", "time_s,rate_dph\n0,1\n")));
  EXPECT_TRUE(is_raw(file("r.csv", "time_s,adc_x [LSB]\n0,1\n")));
  file("m.json", R"({"columns": {"ch1": "adc_x", "junk": null}})");
  EXPECT_TRUE(is_raw(file("m.csv", "ch1,junk\n0,1\n")));
}

TEST_F(Raw, SidecarBesideKeepsItsOtherKeys) {
  file("a.json", R"({"format": "hemi-recording/1", "device": "A", "sample_rate_hz": 10, "mine": [1]})");
  const RawCapture capture{.sample_rate_hz = 1e5, .full_scale_lsb = 32768, .adc_x = {1, 2}, .adc_y = {3, 4}};
  write_csv(path("a.raw.csv"), capture);
  EXPECT_EQ(content("a.raw.csv"), "adc_x,adc_y\n1,3\n2,4\n");
  const Json sidecar = Json::parse(content("a.json"));
  EXPECT_EQ(sidecar["sample_rate_hz"], 10);
  EXPECT_EQ(sidecar["mine"], Json::array({1}));
  EXPECT_EQ(sidecar["raw"]["sample_rate_hz"], 1e5);
  EXPECT_EQ(sidecar["raw"]["full_scale_lsb"], 32768);
  EXPECT_EQ(names(), (std::vector<std::string>{"a.json", "a.raw.csv"}));
}

}  // namespace
}  // namespace hemi::recording::testing

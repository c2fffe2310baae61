// SPDX-License-Identifier: Apache-2.0
#include <sndfile.h>

#include <filesystem>

#include "cli/recording/raw_capture.hpp"
#include "tests/cli/recording/scratch.hpp"

namespace hemi::recording::testing {
namespace {

class BadRaw : public ScratchTest {
 protected:
  void expect_bad(std::string_view text, std::initializer_list<std::string_view> parts) {
    const std::string csv = file("a.raw.csv", text);
    file("a.json", R"({"raw": {"sample_rate_hz": 1000, "full_scale_lsb": 128}})");
    expect_input_error([&] { read_raw_capture(csv); }, parts);
  }
};

TEST_F(BadRaw, Values) {
  expect_bad("adc_x,adc_y\n1,2\n1.5,2\n", {"a.raw.csv:3: adc_x", "1.5 is no integer"});
  expect_bad("adc_x,adc_y\n1,2\n1,128\n", {"a.raw.csv:3: adc_y", "128 lies outside full scale, -128 to 127"});
  expect_bad("adc_x\n-129\n", {"a.raw.csv:2: adc_x", "-129 lies outside", "full_scale_lsb"});
  expect_bad("adc_x\n3e9\n", {"a.raw.csv:2: adc_x", "outside full scale"});
  expect_bad("adc_x\ninf\n", {"a.raw.csv:2: adc_x", "infinite"});
  expect_bad("adc_x,adc_y\n1,2\n1", {"a.raw.csv:3", "1 cells"});
  expect_bad("adc_x,adc_y\n,2\n,3\n", {"adc_x", "every value is missing"});
  expect_bad("time_s,adc_x\n0,1\n0,1\n", {"a.raw.csv:3: time_s", "repeated"});
  expect_bad("adc_x,adc_z\n1,2\n", {"a.raw.csv:1: adc_z", "unknown channel", "'adc_x'"});
  expect_bad("adc_y\n1\n", {"adc_x", "not a raw capture"});
}

TEST_F(BadRaw, RateAndFullScale) {
  const std::string csv = file("a.raw.csv", "adc_x\n1\n2\n");
  expect_input_error([&] { read_raw_capture(csv); }, {csv, "nothing tells the ADC rate", "a.json"});
  file("a.json", R"({"sample_rate_hz": 10})");  // of the telemetry
  expect_input_error([&] { read_raw_capture(csv); }, {csv, "nothing tells the ADC rate"});
  file("a.json", R"({"raw": {"sample_rate_hz": -5}})");
  expect_input_error([&] { read_raw_capture(csv); }, {"a.json: raw.sample_rate_hz", "above zero"});
  file("a.json", R"({"raw": {"sample_rate_hz": 5, "full_scale_lsb": 0.5}})");
  expect_input_error([&] { read_raw_capture(csv); }, {"a.json: raw.full_scale_lsb", "no full scale"});
  expect_input_error([&] { read_raw_capture(csv, {.sample_rate_hz = 0.0, .full_scale_lsb = {}}); },
                     {csv, "above zero"});
}

TEST_F(BadRaw, Sound) {
  const auto bad = [&](const std::string& name, std::initializer_list<std::string_view> parts) {
    expect_input_error([&] { read_raw_capture(path(name)); }, parts);
    expect_input_error([&] { read_raw_capture(path(name)); }, {path(name)});
  };
  file("junk.wav", "this is no sound at all, whatever its name says");
  bad("junk.wav", {"no sound file"});
  file("empty.wav", "");
  bad("empty.wav", {"is empty"});
  bad("none.wav", {"No such file"});
  write_sound(path("float.wav"), SF_FORMAT_WAV | SF_FORMAT_FLOAT, 16, 8000, {1, 2}, {});
  bad("float.wav", {"floating-point or lossy", "PCM"});
  write_sound(path("ulaw.wav"), SF_FORMAT_WAV | SF_FORMAT_ULAW, 16, 8000, {1, 2}, {});
  bad("ulaw.wav", {"floating-point or lossy"});
  write_sound(path("nothing.wav"), SF_FORMAT_WAV | SF_FORMAT_PCM_16, 16, 8000, {}, {});
  bad("nothing.wav", {"no samples"});
}

TEST_F(BadRaw, SoundOfThreeChannels) {
  SF_INFO info{};
  info.samplerate = 8000;
  info.channels = 3;
  info.format = SF_FORMAT_WAV | SF_FORMAT_PCM_16;
  SNDFILE* sound = sf_open(path("three.wav").c_str(), SFM_WRITE, &info);
  ASSERT_NE(sound, nullptr);
  const int frame[3] = {1, 2, 3};
  sf_writef_int(sound, frame, 1);
  sf_close(sound);
  expect_input_error([&] { read_raw_capture(path("three.wav")); }, {"three.wav", "3 channels"});
}

TEST_F(BadRaw, SoundCutOff) {
  const auto samples = ring_down(20000, 16, 0.08, 3);
  for (const auto& [name, format] : {std::pair{"a.wav", SF_FORMAT_WAV | SF_FORMAT_PCM_16},
                                     std::pair{"a.flac", SF_FORMAT_FLAC | SF_FORMAT_PCM_16}}) {
    write_sound(path(name), format, 16, 8000, samples, samples);
    std::filesystem::resize_file(path(name), std::filesystem::file_size(path(name)) * 2 / 3);
    expect_input_error([&] { read_raw_capture(path(name)); }, {path(name), "cut off"});
  }
}

TEST_F(BadRaw, SoundBeyondStatedFullScale) {
  write_sound(path("a.wav"), SF_FORMAT_WAV | SF_FORMAT_PCM_16, 16, 8000, {1, 2, 300}, {});
  file("a.json", R"({"raw": {"full_scale_lsb": 256}})");
  expect_input_error([&] { read_raw_capture(path("a.wav")); }, {"a.wav: row 3: adc_x", "300 lies outside"});
}

TEST_F(BadRaw, TelemetryIsNoCapture) {
  expect_input_error([&] { read_raw_capture(file("a.csv", "time_s,rate_dph\n0,1\n1,2\n")); },
                     {"a.csv: adc_x", "not a raw capture"});
}

}  // namespace
}  // namespace hemi::recording::testing

// SPDX-License-Identifier: Apache-2.0
// Every file that is not as it should be: one line, exit code 2, nothing left behind.
#include <sndfile.h>

#include <numeric>

#include "cli/recording/write.hpp"
#include "tests/cli/program/program.hpp"

namespace hemi::cli::testing {
namespace {

class BadFiles : public ProgramTest {
 protected:
  void SetUp() override { write_model(); }

  void expect_bad_telemetry(std::string_view text, std::initializer_list<std::string_view> parts) const {
    file("a.csv", text);
    expect_bad({"run", "a.csv", "-m", "hrg.model.json", "-o", "o.csv"}, parts);
    expect_bad({"compare", "a.csv", "-m", "hrg.model.json"}, parts);
    expect_bad({"calibrate", "a.csv", "--base", "hrg.model.json", "-o", "o.model.json"}, parts);
  }
};

std::string binary() {
  std::string bytes(2000, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 197 + i / 7);
  return bytes;
}

TEST_F(BadFiles, MissingEmptyDirectory) {
  expect_bad({"run", "a.csv", "-f", "4425"}, {"a.csv: No such file"});
  expect_bad({"calibrate", "a.csv"}, {"a.csv: No such file"});
  expect_bad({"allan", "a.csv"}, {"a.csv: No such file"});
  expect_bad({"compare", "a.wav", "-f", "4425"}, {"a.wav: No such file"});
  expect_bad({"run", ".", "-f", "4425"}, {"is a directory"});
  for (const char* name : {"e.csv", "e.wav", "e.h5"}) {
    file(name, "");
    expect_bad({"run", name, "-f", "4425", "-o", "o.csv"}, {name, "is empty"});
    expect_bad({"calibrate", name}, {name, "is empty"});
    expect_bad({"allan", name}, {name, "is empty"});
  }
}

TEST_F(BadFiles, Binary) {
  for (const char* name : {"b.csv", "b.wav", "b.flac", "b.h5"}) {
    file(name, binary());
    expect_bad({"run", name, "-f", "4425", "-o", "o.csv"}, {name});
    expect_bad({"compare", name, "-f", "4425"}, {name});
    expect_bad({"calibrate", name, "--base", "hrg.model.json"}, {name});
    expect_bad({"allan", name}, {name});
  }
}

TEST_F(BadFiles, Telemetry) {
  expect_bad_telemetry("time_s,frequency_hz,rate_dph\n0,4425,1\n1,4425,1\n2,44", {"a.csv:4:", "cut off"});
  expect_bad_telemetry("time_s,frequency_hz,rate_dph\n0,4425,1\n1,abc,1\n",
                       {"a.csv:3: frequency_hz: 'abc' is not a number"});
  expect_bad_telemetry("time_s,frequency_hz,rate_dph\n0,4425,1\n1,4425,inf\n",
                       {"a.csv:3: rate_dph: 'inf' is infinite"});
  expect_bad_telemetry("time_s,frequency_hz,rate_dph\n0,4425,1\n1,4425,1\n0.5,4425,1\n",
                       {"a.csv:4: time_s: time runs backwards"});
  expect_bad_telemetry("time_s,frequenzy_hz,rate_dph\n0,4425,1\n",
                       {"a.csv:1:", "unknown channel 'frequenzy_hz'", "frequency_hz"});
  expect_bad_telemetry("time_s,frequency_hz [kHz],rate_dph\n0,4.425,1\n",
                       {"a.csv:1:", "unit 'kHz'", "\"scale\": 1000"});
  expect_bad_telemetry("time_s,frequency_hz,rate_dph\n0,nan,1\n1,,1\n2,nan,1\n", {"a.csv", "frequency_hz"});
  expect_bad_telemetry("time_s,frequency_hz,rate_dph\n0,4425,nan\n1,4425,\n", {"a.csv", "rate_dph"});
  expect_bad_telemetry("time_s,frequency_hz,rate_dph\n0,4425,1\n", {"a.csv:2", "sample rate"});
  expect_bad_telemetry("time_s,frequency_hz,rate_dph\n0,4425,1\n1,1e9,1\n2,4425,1\n",
                       {"a.csv: row 2: frequency_hz", "65536"});
  expect_bad_telemetry("time_s,frequency_hz,rate_dph\n0,4425,1\n1,4425,1e300\n2,4425,1\n",
                       {"a.csv: row 2: rate_dph", "524288"});
}

TEST_F(BadFiles, EveryEngineRefusesAValueBeyondItsWord) {
  file("a.csv", "time_s,frequency_hz,rate_dph\n0,4425,1\n1,4425,6e5\n2,4425,1\n");
  for (const char* engine : {"ideal", "golden", "hls", "rtl", "systemc"})
    expect_bad({"run", "a.csv", "-m", "hrg.model.json", "-e", engine}, {"a.csv: row 2: rate_dph"});
}

TEST_F(BadFiles, TelemetryWithoutAModel) {
  write_telemetry(50);
  expect_bad({"run", "chamber.csv"}, {"chamber.csv", "--model"});
  expect_bad({"compare", "chamber.csv"}, {"chamber.csv", "--model"});
  expect_bad({"calibrate", "chamber.csv"}, {"chamber.csv", "f(T)", "--base"});
}

TEST_F(BadFiles, Captures) {
  file("a.raw.csv", "adc_x,adc_y\n1,2\n2.5,1\n");
  expect_bad({"run", "a.raw.csv", "-f", "4425"}, {"a.raw.csv", "ADC rate", "sample_rate_hz"});
  expect_bad({"run", "a.raw.csv", "-f", "4425", "--adc-rate", "1e5"},
             {"a.raw.csv:3: adc_x: 2.5 is no integer"});
  file("b.raw.csv", "adc_x,adc_y\n1,2\n2,1\n");
  expect_bad({"run", "b.raw.csv", "--adc-rate", "1e5"}, {"b.raw.csv", "--frequency"});
}

// A capture that is cut off before its first output compares nothing: that is no success.
TEST_F(BadFiles, CaptureShorterThanAnOutput) {
  write_tone(499);
  expect_bad({"run", "tone.raw.csv", "-f", "4425", "-o", "o.csv"}, {"499 sample pairs", "500"});
  expect_bad({"compare", "tone.raw.csv", "-f", "4425"}, {"499 sample pairs"});
  write_tone(500);
  good({"run", "tone.raw.csv", "-f", "4425", "-o", "o.csv"});
}

TEST_F(BadFiles, UnsupportedRate) {
  write_tone(1000);
  expect_bad({"run", "tone.raw.csv", "-f", "499"}, {"tone.raw.csv", "0.005 to 0.3"});
  expect_bad({"run", "tone.raw.csv", "-f", "30001"}, {"tone.raw.csv", "0.005 to 0.3"});
  expect_bad({"run", "tone.raw.csv", "-f", "4425", "--adc-rate", "9000"}, {"0.4917", "0.3"});
  good({"run", "tone.raw.csv", "-f", "500.001"});
  good({"run", "tone.raw.csv", "-f", "29999"});
  // 18 bits: the frequency word ends before 0.3 of 250 kS/s.
  recording::RawCapture wide = tone(5000, 250e3, 4425.0);
  wide.full_scale_lsb = 131072.0;
  recording::write_csv(path("wide.raw.csv"), wide);
  good({"run", "wide.raw.csv", "-f", "64999"});
  expect_bad({"run", "wide.raw.csv", "-f", "65001"}, {"wide.raw.csv", "0.005 to 0.26"});
}

TEST_F(BadFiles, SoundOf24Bits) {
  std::vector<std::int32_t> x(2000);
  std::iota(x.begin(), x.end(), 0);
  recording::testing::write_sound(path("a.wav"), SF_FORMAT_WAV | SF_FORMAT_PCM_24, 24, 44100, x, x);
  expect_bad({"run", "a.wav", "-f", "3621"}, {"a.wav: adc_x", "8388608", "18 bits"});
  // Cut in the middle of the samples.
  recording::testing::write_sound(path("b.wav"), SF_FORMAT_WAV | SF_FORMAT_PCM_16, 16, 44100, x, x);
  file("c.wav", content("b.wav").substr(0, 3000));
  expect_bad({"run", "c.wav", "-f", "3621"}, {"c.wav"});
}

TEST_F(BadFiles, SettledPoints) {
  const auto bad = [&](std::string_view text, std::initializer_list<std::string_view> parts) {
    file("s.csv", text);
    expect_bad({"calibrate", "s.csv", "-o", "o.model.json"}, parts);
  };
  bad("settled_degc,frequency_hz\n", {"s.csv", "0 settled points", "needs 3"});
  bad("settled_degc,frequency_hz\n0,4425\n10,4428\n", {"s.csv", "2 settled points"});
  bad("settled_degc,frequency_hz\n0,4425\n10,nan\n20,4432\n", {"s.csv:3: frequency_hz", "not finite"});
  bad("settled_degc,frequency_hz\n0,4425\n10,\n20,4432\n", {"s.csv:3: frequency_hz", "missing"});
  bad("settled_degc,frequency_hz\n0,4425\n10,4x\n20,4432\n", {"s.csv:3: frequency_hz", "'4x'"});
  bad("settled_degc,frequency_hz\n0,4425\n10,-4428\n20,4432\n", {"s.csv:3: frequency_hz", "above zero"});
  bad("settled_degc,frequency_hz\n0,4425\n10,4428,1\n20,4432\n", {"s.csv:3"});
  bad("settled_degc\n0\n10\n20\n", {"s.csv:1: frequency_hz: there is no such column"});
  bad("settled_degc,frequency_hz\n5,4425\n5,4426\n5,4427\n5,4428\n", {"s.csv", "different temperatures"});
  file("s.csv", "settled_degc,frequency_hz\n0,4425\n10,4428\n20,4432\n");
  expect_bad({"calibrate", "s.csv", "--order", "3"}, {"s.csv", "3 settled points, order 3 needs 5"});
}

TEST_F(BadFiles, OneKindWhereAnotherIsExpected) {
  write_tone(1000);
  expect_bad({"calibrate", "tone.raw.csv"}, {"tone.raw.csv", "raw capture", "hemi run"});
  expect_bad({"allan", "tone.raw.csv"}, {"tone.raw.csv", "raw capture", "hemi run"});
  file("s.csv", "settled_degc,frequency_hz\n0,4425\n10,4428\n20,4432\n");
  for (const char* command : {"run", "compare"})
    expect_bad({command, "s.csv", "-m", "hrg.model.json"}, {"s.csv", "settled points", "hemi calibrate"});
  expect_bad({"allan", "s.csv"}, {"s.csv", "settled points", "hemi calibrate"});
  write_telemetry(50);
  expect_bad({"run", "chamber.csv", "-m", "chamber.csv"}, {"chamber.csv", "JSON"});
}

}  // namespace
}  // namespace hemi::cli::testing

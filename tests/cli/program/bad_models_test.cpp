// SPDX-License-Identifier: Apache-2.0
// Models that the core's registers cannot hold, told in the model's own terms; the same for every engine.
#include <fmt/format.h>

#include "tests/cli/program/program.hpp"

namespace hemi::cli::testing {
namespace {

class BadModels : public ProgramTest {
 protected:
  void SetUp() override { write_telemetry(50); }

  void expect_bad_model(std::string_view key, std::string_view value,
                        std::initializer_list<std::string_view> parts) const {
    file("a.model.json", model_text(key, value));
    expect_bad({"run", "chamber.csv", "-m", "a.model.json", "-o", "o.csv"}, parts);
  }
};

std::string bias(std::string_view term, double value) {
  return fmt::format(R"({{"reference_hz": 4432.07, "terms_dph": {{"{}": {}}}}})", term, value);
}

TEST_F(BadModels, NoModelAtAll) {
  expect_bad({"run", "chamber.csv", "-m", "a.model.json"}, {"a.model.json: No such file"});
  file("e.model.json", "");
  expect_bad({"run", "chamber.csv", "-m", "e.model.json"}, {"e.model.json", "is empty"});
  file("t.model.json", "{\"format\": \"hemi-model/1\",\n\"frequency\": {");
  expect_bad({"run", "chamber.csv", "-m", "t.model.json"}, {"t.model.json:2", "JSON"});
  file("f.model.json", "{\"format\": \"hemi-model/9\"}");
  expect_bad({"run", "chamber.csv", "-m", "f.model.json"}, {"f.model.json: format", "hemi-model/1"});
  file("n.model.json", "{\"format\": \"hemi-model/1\"}");
  expect_bad({"run", "chamber.csv", "-m", "n.model.json"}, {"n.model.json: frequency", "hemi calibrate"});
}

// Register bias_k ends at 2^18 deg/h; f is at full scale at 64 Hz, df at 0.125 Hz/s.
TEST_F(BadModels, BiasTermsBeyondTheirRegisters) {
  expect_bad_model("bias", bias("f^2", 1000.0),
                   {"a.model.json: bias.terms_dph.f^2: 1000 makes 4.096e+06 deg/h", "bias_f2", "below 64"});
  expect_bad_model("bias", bias("1", -3e5), {"bias.terms_dph.1: -300000", "below 2.621e+05"});
  expect_bad_model("bias", bias("df^3", 1e9), {"bias.terms_dph.df^3", "below 1.342e+08"});
  expect_bad_model("bias", bias("g", 1.0), {"bias.terms_dph.g", "no such term"});
}

TEST_F(BadModels, TheRemedyThatIsNamedHelps) {
  file("a.model.json", model_text("bias", bias("f^2", 63.99)));
  good({"run", "chamber.csv", "-m", "a.model.json"});
}

TEST_F(BadModels, EveryEngineRefusesAlike) {
  file("a.model.json", model_text("bias", bias("f", 1e5)));
  for (const char* engine : {"ideal", "golden", "hls", "rtl", "systemc"})
    expect_bad({"run", "chamber.csv", "-m", "a.model.json", "-e", engine}, {"bias.terms_dph.f: 100000"});
  expect_bad({"compare", "chamber.csv", "-m", "a.model.json"}, {"bias.terms_dph.f: 100000"});
}

TEST_F(BadModels, ReferenceFarFromFOfT) {
  for (const char* hz : {"9000", "-5", "1e9", "4523"}) {
    expect_bad_model("bias", fmt::format(R"({{"reference_hz": {}, "terms_dph": {{"1": 1}}}})", hz),
                     {"a.model.json: bias.reference_hz", "4458.86"});
  }
}

TEST_F(BadModels, ScaleFactor) {
  expect_bad_model("scale_factor", "0.5", {"a.model.json: scale_factor: 0.5", "0.9412 to 1.0667"});
  expect_bad_model("scale_factor", "-1", {"a.model.json: scale_factor: -1"});
  expect_bad_model("scale_factor", "0", {"a.model.json: scale_factor", "zero"});
  file("a.model.json", model_text("scale_factor", "1.0666"));
  good({"run", "chamber.csv", "-m", "a.model.json"});
}

TEST_F(BadModels, FrequencyPolynomial) {
  expect_bad_model("frequency", R"({"reference_degc": 20, "coefficients_hz": [4425, 0, 1]})",
                   {"a.model.json: frequency", "turns round", "calibrated_degc"});
  expect_bad_model("frequency", R"({"reference_degc": 20, "coefficients_hz": [4425]})",
                   {"a.model.json: frequency.coefficients_hz", "no slope"});
  expect_bad_model("frequency", R"({"reference_degc": 20, "coefficients_hz": [4425, 1e-9]})",
                   {"a.model.json: frequency.coefficients_hz", "flat"});
  expect_bad_model("frequency", R"({"reference_degc": 20, "coefficients_hz": [1e308, 1e308]})",
                   {"a.model.json: frequency.coefficients_hz", "not finite"});
  expect_bad_model("frequency", R"({"reference_degc": 20, "coefficients_hz": "x"})",
                   {"a.model.json: frequency.coefficients_hz", "list"});
  expect_bad_model("frequency", "[1]", {"a.model.json: frequency", "object"});
  for (const char* range : {"[5, 5]", "[40, -40]", "\"x\"", "[-1e300, 1e300]"}) {
    expect_bad_model(
        "frequency",
        fmt::format(R"({{"reference_degc": 0, "coefficients_hz": [4425, 0.3], "calibrated_degc": {}}})",
                    range),
        {"a.model.json: frequency.calibrated_degc", "[lowest, highest]"});
  }
}

// A capture needs no f(T): without one there is no temperature, and no range that could be left.
TEST_F(BadModels, CaptureWithABiasModelAlone) {
  write_tone(60000);
  file("a.model.json",
       R"({"format": "hemi-model/1", "bias": {"reference_hz": 4425, "terms_dph": {"1": 7}}})");
  expect_bad({"run", "tone.raw.csv", "-m", "a.model.json"}, {"tone.raw.csv", "--frequency"});
  good({"run", "tone.raw.csv", "-m", "a.model.json", "-f", "4425", "-o", "o.csv"});
  const auto out = recording::read_recording(path("o.csv"));
  EXPECT_EQ(out.find("temperature_degc"), nullptr) << "all cells are empty";
  constexpr std::uint64_t out_of_calibrated_range = std::uint64_t{1} << 12;
  const auto status = static_cast<std::uint64_t>(out.find("status")->values.back());
  EXPECT_EQ(status & out_of_calibrated_range, 0U);
  EXPECT_NEAR(out.find("bias_dph")->values.back(), 7.0, 1e-3);
}

}  // namespace
}  // namespace hemi::cli::testing

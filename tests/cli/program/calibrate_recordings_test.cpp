// SPDX-License-Identifier: Apache-2.0
// Chamber recordings through the program: a whole model, a register image, held-out runs, what is refused.
#include <fmt/format.h>

#include <cmath>

#include "tests/cli/program/program.hpp"
#include "tests/golden/calibration/chamber_recording.hpp"

namespace hemi::cli::testing {
namespace {

namespace chamber = hemi::calibration::testing;

class CalibrateRecordings : public ProgramTest {
 protected:
  void write_run(const char* name, const chamber::Targets& targets, double duration_s,
                 std::uint64_t seed) const {
    const auto run = chamber::chamber_recording({}, targets, duration_s, seed, 5.0);
    std::mt19937_64 generator(seed + 1000);
    std::normal_distribution<double> normal;
    std::string text = "time_s,case_temp_degc,frequency_hz,rate_dph,drive_v,quadrature_v,amplitude\n";
    for (std::size_t i = 0; i < run.time_s.size(); ++i) {
      const double t = run.resonator_degc[i] - 20.0;
      text += fmt::format("{},{:.2f},{:.7f},{:.4f},{:.6f},{:.6f},{:.7f}\n", run.time_s[i], run.case_degc[i],
                          run.frequency_hz[i], run.rate_dph[i], 2.0 + 0.004 * t + 1e-4 * normal(generator),
                          0.8 + 0.002 * t + 1e-4 * normal(generator), 1.0 + 1e-5 * normal(generator));
    }
    file(name, text);
  }
};

TEST_F(CalibrateRecordings, SoaksToModelRegistersAndHeldOutRuns) {
  write_run("soaks.csv", chamber::seven_soaks(4.0 * 3600.0), 28.0 * 3600.0, 1);
  write_run("cool.csv", {{0.0, -20.0}}, 18000.0, 2);
  const auto json = good({"calibrate", "soaks.csv", "--heldout", "cool.csv", "-o", "m.model.json",
                          "--registers", "r.json", "--json"})
                        .json();
  EXPECT_EQ(json["settled_stretches"].size(), 7U);
  EXPECT_EQ(json["frequency"]["order"], 3);
  const double tau_error_s = json["thermal"]["standard_error_s"];
  EXPECT_NEAR(json["thermal"]["time_constant_s"].get<double>(), 2600.0, 5.0 * tau_error_s);
  for (const auto& soak : json["left_out_soaks"]) EXPECT_LE(std::abs(soak["error_degc"].get<double>()), 0.02);
  for (const auto& score : json["held_out"]) {
    EXPECT_GT(score["cooling"]["before_dph"].get<double>() / score["cooling"]["after_dph"].get<double>(),
              5.0);
  }
  const auto model = recording::Json::parse(content("m.model.json"));
  for (const char* part : {"frequency", "thermal", "bias", "drive", "quadrature", "amplitude", "noise"})
    EXPECT_TRUE(model.contains(part)) << part;
  EXPECT_NEAR(model["drive"]["coefficients_v"][1].get<double>(), 0.004, 1e-6);
  // The model's own program takes it again.
  good({"run", "cool.csv", "-m", "m.model.json"});
  const auto image = recording::Json::parse(content("r.json"));
  EXPECT_EQ(image["registers"][0]["name"], "nco_start");
  EXPECT_LT(json["registers"]["thermometer_error_degc"].get<double>(), 0.005);
  for (const char* name : {"r.h", "r.mem"})
    good({"calibrate", "cool.csv", "--base", "m.model.json", "--registers", name});
  expect_bad({"calibrate", "cool.csv", "--base", "m.model.json", "--registers", "r.txt"}, {"r.txt", ".mem"});
}

TEST_F(CalibrateRecordings, WhatCannotBeCalibrated) {
  write_run("flat.csv", {{0.0, 23.0}}, 7200.0, 3);
  expect_bad({"calibrate", "flat.csv"}, {"flat.csv", "hardly moves", "--base"});
  write_run("short.csv", {{0.0, -20.0}}, 300.0, 4);
  expect_bad({"calibrate", "short.csv"}, {"short.csv", "ten minutes", "--base"});
}

}  // namespace
}  // namespace hemi::cli::testing

// SPDX-License-Identifier: Apache-2.0
// hemi diagnose as a user meets it: files, verdict, the corrected model given back, messages.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "cli/recording/recording.hpp"
#include "cli/recording/write.hpp"
#include "tests/cli/program/program.hpp"

namespace hemi::cli::testing {
namespace {

class Diagnose : public ProgramTest {
 protected:
  // Exit code 1: something was found.
  Outcome found(const Arguments& arguments) const {
    Outcome outcome = hemi(arguments);
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    return outcome;
  }
  // A resonator of 16 Hz under random steps of force, integrated by velocity Verlet at 64 steps a sample.
  void write_bench(double k3) const {
    recording::Recording bench{.device = "rig", .sample_rate_hz = 200.0};
    bench.channels = {{"time_s", "s", {}}, {"force_v", "V", {}}, {"displacement_v", "V", {}}};
    std::mt19937_64 random(4);
    std::normal_distribution<double> normal;
    double y = 0.0, v = 0.0, u = 0.0;
    const double h = 1.0 / (200.0 * 64.0);
    for (int row = 0; row < 4096; ++row) {
      u = 0.5 * u + 0.1 * normal(random);
      const double noise = 1e-4 * normal(random);
      const double values[] = {row / 200.0, u, y + noise};
      for (std::size_t c = 0; c < 3; ++c) bench.channels[c].values.push_back(values[c]);
      for (int step = 0; step < 64; ++step) {
        const auto spring = [&] { return 8000.0 * u + 30.0 - 1e4 * y - k3 * y * y * y; };
        v += 0.5 * h * (spring() - 10.0 * v);
        y += h * v;
        v = (v + 0.5 * h * spring()) / (1.0 + 5.0 * h);
      }
    }
    recording::write_file(path("bench.csv"), bench);
  }
};

TEST_F(Diagnose, NamesModelsAndIsContentWithTheModel) {
  write_bench(4e4);
  const auto json = found({"diagnose", "bench.csv", "-o", "out", "--json"}).json();
  EXPECT_EQ(json["format"], "hemi-diagnosis/1");
  ASSERT_EQ(json["verdict"], "named");
  ASSERT_EQ(json["effects"].size(), 1U);
  EXPECT_EQ(json["effects"][0]["id"], "duffing");
  const auto& k3 = json["effects"][0]["parameters"]["k3"];
  const double low = k3["ci95"][0], high = k3["ci95"][1];
  // Twice the 95 % interval about the estimate.
  EXPECT_NEAR(k3["value"].get<double>(), 4e4, high - low);
  const auto& improvement = json["improvement"]["displacement_v"];
  for (const char* part : {"train", "heldout"}) {
    EXPECT_LT(improvement[part]["after_rms"].get<double>(), improvement[part]["before_rms"].get<double>())
        << part;
    EXPECT_GT(improvement[part]["gain_ci95"][0].get<double>(), 0.0) << part;
  }
  EXPECT_EQ(recording::read_json_object(path("out/diagnosis.json")), json);
  const auto again =
      good({"diagnose", "bench.csv", "--model", "out/corrected.model.json", "-o", "again", "--json"}).json();
  EXPECT_EQ(again["verdict"], "consistent");
  EXPECT_TRUE(again["effects"].empty());
  EXPECT_NE(found({"diagnose", "bench.csv", "-o", "out"}).out.find("verdict: named"), std::string::npos);
}

TEST_F(Diagnose, BadInputs) {
  write_telemetry(2000);
  expect_bad({"diagnose", "chamber.csv"}, {"chamber.csv", "instrument model", "--model", "hemi calibrate"});
  write_bench(0.0);
  expect_bad({"diagnose", "bench.csv", "--from", "5", "--to", "4"}, {"no stretch", "--from below --to"});
  expect_bad({"diagnose", "bench.csv", "--from", "5", "--to", "6"}, {"bench.csv", "1024"});
  file("hrg.model.json", "{\"format\": \"hemi-model/1\"}");
  expect_bad({"diagnose", "bench.csv", "--model", "hrg.model.json"}, {"hrg.model.json", "bench", "missing"});
  file("odd.model.json",
       "{\"format\": \"hemi-model/1\", \"bench\": {\"gain\": 1, \"damping_per_s\": 1, \"stiffness_per_s2\": "
       "1}, "
       "\"effects\": [{\"id\": \"gas_leak\"}]}");
  expect_bad({"diagnose", "bench.csv", "--model", "odd.model.json"}, {"odd.model.json", "gas_leak", "known"});
}

struct Elsewhere {
  const char* file;
  const char* verdict;
  const char* effect;  // empty: none
};

// Recordings from a writer that shares no code with this program, not part of the source: skipped where
// absent.
class WrittenElsewhere : public Diagnose, public ::testing::WithParamInterface<Elsewhere> {};

TEST_P(WrittenElsewhere, HasTheRightVerdict) {
  const char* const shared = std::getenv("HEMI_SHARED");
  const std::filesystem::path folder =
      (shared != nullptr ? std::filesystem::path(shared)
                         : std::filesystem::path(HEMI_SOURCE_DIR) / ".." / "shared") /
      "recordings" / "written-elsewhere";
  const auto at = [&](const char* suffix) {
    return (folder / (std::string(GetParam().file) + suffix)).string();
  };
  if (!std::filesystem::exists(at(".csv"))) GTEST_SKIP() << "no " << at(".csv");
  const Outcome outcome = hemi({"diagnose", at(".csv"), "--model", at(".model.json"), "-o", "out", "--json"});
  EXPECT_EQ(outcome.code, std::string_view(GetParam().verdict) == "consistent" ? 0 : 1) << outcome.err;
  const auto json = outcome.json();
  EXPECT_EQ(json["verdict"], GetParam().verdict);
  EXPECT_TRUE(json["alternatives"].empty());
  std::string effects;
  for (const auto& effect : json["effects"]) effects += effect["id"].get<std::string>();
  EXPECT_EQ(effects, GetParam().effect);
  EXPECT_TRUE(std::filesystem::exists(path("out/report.html")));
}

INSTANTIATE_TEST_SUITE_P(
    Recordings, WrittenElsewhere,
    ::testing::Values(Elsewhere{"null-cycle", "consistent", ""},
                      Elsewhere{"single-demodulation_phase", "named", "demodulation_phase"},
                      Elsewhere{"single-duffing", "named", "duffing"},
                      Elsewhere{"single-oscillator_temperature", "named", "oscillator_temperature"},
                      Elsewhere{"single-thermal_hysteresis", "named", "thermal_hysteresis"},
                      Elsewhere{"unknown-u_etalon", "unknown", "unknown"}),
    [](const auto& each) {
      std::string name = each.param.file;
      std::ranges::replace(name, '-', '_');
      return name;
    });

}  // namespace
}  // namespace hemi::cli::testing

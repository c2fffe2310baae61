// SPDX-License-Identifier: Apache-2.0
// hemi diagnose as a user meets it: files, verdict, the corrected model given back, messages.
#include <cmath>
#include <random>

#include "cli/recording/recording.hpp"
#include "cli/recording/write.hpp"
#include "tests/cli/program/program.hpp"

namespace hemi::cli::testing {
namespace {

class Diagnose : public ProgramTest {
 protected:
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
  const auto json = good({"diagnose", "bench.csv", "-o", "out", "--json"}).json();
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
  EXPECT_NE(good({"diagnose", "bench.csv", "-o", "out"}).out.find("verdict: named"), std::string::npos);
}

TEST_F(Diagnose, BadInputs) {
  write_telemetry(2000);
  expect_bad({"diagnose", "chamber.csv"}, {"chamber.csv", "force_v", "not diagnosed yet", "hemi calibrate"});
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

}  // namespace
}  // namespace hemi::cli::testing

// SPDX-License-Identifier: Apache-2.0
// The paper's experiment, simulated at its conditions: seven soaks calibrate, runs that the fit has not seen
// are compensated.
#include <filesystem>

#include "tests/cli/program/program.hpp"

namespace hemi::cli::testing {
namespace {

class PaperExperiment : public ProgramTest {
 protected:
  void simulate(const std::string& name) const {
    const auto scenario = std::filesystem::path(HEMI_SOURCE_DIR) / "scripts/scenarios" / (name + ".toml");
    good({"simulate", scenario.string(), "-o", "."});
  }
};

TEST_F(PaperExperiment, ReadsTemperatureAndCompensatesRunsThatTheFitHasNotSeen) {
  for (const char* name : {"paper_soaks", "room_to_minus_20", "cycles"}) simulate(name);
  const auto json = good({"calibrate", "paper_soaks.csv", "--heldout", "room_to_minus_20.csv", "cycles.csv",
                          "-o", "m.model.json", "--json"})
                        .json();
  // The thermal pole is known: the scenario's 2600 s.
  EXPECT_NEAR(json["thermal"]["time_constant_s"].get<double>(), 2600.0,
              5.0 * json["thermal"]["standard_error_s"].get<double>() + 0.05);
  ASSERT_EQ(json["left_out_soaks"].size(), 7u);
  for (const auto& soak : json["left_out_soaks"])
    EXPECT_LE(std::abs(soak["error_degc"].get<double>()), 0.02) << soak;
  int scored = 0;
  for (const auto& run : json["held_out"]) {
    if (run["average_s"] != 10.0) continue;
    for (const char* part : {"all", "cooling", "warming"}) {
      if (!run.contains(part)) continue;
      const double before = run[part]["before_dph"], after = run[part]["after_dph"];
      // The mark to pass: 17.5 times (Micromachines 2025, 16, 357); the paper: 5.15 times on the run that it
      // fitted.
      EXPECT_GE(before / after, 17.5) << run["recording"] << " " << part;
      ++scored;
    }
  }
  EXPECT_EQ(scored, 5);
}

}  // namespace
}  // namespace hemi::cli::testing

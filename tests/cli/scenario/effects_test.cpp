// SPDX-License-Identifier: Apache-2.0
// Effects of the catalogue in scenarios.
#include <cmath>

#include "cli/scenario/run.hpp"
#include "tests/cli/scenario/scenario_test.hpp"

namespace hemi::scenario::testing {
namespace {

using Effects = ScenarioTest;

TEST_F(Effects, EveryOneRunsWithItsTypicalValues) {
  ASSERT_GE(physics::catalogue().size(), 30U);
  for (const auto& [id, entry] : physics::catalogue()) {
    SCOPED_TRACE(id);
    const Scenario s = read("[scenario]\nduration = \"10 min\"\n[[effect]]\nid = \"" + id + "\"\n");
    ASSERT_EQ(s.effects.size(), 1U);
    EXPECT_EQ(s.effects[0].values.size(), entry.description.parameters.size());
    EXPECT_GE(simulate_slow(s).telemetry.size(), 500U);
  }
}

TEST_F(Effects, ParametersTakeUnits) {
  const Scenario s = read(
      "[scenario]\nduration = 100\n[[effect]]\nid = \"self_heating\"\nrise = \"2 degC\"\n"
      "time_constant = \"10 min\"\n");
  EXPECT_EQ(s.effects[0].values.at("rise"), 2.0);
  EXPECT_EQ(s.effects[0].values.at("time_constant"), 600.0);
}

// df/f = (3/8)(k3/k) a^2: relative_shift is what amplitude 1 makes of it; the model does not know of it.
TEST_F(Effects, ActInTheRunAndNotInTheModel) {
  const std::string nominal = "[scenario]\nduration = 100\nnoise = false\n[amplitude]\nsetpoint = 1.1\n";
  const Scenario without = read(nominal);
  const Scenario with = read(nominal + "[[effect]]\nid = \"duffing\"\nrelative_shift = 1e-6\n");
  const double f0 = simulate_slow(without).telemetry[50].frequency_hz;
  const double f1 = simulate_slow(with).telemetry[50].frequency_hz;
  EXPECT_NEAR(f1 / f0 - 1.0, 1e-6 * 1.21, 1e-3 * 1.21e-6);
  EXPECT_EQ(without.nominal_model().frequency->coefficients_hz,
            with.nominal_model().frequency->coefficients_hz);
}

}  // namespace
}  // namespace hemi::scenario::testing

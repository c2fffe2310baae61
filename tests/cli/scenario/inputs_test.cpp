// SPDX-License-Identifier: Apache-2.0
// Inputs over time: what a scenario says, at what time.
#include <cmath>
#include <numbers>

#include "tests/cli/scenario/scenario_test.hpp"

namespace hemi::scenario::testing {
namespace {

using InputsOverTime = ScenarioTest;

TEST_F(InputsOverTime, Defaults) {
  const Scenario s = read("[scenario]\nduration = \"10 min\"\n");
  const physics::Instrument nominal;
  EXPECT_EQ(s.name, "s");
  EXPECT_EQ(s.duration_s, 600.0);
  EXPECT_EQ(s.rows(), 600U);
  EXPECT_EQ(s.mode, Mode::slow);
  EXPECT_TRUE(s.noise);
  EXPECT_EQ(s.inputs.at(5.0).chamber_degc, 20.0);
  EXPECT_EQ(s.inputs.at(5.0).amplitude_setpoint, 1.0);
  EXPECT_EQ(s.instrument.frequency_hz, nominal.frequency_hz);
  EXPECT_EQ(s.instrument.quality_factor, nominal.quality_factor);
  EXPECT_TRUE(s.effects.empty());
}

TEST_F(InputsOverTime, ProfilesAreLinearBetweenTheirPoints) {
  const Scenario s = read("[chamber]\nprofile = [[\"1 min\", 20], [\"0.05 h\", -20], [240, \"253.15 K\"]]\n");
  EXPECT_EQ(s.duration_s, 240.0);
  EXPECT_EQ(s.inputs.at(0.0).chamber_degc, 20.0);
  EXPECT_EQ(s.inputs.at(60.0).chamber_degc, 20.0);
  EXPECT_NEAR(s.inputs.at(120.0).chamber_degc, 0.0, 1e-12);
  EXPECT_NEAR(s.inputs.at(180.0).chamber_degc, -20.0, 1e-12);
  EXPECT_NEAR(s.inputs.at(1e6).chamber_degc, -20.0, 1e-12);
}

// 20 -> -20 at 2 degC/min: 20 min; hold 30 min; -20 -> 10: 15 min; hold 30 min.
TEST_F(InputsOverTime, Soaks) {
  const Scenario s =
      read("[chamber]\nsoaks = {levels = [-20, 10], start = 20, hold = \"30 min\", ramp = 2}\n");
  EXPECT_NEAR(s.duration_s, 95.0 * 60.0, 1e-9);
  EXPECT_NEAR(s.inputs.at(10 * 60.0).chamber_degc, 0.0, 1e-12);
  EXPECT_EQ(s.inputs.at(35 * 60.0).chamber_degc, -20.0);
  EXPECT_NEAR(s.inputs.at(60 * 60.0).chamber_degc, 0.0, 1e-12);
  EXPECT_EQ(s.inputs.at(80 * 60.0).chamber_degc, 10.0);
  const Scenario seven = read("[chamber]\nsoaks = {from = -20, to = 40, start = 20, period = \"5 h\"}\n");
  EXPECT_NEAR(seven.duration_s, 35.0 * 3600.0, 1e-6);
  for (int i = 0; i < 7; ++i)
    EXPECT_NEAR(seven.inputs.at((5.0 * i + 4.9) * 3600.0).chamber_degc, -20.0 + 10.0 * i, 1e-9);
}

// hold 10 min, down 20 min, hold, up 30 min, hold, back 10 min, hold.
TEST_F(InputsOverTime, Cycles) {
  const Scenario s =
      read("[chamber]\ncycles = {low = 0, high = 30, count = 1, hold = \"10 min\", ramp = 1}\n");
  EXPECT_NEAR(s.duration_s, 100.0 * 60.0, 1e-9);
  EXPECT_EQ(s.inputs.at(5 * 60.0).chamber_degc, 20.0);
  EXPECT_NEAR(s.inputs.at(20 * 60.0).chamber_degc, 10.0, 1e-12);
  EXPECT_NEAR(s.inputs.at(35 * 60.0).chamber_degc, 0.0, 1e-12);
  EXPECT_NEAR(s.inputs.at(55 * 60.0).chamber_degc, 15.0, 1e-12);
  EXPECT_EQ(s.inputs.at(75 * 60.0).chamber_degc, 30.0);
  EXPECT_EQ(s.inputs.at(99 * 60.0).chamber_degc, 20.0);
}

TEST_F(InputsOverTime, TableTakesTimeToTurn) {
  const Scenario s = read(
      "[scenario]\nduration = 30\n[table]\nsteps = [[10, \"100 deg/s\"]]\nacceleration = \"50 deg/s^2\"\n");
  EXPECT_EQ(s.inputs.at(9.9).rate_dph, 0.0);
  EXPECT_NEAR(s.inputs.at(11.0).rate_dph, 50.0 * 3600.0, 1e-6);
  EXPECT_NEAR(s.inputs.at(11.0).rate_slope_dph_s, 50.0 * 3600.0, 1e-6);
  EXPECT_EQ(s.inputs.at(12.0).rate_dph, 100.0 * 3600.0);
  EXPECT_EQ(s.inputs.at(12.0).rate_slope_dph_s, 0.0);
  EXPECT_EQ(s.inputs.at(0.0).rate_slope_dph_s, 0.0);
}

TEST_F(InputsOverTime, StepsHoldAndJump) {
  const Scenario s = read(
      "[scenario]\nduration = 30\n[amplitude]\nsteps = [[10, 0.9], [20, 1.1]]\n"
      "[quadrature]\ntrim_v = \"50 mV\"\n[supply]\nsteps = [[0, 6]]\npower_on = \"-1 h\"\n");
  EXPECT_EQ(s.inputs.at(9.999).amplitude_setpoint, 1.0);
  EXPECT_EQ(s.inputs.at(10.0).amplitude_setpoint, 0.9);
  EXPECT_EQ(s.inputs.at(20.0).amplitude_setpoint, 1.1);
  EXPECT_EQ(s.inputs.at(0.0).supply_v, 6.0);
  EXPECT_EQ(s.inputs.at(0.0).quadrature_trim_v, 0.05);
  EXPECT_EQ(s.inputs.at(0.0).power_on_s, -3600.0);
}

TEST_F(InputsOverTime, AHeaterOnTheBoardHeatsOnly) {
  EXPECT_EQ(read("[scenario]\nduration = 30\n").inputs.at(5.0).board_heater_degc, 0.0);
  EXPECT_EQ(read("[scenario]\nduration = 30\n[board]\nheater_degc = 10\n").inputs.at(5.0).board_heater_degc,
            10.0);
  const Scenario s = read("[scenario]\nduration = 30\n[board]\nsteps = [[10, 5]]\n");
  EXPECT_EQ(s.inputs.at(9.999).board_heater_degc, 0.0);
  EXPECT_EQ(s.inputs.at(10.0).board_heater_degc, 5.0);
  expect_refused("[scenario]\nduration = 30\n[board]\nheater_degc = -1\n", 4, {"heater_degc"});
  expect_refused("[scenario]\nduration = 30\n[board]\nheater = 1\n", 4, {"heater"});
}

TEST_F(InputsOverTime, Sine) {
  const Scenario s = read(
      "[scenario]\nduration = 30\n[table]\nsine = {amplitude = \"10 deg/s\", frequency = 0.25, offset = "
      "7}\n");
  EXPECT_NEAR(s.inputs.at(1.0).rate_dph, 36000.0 + 7.0, 1e-9);
  EXPECT_NEAR(s.inputs.at(2.0).rate_slope_dph_s, -36000.0 * 2.0 * std::numbers::pi * 0.25, 1e-6);
}

TEST_F(InputsOverTime, FieldsOfTheInstrument) {
  const Scenario s = read(
      "[scenario]\nduration = 30\n[instrument]\nquality_factor = 1e6\nsplit_hz = \"2 mHz\"\n"
      "shell_time_constant_s = \"0.5 h\"\nfrequency_hz = [4400, 0.4]\n"
      "[instrument.bias]\n\"f*df\" = 12\n1 = 3\n");
  EXPECT_EQ(s.instrument.quality_factor, 1e6);
  EXPECT_EQ(s.instrument.split_hz, 2e-3);
  EXPECT_EQ(s.instrument.shell_time_constant_s, 1800.0);
  EXPECT_EQ(s.instrument.frequency_hz, (std::vector<double>{4400, 0.4}));
  EXPECT_EQ(s.instrument.bias_terms_dph[0], 3.0);
  EXPECT_EQ(s.instrument.bias_terms_dph[7], 12.0);
}

}  // namespace
}  // namespace hemi::scenario::testing

// SPDX-License-Identifier: Apache-2.0
// Scenarios that are not well formed: each is refused with file, line, key and remedy.
#include <string>

#include "tests/cli/scenario/scenario_test.hpp"

namespace hemi::scenario::testing {
namespace {

using BadScenario = ScenarioTest;

// Line 1 is [scenario], line 2 the duration, `text` begins on line 3.
std::string with(std::string_view text) {
  return "[scenario]\nduration = \"1 h\"\n" + std::string(text);
}

TEST_F(BadScenario, NoToml) {
  expect_refused("[scenario\n", 1, {"not valid TOML"});
  expect_refused(with("a = 1\na = 2\n"), 4, {"not valid TOML"});
  expect_refused(with("name = \"x\n"), 3, {"not valid TOML", "quote"});
  recording::testing::expect_input_error([&] { read_scenario(path("none.toml")); },
                                         {"none.toml", "No such file"});
  recording::testing::expect_input_error([&] { read_scenario(file("e.toml", "")); }, {"e.toml", "empty"});
}

TEST_F(BadScenario, UnknownKeys) {
  expect_refused(with("[chambre]\n"), 3, {"unknown key 'chambre'", "did you mean 'chamber'", "instrument"});
  expect_refused(
      with("telemetry_rate = 1\n"), 3,
      {"scenario", "unknown key 'telemetry_rate'", "did you mean 'telemetry_rate_hz'", "raw_capture"});
  expect_refused(with("[instrument]\nqualty_factor = 1e7\n"), 4,
                 {"instrument", "'qualty_factor'", "did you mean 'quality_factor'"});
  expect_refused(with("[instrument.bias]\nf2 = 1\n"), 4, {"instrument.bias", "'f2'", "f^2", "f*df"});
  expect_refused(with("[chamber]\nsoaks = {level = [1, 2], hold = \"1 h\"}\n"), 4,
                 {"chamber.soaks", "'level'", "did you mean 'levels'"});
  expect_refused(with("[table]\nrate = 3\n"), 4, {"table", "'rate'", "did you mean 'rate_dph'"});
  expect_refused(with("[supply]\nxyzzy_quux = 3\n"), 4, {"supply", "'xyzzy_quux'", "known here: supply_v"});
}

TEST_F(BadScenario, WrongUnits) {
  expect_refused("[scenario]\nduration = \"5 kg\"\n", 2, {"scenario.duration", "'kg'", "s, ms, min, h or d"});
  expect_refused("[scenario]\nduration = \"long\"\n", 2, {"scenario.duration", "'long' is no number"});
  expect_refused("[scenario]\nduration = true\n", 2,
                 {"scenario.duration", "expected a number", "true or false"});
  expect_refused(with("[chamber]\ntemperature_degc = \"20 V\"\n"), 4,
                 {"chamber.temperature_degc", "'V'", "degC"});
  expect_refused(with("[table]\nrate_dph = \"20 Hz\"\n"), 4, {"table.rate_dph", "'Hz'", "deg/h or deg/s"});
  expect_refused(with("[chamber]\nprofile = [[\"1 m\", 20]]\n"), 4, {"chamber.profile", "'m'"});
  expect_refused(with("[attitude]\naccel_g = \"1 s\"\n"), 4, {"attitude.accel_g", "'s'", "use g"});
}

TEST_F(BadScenario, WrongKinds) {
  expect_refused(with("noise = 1\n"), 3, {"scenario.noise", "true or false"});
  expect_refused(with("name = 1\n"), 3, {"scenario.name", "expected text"});
  expect_refused(with("name = \"../x\"\n"), 3, {"scenario.name", "no name for files"});
  expect_refused(with("start = \"tomorrow\"\n"), 3, {"scenario.start", "'tomorrow' is no date"});
  expect_refused(with("start = \"2026-02-30\"\n"), 3, {"scenario.start", "no date"});
  expect_refused(with("seed = 1.5\n"), 3, {"scenario.seed", "whole"});
  expect_refused(with("seed = -1\n"), 3, {"scenario.seed", "outside"});
  expect_refused(with("mode = \"fast\"\n"), 3, {"scenario.mode", "'fast'", "slow, full"});
  expect_refused(with("chamber = 3\n"), 3, {"scenario", "'chamber'"});
  expect_refused("chamber = 3\n", 1, {"chamber", "expected a table", "a number"});
  expect_refused(with("[chamber]\nprofile = 3\n"), 4, {"chamber.profile", "expected a list"});
  expect_refused(with("[chamber]\nprofile = [3]\n"), 4, {"chamber.profile", "[time, value]"});
  expect_refused(with("[chamber]\nprofile = []\n"), 4, {"chamber.profile", "empty"});
  expect_refused(with("[chamber]\ntemperature_degc = nan\n"), 4, {"chamber.temperature_degc", "outside"});
  expect_refused(with("[chamber]\ntemperature_degc = inf\n"), 4, {"chamber.temperature_degc", "outside"});
}

TEST_F(BadScenario, ProfilesThatDoNotRun) {
  expect_refused(with("[chamber]\nprofile = [[0, 20],\n[10, 21],\n[10, 22]]\n"), 6,
                 {"chamber.profile", "times must increase", "10 s follows 10 s"});
  expect_refused(with("[chamber]\nprofile = [[-1, 20]]\n"), 4, {"chamber.profile", "-1 s is outside"});
  expect_refused(with("[chamber]\ntemperature_degc = 20\nprofile = [[0, 20]]\n"), 5,
                 {"chamber.profile", "stands beside temperature_degc"});
  expect_refused(with("[chamber]\nsoaks = {from = 0, to = 10, step = 3, hold = 1}\n"), 4,
                 {"chamber.soaks.step", "do not divide"});
  expect_refused(with("[chamber]\nsoaks = {levels = [0, 40], period = \"10 min\"}\n"), 4,
                 {"chamber.soaks.period", "2400 s"});
  expect_refused(with("[chamber]\nsoaks = {levels = [0, 40]}\n"), 4, {"chamber.soaks.hold", "is missing"});
  expect_refused(with("[chamber]\ncycles = {low = 20, high = 20}\n"), 4,
                 {"chamber.cycles.high", "not above low"});
  expect_refused(with("[chamber]\ncycles = {low = 0, high = 20, ramp = 0}\n"), 4,
                 {"chamber.cycles.ramp", "outside"});
  expect_refused(with("[table]\nacceleration = 1\nsteps = [[0, \"50 deg/s\"], [10, 0]]\n"), 5,
                 {"table.steps", "still on its way", "until 50 s"});
  expect_refused(with("[table]\nrate_dph = 1\nacceleration = 1\n"), 5, {"table.acceleration", "no use"});
  expect_refused("[scenario]\nname = \"x\"\n", 1, {"scenario.duration", "is missing"});
  expect_refused("[scenario]\nduration = 0.5\n", 2, {"scenario.duration", "0 rows"});
  expect_refused("[scenario]\nduration = 1e9\n", 2, {"scenario.duration", "rows", "telemetry_rate_hz"});
}

TEST_F(BadScenario, ModeAndEngine) {
  expect_refused(with("engine = \"hls\"\n"), 3, {"scenario.engine", "mode slow", "mode = \"full\""});
  expect_refused(with("raw_capture = {from = 0, to = 1}\n"), 3, {"scenario.raw_capture", "mode slow"});
  expect_refused(with("[vibration]\namplitude = 1\n"), 3, {"vibration", "mode slow"});
  expect_refused(with("mode = \"full\"\nengine = \"vhdl\"\n"), 4, {"scenario.engine", "'vhdl'", "systemc"});
  expect_refused(with("mode = \"full\"\ntelemetry_rate_hz = 3\n"), 4,
                 {"telemetry_rate_hz", "whole fraction"});
  expect_refused(with("telemetry_rate_hz = 0\n"), 3, {"telemetry_rate_hz", "outside"});
  expect_refused(with("telemetry_rate_hz = 201\n"), 3, {"telemetry_rate_hz", "outside"});
  expect_refused(with("mode = \"full\"\nraw_capture = {from = 3, to = 2}\n"), 4,
                 {"raw_capture.to", "not later"});
  expect_refused(with("mode = \"full\"\nraw_capture = {from = 3, to = 4000}\n"), 4,
                 {"raw_capture.to", "after the end", "3600 s"});
}

TEST_F(BadScenario, Effects) {
  expect_refused(with("[[effect]]\nname = 3\n"), 3, {"effect.id", "is missing", "hemi effects"});
  expect_refused(with("[[effect]]\nid = \"termal_hysteresis\"\n"), 4,
                 {"effect.id", "'termal_hysteresis'", "did you mean 'thermal_hysteresis'"});
  expect_refused(with("[[effect]]\nid = \"thermal_hysteresis\"\nloop_hight = 1\n"), 5,
                 {"effect", "'loop_hight'", "did you mean 'loop_height'"});
  expect_refused(with("[[effect]]\nid = \"duffing\"\n[[effect]]\nid = \"self_heating\"\nrise = \"1 V\"\n"), 7,
                 {"effect.rise", "'V'", "degC"});
  expect_refused(with("[[effect]]\nid = \"self_heating\"\ntime_constant = -1\n"), 5,
                 {"effect.time_constant", "-1 s is outside"});
  expect_refused("effect = 3\n[scenario]\nduration = 10\n", 1, {"effect", "expected a list"});
  expect_refused("effect = [3]\n[scenario]\nduration = 10\n", 1, {"effect", "expected a table"});
}

}  // namespace
}  // namespace hemi::scenario::testing

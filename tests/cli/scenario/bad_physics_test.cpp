// SPDX-License-Identifier: Apache-2.0
// Well-formed scenarios of instruments that cannot be, and of what an instrument cannot do.
#include <string>

#include "tests/cli/scenario/scenario_test.hpp"

namespace hemi::scenario::testing {
namespace {

using BadPhysics = ScenarioTest;

std::string with(std::string_view text) {
  return "[scenario]\nduration = \"1 h\"\n" + std::string(text);
}

TEST_F(BadPhysics, NumbersThatNothingHas) {
  expect_refused(with("[chamber]\ntemperature_degc = -300\n"), 4, {"chamber.temperature_degc", "-273.15"});
  expect_refused(with("[chamber]\nprofile = [[0, 20], [10, -274]]\n"), 4, {"chamber.profile", "-274 degC"});
  expect_refused(with("[instrument]\nquality_factor = 0\n"), 4, {"instrument.quality_factor", "outside"});
  expect_refused(with("[instrument]\nquality_factor = -1e7\n"), 4, {"instrument.quality_factor", "outside"});
  expect_refused(with("[instrument]\nshell_time_constant_s = -1\n"), 4, {"shell_time_constant_s", "outside"});
  expect_refused(with("[instrument]\ncase_time_constant_s = \"-1 h\"\n"), 4,
                 {"case_time_constant_s", "-3600 s"});
  expect_refused(with("[instrument]\npickoff_noise_lsb = -0.1\n"), 4, {"pickoff_noise_lsb", "outside"});
  expect_refused(with("[instrument]\nkappa = 0\n"), 4, {"instrument.kappa", "outside"});
  expect_refused(with("[amplitude]\nsetpoint = 0\n"), 4, {"amplitude.setpoint", "outside"});
}

// f(T) = 4425 + 0.4 T - 0.01 T^2 has its top at 20 degC; the range of the check is that of the chamber and 5
// degC.
TEST_F(BadPhysics, FrequencyThatIsNoThermometer) {
  const std::string polynomial = "[instrument]\nfrequency_hz = [4425, 0.4, -0.01]\n";
  expect_refused(with(polynomial + "[chamber]\nprofile = [[0, 0], [60, 16]]\n"), 6,
                 {"chamber.profile", "not monotonic from -5 to 21 degC"});
  read(with(polynomial + "[chamber]\nprofile = [[0, 0], [60, 14]]\n"));
  expect_refused(with("[instrument]\nfrequency_hz = [4425]\n"), 4,
                 {"instrument.frequency_hz", "does not depend"});
  expect_refused(with("[instrument]\nfrequency_hz = [-4425, 1]\n"), 4,
                 {"instrument.frequency_hz", "above zero"});
  expect_refused(with("[instrument]\nrelative_damping = [1, -0.1]\n[chamber]\ntemperature_degc = 30\n"), 4,
                 {"instrument.relative_damping", "not above zero"});
}

// Amplitude 1 takes 1/n of the drive's full scale where full scale is n times the steady drive.
TEST_F(BadPhysics, DriveThatCannotHoldTheAmplitude) {
  expect_refused(with("[instrument]\ndrive_full_scale_over_steady = 0.5\n"), 4,
                 {"drive_full_scale_over_steady", "201 % of the drive's full scale"});
  expect_refused(with("[instrument]\ndrive_full_scale_over_steady = 1.1\n[amplitude]\nsteps = [[10, 1.2]]\n"),
                 4, {"amplitude 1.2", "110 %"});
  read(with("[instrument]\ndrive_full_scale_over_steady = 1.3\n[amplitude]\nsteps = [[10, 1.2]]\n"));
}

TEST_F(BadPhysics, FullScales) {
  expect_refused(with("[amplitude]\nsetpoint = 1.3\n"), 4,
                 {"amplitude.setpoint", "104 % of the ADC's full scale"});
  expect_refused(with("[table]\nrate_dph = \"121 deg/s\"\n"), 4,
                 {"table.rate_dph", "121 deg/s", "120 deg/s"});
  expect_refused(with("[table]\nsine = {amplitude = \"121 deg/s\", frequency = 1}\n"), 4,
                 {"table.sine", "121 deg/s"});
  expect_refused(with("[instrument]\nsplit_hz = 0.1\n"), 4, {"instrument.split_hz", "141 %", "quadrature"});
  expect_refused(with("[quadrature]\ntrim_v = 10\n"), 4, {"quadrature.trim_v", "full scale"});
}

TEST_F(BadPhysics, ResonatorThatTheCoreCannotFollow) {
  const std::string full = "mode = \"full\"\n[instrument]\nfrequency_hz = ";
  expect_refused(with(full + "[300, 0.1]\n"), 5, {"instrument.frequency_hz", "ADC's rate", "0.005"});
  expect_refused(with(full + "[40000, 0.1]\n"), 5, {"instrument.frequency_hz", "0.26"});
}

// Delay from motion to force: 6 x 20 + 1/2 samples, 1.2 ms. At 200 Hz that alone turns the phase by 87
// degrees.
TEST_F(BadPhysics, LoopsFasterThanTheirDelayAllows) {
  const std::string full = "mode = \"full\"\n[loops]\n";
  expect_refused(with(full + "rebalance_hz = 200\n"), 5, {"loops.rebalance_hz", "lower the bandwidth"});
  expect_refused(with(full + "amplitude_hz = 500\n"), 5, {"loops.amplitude_hz", "lower the bandwidth"});
  expect_refused(with(full + "reference_phase_hz = 1000\n"), 5, {"loops.reference_phase_hz"});
  read(with(full + "rebalance_hz = 50\n"));
}

TEST_F(BadPhysics, InputsThatTheCoreDoesNotHave) {
  const std::string full = "mode = \"full\"\n";
  expect_refused(with(full + "[amplitude]\nsteps = [[1, 0.9]]\n"), 5, {"amplitude.steps", "register"});
  expect_refused(with(full + "[quadrature]\ntrim_v = 0.1\n"), 5, {"quadrature.trim_v", "mode = \"slow\""});
  read(with(full + "[amplitude]\nsetpoint = 0.9\n"));
}

}  // namespace
}  // namespace hemi::scenario::testing

// SPDX-License-Identifier: Apache-2.0
// Physics outside the catalogue, so that "unknown" can be the right answer.
#include <cmath>
#include <numbers>

#include "golden/concealed/effects.hpp"

namespace hemi::concealed {
namespace {

Form shaped(const std::string& name, Stage stage, int output, const Series& shape, double high, double sign) {
  Form form;
  form.name = name;
  form.high = high;
  form.sign = sign;
  form.at = [=](double strength) { return adding(stage, output, shape, strength); };
  form.parameters = [](double) { return Values{}; };
  return form;
}

double inside(const Setting& in) {
  const Series& shell = in.baseline.shell_degc;
  const double low = shell.minCoeff(), high = shell.maxCoeff();
  return in.random.uniform(low + 0.25 * (high - low), high - 0.25 * (high - low));
}

Form etalon(const Setting& in) {
  const double period_degc = in.random.uniform(1.5, 5.0);
  const Series ripple =
      (kTurn_rad * in.baseline.shell_degc / period_degc + in.random.uniform(0.0, 6.0)).sin();
  return shaped("light interferes in a gap", Stage::kRate, kRate, ripple, 3.0, 1.0);
}

Form slow_wave(const Setting& in) {
  const Series wave =
      (kTurn_rad * in.in.time_s / in.random.uniform(4000.0, 9000.0) + in.random.uniform(0.0, 6.0)).sin();
  return shaped("air conditioning", Stage::kRate, kRate, wave, 3.0, 1.0);
}

Form transition(const Setting& in) {
  const Series step = 0.5 * ((in.baseline.shell_degc - inside(in)) / in.random.uniform(0.05, 0.4)).tanh();
  return shaped("a phase transition of the adhesive, reversible", Stage::kRate, kRate, step, 3.0,
                in.random.sign());
}

/// Forced air reaches the thermometer, not the housing.
Form airflow(const Setting& in) {
  Form form;
  form.name = "fan on and off";
  form.high = 2.0;
  form.sign = in.random.sign();
  Series fan(in.in.time_s.size());
  double on = 0.0, next_s = in.random.uniform(1500.0, 4000.0);
  for (Eigen::Index i = 0; i < fan.size(); ++i) {
    if (static_cast<double>(i) > next_s) {
      on = 1.0 - on;
      next_s += in.random.uniform(1500.0, 5000.0);
    }
    fan[i] = on;
  }
  const Series offset = lagged(fan, 45.0, 0.0);
  form.at = [offset](double degc) {
    return acting(Stage::kThermometer, [=](State& s) { s.case_reading_degc += degc * offset; });
  };
  form.parameters = [](double) { return Values{}; };
  return form;
}

Form supply_square(const Setting& in) {
  return shaped("rate pulled by the square of the supply's error", Stage::kRate, kRate,
                ((in.in.supply_v - 150.0) / 0.6).square(), 3.0, in.random.sign());
}

Form dead_zone(const Setting& in) {
  const Series& w = in.in.rate_in_dph;
  const Series shape = (w > 0.0).cast<double>() * (1.0 - (-w.abs() / 2e4).exp());
  return shaped("one direction of rotation alone", Stage::kRate, kRate, shape, 20.0, in.random.sign());
}

Form memory_of_rotation(const Setting& in) {
  const Series charge = lagged(in.in.rate_in_dph / 1e5, in.random.uniform(900.0, 2500.0), 0.0);
  return shaped("charge left by past rotation", Stage::kRate, kRate, charge, 20.0, in.random.sign());
}

Form rectified_slope(const Setting& in) {
  const Series speed = slope(in.baseline.shell_degc).abs() * 1e3;
  return shaped("follows the size of dT/dt, not its sign", Stage::kRate, kRate, speed, 3.0, in.random.sign());
}

Form acceleration_frequency(const Setting& in) {
  return shaped("stem sags under its weight", Stage::kFrequency, kFrequency, in.in.accel_g, 5e-3,
                in.random.sign());
}

Form quadrature_supply(const Setting& in) {
  return shaped("quadrature follows the supply", Stage::kQuadrature, kQuadrature, in.in.supply_v - 150.0,
                0.02, in.random.sign());
}

Form drive_acceleration(const Setting& in) {
  return shaped("drive follows specific force", Stage::kDrive, kDrive, in.in.accel_g, 0.02, in.random.sign());
}

Form mode_crossing(const Setting& in) {
  const Series x = (in.baseline.shell_degc - inside(in)) / in.random.uniform(0.4, 1.2);
  return shaped("another mode crosses", Stage::kFrequency, kFrequency, x / (1.0 + x.square()), 0.02,
                in.random.sign());
}

Form telegraph(const Setting& in) {
  Series state(in.in.time_s.size());
  double now = 0.0, next_s = in.random.uniform(800.0, 4000.0);
  for (Eigen::Index i = 0; i < state.size(); ++i) {
    if (static_cast<double>(i) > next_s) {
      now = 1.0 - now;
      next_s += in.random.uniform(800.0, 6000.0);
    }
    state[i] = now;
  }
  return shaped("a loose particle comes and goes", Stage::kFrequency, kFrequency, state, 5e-3,
                in.random.sign());
}

}  // namespace

const std::vector<Kind>& unknown_kinds() {
  static const std::vector<Kind> kinds = {
      {"u_etalon", "rate_dph", 0, etalon, {}},
      {"u_slow_wave", "rate_dph", 0, slow_wave, {}},
      {"u_transition", "rate_dph", 0, transition, {}},
      {"u_airflow", "frequency_hz", 0, airflow, {}},
      {"u_supply_square", "rate_dph", kSupply, supply_square, {}},
      {"u_dead_zone", "rate_dph", kTurn, dead_zone, {}},
      {"u_memory_of_rotation", "rate_dph", kTurn, memory_of_rotation, {}},
      {"u_rectified_slope", "rate_dph", 0, rectified_slope, {}},
      {"u_acceleration_frequency", "frequency_hz", kTumble, acceleration_frequency, {}},
      {"u_quadrature_supply", "quadrature_v", kSupply, quadrature_supply, {}},
      {"u_drive_acceleration", "drive_v", kTumble, drive_acceleration, {}},
      {"u_mode_crossing", "frequency_hz", 0, mode_crossing, {}},
      {"u_telegraph", "frequency_hz", 0, telegraph, {}}};
  return kinds;
}

}  // namespace hemi::concealed

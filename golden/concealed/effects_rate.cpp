// SPDX-License-Identifier: Apache-2.0
// Effects on the rate output that follow another signal.
#include <cmath>
#include <numbers>

#include "golden/concealed/effects.hpp"

namespace hemi::concealed {
namespace {

Form rate_form(const std::string& name, double high, double sign, const std::string& parameter,
               std::function<Series(const State&)> regressor) {
  Form form;
  form.name = name;
  form.high = high;
  form.sign = sign;
  form.at = [=](double strength) {
    return acting(Stage::kRate, [=](State& s) { s.rate_dph += strength * regressor(s); });
  };
  form.parameters = [parameter](double strength) { return Values{{parameter, strength}}; };
  return form;
}

Form demodulation_phase(const Setting& in) {
  const double drift = in.random.chance(0.4) ? in.random.uniform(-0.01, 0.01) : 0.0;
  return rate_form(
      drift == 0.0 ? "constant phase" : "phase follows the board", 20.0, in.random.sign(), "gain",
      [drift](const State& s) { return Series(s.quadrature_v * (1.0 + drift * (s.in->board_degc - 25.0))); });
}

Form forcer_misalignment(const Setting& in) {
  return rate_form("share of the drive on the second mode", 20.0, in.random.sign(), "gain",
                   [](const State& s) { return Series(s.drive_v * s.in->amplitude); });
}

Form damping_anisotropy(const Setting& in) {
  return rate_form("share of the loss", 20.0, in.random.sign(), "gain",
                   [](const State& s) { return Series(s.drive_v / s.in->amplitude); });
}

Form scale_temperature(const Setting& in) {
  const double bend = in.random.chance(0.3) ? in.random.uniform(-0.003, 0.003) : 0.0;
  return rate_form(bend == 0.0 ? "linear" : "slightly bent", 2e-4, in.random.sign(), "per_degc",
                   [bend](const State& s) {
                     const Series warm = s.shell_degc - 20.0;
                     return Series(s.in->rate_in_dph * warm * (1.0 + bend * warm));
                   });
}

Form scale_nonlinearity(const Setting& in) {
  const double curve = in.random.chance(0.5) ? in.random.uniform(0.2, 0.7) : 0.0;
  return rate_form(curve == 0.0 ? "cubic" : "hyperbolic sine", 50.0, in.random.sign(), "cubic",
                   [curve](const State& s) {
                     const Series x = s.in->rate_in_dph / 1e5;
                     if (curve == 0.0) return Series(x.cube());
                     return Series(((curve * x).sinh() - curve * x) / (std::sinh(curve) - curve));
                   });
}

Form g_sensitivity(const Setting& in) {
  const double square = in.random.chance(0.4) ? in.random.uniform(-0.2, 0.2) : 0.0;
  return rate_form(
      square == 0.0 ? "linear" : "linear and square", 2.0, in.random.sign(), "per_g",
      [square](const State& s) { return Series(s.in->accel_g + square * s.in->accel_g.square()); });
}

/// The site's latitude and the tilt that turns the axis from the vertical decide; nothing else to choose.
Form earth_rate(const Setting& in) {
  const double latitude = in.random.uniform(0.35, 1.05);
  Form form = rate_form("forgotten in rate_in", 1.0, 1.0, "", [latitude](const State& s) {
    return Series(15.041 * (latitude + s.in->accel_g.acos()).sin());
  });
  form.scalable = false;
  form.parameters = [](double) { return Values{}; };
  return form;
}

}  // namespace

std::vector<Kind> rate_kinds() {
  return {{"demodulation_phase", "rate_dph", kTrim, demodulation_phase, {}},
          {"forcer_misalignment", "rate_dph", kSteps, forcer_misalignment, {}},
          {"damping_anisotropy", "rate_dph", 0, damping_anisotropy, {"forcer_misalignment"}, true},
          {"scale_factor_temperature", "rate_dph", kTurn, scale_temperature, {}},
          {"scale_factor_nonlinearity", "rate_dph", kTurn, scale_nonlinearity, {}},
          {"g_sensitivity", "rate_dph", kTumble, g_sensitivity, {}},
          {"earth_rate", "rate_dph", kTilts, earth_rate, {}}};
}

}  // namespace hemi::concealed

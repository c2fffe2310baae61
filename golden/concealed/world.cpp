// SPDX-License-Identifier: Apache-2.0
#include "golden/concealed/world.hpp"

#include <stdexcept>

namespace hemi::concealed {

Series& State::output(int which) {
  switch (which) {
    case kFrequency:
      return frequency_hz;
    case kDrive:
      return drive_v;
    case kQuadrature:
      return quadrature_v;
    case kRate:
      return rate_dph;
    default:
      throw std::out_of_range("no such output");
  }
}

const Series& State::output(int which) const {
  return const_cast<State*>(this)->output(which);
}

Series slope(const Series& values) {
  const Eigen::Index n = values.size();
  Series d(n);
  d.segment(1, n - 2) = (values.segment(2, n - 2) - values.segment(0, n - 2)) / 2.0;
  d[0] = values[1] - values[0];
  d[n - 1] = values[n - 1] - values[n - 2];
  return d;
}

State simulate(const Model& model, const Excitation& in, double start_offset_degc, const Effects& effects) {
  State s;
  s.in = &in;
  s.model = &model;
  const auto at = [&](Stage stage) {
    for (const auto& effect : effects) effect->act(s, stage);
  };
  s.case_reading_degc = in.case_degc;
  s.amplitude = in.amplitude;
  at(Stage::kThermometer);
  s.shell_degc = lagged(in.case_ahead_degc, model.time_constant_s, in.case_ahead_degc[0] + start_offset_degc);
  at(Stage::kShell);
  s.thermal_hz = polynomial(model.frequency_hz, s.shell_degc);
  s.frequency_hz = s.thermal_hz;
  at(Stage::kFrequency);
  at(Stage::kClock);
  const Series warm = s.shell_degc - model.command_reference_degc;
  s.drive_v = in.amplitude * polynomial(model.drive_v, warm);
  at(Stage::kDrive);
  s.quadrature_v = in.amplitude * polynomial(model.quadrature_v, warm) + in.trim_v;
  at(Stage::kQuadrature);
  s.rate_dph = model.scale_factor * in.rate_in_dph + bias(model, s.thermal_hz, slope(s.thermal_hz));
  at(Stage::kRate);
  at(Stage::kOutput);
  return s;
}

}  // namespace hemi::concealed

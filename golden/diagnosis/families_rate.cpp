// SPDX-License-Identifier: Apache-2.0
// What reaches the rate by other ways than heat.
#include <cmath>
#include <numbers>

#include "golden/diagnosis/effect_family.hpp"

namespace hemi::diagnosis {
namespace {

using Eigen::ArrayXd;
using Shape = std::vector<double>;
constexpr double kEarth_dph = 15.041;
constexpr double kDelayRatio = 1.35;

using Column = std::function<ArrayXd(const Simulation&)>;

EffectFamily in_rate(const char* effect, const std::string& form, const std::vector<Column>& list) {
  EffectFamily family;
  family.effect = effect;
  family.form = form;
  family.columns = [list](const Simulation& s, const Shape&) {
    std::vector<Trace> columns;
    for (const auto& column : list) {
      Trace trace;
      trace[Output::rate] = column(s);
      columns.push_back(std::move(trace));
    }
    return columns;
  };
  return family;
}

void name_figure(EffectFamily& family, const char* name, const char* unit) {
  family.figures = [name, unit](const Simulation&, const Shape& c, const Shape&) {
    return std::vector<Figure>{{name, unit, c[0]}};
  };
}

// As recorded, which carries what is not in the model; the nominal one where values are missing.
ArrayXd recorded_command(const Simulation& s, Output output) {
  const ArrayXd nominal = s.nominal[output];
  if (!s.telemetry->has(output)) return nominal;
  const ArrayXd recorded = (*s.telemetry)[output];
  return recorded.isNaN().select(nominal, recorded);
}

// "gain" deg/h per V of a command.
void add_commands(std::vector<EffectFamily>& families, const Telemetry& t) {
  const auto amplitude = [](const Simulation& s) { return s.telemetry->amplitude.array(); };
  const auto add = [&](const char* effect, const char* form, const Column& column) {
    families.push_back(in_rate(effect, form, {column}));
    name_figure(families.back(), "gain", "deg/h per V");
  };
  const auto drive = [](const Simulation& s) { return recorded_command(s, Output::drive); };
  if (t.has(Output::drive)) {
    add("damping_anisotropy", "rate += g drive / A",
        [=](const Simulation& s) -> ArrayXd { return drive(s) / amplitude(s); });
    add("damping_anisotropy", "rate += g drive", drive);
    add("forcer_misalignment", "rate += g drive", drive);
    add("forcer_misalignment", "rate += g drive A",
        [=](const Simulation& s) -> ArrayXd { return drive(s) * amplitude(s); });
  }
  if (!t.has(Output::quadrature)) return;
  add("demodulation_phase", "rate += g quadrature",
      [](const Simulation& s) { return recorded_command(s, Output::quadrature); });
  if (!t.has_board || !moves(t.board_degc, 0.5)) return;
  const Column follows = [](const Simulation& s) -> ArrayXd {
    return recorded_command(s, Output::quadrature) * (s.board_degc - 25.0);
  };
  add("demodulation_phase", "rate += g (Tb - 25) quadrature", follows);
  families.push_back(
      in_rate("demodulation_phase", "rate += (g + b (Tb - 25)) quadrature",
              {[](const Simulation& s) { return recorded_command(s, Output::quadrature); }, follows}));
  name_figure(families.back(), "gain", "deg/h per V");
}

void add_turning(std::vector<EffectFamily>& families) {
  const auto rate = [](const Simulation& s) { return s.telemetry->rate_in_dph.array(); };
  families.push_back(
      in_rate("scale_factor_temperature", "rate += s (T - 20) W",
              {[=](const Simulation& s) -> ArrayXd { return rate(s) * (s.smooth_degc - 20.0); }}));
  name_figure(families.back(), "per_degc", "1/degC");
  families.push_back(
      in_rate("scale_factor_temperature", "rate += (s (T - 20) + s2 (T - 20)^2) W",
              {[=](const Simulation& s) -> ArrayXd { return rate(s) * (s.smooth_degc - 20.0); },
               [=](const Simulation& s) -> ArrayXd { return rate(s) * (s.smooth_degc - 20.0).square(); }}));
  name_figure(families.back(), "per_degc", "1/degC");
  const Column square = [=](const Simulation& s) -> ArrayXd { return rate(s).square() / kFullRate_dph; };
  const Column cube = [=](const Simulation& s) -> ArrayXd {
    return rate(s).cube() / std::pow(kFullRate_dph, 2);
  };
  const auto add = [&](const char* form, const std::vector<Column>& list, bool cubic) {
    families.push_back(in_rate("scale_factor_nonlinearity", form, list));
    families.back().figures = [cubic](const Simulation&, const Shape& c, const Shape&) {
      std::vector<Figure> figures;
      if (cubic) figures.push_back({"cubic", "deg/h at 1e5 deg/h", c.back() * kFullRate_dph});
      if (!cubic || c.size() > 1)
        figures.push_back({"quadratic", "deg/h at 1e5 deg/h", c[0] * kFullRate_dph});
      return figures;
    };
  };
  add("rate += n3 W^3", {cube}, true);
  add("rate += n2 W^2", {square}, false);
  add("rate += n2 W^2 + n3 W^3", {square, cube}, true);
}

void add_attitude(std::vector<EffectFamily>& families) {
  const Column linear = [](const Simulation& s) -> ArrayXd { return s.telemetry->accel_g; };
  const Column square = [](const Simulation& s) -> ArrayXd { return s.telemetry->accel_g.array().square(); };
  families.push_back(in_rate("g_sensitivity", "rate += g1 a", {linear}));
  name_figure(families.back(), "per_g", "deg/h/g");
  families.push_back(in_rate("g_sensitivity", "rate += g1 a + g2 a^2", {linear, square}));
  name_figure(families.back(), "per_g", "deg/h/g");
  // The sensing axis along the plumb line sees sin(latitude), across it up to cos(latitude).
  const Column across = [](const Simulation& s) -> ArrayXd {
    return (1.0 - s.telemetry->accel_g.array().square()).max(0.0).sqrt();
  };
  families.push_back(in_rate("earth_rate", "rate += Omega (sin(latitude) a + cos(latitude) sqrt(1 - a^2))",
                             {linear, across}));
  families.back().figures = [](const Simulation&, const Shape& c, const Shape&) {
    return std::vector<Figure>{{"latitude", "deg", std::atan2(c[0], c[1]) * 180.0 / std::numbers::pi}};
  };
  families.back().possible = [](const Simulation&, const Shape& c, const Shape&) {
    return std::abs(std::hypot(c[0], c[1]) / kEarth_dph - 1.0) < 0.02;
  };
}

// The nominal output without the thermometer's noise, which a delay would move against itself.
ArrayXd smooth_nominal(const Simulation& s, Output output) {
  if (output == Output::frequency) return s.smooth_f;
  if (output == Output::drive) return s.smooth_amplitude * s.model.drive_v.at(s.smooth_degc);
  if (output == Output::quadrature)
    return s.smooth_amplitude * s.model.quadrature_v.at(s.smooth_degc) + s.telemetry->trim_v.array();
  return s.model.scale_factor * s.telemetry->rate_in_dph.array() +
         bias_dph(s.model, s.smooth_f, slope_in_time(s.smooth_f, s.telemetry->step_s));
}

EffectFamily time_shift(Output output) {
  EffectFamily family;
  family.effect = "time_shift";
  family.form = std::string(kOutputNames[place(output)]) + " late by n samples";
  family.grid = geometric_grid(1.0, 200.0, kDelayRatio);
  family.spacing = {kDelayRatio};
  family.columns = [output](const Simulation& s, const Shape& shape) {
    Trace trace;
    const ArrayXd whole = smooth_nominal(s, output);
    trace[output] = late(whole, shape[0]) - whole;
    return std::vector<Trace>{trace};
  };
  family.figures = [](const Simulation& s, const Shape& c, const Shape& shape) {
    return std::vector<Figure>{{"delay", "s", c[0] * shape[0] * s.telemetry->step_s}};
  };
  family.possible = [](const Simulation&, const Shape& c, const Shape&) { return c[0] > 0.7 && c[0] < 1.3; };
  return family;
}

}  // namespace

std::vector<EffectFamily> rate_families(const Simulation& s) {
  std::vector<EffectFamily> families;
  const Telemetry& t = *s.telemetry;
  for (const Output output : kOutputs) {
    const bool moving = moves(t.case_degc, 1.0) ||
                        (output != Output::frequency &&
                         (moves(t.rate_in_dph, 1.0) || moves(t.trim_v, 1e-3) || moves(t.amplitude, 1e-3)));
    if (t.has(output) && moving) families.push_back(time_shift(output));
  }
  if (!t.has(Output::rate)) return families;
  add_commands(families, t);
  if (moves(t.rate_in_dph, 1.0)) add_turning(families);
  if (t.has_accel && moves(t.accel_g, 0.05)) add_attitude(families);
  return families;
}

}  // namespace hemi::diagnosis

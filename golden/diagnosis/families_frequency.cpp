// SPDX-License-Identifier: Apache-2.0
// What moves the counted frequency but by heat.
#include <algorithm>
#include <cmath>

#include "golden/diagnosis/effect_family.hpp"

namespace hemi::diagnosis {
namespace {

using Eigen::ArrayXd;
using Shape = std::vector<double>;
constexpr double kTimeRatio = 1.6;
constexpr double kSecondsADay = 86400.0;

// The clock's own: the count moves, the rate does not.
Trace counted(const ArrayXd& column) {
  Trace trace;
  trace[Output::frequency] = column;
  return trace;
}

EffectFamily polynomial_order(int terms) {
  EffectFamily family;
  family.effect = "frequency_polynomial_order";
  family.form = terms == 1 ? "f += a4 (T - T0)^4" : "f += a4 (T - T0)^4 + a5 (T - T0)^5";
  family.columns = [terms](const Simulation& s, const Shape&) {
    std::vector<Trace> columns;
    const ArrayXd t = s.smooth_degc - s.model.frequency_hz.reference;
    for (int i = 0; i < terms; ++i) columns.push_back(s.frequency(t.pow(4 + i)));
    return columns;
  };
  family.figures = [](const Simulation&, const Shape& c, const Shape&) {
    std::vector<Figure> figures = {{"a4", "Hz/degC^4", c[0]}};
    if (c.size() > 1) figures.push_back({"a5", "Hz/degC^5", c[1]});
    return figures;
  };
  return family;
}

using Curve = ArrayXd (*)(const ArrayXd& time_s, double t0);

EffectFamily ageing(const Simulation& s, const char* form, Curve curve, bool shaped) {
  EffectFamily family;
  family.effect = "frequency_ageing";
  family.form = form;
  const double length = s.time_s[s.time_s.size() - 1];
  if (shaped) {
    family.grid = geometric_grid(60.0, 3.0 * length, kTimeRatio);
    family.spacing = {kTimeRatio};
  } else {
    family.grid = {{length}};
  }
  family.columns = [curve](const Simulation& at, const Shape& shape) {
    return std::vector<Trace>{at.frequency(curve(at.time_s, shape[0]))};
  };
  family.figures = [curve](const Simulation& at, const Shape& c, const Shape& shape) {
    const ArrayXd shift = curve(at.time_s, shape[0]);
    return std::vector<Figure>{{"total", "Hz", c[0] * (shift[shift.size() - 1] - shift[0])}};
  };
  return family;
}

EffectFamily oscillator_temperature(int order) {
  EffectFamily family;
  family.effect = "oscillator_temperature";
  family.form = "f = f (1 - y(Tb)), y a polynomial of order " + std::to_string(order);
  const auto powers = [order](const Simulation& s) {
    std::vector<ArrayXd> list;
    const ArrayXd tb = s.board_degc - s.board_degc.mean();
    for (int i = 1; i <= order; ++i) list.push_back(tb.pow(i));
    return list;
  };
  family.columns = [powers](const Simulation& s, const Shape&) {
    std::vector<Trace> columns;
    const ArrayXd frequency = s.f + s.model.bias_reference_hz;
    for (const auto& y : powers(s)) columns.push_back(counted(-1e-6 * frequency * y));
    return columns;
  };
  family.figures = [powers](const Simulation& s, const Shape& c, const Shape&) {
    ArrayXd y = ArrayXd::Zero(s.f.size());
    const auto list = powers(s);
    for (std::size_t i = 0; i < list.size(); ++i) y += c[i] * list[i];
    return std::vector<Figure>{{"ppm_span", "ppm", span(y)}};
  };
  return family;
}

EffectFamily oscillator_ageing() {
  EffectFamily family;
  family.effect = "oscillator_ageing";
  family.form = "f = f (1 - r t)";
  family.columns = [](const Simulation& s, const Shape&) {
    return std::vector<Trace>{counted(-1e-6 / kSecondsADay * (s.f + s.model.bias_reference_hz) * s.time_s)};
  };
  family.figures = [](const Simulation&, const Shape& c, const Shape&) {
    return std::vector<Figure>{{"rate", "ppm/day", c[0]}};
  };
  return family;
}

// df/f = s (x^2 - 1): x the amplitude, or the supply in units of its median.
EffectFamily square_of_input(const char* effect, const char* form, const Eigen::VectorXd& input) {
  EffectFamily family;
  family.effect = effect;
  family.form = form;
  const ArrayXd square = input.array().square() - 1.0;
  family.columns = [square](const Simulation& s, const Shape&) {
    Trace trace = counted((s.f + s.model.bias_reference_hz) * square);
    trace[Output::rate] = s.rate_per_f * trace[Output::frequency].array();
    return std::vector<Trace>{trace};
  };
  family.figures = [](const Simulation&, const Shape& c, const Shape&) {
    return std::vector<Figure>{{"relative_shift", "1", c[0]}};
  };
  return family;
}

EffectFamily loop_lag(const Simulation& s) {
  EffectFamily family;
  family.effect = "pll_lag";
  family.form = "tau_p f_out' = f - f_out";
  family.grid = geometric_grid(2.0 * s.telemetry->step_s, 300.0 * s.telemetry->step_s, 2.0);
  family.columns = [](const Simulation& at, const Shape& shape) {
    return std::vector<Trace>{
        counted(lag(at.smooth_f, at.telemetry->step_s, shape[0], at.smooth_f[0]) - at.smooth_f)};
  };
  family.figures = [](const Simulation&, const Shape& c, const Shape& shape) {
    return std::vector<Figure>{{"time_constant", "s", c[0] * shape[0]}};
  };
  family.possible = [](const Simulation&, const Shape& c, const Shape&) { return c[0] > 0.0; };
  return family;
}

double median(const Eigen::VectorXd& values) {
  std::vector<double> sorted(values.data(), values.data() + values.size());
  const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), at, sorted.end());
  return *at;
}

}  // namespace

std::vector<EffectFamily> frequency_families(const Simulation& s) {
  std::vector<EffectFamily> families;
  const Telemetry& t = *s.telemetry;
  if (!t.has(Output::frequency)) return families;
  families.push_back(ageing(
      s, "f += a t", [](const ArrayXd& x, double length) -> ArrayXd { return x / length; }, false));
  families.push_back(ageing(
      s, "f += a (1 - exp(-t / t0))",
      [](const ArrayXd& x, double t0) -> ArrayXd { return 1.0 - (-x / t0).exp(); }, true));
  families.push_back(ageing(
      s, "f += a ln(1 + t / t0)", [](const ArrayXd& x, double t0) -> ArrayXd { return (1.0 + x / t0).log(); },
      true));
  families.push_back(oscillator_ageing());
  if (moves(t.case_degc, 1.0)) {
    families.push_back(polynomial_order(1));
    families.push_back(polynomial_order(2));
    families.push_back(loop_lag(s));
  }
  if (t.has_board && moves(t.board_degc, 0.5))
    for (const int order : {1, 2, 3}) families.push_back(oscillator_temperature(order));
  if (moves(t.amplitude, 1e-3))
    families.push_back(square_of_input("duffing", "f += f s (A^2 - 1)", t.amplitude));
  if (t.has_supply && moves(t.supply_v, 1e-3 * std::abs(median(t.supply_v))))
    families.push_back(square_of_input("electrostatic_softening", "f += f s ((V / V0)^2 - 1)",
                                       t.supply_v / median(t.supply_v)));
  return families;
}

}  // namespace hemi::diagnosis

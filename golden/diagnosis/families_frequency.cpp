// SPDX-License-Identifier: Apache-2.0
// What moves the counted frequency but by heat.
#include <algorithm>
#include <cmath>

#include "golden/diagnosis/effect_family.hpp"

namespace hemi::diagnosis {
namespace {

using Eigen::ArrayXd;
using Shape = std::vector<double>;
constexpr double kAgeingRatio = 1.6;
constexpr double kFrequencyLagRatio = 1.5;
constexpr double kSlowest_s = 600.0;  // what is over sooner is no ageing
constexpr double kMostAgeing_ppm = 20.0;
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

// How ageing goes on; the same for the resonator and for the clock that it is counted with.
struct AgeingCurve {
  const char* text;
  ArrayXd (*at)(const ArrayXd& time_s, double t0);
  bool shaped;
};
constexpr AgeingCurve kCurves[] = {
    {"t", [](const ArrayXd& t, double length) -> ArrayXd { return t / length; }, false},
    {"(1 - exp(-t / t0))", [](const ArrayXd& t, double t0) -> ArrayXd { return 1.0 - (-t / t0).exp(); },
     true},
    {"ln(1 + t / t0)", [](const ArrayXd& t, double t0) -> ArrayXd { return (1.0 + t / t0).log(); }, true}};

EffectFamily ageing(const Simulation& s, const AgeingCurve& curve, bool of_clock) {
  EffectFamily family;
  family.effect = of_clock ? "oscillator_ageing" : "frequency_ageing";
  family.form = (of_clock ? "f = f (1 - a " : "f += a ") + std::string(curve.text) + (of_clock ? ")" : "");
  const double length = s.time_s[s.time_s.size() - 1];
  family.grid = {{length}};
  if (curve.shaped) {
    family.grid = geometric_grid(std::min(kSlowest_s, length), 3.0 * length, kAgeingRatio);
    family.spacing = {kAgeingRatio};
  }
  const auto shift = curve.at;
  family.columns = [shift, of_clock](const Simulation& at, const Shape& shape) {
    const ArrayXd y = shift(at.time_s, shape[0]);
    if (!of_clock) return std::vector<Trace>{at.frequency(y)};
    return std::vector<Trace>{counted(-1e-6 * (at.f + at.model.bias_reference_hz) * y)};
  };
  family.figures = [shift, of_clock](const Simulation& at, const Shape& c, const Shape& shape) {
    const ArrayXd y = shift(at.time_s, shape[0]);
    const double total = c[0] * (y[y.size() - 1] - y[0]);
    if (!of_clock) return std::vector<Figure>{{"total", "Hz", total}};
    return std::vector<Figure>{{"rate", "ppm/day", total * kSecondsADay / span(at.time_s)}};
  };
  family.possible = [shift, of_clock](const Simulation& at, const Shape& c, const Shape& shape) {
    const double total = std::abs(c[0]) * span(shift(at.time_s, shape[0]));
    return (of_clock ? total : 1e6 * total / at.model.bias_reference_hz) < kMostAgeing_ppm;
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

EffectFamily loop_lag(const Simulation& s, int poles) {
  EffectFamily family;
  family.effect = "pll_lag";
  family.form = poles == 1 ? "tau_p f_out' = f - f_out" : "f_out behind f by two poles of tau_p / 2";
  family.grid = geometric_grid(2.0 * s.telemetry->step_s, 300.0 * s.telemetry->step_s, kFrequencyLagRatio);
  family.spacing = {kFrequencyLagRatio};
  family.columns = [poles](const Simulation& at, const Shape& shape) {
    ArrayXd behind = at.smooth_f;
    for (int i = 0; i < poles; ++i)
      behind = lag(behind, at.telemetry->step_s, shape[0] / static_cast<double>(poles), behind[0]);
    return std::vector<Trace>{counted(behind - at.smooth_f)};
  };
  family.figures = [](const Simulation&, const Shape& c, const Shape& shape) {
    return std::vector<Figure>{{"time_constant", "s", c[0] * shape[0]}};
  };
  family.possible = [](const Simulation&, const Shape& c, const Shape&) { return c[0] > 0.7 && c[0] < 1.3; };
  return family;
}

}  // namespace

std::vector<EffectFamily> frequency_families(const Simulation& s) {
  std::vector<EffectFamily> families;
  const Telemetry& t = *s.telemetry;
  if (!t.has(Output::frequency)) return families;
  for (const bool of_clock : {false, true})
    for (const AgeingCurve& curve : kCurves) families.push_back(ageing(s, curve, of_clock));
  if (moves(t.case_degc, 1.0)) {
    families.push_back(polynomial_order(1));
    families.push_back(polynomial_order(2));
    for (const int poles : {1, 2}) families.push_back(loop_lag(s, poles));
  }
  if (t.has_board && moves(t.board_degc, 0.5))
    for (const int order : {1, 2, 3, 5}) families.push_back(oscillator_temperature(order));
  if (moves(t.amplitude, 1e-3))
    families.push_back(square_of_input("duffing", "f += f s (A^2 - 1)", t.amplitude));
  if (t.has_supply && moves(t.supply_v, 1e-3 * std::abs(median(t.supply_v))))
    families.push_back(square_of_input("electrostatic_softening", "f += f s ((V / V0)^2 - 1)",
                                       t.supply_v / median(t.supply_v)));
  return families;
}

}  // namespace hemi::diagnosis

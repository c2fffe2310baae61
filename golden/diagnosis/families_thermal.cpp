// SPDX-License-Identifier: Apache-2.0
// Heat: how the resonator's temperature follows the case's, and what of it reaches the rate.
#include <fmt/format.h>

#include <cmath>

#include "golden/diagnosis/effect_family.hpp"

namespace hemi::diagnosis {
namespace {

using Eigen::ArrayXd;
using Shape = std::vector<double>;
constexpr double kThermalLagRatio = 1.35;
constexpr double kRadiusRatio = 1.5;
constexpr double kLongestSeries_s = 600.0;
constexpr double kFastPart = 0.2;

ArrayXd case_behind(const Simulation& s, double tau_s) {
  const ArrayXd& degc = s.smooth_case_degc;
  return lag(degc, s.telemetry->step_s, tau_s, degc[0]);
}

// Play operator (backlash) of half width r: Visintin, Differential Models of Hysteresis (1994), ch. III.
ArrayXd play(const ArrayXd& x, double r) {
  ArrayXd y(x.size());
  double state = x[0];
  for (Eigen::Index i = 0; i < x.size(); ++i) y[i] = state = std::clamp(state, x[i] - r, x[i] + r);
  return y;
}

Trace in_rate(const ArrayXd& column) {
  Trace trace;
  trace[Output::rate] = column;
  return trace;
}

// How the second body stands to the first.
enum class SecondBody { in_series, shares_the_way, beside };

EffectFamily second_time_constant(const Simulation& s, SecondBody body) {
  EffectFamily family;
  family.effect = "thermal_second_time_constant";
  const bool beside = body == SecondBody::beside, series = body == SecondBody::in_series;
  family.form = series   ? "T = lag(T, tau2)"
                : beside ? "T += w (lag(case, tau2) - T)"
                         : "T += w (lag(T, tau2) - T)";
  family.grid = series   ? geometric_grid(4.0 * s.telemetry->step_s, kLongestSeries_s, kThermalLagRatio)
                : beside ? geometric_grid(1.35 * s.model.time_constant_s, 20000.0, kThermalLagRatio)
                         : geometric_grid(kLongestSeries_s, 20000.0, kThermalLagRatio);
  family.spacing = {kThermalLagRatio};
  family.columns = [beside](const Simulation& at, const Shape& shape) {
    const ArrayXd behind = beside ? case_behind(at, shape[0])
                                  : lag(at.smooth_degc, at.telemetry->step_s, shape[0], at.smooth_degc[0]);
    return std::vector<Trace>{at.thermal(behind - at.smooth_degc)};
  };
  family.figures = [](const Simulation&, const Shape& c, const Shape& shape) {
    return std::vector<Figure>{{"second_time_constant", "s", shape[0]}, {"weight", "1", c[0]}};
  };
  // A pole in series has weight one; poles side by side share it.
  family.possible = [body](const Simulation&, const Shape& c, const Shape&) {
    if (body == SecondBody::in_series) return c[0] > 0.8 && c[0] < 1.25;
    return c[0] > 0.0 && c[0] < (body == SecondBody::beside ? 1.0 : 1.5);
  };
  return family;
}

EffectFamily gradient(const Simulation& s) {
  EffectFamily family;
  family.effect = "thermal_gradient_bias";
  family.form = "rate += g (case - lag(case, tau_n))";
  family.grid = geometric_grid(std::max(50.0, 4.0 * s.telemetry->step_s), 20000.0, kThermalLagRatio);
  family.spacing = {kThermalLagRatio};
  family.columns = [](const Simulation& at, const Shape& shape) {
    return std::vector<Trace>{in_rate(at.smooth_case_degc - case_behind(at, shape[0]))};
  };
  family.figures = [](const Simulation&, const Shape& c, const Shape& shape) {
    return std::vector<Figure>{{"gain", "deg/h per degC", c[0]}, {"node_time_constant", "s", shape[0]}};
  };
  return family;
}

// The outer node stands behind the case as well.
EffectFamily gradient_of_two(const Simulation& s) {
  EffectFamily family = gradient(s);
  family.form = "rate += g (n - lag(n, tau_n)), n = lag(case, tau_1)";
  family.grid.clear();
  for (const double outer : {40.0, 120.0})
    for (const auto& inner : geometric_grid(3.0 * outer, 20000.0, kThermalLagRatio * kThermalLagRatio))
      family.grid.push_back({inner[0], outer});
  family.spacing = {kThermalLagRatio * kThermalLagRatio, 3.0};
  family.columns = [](const Simulation& at, const Shape& shape) {
    const ArrayXd outer = case_behind(at, shape[1]);
    return std::vector<Trace>{in_rate(outer - lag(outer, at.telemetry->step_s, shape[0], outer[0]))};
  };
  return family;
}

// Down, up and down again over the recording's range of T, kLoopRows rows each way.
constexpr Eigen::Index kLoopRows = 400;
ArrayXd full_loop(const Simulation& s) {
  const ArrayXd down = ArrayXd::LinSpaced(kLoopRows, s.smooth_degc.maxCoeff(), s.smooth_degc.minCoeff());
  ArrayXd way(3 * kLoopRows);
  way << down, down.reverse(), down;
  return way;
}

// Loop height: largest difference between the ways up and down over the full range. A function of T alone has
// none.
double opening(const ArrayXd& along_full_loop) {
  const ArrayXd up = along_full_loop.segment(kLoopRows, kLoopRows);
  return (up - along_full_loop.tail(kLoopRows).reverse()).abs().maxCoeff();
}

// Radii and ways along T are shares of its half range.
double of_half_range(const Simulation& s, double share) {
  return 0.5 * share * span(s.smooth_degc);
}

// Radii one column each.
EffectFamily hysteresis(std::vector<Shape> grid, bool shaped) {
  EffectFamily family;
  family.effect = "thermal_hysteresis";
  family.form = "rate += sum w_i (play(T, r_i) - T)";
  if (shaped) family.spacing = Shape(grid[0].size(), kRadiusRatio);
  family.grid = std::move(grid);
  family.columns = [](const Simulation& s, const Shape& radii) {
    std::vector<Trace> columns;
    for (const double share : radii)
      columns.push_back(in_rate(play(s.smooth_degc, of_half_range(s, share)) - s.smooth_degc));
    return columns;
  };
  // What is a function of T alone the bias model takes, which is why the columns are less T.
  family.figures = [](const Simulation& s, const Shape& c, const Shape& radii) {
    const ArrayXd way = full_loop(s);
    ArrayXd sum = ArrayXd::Zero(way.size());
    for (std::size_t i = 0; i < radii.size(); ++i) sum += c[i] * play(way, of_half_range(s, radii[i]));
    return std::vector<Figure>{{"loop_height", "deg/h", opening(sum)}};
  };
  return family;
}

// h' = (T' - |T'| h) / L: saturates exponentially, a way L along T after every turn.
// Source: Duhem's operator; Visintin, Differential Models of Hysteresis (1994), ch. V.
EffectFamily exponential_hysteresis() {
  EffectFamily family;
  family.effect = "thermal_hysteresis";
  family.form = "rate += w h, h' = (T' - |T'| h) / L";
  family.grid = geometric_grid(0.05, 1.6, kRadiusRatio);
  family.spacing = {kRadiusRatio};
  const auto memory = [](const ArrayXd& t, double length) {
    ArrayXd h = ArrayXd::Zero(t.size());
    for (Eigen::Index i = 1; i < t.size(); ++i) {
      const double step = (t[i] - t[i - 1]) / length;
      h[i] = (h[i - 1] + step) / (1.0 + std::abs(step));
    }
    return h;
  };
  family.columns = [memory](const Simulation& s, const Shape& shape) {
    return std::vector<Trace>{in_rate(memory(s.smooth_degc, of_half_range(s, shape[0])))};
  };
  family.figures = [memory](const Simulation& s, const Shape& c, const Shape& shape) {
    const double height = opening(memory(full_loop(s), of_half_range(s, shape[0])));
    return std::vector<Figure>{{"loop_height", "deg/h", std::abs(c[0]) * height}};
  };
  return family;
}

// Share of the final rise: towards 1 while rows come, towards 0 while they are missing (power off).
ArrayXd warmth(const Simulation& s, double t0, bool restarts) {
  if (!restarts) return 1.0 - (-s.time_s / t0).exp();
  const double gain = -std::expm1(-s.telemetry->step_s / t0);
  ArrayXd share(s.time_s.size());
  double state = 0.0;
  for (Eigen::Index i = 0; i < share.size(); ++i) {
    share[i] = state;
    state += gain * ((s.telemetry->powered[i] ? 1.0 : 0.0) - state);
  }
  return share;
}

// `bodies`: the electronics' box warms in a fraction of the time that its surroundings take.
EffectFamily self_heating(const Simulation& s, bool restarts, int bodies) {
  EffectFamily family;
  family.effect = "self_heating";
  family.form = bodies == 1
                    ? "T += rise (1 - exp(-t / t0))"
                    : fmt::format("T += r1 (1 - exp(-t / t0)) + r2 (1 - exp(-t / ({:g} t0)))", kFastPart);
  if (restarts) family.form += ", again after every power cut";
  family.grid = geometric_grid(60.0, 2.0 * s.time_s[s.time_s.size() - 1], kThermalLagRatio);
  family.spacing = {kThermalLagRatio};
  family.columns = [=](const Simulation& at, const Shape& shape) {
    std::vector<Trace> columns = {at.thermal(warmth(at, shape[0], restarts))};
    if (bodies > 1) columns.push_back(at.thermal(warmth(at, kFastPart * shape[0], restarts)));
    return columns;
  };
  family.figures = [](const Simulation&, const Shape& c, const Shape& shape) {
    std::vector<Figure> figures = {{"rise", "degC", c[0]}};
    if (c.size() > 1) figures[0].value += c[1];
    figures.push_back({"time_constant", "s", shape[0]});
    return figures;
  };
  family.possible = [](const Simulation&, const Shape& c, const Shape&) {
    return c[0] > 0.0 && c.back() > 0.0 && c[0] < 30.0;
  };
  // What the stem brings comes as slowly as the resonator follows its case.
  family.start_may_hold = true;
  return family;
}

}  // namespace

std::vector<EffectFamily> thermal_families(const Simulation& s) {
  std::vector<EffectFamily> families;
  const bool frequency = s.telemetry->has(Output::frequency);
  for (const int bodies : {1, 2}) {
    if (frequency) families.push_back(self_heating(s, false, bodies));
    if (frequency && !s.telemetry->powered.all()) families.push_back(self_heating(s, true, bodies));
  }
  if (!moves(s.telemetry->case_degc, kLeastSwing_degc)) return families;
  if (frequency)
    for (const auto body : {SecondBody::in_series, SecondBody::shares_the_way, SecondBody::beside})
      families.push_back(second_time_constant(s, body));
  if (!s.telemetry->has(Output::rate)) return families;
  families.push_back(gradient(s));
  families.push_back(gradient_of_two(s));
  families.push_back(hysteresis(geometric_grid(0.02, 0.9, kRadiusRatio), true));
  families.push_back(hysteresis({{0.04, 0.2}, {0.08, 0.35}, {0.15, 0.5}, {0.3, 0.7}}, true));
  families.push_back(hysteresis({{0.03, 0.1, 0.3, 0.6}}, false));
  families.push_back(hysteresis({{0.05, 0.15, 0.3, 0.5, 0.75}}, false));
  families.push_back(exponential_hysteresis());
  return families;
}

}  // namespace hemi::diagnosis

// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/nominal_simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "golden/diagnosis/effect_family.hpp"

namespace hemi::diagnosis {

using Eigen::ArrayXd;

ArrayXd Polynomial::at(const ArrayXd& x) const {
  ArrayXd sum = ArrayXd::Zero(x.size());
  for (auto c = coefficients.rbegin(); c != coefficients.rend(); ++c) sum = sum * (x - reference) + *c;
  return sum;
}

ArrayXd Polynomial::slope(const ArrayXd& x) const {
  ArrayXd sum = ArrayXd::Zero(x.size());
  for (std::size_t i = coefficients.size(); i-- > 1;)
    sum = sum * (x - reference) + static_cast<double>(i) * coefficients[i];
  return sum;
}

Trace summed(const std::vector<Trace>& columns, const Eigen::VectorXd& coefficients) {
  Trace sum;
  for (std::size_t k = 0; k < columns.size(); ++k)
    for (const Output output : kOutputs) {
      const auto& column = columns[k][output];
      if (column.size() == 0) continue;
      if (sum[output].size() == 0) sum[output] = Eigen::VectorXd::Zero(column.size());
      sum[output] += coefficients[static_cast<Eigen::Index>(k)] * column;
    }
  return sum;
}

std::array<ArrayXd, kBiasTermCount> bias_terms(const ArrayXd& f, const ArrayXd& df) {
  return {
      ArrayXd::Ones(f.size()), f, f.square(), f.cube(), df, df.square(), df.cube(), f * df, f.square() * df,
      f * df.square()};
}

ArrayXd bias_dph(const NominalModel& model, const ArrayXd& f, const ArrayXd& df) {
  const auto terms = bias_terms(f, df);
  ArrayXd sum = ArrayXd::Zero(f.size());
  for (std::size_t i = 0; i < kBiasTermCount; ++i) sum += model.bias_dph[i] * terms[i];
  return sum;
}

namespace {

constexpr Eigen::Index kMedianRows = 15;

void fill_rate(Simulation& s) {
  const auto& b = s.model.bias_dph;
  s.nominal[Output::rate] =
      s.model.scale_factor * s.telemetry->rate_in_dph.array() + bias_dph(s.model, s.f, s.df);
  s.rate_per_f = b[1] + 2.0 * b[2] * s.f + 3.0 * b[3] * s.f.square() + b[7] * s.df + 2.0 * b[8] * s.f * s.df +
                 b[9] * s.df.square();
  s.rate_per_df = b[4] + 2.0 * b[5] * s.df + 3.0 * b[6] * s.df.square() + b[7] * s.f + b[8] * s.f.square() +
                  2.0 * b[9] * s.f * s.df;
}

// What each does is linear in its coefficients, on the run without any of them.
void add_effects(Simulation& s) {
  const auto families = effect_families(s);
  std::vector<Trace> traces;
  for (const GivenEffect& given : s.model.effects) {
    const auto family = family_of(families, given.effect, given.form);
    if (!family) continue;
    const auto& c = given.coefficients;
    if (given.shape.size() != families[*family].grid.front().size())
      throw BadEffect(fmt::format("{}: fit.shape has {} numbers, its form {}", given.effect,
                                  given.shape.size(), families[*family].grid.front().size()));
    const auto columns = families[*family].columns(s, given.shape);
    if (columns.size() != c.size())
      throw BadEffect(fmt::format("{}: fit.coefficients has {} numbers, its form {}", given.effect, c.size(),
                                  columns.size()));
    traces.push_back(summed(columns, Eigen::VectorXd::Map(c.data(), static_cast<Eigen::Index>(c.size()))));
  }
  for (const Trace& trace : traces)
    for (const Output output : kOutputs)
      if (trace[output].size() > 0) s.nominal[output] += trace[output];
}

}  // namespace

std::vector<Restart> restarts(const Telemetry& telemetry, double tau_s) {
  std::vector<Restart> list;
  const auto& powered = telemetry.powered;
  Eigen::Index begin = 0;
  for (Eigen::Index i = 0; i < powered.size(); ++i) {
    if (!powered[i]) continue;
    const Eigen::Index missing = i - begin;
    begin = i + 1;
    if (missing == 0 || missing == i) continue;
    Restart restart{i, missing, ArrayXd::Zero(powered.size())};
    // Up within the stretch, so that nothing jumps where rows go on.
    restart.fading.segment(i - missing, missing) =
        ArrayXd::LinSpaced(missing, 0.0, 1.0 - 1.0 / static_cast<double>(missing)).square();
    const Eigen::Index rows = powered.size() - i;
    restart.fading.tail(rows) =
        (-telemetry.step_s / tau_s * ArrayXd::LinSpaced(rows, 0.0, static_cast<double>(rows - 1))).exp();
    list.push_back(std::move(restart));
  }
  return list;
}

Simulation simulate(const Telemetry& telemetry, const NominalModel& model, const Unsettled& unsettled) {
  Simulation s;
  s.telemetry = &telemetry;
  s.model = model;
  s.unsettled = unsettled;
  const Eigen::Index n = telemetry.rows();
  s.time_s = ArrayXd::LinSpaced(n, 0.0, telemetry.step_s * static_cast<double>(n - 1));
  const ArrayXd case_degc = telemetry.case_degc;
  s.temperature_degc =
      lag(case_degc, telemetry.step_s, model.time_constant_s, case_degc[0] + unsettled.start_degc);
  s.board_degc = smoothed(telemetry.board_degc, telemetry.step_s, kSmoothing_s);
  s.smooth_case_degc = smoothed(telemetry.case_degc, telemetry.step_s, kSmoothing_s);
  s.smooth_degc = lag(s.smooth_case_degc, telemetry.step_s, model.time_constant_s,
                      s.smooth_case_degc[0] + unsettled.start_degc);
  const auto again = restarts(telemetry, model.time_constant_s);
  for (std::size_t k = 0; k < std::min(again.size(), unsettled.restart_degc.size()); ++k) {
    s.temperature_degc += unsettled.restart_degc[k] * again[k].fading;
    s.smooth_degc += unsettled.restart_degc[k] * again[k].fading;
  }
  s.smooth_amplitude = running_median(telemetry.amplitude, kMedianRows);
  s.smooth_f = model.frequency_hz.at(s.smooth_degc) - model.bias_reference_hz;
  const ArrayXd frequency = model.frequency_hz.at(s.temperature_degc);
  s.frequency_per_degc = model.frequency_hz.slope(s.temperature_degc);
  s.f = frequency - model.bias_reference_hz;
  s.df = slope_in_time(frequency, telemetry.step_s);
  const ArrayXd amplitude = telemetry.amplitude;
  s.nominal[Output::frequency] = frequency;
  s.nominal[Output::drive] = amplitude * model.drive_v.at(s.temperature_degc);
  s.nominal[Output::quadrature] =
      amplitude * model.quadrature_v.at(s.temperature_degc) + telemetry.trim_v.array();
  fill_rate(s);
  if (!model.effects.empty()) add_effects(s);
  return s;
}

Trace Simulation::frequency(const ArrayXd& higher) const {
  Trace trace;
  trace[Output::frequency] = higher;
  trace[Output::rate] = rate_per_f * higher + rate_per_df * slope_in_time(higher, telemetry->step_s);
  return trace;
}

Trace Simulation::thermal(const ArrayXd& warmer) const {
  const ArrayXd higher = model.frequency_hz.at(smooth_degc + warmer) - model.frequency_hz.at(smooth_degc);
  Trace trace = frequency(higher);
  const ArrayXd amplitude = telemetry->amplitude;
  trace[Output::drive] = amplitude * model.drive_v.slope(smooth_degc) * warmer;
  trace[Output::quadrature] = amplitude * model.quadrature_v.slope(smooth_degc) * warmer;
  return trace;
}

namespace {

constexpr double kDecay_s = 2000.0;
constexpr const char* kBiasNames[kBiasTermCount] = {"1",    "f",    "f^2",  "f^3",    "df",
                                                    "df^2", "df^3", "f*df", "f^2*df", "f*df^2"};

ArrayXd power(const ArrayXd& x, std::size_t exponent) {
  ArrayXd value = ArrayXd::Ones(x.size());
  for (std::size_t i = 0; i < exponent; ++i) value *= x;
  return value;
}

void add_polynomial(std::vector<BaselineColumn>& columns, const Simulation& s, Output output,
                    const Polynomial& polynomial, const char* name) {
  if (!s.telemetry->has(output)) return;
  // Over a case that stands still only start temperature times slope shows in the frequency, and the slope is
  // the better known of the two; the drive and the quadrature then show theirs.
  const std::size_t few = output == Output::frequency ? 1 : 2;
  const std::size_t terms =
      span(s.smooth_case_degc) < kLeastSwing_degc ? few : polynomial.coefficients.size();
  for (std::size_t i = 0; i < std::min(terms, polynomial.coefficients.size()); ++i) {
    ArrayXd column = power(s.smooth_degc - polynomial.reference, i);
    if (output != Output::frequency) column *= s.telemetry->amplitude.array();
    BaselineColumn entry;
    entry.name = fmt::format("{}[{}]", name, i);
    entry.trace[output] = column;
    columns.push_back(std::move(entry));
  }
}

void add_start(std::vector<BaselineColumn>& columns, const Simulation& s) {
  columns.push_back(
      {.name = "start", .trace = s.thermal((-s.time_s / s.model.time_constant_s).exp()), .nuisance = true});
}

// How far x strays on average from the straight line over stretches of this many rows, rms over the
// recording.
double straying(const ArrayXd& x, Eigen::Index rows) {
  double squares = 0.0;
  Eigen::Index count = 0;
  const Eigen::Index step = std::max<Eigen::Index>(1, rows / 4);
  for (Eigen::Index begin = 0; begin + rows < x.size(); begin += step, ++count)
    squares += std::pow(x.segment(begin, rows + 1).mean() - 0.5 * (x[begin] + x[begin + rows]), 2);
  return count == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(count));
}

// The case's way through a stretch without rows is not known, nor then where the resonator is after it.
void add_restarts(std::vector<BaselineColumn>& columns, const Simulation& s) {
  const double tau = s.model.time_constant_s;
  for (const Restart& restart : restarts(*s.telemetry, tau)) {
    const double share = -std::expm1(-s.telemetry->step_s * static_cast<double>(restart.missing) / tau);
    columns.push_back({.name = "restart",
                       .trace = s.thermal(restart.fading),
                       .prior_sd = std::max(1e-4, share * straying(s.smooth_case_degc, restart.missing)),
                       .nuisance = true});
  }
}

void add_thermal(std::vector<BaselineColumn>& columns, const Simulation& s) {
  const double tau = s.model.time_constant_s;
  const ArrayXd settled =
      lag(s.smooth_case_degc, s.telemetry->step_s, tau, s.smooth_case_degc[0] + s.unsettled.start_degc);
  // A thousandth of tau: the difference quotient is exact to 1e-3 of itself, and Gauss-Newton repeats.
  const ArrayXd later = lag(s.smooth_case_degc, s.telemetry->step_s, tau * 1.001,
                            s.smooth_case_degc[0] + s.unsettled.start_degc);
  columns.push_back({.name = "thermal.time_constant_s", .trace = s.thermal((later - settled) / 0.001)});
  columns.push_back(
      {.name = "lag",
       .trace = s.thermal(-s.telemetry->step_s * slope_in_time(s.smooth_degc, s.telemetry->step_s)),
       .prior_sd = 0.5,
       .nuisance = true});
}

// A resonator whose frequency moves keeps its action, energy over frequency: at constant amplitude the drive
// makes good 1/tau_d + f'/(2 f), tau_d the amplitude's time constant, of which the model says nothing.
// Source: Landau and Lifshitz, Mechanics, section 49.
void add_decay(std::vector<BaselineColumn>& columns, const Simulation& s) {
  const ArrayXd growth = 0.5 * slope_in_time(s.smooth_f, s.telemetry->step_s) / s.model.bias_reference_hz;
  BaselineColumn entry{.name = "decay", .trace = {}, .prior_sd = kDecay_s, .nuisance = true};
  entry.trace[Output::drive] = s.telemetry->amplitude.array() * s.model.drive_v.at(s.smooth_degc) * growth;
  columns.push_back(std::move(entry));
}

}  // namespace

std::vector<BaselineColumn> baseline_columns(const Simulation& s) {
  std::vector<BaselineColumn> columns;
  add_polynomial(columns, s, Output::frequency, s.model.frequency_hz, "frequency.coefficients_hz");
  const double swing = span(s.smooth_case_degc);
  // A resonator that has not settled shows its start at any temperature, its time constant at none.
  if (s.telemetry->has_case && s.model.time_constant_s > 0.0) add_start(columns, s);
  if (s.telemetry->has_case && swing > kLeastSwing_degc) add_thermal(columns, s);
  if (s.telemetry->has_case && s.model.time_constant_s > 0.0) add_restarts(columns, s);
  if (s.telemetry->has(Output::rate)) {
    const auto terms = bias_terms(s.smooth_f, slope_in_time(s.smooth_f, s.telemetry->step_s));
    for (std::size_t i = 0; i < kBiasTermCount; ++i) {
      if (swing < kLeastSwing_degc && i != 0 && i != 1 && i != 4) continue;  // 1, f, df
      BaselineColumn entry{.name = fmt::format("bias.terms_dph.{}", kBiasNames[i]), .trace = {}};
      entry.trace[Output::rate] = terms[i];
      columns.push_back(std::move(entry));
    }
    BaselineColumn scale{.name = "scale_factor", .trace = {}};
    scale.trace[Output::rate] = s.telemetry->rate_in_dph;
    if (s.telemetry->rate_in_dph.maxCoeff() > s.telemetry->rate_in_dph.minCoeff())
      columns.push_back(std::move(scale));
  }
  add_polynomial(columns, s, Output::drive, s.model.drive_v, "drive.coefficients_v");
  if (s.telemetry->has(Output::drive) && swing > kLeastSwing_degc) add_decay(columns, s);
  add_polynomial(columns, s, Output::quadrature, s.model.quadrature_v, "quadrature.coefficients_v");
  return columns;
}

namespace {

// The value itself; nullptr for a nuisance.
double* place_of(NominalModel& model, const std::string& name) {
  const auto inside = [&](Polynomial& polynomial) {
    return &polynomial.coefficients[std::stoul(name.substr(name.find('[') + 1))];
  };
  if (name.starts_with("frequency.")) return inside(model.frequency_hz);
  if (name.starts_with("drive.")) return inside(model.drive_v);
  if (name.starts_with("quadrature.")) return inside(model.quadrature_v);
  if (name == "thermal.time_constant_s") return &model.time_constant_s;
  if (name == "scale_factor") return &model.scale_factor;
  for (std::size_t k = 0; k < kBiasTermCount; ++k)
    if (name == fmt::format("bias.terms_dph.{}", kBiasNames[k])) return &model.bias_dph[k];
  return nullptr;
}

}  // namespace

double parameter(const NominalModel& model, const std::string& name) {
  NominalModel copy = model;
  const double* value = place_of(copy, name);
  return value == nullptr ? 0.0 : *value;
}

void move_parameters(const std::vector<BaselineColumn>& columns, const Eigen::VectorXd& steps,
                     NominalModel& model, Unsettled& unsettled) {
  std::size_t restart = 0;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const double step = steps[static_cast<Eigen::Index>(i)];
    if (columns[i].name == "start") unsettled.start_degc += step;
    if (columns[i].name == "restart") {
      if (unsettled.restart_degc.size() <= restart) unsettled.restart_degc.push_back(0.0);
      unsettled.restart_degc[restart++] += step;
    }
    double* value = place_of(model, columns[i].name);
    if (value == nullptr) continue;
    // The time constant's column is per unit of its logarithm; half of that at most in one step.
    if (value == &model.time_constant_s)
      *value *= std::exp(std::clamp(step, -0.5, 0.5));
    else
      *value += step;
  }
}

}  // namespace hemi::diagnosis

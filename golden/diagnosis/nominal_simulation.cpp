// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/nominal_simulation.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

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

ArrayXd lag(const ArrayXd& x, double step_s, double tau_s, double start) {
  if (tau_s <= 0.0) return x;
  const double gain = -std::expm1(-step_s / tau_s);
  ArrayXd y(x.size());
  double state = start;
  if (x.size() > 0) y[0] = state;
  for (Eigen::Index i = 1; i < x.size(); ++i) y[i] = state += gain * (x[i] - state);
  return y;
}

double span(const ArrayXd& x) {
  return x.size() == 0 ? 0.0 : x.maxCoeff() - x.minCoeff();
}

ArrayXd slope_in_time(const ArrayXd& x, double step_s) {
  const Eigen::Index n = x.size();
  ArrayXd slope = ArrayXd::Zero(n);
  if (n < 2) return slope;
  slope.segment(1, n - 2) = (x.tail(n - 2) - x.head(n - 2)) / (2.0 * step_s);
  slope[0] = (x[1] - x[0]) / step_s;
  slope[n - 1] = (x[n - 1] - x[n - 2]) / step_s;
  return slope;
}

ArrayXd smoothed(const ArrayXd& x, double step_s, double half_width_s) {
  const auto half = std::min(static_cast<Eigen::Index>(half_width_s / step_s), (x.size() - 1) / 2);
  if (half < 2) return x;
  const Eigen::Index width = 2 * half + 1;
  const ArrayXd u = ArrayXd::LinSpaced(width, -1.0, 1.0);
  Eigen::MatrixXd powers(width, 4);
  for (Eigen::Index i = 0; i < 4; ++i) powers.col(i) = u.pow(static_cast<double>(i));
  const Eigen::MatrixXd fit = powers.householderQr().solve(Eigen::MatrixXd::Identity(width, width));
  const Eigen::VectorXd centre = fit.row(0);
  ArrayXd y(x.size());
  for (Eigen::Index i = half; i + half < x.size(); ++i)
    y[i] = centre.dot(x.segment(i - half, width).matrix());
  y.head(half) = (powers * (fit * x.head(width).matrix())).head(half);
  y.tail(half) = (powers * (fit * x.tail(width).matrix())).tail(half);
  return y;
}

std::array<ArrayXd, kBiasTermCount> bias_terms(const ArrayXd& f, const ArrayXd& df) {
  return {
      ArrayXd::Ones(f.size()), f, f.square(), f.cube(), df, df.square(), df.cube(), f * df, f.square() * df,
      f * df.square()};
}

namespace {

void fill_rate(Simulation& s) {
  const auto& b = s.model.bias_dph;
  const auto terms = bias_terms(s.f, s.df);
  ArrayXd rate = s.model.scale_factor * s.telemetry->rate_in_dph.array();
  for (std::size_t i = 0; i < kBiasTermCount; ++i)
    if (b[i] != 0.0) rate += b[i] * terms[i];
  s.nominal[Output::rate] = rate;
  s.rate_per_f = b[1] + 2.0 * b[2] * s.f + 3.0 * b[3] * s.f.square() + b[7] * s.df + 2.0 * b[8] * s.f * s.df +
                 b[9] * s.df.square();
  s.rate_per_df = b[4] + 2.0 * b[5] * s.df + 3.0 * b[6] * s.df.square() + b[7] * s.f + b[8] * s.f.square() +
                  2.0 * b[9] * s.f * s.df;
}

}  // namespace

Simulation simulate(const Telemetry& telemetry, const NominalModel& model, double start_degc) {
  Simulation s;
  s.telemetry = &telemetry;
  s.model = model;
  s.start_degc = start_degc;
  const Eigen::Index n = telemetry.rows();
  s.time_s = ArrayXd::LinSpaced(n, 0.0, telemetry.step_s * static_cast<double>(n - 1));
  const ArrayXd case_degc = telemetry.case_degc;
  s.temperature_degc = lag(case_degc, telemetry.step_s, model.time_constant_s, case_degc[0] + start_degc);
  s.board_degc = smoothed(telemetry.board_degc, telemetry.step_s, kSmoothing_s);
  s.smooth_case_degc = smoothed(telemetry.case_degc, telemetry.step_s, kSmoothing_s);
  s.smooth_degc =
      lag(s.smooth_case_degc, telemetry.step_s, model.time_constant_s, s.smooth_case_degc[0] + start_degc);
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

// Below this the bias model's terms but the constant one are noise of the thermometer.
constexpr double kLeastSwing_degc = 1.0;
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
  // At one temperature nothing but the constant can be told.
  const std::size_t terms = span(s.smooth_case_degc) < kLeastSwing_degc ? 1 : polynomial.coefficients.size();
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

void add_thermal(std::vector<BaselineColumn>& columns, const Simulation& s) {
  const double tau = s.model.time_constant_s;
  // A thousandth of tau: the difference quotient is exact to 1e-3 of itself, and Gauss-Newton repeats.
  const ArrayXd later =
      lag(s.smooth_case_degc, s.telemetry->step_s, tau * 1.001, s.smooth_case_degc[0] + s.start_degc);
  columns.push_back({.name = "thermal.time_constant_s", .trace = s.thermal((later - s.smooth_degc) / 0.001)});
  columns.push_back(
      {.name = "lag",
       .trace = s.thermal(-s.telemetry->step_s * slope_in_time(s.smooth_degc, s.telemetry->step_s)),
       .prior_sd = 0.5,
       .nuisance = true});
}

}  // namespace

std::vector<BaselineColumn> baseline_columns(const Simulation& s) {
  std::vector<BaselineColumn> columns;
  add_polynomial(columns, s, Output::frequency, s.model.frequency_hz, "frequency.coefficients_hz");
  const double swing = span(s.smooth_case_degc);
  // A resonator that has not settled shows its start at any temperature, its time constant at none.
  if (s.telemetry->has_case && s.model.time_constant_s > 0.0) add_start(columns, s);
  if (s.telemetry->has_case && swing > kLeastSwing_degc) add_thermal(columns, s);
  if (s.telemetry->has(Output::rate)) {
    const auto terms = bias_terms(s.smooth_f, slope_in_time(s.smooth_f, s.telemetry->step_s));
    for (std::size_t i = 0; i < kBiasTermCount; ++i) {
      if (i > 0 && swing < kLeastSwing_degc) break;
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
                     NominalModel& model, double& start_degc) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const double step = steps[static_cast<Eigen::Index>(i)];
    if (columns[i].name == "start") start_degc += step;
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

// SPDX-License-Identifier: Apache-2.0
#include "golden/rivals/library.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hemi::rivals {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The format's own recursion.
ArrayXd behind(const ArrayXd& input, const ArrayXd& time_s, double tau_s, double start) {
  ArrayXd output(input.size());
  output[0] = start;
  for (Index i = 1; i < input.size(); ++i)
    output[i] = output[i - 1] - std::expm1(-(time_s[i] - time_s[i - 1]) / tau_s) * (input[i] - output[i - 1]);
  return output;
}

ArrayXd power_sum(const std::vector<double>& coefficients, const ArrayXd& x) {
  ArrayXd sum = ArrayXd::Zero(x.size());
  for (std::size_t k = 0; k < coefficients.size(); ++k)
    sum += coefficients[k] * x.pow(static_cast<double>(k));
  return sum;
}

ArrayXd slope(const ArrayXd& values, const ArrayXd& time_s) {
  ArrayXd d(values.size());
  for (Index i = 0; i < values.size(); ++i) {
    const Index low = std::max<Index>(i - 1, 0), high = std::min<Index>(i + 1, values.size() - 1);
    d[i] = (values[high] - values[low]) / (time_s[high] - time_s[low]);
  }
  return d;
}

ArrayXd play(const ArrayXd& input, double radius) {
  ArrayXd output(input.size());
  double state = input[0];
  for (Index i = 0; i < input.size(); ++i)
    output[i] = state = std::clamp(state, input[i] - radius, input[i] + radius);
  return output;
}

/// Missing cells of an input hold the last value.
ArrayXd filled(const VectorXd& values, Index rows, double fallback) {
  if (values.size() == 0) return ArrayXd::Constant(rows, fallback);
  ArrayXd result = values.array();
  double last = fallback;
  for (double& value : result) last = value = std::isnan(value) ? last : value;
  return result;
}

/// All series that the library is built from, at the recording's own rate.
struct Signals {
  ArrayXd t, c, b, w, a, v, trim, amplitude, q, d, shell, slow, fast, start, tau, f, df, f_slope;
  bool board, accel, supply, turning, steps, trimmed;
};

bool varies(const ArrayXd& values) {
  return values.maxCoeff() - values.minCoeff() > 1e-3 * (1.0 + values.abs().maxCoeff());
}

Signals signals(const Telemetry& in, const Numbers& model) {
  Signals s;
  const Index n = in.time_s.size();
  s.t = in.time_s.array() - in.time_s[0];
  s.c = filled(in.case_degc, n, 20.0);
  s.b = filled(in.board_degc, n, 25.0);
  s.w = filled(in.rate_in_dph, n, 0.0);
  s.a = filled(in.accel_g, n, 0.0);
  s.v = filled(in.supply_v, n, 1.0);
  s.trim = filled(in.trim_v, n, 0.0);
  s.amplitude = filled(in.amplitude, n, 1.0);
  s.q = filled(in.quadrature_v, n, 0.0);
  s.d = filled(in.drive_v, n, 0.0);
  const double tau_s = model.time_constant_s;
  s.shell = behind(s.c, s.t, tau_s, s.c[0]);
  s.tau = (behind(s.c, s.t, 1.01 * tau_s, s.c[0]) - s.shell) / (0.01 * tau_s);
  s.start = (-s.t / tau_s).exp();
  s.fast = behind(s.shell, s.t, 300.0, s.shell[0]) - s.shell;
  s.slow = behind(s.c, s.t, 7200.0, s.c[0]) - s.shell;
  const ArrayXd warm = s.shell - model.frequency_reference_degc;
  const ArrayXd frequency = power_sum(model.frequency_hz, warm);
  s.f = frequency - model.bias_reference_hz;
  s.df = slope(frequency, s.t);
  s.f_slope = ArrayXd::Zero(n);
  for (std::size_t k = 1; k < model.frequency_hz.size(); ++k)
    s.f_slope += static_cast<double>(k) * model.frequency_hz[k] * warm.pow(static_cast<double>(k) - 1.0);
  s.board = in.board_degc.size() > 0;
  s.accel = varies(s.a);
  s.supply = varies(s.v);
  s.turning = varies(s.w);
  s.steps = s.amplitude.maxCoeff() - s.amplitude.minCoeff() > 0.01;
  s.trimmed = varies(s.trim);
  return s;
}

using Columns = std::vector<ArrayXd>;

MatrixXd matrix(const Columns& columns, const std::vector<std::vector<Index>>& groups) {
  MatrixXd result(static_cast<Index>(groups.size()), static_cast<Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    for (std::size_t g = 0; g < groups.size(); ++g) {
      double sum = 0.0;
      for (const Index i : groups[g]) sum += columns[k][i];
      result(static_cast<Index>(g), static_cast<Index>(k)) = sum / static_cast<double>(groups[g].size());
    }
  }
  return result;
}

struct Raw {
  std::string channel;
  ArrayXd misfit;
  Columns base;
  std::vector<std::pair<std::string, Columns>> candidates;
};

Raw frequency_problem(const Telemetry& in, const Numbers& model, const Signals& s) {
  const ArrayXd x = (s.shell - model.frequency_reference_degc) / 30.0;
  Raw raw{"frequency_hz", in.frequency_hz.array() - (s.f + model.bias_reference_hz), {}, {}};
  for (std::size_t k = 0; k < model.frequency_hz.size(); ++k)
    raw.base.push_back(x.pow(static_cast<double>(k)));
  raw.base.push_back(s.f_slope * s.tau);
  raw.base.push_back(s.f_slope * s.start);
  raw.base.push_back(s.df);
  const double order = static_cast<double>(model.frequency_hz.size());
  raw.candidates = {{"frequency_polynomial_order", {x.pow(order)}},
                    {"frequency_ageing", {(1.0 + s.t / 3600.0).log()}},
                    {"oscillator_ageing", {s.t / 1e4}},
                    {"self_heating", {s.f_slope * (1.0 - (-s.t / 1200.0).exp())}},
                    {"thermal_second_time_constant", {s.f_slope * s.fast, s.f_slope * s.slow}}};
  if (s.board) {
    const ArrayXd y = (s.b - 25.0) / 30.0;
    raw.candidates.push_back({"oscillator_temperature", {y, y.square(), y.cube()}});
  }
  if (s.steps) raw.candidates.push_back({"duffing", {s.amplitude.square()}});
  if (s.supply)
    raw.candidates.push_back({"electrostatic_softening", {s.v.square() / s.v.square().mean() - 1.0}});
  return raw;
}

Raw drive_problem(const Telemetry& in, const Numbers& model, const Signals& s) {
  const ArrayXd x = (s.shell - model.drive_reference_degc) / 30.0;
  Raw raw{"drive_v",
          in.drive_v.array() - s.amplitude * power_sum(model.drive_v, s.shell - model.drive_reference_degc),
          {},
          {}};
  const double order = static_cast<double>(model.drive_v.size());
  for (std::size_t k = 0; k < model.drive_v.size(); ++k)
    raw.base.push_back(s.amplitude * x.pow(static_cast<double>(k)));
  raw.base.push_back(s.amplitude * s.tau);
  raw.candidates = {{"gas_leak", {s.amplitude * s.t / 1e4}},
                    {"damping_temperature", {s.amplitude * x.pow(order), s.amplitude * x.pow(order + 1.0)}}};
  if (s.board) raw.candidates.push_back({"pickoff_gain", {s.amplitude * (s.b - 25.0) / 30.0}});
  if (s.steps) raw.candidates.push_back({"damping_nonlinearity", {s.amplitude.cube()}});
  return raw;
}

Raw quadrature_problem(const Telemetry& in, const Numbers& model, const Signals& s) {
  const ArrayXd x = (s.shell - model.quadrature_reference_degc) / 30.0;
  const ArrayXd nominal =
      s.amplitude * power_sum(model.quadrature_v, s.shell - model.quadrature_reference_degc);
  Raw raw{"quadrature_v", in.quadrature_v.array() - nominal - s.trim, {}, {}};
  const double order = static_cast<double>(model.quadrature_v.size());
  for (std::size_t k = 0; k < model.quadrature_v.size(); ++k)
    raw.base.push_back(s.amplitude * x.pow(static_cast<double>(k)));
  raw.base.push_back(s.amplitude * s.tau);
  raw.candidates = {{"frequency_split", {x.pow(order), x.pow(order + 1.0)}}};
  return raw;
}

Raw rate_problem(const Telemetry& in, const Numbers& model, const Signals& s) {
  const ArrayXd f = s.f / 10.0, d = s.df / 3e-3;
  const Columns terms{
      ArrayXd::Ones(f.size()), f, f.square(), f.cube(), d, d.square(), d.cube(), f * d, f.square() * d,
      f * d.square()};
  const std::array<double, 10> units{1.0, 10.0, 100.0, 1000.0, 3e-3, 9e-6, 2.7e-8, 3e-2, 3e-1, 9e-5};
  ArrayXd nominal = model.scale_factor * s.w;
  for (std::size_t k = 0; k < 10; ++k) nominal += model.bias_dph[k] * units[k] * terms[k];
  Raw raw{"rate_dph", in.rate_dph.array() - nominal, terms, {}};
  if (s.turning) raw.base.push_back(s.w / 1e5);
  const double span = std::max(s.shell.maxCoeff() - s.shell.minCoeff(), 1e-3);
  raw.candidates = {{"thermal_gradient_bias", {s.c - behind(s.c, s.t, 300.0, s.c[0])}},
                    {"thermal_hysteresis", {play(s.shell, 0.05 * span), play(s.shell, 0.2 * span)}},
                    {"rate_random_walk", {s.t / 1e4, (s.t / 1e4).square(), (s.t / 1e4).cube()}}};
  if (s.trimmed) raw.candidates.push_back({"demodulation_phase", {s.q}});
  if (s.steps) raw.candidates.push_back({"forcer_misalignment", {s.d * s.amplitude}});
  if (s.accel) raw.candidates.push_back({"g_sensitivity", {s.a}});
  if (s.turning) {
    raw.candidates.push_back({"scale_factor_temperature", {s.w / 1e5 * (s.shell - 20.0)}});
    raw.candidates.push_back({"scale_factor_nonlinearity", {(s.w / 1e5).cube()}});
    raw.candidates.push_back({"time_shift", {slope(s.w / 1e5, s.t)}});
    if (s.board) raw.candidates.push_back({"pickoff_gain", {s.w / 1e5 * (s.b - 25.0)}});
  }
  return raw;
}

/// Averages over `average` rows that hold a value; groups without any are left out.
Problem averaged(const Raw& raw, const Signals& s, int average) {
  std::vector<std::vector<Index>> groups;
  for (Index from = 0; from + average <= raw.misfit.size(); from += average) {
    std::vector<Index> rows;
    for (Index i = from; i < from + average; ++i)
      if (std::isfinite(raw.misfit[i])) rows.push_back(i);
    if (!rows.empty()) groups.push_back(std::move(rows));
  }
  Problem problem;
  problem.channel = raw.channel;
  problem.misfit = matrix({raw.misfit}, groups).col(0);
  problem.base = matrix(raw.base, groups);
  for (const auto& [id, columns] : raw.candidates)
    problem.candidates.push_back({id, matrix(columns, groups)});
  problem.inputs = matrix({s.shell, slope(s.shell, s.t), s.t, s.b, s.amplitude, s.v, s.w, s.a, s.q}, groups);
  return problem;
}

}  // namespace

std::vector<Problem> problems(const Telemetry& in, const Numbers& numbers, int average) {
  if (in.time_s.size() < 2 || in.case_degc.size() != in.time_s.size())
    throw std::invalid_argument("the comparison needs time_s and case_temp_degc");
  const Signals s = signals(in, numbers);
  std::vector<Problem> all;
  if (in.frequency_hz.size() > 0) all.push_back(averaged(frequency_problem(in, numbers, s), s, average));
  if (in.drive_v.size() > 0) all.push_back(averaged(drive_problem(in, numbers, s), s, average));
  if (in.quadrature_v.size() > 0) all.push_back(averaged(quadrature_problem(in, numbers, s), s, average));
  if (in.rate_dph.size() > 0) all.push_back(averaged(rate_problem(in, numbers, s), s, average));
  if (all.empty()) throw std::invalid_argument("the comparison needs an output of the gyro");
  return all;
}

}  // namespace hemi::rivals

// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/unexplained.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "golden/calibration/autoregressive_noise.hpp"

namespace hemi::diagnosis {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kMostNodes = 64;
constexpr double kMemories_s[] = {300.0, 900.0, 2700.0};

struct Variable {
  std::string name;
  ArrayXd values;
  Index most_nodes = kMostNodes;
};

std::vector<Variable> variables_of(const Simulation& s) {
  const Telemetry& t = *s.telemetry;
  std::vector<Variable> list;
  const auto add = [&](const char* name, const ArrayXd& values, Index most_nodes = kMostNodes) {
    if (span(values) > 1e-9 * (1.0 + values.abs().maxCoeff())) list.push_back({name, values, most_nodes});
  };
  add("time_s", s.time_s);
  // A thermometer that shows nothing but its noise orders the noise that it makes itself.
  if (span(s.smooth_case_degc) > kLeastSwing_degc) {
    add("resonator_temp_degc", s.smooth_degc, 2 * kMostNodes);  // fringes of light in a gap stand close
    add("resonator_temp_slope_degc_s", slope_in_time(s.smooth_degc, t.step_s));
    add("case_temp_degc", s.smooth_case_degc);
  }
  if (t.has_board) add("board_temp_degc", s.board_degc);
  add("rate_in_dph", t.rate_in_dph);
  if (t.has_accel) add("accel_g", t.accel_g);
  if (t.has_supply) add("supply_v", t.supply_v);
  add("quadrature_trim_v", t.trim_v);
  if (moves(t.amplitude, 1e-3)) add("amplitude", t.amplitude);
  // What is past may act on: both the signed and the squared rate, behind one lag.
  if (moves(t.rate_in_dph, 1.0))
    for (const double tau_s : kMemories_s) {
      const ArrayXd rate = t.rate_in_dph.array() / kFullRate_dph;
      const auto name = [&](const char* of) { return fmt::format("{} behind {:.0f} s", of, tau_s); };
      list.push_back({name("rate_in_dph"), lag(rate, t.step_s, tau_s, rate[0])});
      list.push_back({name("rate_in_dph squared"), lag(rate.square(), t.step_s, tau_s, rate[0] * rate[0])});
    }
  return list;
}

// Hat functions on nodes equally spaced between the extremes.
Reduced hats(const RowSpace& space, const ArrayXd& x, Index nodes, Output output) {
  const double low = x.minCoeff(), step = span(x) / static_cast<double>(nodes - 1);
  std::vector<Trace> traces(static_cast<std::size_t>(nodes));
  for (auto& trace : traces) trace[output] = VectorXd::Zero(x.size());
  for (Index i = 0; i < x.size(); ++i) {
    const double place = std::clamp((x[i] - low) / step, 0.0, static_cast<double>(nodes - 1));
    const auto left = std::min(static_cast<Index>(place), nodes - 2);
    traces[static_cast<std::size_t>(left)][output][i] = static_cast<double>(left + 1) - place;
    traces[static_cast<std::size_t>(left + 1)][output][i] = place - static_cast<double>(left);
  }
  std::vector<const Trace*> list;
  list.reserve(traces.size());
  for (const auto& trace : traces) list.push_back(&trace);
  return space.reduce(list);
}

// One output alone: least squares of y on x with autoregressive noise; -2 log likelihood and the fit.
struct Alone {
  double minus_two_log = std::numeric_limits<double>::infinity();
  VectorXd coefficients, half_width;
};

Alone fit_alone(const MatrixXd& x, const VectorXd& y, const std::vector<calibration::RowRange>& segments,
                const VectorXd& partial) {
  MatrixXd z(x.rows(), x.cols() + 1);
  z << x, y;
  const MatrixXd white = calibration::whiten(z, segments, partial);
  const VectorXd size = white.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
  const MatrixXd products = size.asDiagonal() * (white.transpose() * white) * size.asDiagonal();
  const Index n = x.cols();
  MatrixXd normal = products.topLeftCorner(n, n);
  normal.diagonal().array() += 1e-9;
  const Eigen::LDLT<MatrixXd> solver(normal);
  Alone result;
  const VectorXd scaled = solver.solve(products.col(n).head(n));
  const double squares = std::max(products(n, n) - scaled.dot(products.col(n).head(n)), 1e-12);
  const auto rows = static_cast<double>(y.size());
  result.coefficients = (size.head(n).array() * scaled.array() / size[n]).matrix();
  const double variance = squares / (size[n] * size[n]) / rows;
  result.half_width = (1.96 * std::sqrt(variance) * size.head(n).array() *
                       solver.solve(MatrixXd::Identity(n, n)).diagonal().array().max(0.0).sqrt())
                          .matrix();
  result.minus_two_log = rows * std::log(variance);
  for (Index k = 0; k < partial.size(); ++k)
    result.minus_two_log -= static_cast<double>(k + 1) * std::log1p(-partial[k] * partial[k]);
  return result;
}

// The remainder's own noise: what is left when the free function is taken away, by Burg's recursion on the
// residual (order by BIC).
VectorXd burg(const VectorXd& e, Index most) {
  VectorXd forward = e, backward = e, partial(most);
  double power = e.squaredNorm() / static_cast<double>(e.size());
  const auto rows = static_cast<double>(e.size());
  double best = rows * std::log(power);
  Index order = 0;
  for (Index k = 0; k < most; ++k) {
    const Index n = forward.size() - 1;
    const VectorXd f = forward.tail(n), b = backward.head(n);
    partial[k] = std::clamp(2.0 * f.dot(b) / (f.squaredNorm() + b.squaredNorm()), -0.9999, 0.9999);
    forward = f - partial[k] * b;
    backward = b - partial[k] * f;
    power *= 1.0 - partial[k] * partial[k];
    const double score = rows * std::log(power) + static_cast<double>(k + 1) * std::log(rows);
    if (score < best) {
      best = score;
      order = k + 1;
    }
  }
  return partial.head(order);
}

Alone with_own_noise(const MatrixXd& x, const VectorXd& y, const std::vector<calibration::RowRange>& segments,
                     double rows_price) {
  VectorXd partial;
  Alone result;
  for (int round = 0; round < 3; ++round) {
    result = fit_alone(x, y, segments, partial);
    result.minus_two_log += rows_price * static_cast<double>(partial.size());
    if (round < 2) partial = burg(y - x * result.coefficients, 8);
  }
  return result;
}

// What free functions of one output are tried beside.
struct Beside {
  const RowSpace& space;
  const MatrixXd& own;
  const VectorXd& y;
  const std::vector<calibration::RowRange>& segments;
  double price;
  double minus_two_log;  // without any
};

void try_along(const Variable& variable, Index nodes, const Beside& beside, Remainder& best) {
  const Reduced free = hats(beside.space, variable.values, nodes, best.output);
  const MatrixXd& columns = free[place(best.output)];
  std::vector<Index> used;
  for (Index j = 0; j < nodes; ++j)
    if (columns.col(j).squaredNorm() > 0.0) used.push_back(j);
  const auto count = static_cast<Index>(used.size());
  MatrixXd x(beside.own.rows(), beside.own.cols() + count);
  x << beside.own, columns(Eigen::all, used);
  const Alone with = with_own_noise(x, beside.y, beside.segments, beside.price);
  const double evidence =
      beside.minus_two_log - with.minus_two_log - beside.price * static_cast<double>(count);
  if (evidence <= best.evidence) return;
  best.evidence = evidence;
  best.variable = variable.name;
  best.value = with.coefficients.tail(count);
  best.half_width = with.half_width.tail(count);
  best.fitted = x.rightCols(count) * best.value;
  best.at.resize(count);
  for (Index j = 0; j < count; ++j)
    best.at[j] = variable.values.minCoeff() + span(variable.values) *
                                                  static_cast<double>(used[static_cast<std::size_t>(j)]) /
                                                  static_cast<double>(nodes - 1);
}

std::vector<calibration::RowRange> segments_of(const std::vector<Index>& blocks) {
  std::vector<calibration::RowRange> segments;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (i == 0 || blocks[i] != blocks[i - 1] + 1) segments.push_back({static_cast<Index>(i), 0});
    ++segments.back().count;
  }
  return segments;
}

}  // namespace

std::vector<Remainder> remainders(Hypotheses& hypotheses, const std::vector<Member>& members,
                                  double threshold) {
  std::vector<Remainder> list;
  const RowSpace& space = hypotheses.space();
  const Reduced design = hypotheses.design(members);
  const auto variables = variables_of(hypotheses.simulation());
  for (const Output output : kOutputs) {
    const std::size_t c = place(output);
    if (space.rows(output) < 64) continue;
    std::vector<Index> acting;
    for (Index j = 0; j < design[c].cols(); ++j)
      if (design[c].col(j).squaredNorm() > 0.0) acting.push_back(j);
    const MatrixXd own = design[c](Eigen::all, acting);
    const VectorXd y = hypotheses.data()[c];
    const double price = std::log(static_cast<double>(y.size()));
    const auto segments = segments_of(space.blocks(output));
    const Alone without = with_own_noise(own, y, segments, price);
    Remainder in_time, of_input;
    for (Remainder* each : {&in_time, &of_input}) {
      each->output = output;
      each->evidence = threshold;
    }
    for (const auto& variable : variables)
      for (Index nodes = 8; nodes <= variable.most_nodes; nodes *= 2)
        try_along(variable, nodes, {space, own, y, segments, price, without.minus_two_log},
                  variable.name == "time_s" ? in_time : of_input);
    for (Remainder* each : {&of_input, &in_time})
      if (!each->variable.empty()) list.push_back(std::move(*each));
  }
  return list;
}

Eigen::VectorXd along_rows(const Simulation& simulation, const Remainder& remainder) {
  for (const auto& variable : variables_of(simulation)) {
    if (variable.name != remainder.variable) continue;
    VectorXd values(variable.values.size());
    const Index last = remainder.at.size() - 1;
    Index node = 0;
    for (Index i = 0; i < values.size(); ++i) {
      const double x = std::clamp(variable.values[i], remainder.at[0], remainder.at[last]);
      while (node > 0 && x < remainder.at[node]) --node;
      while (node + 1 < last && x > remainder.at[node + 1]) ++node;
      const double share = (x - remainder.at[node]) / (remainder.at[node + 1] - remainder.at[node]);
      values[i] = (1.0 - share) * remainder.value[node] + share * remainder.value[node + 1];
    }
    return values;
  }
  return VectorXd::Zero(simulation.time_s.size());
}

}  // namespace hemi::diagnosis

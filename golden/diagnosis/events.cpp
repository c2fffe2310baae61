// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/events.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hemi::diagnosis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
constexpr double kOutstanding = 20.0;
constexpr double kWhole = 0.1;
constexpr Index kNeighbours = 4;

// What stands out of the median of the rows around.
VectorXd standing_out(const VectorXd& e) {
  VectorXd out = VectorXd::Constant(e.size(), std::numeric_limits<double>::quiet_NaN());
  for (Index i = 0; i < e.size(); ++i) {
    std::vector<double> around;
    for (Index k = std::max<Index>(0, i - kNeighbours); k <= std::min(e.size() - 1, i + kNeighbours); ++k)
      if (k != i && !std::isnan(e[k])) around.push_back(e[k]);
    if (!around.empty() && !std::isnan(e[i])) out[i] = e[i] - median(std::move(around));
  }
  return out;
}

double deviation(const VectorXd& values) {
  std::vector<double> present;
  for (const double v : values)
    if (!std::isnan(v)) present.push_back(v);
  return robust_deviation(std::move(present));
}

bool repeats_before(const Telemetry& t, Index i) {
  int equal = 0;
  for (const Output output : kOutputs) {
    if (!t.has(output)) continue;
    const double now = t[output][i], before = t[output][i - 1];
    if (std::isnan(now) || std::isnan(before) || now != before) return false;
    ++equal;
  }
  return equal >= 2;
}

}  // namespace

Events find_events(const Telemetry& t, const Simulation& simulation) {
  Events events;
  for (Index i = 1; i < t.rows(); ++i)
    if (repeats_before(t, i)) events.repeats.push_back(i);
  if (!t.has(Output::frequency)) return events;
  const VectorXd out = standing_out(t[Output::frequency] - simulation.nominal[Output::frequency]);
  const double noise = deviation(out);
  for (Index i = 0; i < out.size(); ++i) {
    if (std::isnan(out[i]) || std::abs(out[i]) < kOutstanding * noise) continue;
    // A pulse may lie across the border of two rows.
    double turns = out[i] * t.step_s;
    const bool shared =
        i + 1 < out.size() && std::abs(out[i + 1]) > kOutstanding * noise && out[i + 1] * out[i] > 0.0;
    if (shared) turns += out[i + 1] * t.step_s;
    const double whole = std::round(turns);
    if (whole != 0.0 && std::abs(turns - whole) < kWhole) {
      events.slips.push_back(i);
      if (shared) ++i;
    }
  }
  return events;
}

Telemetry without_events(const Telemetry& telemetry, const Events& events) {
  Telemetry t = telemetry;
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  for (const Index row : events.repeats)
    for (const Output output : kOutputs)
      if (t.has(output)) t.outputs[place(output)][row] = kNothing;
  for (const Index row : events.slips)
    for (Index k = row; k <= std::min(row + 1, t.rows() - 1); ++k)
      t.outputs[place(Output::frequency)][k] = kNothing;
  return t;
}

}  // namespace hemi::diagnosis

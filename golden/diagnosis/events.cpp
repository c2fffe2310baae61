// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/events.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace hemi::diagnosis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
constexpr double kOutstanding = 20.0;
constexpr double kWhole = 0.1;
constexpr Index kNeighbours = 4;
constexpr double kLineLog_p = -16.11809565095832;  // 1e-7: six spectra a recording, tails not quite Gaussian
constexpr Index kMedianBins = 101;
constexpr double kSlowRows = 25.0;
constexpr double kLeastMove_hz = 0.5;
constexpr double kOutputRate_hz = 200.0;

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

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
  std::vector<double> sizes;
  for (const double v : values)
    if (!std::isnan(v)) sizes.push_back(std::abs(v));
  return median(std::move(sizes)) / 0.674489750196082;
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

namespace {

struct Peak {
  double ratio = 0.0;  // power over the local median's mean
  Index bin = 0;
  double level = 0.0;  // noise power of a bin there
};

// Periodogram of e exp(-j phase); both signs of frequency where a phase was taken out.
Peak highest(const VectorXd& e, const VectorXd& phase) {
  Eigen::VectorXcd turned(e.size());
  for (Index i = 0; i < e.size(); ++i) turned[i] = std::polar(e[i], -phase[i]);
  Eigen::FFT<double> fft;
  Eigen::VectorXcd spectrum;
  fft.fwd(spectrum, turned);
  const bool plain = phase.isZero();
  const Index bins = plain ? e.size() / 2 : e.size();
  const VectorXd power = spectrum.head(bins).cwiseAbs2();
  Peak best;
  // Below a fiftieth of the row rate noise is red and effects live.
  for (Index begin = plain ? e.size() / 50 + 1 : 0; begin < bins; begin += kMedianBins) {
    const Index count = std::min(kMedianBins, bins - begin);
    if (count < 20) break;
    const VectorXd part = power.segment(begin, count);
    const double level = median({part.begin(), part.end()}) / std::numbers::ln2;
    Index at = 0;
    const double top = part.maxCoeff(&at);
    if (level > 0.0 && top / level > best.ratio) best = {top / level, begin + at, level};
  }
  return best;
}

}  // namespace

std::optional<Line> find_line(const Telemetry& t, const Simulation& s, Output output,
                              const VectorXd& residual) {
  VectorXd e = residual;
  Index valid = 0;
  for (double& value : e) {
    if (std::isnan(value))
      value = 0.0;
    else
      ++valid;
  }
  if (valid < 512) return std::nullopt;
  // What is slow would be spread by the carrier's phase.
  e -= smoothed(e, t.step_s, kSlowRows * t.step_s).matrix();
  const Eigen::ArrayXd frequency = s.smooth_f + s.model.bias_reference_hz;
  // Phase of the carrier itself, by the recorded frequency where there is one.
  Eigen::ArrayXd recorded = frequency;
  if (t.has(Output::frequency)) {
    const Eigen::ArrayXd counted = t[Output::frequency];
    recorded = counted.isNaN().select(frequency, counted);
  }
  const double moved = frequency.maxCoeff() - frequency.minCoeff();
  std::optional<Line> best;
  double best_ratio = 0.0;
  for (const int harmonic : {0, 1, 2}) {
    // A carrier that stands still is a standing line; taking its phase out would move red noise elsewhere.
    if (harmonic > 0 && moved < kLeastMove_hz) continue;
    VectorXd phase = VectorXd::Zero(e.size());
    double turns = 0.0;
    for (Index i = 0; harmonic > 0 && i < e.size(); ++i) {
      phase[i] = 2.0 * std::numbers::pi * std::fmod(turns, 1.0);
      turns += harmonic * recorded[i] * t.step_s;
    }
    const Peak peak = highest(e, phase);
    // Three spectra, and as many bins as rows in each.
    const double log_p = std::log(3.0 * static_cast<double>(e.size())) - peak.ratio;
    if (log_p > kLineLog_p || peak.ratio <= best_ratio) continue;
    best_ratio = peak.ratio;
    Line line;
    line.output = output;
    line.harmonic = harmonic;
    line.log_p = log_p;
    const auto rows = static_cast<double>(valid);
    line.amplitude = 2.0 * std::sqrt(std::max(peak.ratio - 1.0, 0.0) * peak.level) / rows;
    line.amplitude_deviation = std::sqrt(2.0 * peak.level) / rows;
    const double bin_hz = 1.0 / (static_cast<double>(e.size()) * t.step_s);
    if (harmonic == 0) {
      line.frequency_hz = static_cast<double>(peak.bin) * bin_hz;
    } else {
      // Folded by the core's output first, then by the rows.
      const double folded = std::remainder(harmonic * recorded[0], kOutputRate_hz);
      line.frequency_hz = std::abs(std::remainder(folded, 1.0 / t.step_s));
    }
    best = line;
  }
  return best;
}

}  // namespace hemi::diagnosis

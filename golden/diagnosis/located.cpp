// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/located.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <unsupported/Eigen/FFT>

namespace hemi::diagnosis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
constexpr double kWindow_s = 300.0;
constexpr double kMost = 0.9;
constexpr double kLeastShare = 0.01;
constexpr double kOneWay = 0.8;

// Indices whose values, taken largest first, make up `share` of the whole.
std::vector<bool> holding(const std::vector<double>& energy, double share) {
  std::vector<std::size_t> order(energy.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return energy[a] > energy[b]; });
  const double whole = std::accumulate(energy.begin(), energy.end(), 0.0);
  std::vector<bool> kept(energy.size(), false);
  double sum = 0.0;
  for (const std::size_t i : order) {
    if (sum >= share * whole) break;
    kept[i] = true;
    sum += energy[i];
  }
  return kept;
}

// Squared deviations of the misfit in every window, and its rows in units of the output.
struct Misfit {
  VectorXd values;
  std::vector<double> energy;

  double whole() const { return std::accumulate(energy.begin(), energy.end(), 0.0); }
};

class Windows {
 public:
  explicit Windows(const TelemetryDiagnosis& d)
      : step_s_(d.telemetry->step_s),
        block_s_(step_s_ * static_cast<double>(d.hypotheses->space().block_rows())),
        count_(static_cast<std::size_t>(static_cast<double>(d.telemetry->rows()) * step_s_ / kWindow_s) + 1) {
  }

  std::size_t count() const { return count_; }
  std::size_t of_row(Index row) const { return at((static_cast<double>(row) + 0.5) * step_s_); }
  std::size_t of_block(Index block) const { return at((static_cast<double>(block) + 0.5) * block_s_); }
  Index first_row(std::size_t window) const {
    return static_cast<Index>(std::ceil(static_cast<double>(window) * kWindow_s / step_s_));
  }

 private:
  std::size_t at(double time_s) const {
    return std::min(count_ - 1, static_cast<std::size_t>(time_s / kWindow_s));
  }
  double step_s_, block_s_;
  std::size_t count_;
};

// Under the noise that is expected: residuals of doing without and of the diagnosis's members, and what the
// baseline spans.
struct UnderExpected {
  explicit UnderExpected(const TelemetryDiagnosis& d)
      : baseline(d.hypotheses->fit({}, d.hypotheses->expected()).residual),
        members(d.hypotheses->fit(d.members, d.hypotheses->expected()).residual),
        own(whiten(d.hypotheses->space(), d.hypotheses->expected(), d.hypotheses->baseline_rows())) {}

  Reduced baseline, members;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> own;
};

// A column of one output less what the baseline takes of it.
VectorXd beside_baseline(const Hypotheses& h, const UnderExpected& fits, Output output,
                         const VectorXd& column) {
  const std::size_t c = place(output);
  Reduced alone;
  for (const Output each : kOutputs) alone[place(each)] = Eigen::MatrixXd::Zero(h.space().rows(each), 1);
  alone[c].col(0) = column;
  const VectorXd white = whiten(h.space(), h.expected(), alone).col(0);
  return column - h.baseline_rows()[c] * fits.own.solve(white);
}

// What effects and free functions take off beside the baseline, colour beyond the stated one, and slips.
Misfit misfit_of(const TelemetryDiagnosis& d, const Windows& windows, const UnderExpected& fits,
                 Output output) {
  const std::size_t c = place(output);
  const Hypotheses& h = *d.hypotheses;
  const auto& blocks = h.space().blocks(output);
  const auto noise = coloured_noise(h.expected()[c], h.space().block_count());
  Misfit misfit;
  misfit.values = fits.baseline[c].col(0) - fits.members[c].col(0);
  for (const auto& remainder : d.remainders)
    if (remainder.output == output && remainder.fitted.size() == misfit.values.size())
      misfit.values += beside_baseline(h, fits, output, remainder.fitted);
  misfit.energy.assign(windows.count(), 0.0);
  const bool coloured =
      std::ranges::any_of(d.colours, [&](const Colour& each) { return each.output == output; }) ||
      std::ranges::any_of(d.remainders, [&](const Remainder& each) {
        return each.output == output && each.variable.empty();
      });
  const VectorXd white = whiten(misfit.values, blocks, noise);
  const VectorXd left = whiten(fits.members[c], blocks, noise);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto k = static_cast<Index>(i);
    misfit.energy[windows.of_block(blocks[i])] +=
        white[k] * white[k] + (coloured ? left[k] * left[k] - 1.0 : 0.0);
  }
  for (double& energy : misfit.energy) energy = std::max(energy, 0.0);
  if (coloured) misfit.values += fits.members[c].col(0);
  if (output == Output::frequency) {
    // A pulse of one turn within one row.
    const double row = h.expected()[c].white * static_cast<double>(h.space().block_rows());
    const double pulse = std::pow(1.0 / d.telemetry->step_s, 2) / std::max(row, 1e-300);
    for (const Index slip : d.events.slips) misfit.energy[windows.of_row(slip)] += pulse;
  }
  return misfit;
}

// Range of the case over the windows that hold the misfit, and which way it went there.
void add_region(Located& entry, const TelemetryDiagnosis& d, const Misfit& misfit,
                const std::vector<bool>& kept, const Windows& windows) {
  const Simulation& s = d.hypotheses->simulation();
  entry.variable = "case_temp_degc";
  entry.low = 1e300;
  entry.high = -1e300;
  double up = 0.0, whole = 0.0;
  for (std::size_t w = 0; w < kept.size(); ++w) {
    if (!kept[w]) continue;
    const Index begin = windows.first_row(w);
    const Index count = std::min(windows.first_row(w + 1), s.smooth_case_degc.size()) - begin;
    if (count <= 0) continue;
    const auto degc = s.smooth_case_degc.segment(begin, count);
    entry.low = std::min(entry.low, degc.minCoeff());
    entry.high = std::max(entry.high, degc.maxCoeff());
    whole += misfit.energy[w];
    if (degc[count - 1] > degc[0]) up += misfit.energy[w];
  }
  entry.when = up > kOneWay * whole ? "heating" : up < (1.0 - kOneWay) * whole ? "cooling" : "always";
}

void add_band(Located& entry, const VectorXd& values, double block_s) {
  Eigen::FFT<double> fft;
  const VectorXd centred = values.array() - values.mean();
  Eigen::VectorXcd spectrum;
  fft.fwd(spectrum, centred);
  const Index bins = values.size() / 2;
  std::vector<double> power;
  for (Index k = 1; k <= bins; ++k) power.push_back(std::norm(spectrum[k]));
  const double whole = std::accumulate(power.begin(), power.end(), 0.0);
  const double step_hz = 1.0 / (static_cast<double>(values.size()) * block_s);
  double sum = 0.0;
  entry.low_hz = 0.0;
  for (std::size_t k = 0; k < power.size(); ++k) {
    const double before = sum;
    sum += power[k];
    if (before < 0.05 * whole && sum >= 0.05 * whole) entry.low_hz = static_cast<double>(k + 1) * step_hz;
    if (before < 0.95 * whole && sum >= 0.95 * whole) entry.high_hz = static_cast<double>(k + 1) * step_hz;
  }
}

Located slow(const TelemetryDiagnosis& d, const Windows& windows, Output output, const Misfit& misfit) {
  Located entry;
  entry.output = output;
  entry.share = misfit.whole();
  const auto kept = holding(misfit.energy, kMost);
  for (std::size_t w = 0; w < kept.size(); ++w) {
    if (!kept[w]) continue;
    const double begin = kWindow_s * static_cast<double>(w);
    if (!entry.time_s.empty() && entry.time_s.back().second == begin)
      entry.time_s.back().second = begin + kWindow_s;
    else
      entry.time_s.emplace_back(begin, begin + kWindow_s);
  }
  add_region(entry, d, misfit, kept, windows);
  add_band(entry, misfit.values,
           d.telemetry->step_s * static_cast<double>(d.hypotheses->space().block_rows()));
  return entry;
}

// A line is everywhere in time and in one band.
Located fast(const TelemetryDiagnosis& d, const Line& line) {
  const auto& degc = d.hypotheses->simulation().smooth_case_degc;
  Located entry;
  entry.output = line.output;
  entry.share = std::pow(line.amplitude / line.amplitude_deviation, 2);
  entry.time_s = {{0.0, d.telemetry->step_s * static_cast<double>(d.telemetry->rows())}};
  entry.variable = "case_temp_degc";
  entry.low = degc.minCoeff();
  entry.high = degc.maxCoeff();
  entry.when = "always";
  entry.low_hz = line.low_hz;
  entry.high_hz = line.high_hz;
  return entry;
}

}  // namespace

std::vector<Located> locate(const TelemetryDiagnosis& d) {
  std::vector<Located> list;
  const Windows windows(d);
  const UnderExpected fits(d);
  double whole = 0.0;
  for (const Output output : kOutputs) {
    if (d.hypotheses->space().rows(output) < 16) continue;
    const Misfit misfit = misfit_of(d, windows, fits, output);
    if (misfit.whole() > 0.0) list.push_back(slow(d, windows, output, misfit));
  }
  for (const auto& line : d.lines) list.push_back(fast(d, line));
  for (const auto& entry : list) whole += entry.share;
  std::erase_if(list, [&](const Located& entry) { return entry.share < kLeastShare * whole; });
  for (auto& entry : list) entry.share /= whole;
  std::ranges::stable_sort(list, [](const Located& a, const Located& b) { return a.share > b.share; });
  return list;
}

}  // namespace hemi::diagnosis

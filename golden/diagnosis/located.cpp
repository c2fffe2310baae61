// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/located.hpp"

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

struct Misfit {
  VectorXd values;  // a row of the output each
  double energy = 0.0;
};

Misfit misfit_of(const TelemetryDiagnosis& d, Output output) {
  const std::size_t c = place(output);
  Misfit misfit;
  misfit.values = d.baseline.residual[c].col(0) - d.final.residual[c].col(0);
  for (const auto& remainder : d.remainders)
    if (remainder.output == output && remainder.fitted.size() == misfit.values.size())
      misfit.values += remainder.fitted;
  misfit.energy = misfit.values.squaredNorm() / d.hypotheses->expected()[c].white;
  return misfit;
}

// Inputs of a window: the mean of x over its rows.
void add_region(Located& entry, const TelemetryDiagnosis& d, const std::vector<double>& energy,
                const std::vector<bool>& kept, Index rows_a_window) {
  const Simulation& s = d.hypotheses->simulation();
  entry.variable = "case_temp_degc";
  entry.low = 1e300;
  entry.high = -1e300;
  double up = 0.0, whole = 0.0;
  for (std::size_t w = 0; w < kept.size(); ++w) {
    if (!kept[w]) continue;
    const Index begin = static_cast<Index>(w) * rows_a_window;
    const Index count = std::min(rows_a_window, s.smooth_case_degc.size() - begin);
    if (count <= 0) continue;
    const auto degc = s.smooth_case_degc.segment(begin, count);
    entry.low = std::min(entry.low, degc.minCoeff());
    entry.high = std::max(entry.high, degc.maxCoeff());
    whole += energy[w];
    if (degc[count - 1] > degc[0]) up += energy[w];
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

}  // namespace

std::vector<Located> locate(const TelemetryDiagnosis& d) {
  std::vector<Located> list;
  std::array<Misfit, kOutputs.size()> misfits;
  double whole = 0.0;
  const RowSpace& space = d.hypotheses->space();
  for (const Output output : kOutputs) {
    if (space.rows(output) < 16) continue;
    misfits[place(output)] = misfit_of(d, output);
    whole += misfits[place(output)].energy;
  }
  if (whole <= 0.0) return list;
  const double step_s = d.hypotheses->simulation().telemetry->step_s;
  const double block_s = step_s * static_cast<double>(space.block_rows());
  for (const Output output : kOutputs) {
    const Misfit& misfit = misfits[place(output)];
    if (misfit.energy < kLeastShare * whole) continue;
    Located entry;
    entry.output = output;
    entry.share = misfit.energy / whole;
    const auto blocks_a_window = std::max<Index>(1, std::lround(kWindow_s / block_s));
    std::vector<double> energy(static_cast<std::size_t>(space.block_count() / blocks_a_window + 1), 0.0);
    const auto& blocks = space.blocks(output);
    for (std::size_t i = 0; i < blocks.size(); ++i)
      energy[static_cast<std::size_t>(blocks[i] / blocks_a_window)] +=
          misfit.values[static_cast<Index>(i)] * misfit.values[static_cast<Index>(i)];
    const auto kept = holding(energy, kMost);
    const double window_s = block_s * static_cast<double>(blocks_a_window);
    for (std::size_t w = 0; w < kept.size(); ++w) {
      if (!kept[w]) continue;
      const double begin = window_s * static_cast<double>(w);
      if (!entry.time_s.empty() && entry.time_s.back().second == begin)
        entry.time_s.back().second = begin + window_s;
      else
        entry.time_s.emplace_back(begin, begin + window_s);
    }
    add_region(entry, d, energy, kept, blocks_a_window * space.block_rows());
    add_band(entry, misfit.values, block_s);
    list.push_back(std::move(entry));
  }
  return list;
}

}  // namespace hemi::diagnosis

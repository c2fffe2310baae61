// SPDX-License-Identifier: Apache-2.0
#include "golden/diagnosis/row_space.hpp"

#include <algorithm>
#include <cmath>

namespace hemi::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

}  // namespace

RowSpace::RowSpace(const Telemetry& telemetry, Index most_rows) {
  const Index n = telemetry.rows();
  length_ = std::max<Index>(1, (n + most_rows - 1) / most_rows);
  blocks_ = n / length_;
  for (const Output output : kOutputs) {
    const std::size_t c = place(output);
    if (!telemetry.has(output)) continue;
    for (Index b = 0; b < blocks_; ++b) {
      std::vector<Index> rows;
      for (Index i = b * length_; i < (b + 1) * length_; ++i)
        if (!std::isnan(telemetry[output][i])) rows.push_back(i);
      if (2 * static_cast<Index>(rows.size()) < length_) continue;
      block_of_[c].push_back(b);
      valid_[c].push_back(std::move(rows));
    }
  }
}

Index RowSpace::rows() const {
  Index total = 0;
  for (const Output output : kOutputs) total += rows(output);
  return total;
}

Reduced RowSpace::reduce(const std::vector<const Trace*>& traces) const {
  Reduced reduced;
  for (const Output output : kOutputs) {
    const std::size_t c = place(output);
    reduced[c] = Eigen::MatrixXd::Zero(rows(output), static_cast<Index>(traces.size()));
    for (std::size_t j = 0; j < traces.size(); ++j) {
      const VectorXd& full = (*traces[j])[output];
      if (full.size() == 0) continue;
      for (Index r = 0; r < rows(output); ++r) {
        const auto& list = valid_[c][static_cast<std::size_t>(r)];
        double sum = 0.0;
        for (const Index i : list) sum += full[i];
        reduced[c](r, static_cast<Index>(j)) = sum / static_cast<double>(list.size());
      }
    }
  }
  return reduced;
}

double case_noise_degc(const Telemetry& telemetry) {
  const VectorXd& x = telemetry.case_degc;
  double squares = 0.0;
  Index count = 0;
  for (Index i = 1; i + 1 < x.size(); ++i, ++count) squares += std::pow(x[i + 1] - 2.0 * x[i] + x[i - 1], 2);
  return count == 0 ? 0.0 : std::sqrt(squares / (6.0 * static_cast<double>(count)));
}

Noise expected_noise(const Simulation& simulation, const RowSpace& space, const Reduced& residual) {
  Noise noise;
  const Telemetry& telemetry = *simulation.telemetry;
  const double block_s = telemetry.step_s * static_cast<double>(space.block_rows());
  for (const Output output : kOutputs) {
    const std::size_t c = place(output);
    NoiseShape& own = noise[c];
    std::vector<double> steps;
    const auto& blocks = space.blocks(output);
    for (std::size_t i = 1; i < blocks.size(); ++i)
      if (blocks[i] == blocks[i - 1] + 1)
        steps.push_back((residual[c](static_cast<Index>(i), 0) - residual[c](static_cast<Index>(i) - 1, 0)) /
                        std::sqrt(2.0));
    own.white = std::pow(std::max(robust_deviation(std::move(steps)), 1e-300), 2);
    own.flicker = std::pow(simulation.model.noise[c].flicker, 2) * kFlickerPerProcess;
    own.walk = std::pow(simulation.model.noise[c].walk, 2) * block_s;
    // Neighbouring blocks differ by the red parts as well.
    double red =
        own.walk / 3.0 + own.flicker * (1.0 - flicker_correlations(space.block_count()).array()).sum();
    if (output == Output::frequency && telemetry.has_case) {
      const double tau = simulation.model.time_constant_s;
      const double gain = -std::expm1(-telemetry.step_s / tau);
      own.behind = simulation.frequency_per_degc.square().mean() * std::pow(case_noise_degc(telemetry), 2) *
                   gain / (2.0 - gain);
      own.behind_correlation = std::exp(-block_s / tau);
      red += own.behind * (1.0 - own.behind_correlation);
    }
    own.white = std::max(own.white - red, 0.1 * own.white);
  }
  return noise;
}

MatrixXd whiten(const RowSpace& space, const Noise& noise, const Reduced& columns) {
  MatrixXd stacked(space.rows(), columns[0].cols());
  Index at = 0;
  for (const Output output : kOutputs) {
    const std::size_t c = place(output);
    const Index rows = space.rows(output);
    if (rows == 0) continue;
    stacked.middleRows(at, rows) =
        whiten(columns[c], space.blocks(output), coloured_noise(noise[c], space.block_count()));
    at += rows;
  }
  return stacked;
}

}  // namespace hemi::diagnosis

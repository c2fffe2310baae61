// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "golden/diagnosis/coloured_noise.hpp"
#include "golden/diagnosis/nominal_simulation.hpp"

namespace hemi::diagnosis {

/// A trace, or many side by side, as means over blocks of rows; an output that was not recorded has none.
using Reduced = std::array<Eigen::MatrixXd, kOutputs.size()>;

/// Means over blocks of equal length of those rows that an output has; a block with less than half of them is
/// left out.
class RowSpace {
 public:
  /// At most about `most_rows` blocks an output.
  RowSpace(const Telemetry& telemetry, Eigen::Index most_rows);

  Eigen::Index block_rows() const { return length_; }
  Eigen::Index rows(Output output) const {
    return static_cast<Eigen::Index>(block_of_[place(output)].size());
  }
  Eigen::Index rows() const;
  /// Block number, from 0 at the start of the recording, of each row of an output.
  const std::vector<Eigen::Index>& blocks(Output output) const { return block_of_[place(output)]; }
  Eigen::Index block_count() const { return blocks_; }

  /// One column an entry; outputs that a trace leaves alone are zero.
  Reduced reduce(const std::vector<const Trace*>& traces) const;

 private:
  std::array<std::vector<std::vector<Eigen::Index>>, kOutputs.size()> valid_;  // rows of each kept block
  std::array<std::vector<Eigen::Index>, kOutputs.size()> block_of_;
  Eigen::Index length_ = 1, blocks_ = 0;
};

/// Noise of the reduced outputs, independent between them.
using Noise = std::array<NoiseShape, kOutputs.size()>;

/// Noise that is known before any effect is looked for: white of the size that neighbouring blocks of the
/// residual differ by, the colour that the model states, and in the frequency what the case thermometer's own
/// noise becomes behind the resonator's time constant: variance f'(T)^2 s^2 a / (2 - a), a = 1 - exp(-step /
/// tau), correlation exp(-t / tau).
Noise expected_noise(const Simulation& simulation, const RowSpace& space, const Reduced& residual);

/// Outputs stacked, whitened.
Eigen::MatrixXd whiten(const RowSpace& space, const Noise& noise, const Reduced& columns);

/// Standard deviation of the case thermometer's noise, its steps included, from second differences.
double case_noise_degc(const Telemetry& telemetry);

}  // namespace hemi::diagnosis

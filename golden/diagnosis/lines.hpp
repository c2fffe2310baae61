// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "golden/diagnosis/nominal_simulation.hpp"

namespace hemi::diagnosis {

/// A sinusoid in the residual of one output.
struct Line {
  Output output = Output::rate;
  int harmonic = 0;  ///< of the resonator's frequency that it follows; 0: it stands still
  double amplitude = 0.0, amplitude_deviation = 0.0;
  double frequency_hz = 0.0, frequency_deviation_hz = 0.0;  ///< at the start; as the rows show it
  double low_hz = 0.0, high_hz = 0.0;                       ///< where it stands or moves
  double log_p = 0.0;  ///< of noise alone showing a peak as high anywhere, natural logarithm
};

/// The strongest line of an output's residual (one column, a value a row, NaN where missing) by its
/// periodogram over the local median, plain and with the phase of one and two times the frequency taken out;
/// nothing above p = 1e-7 for all bins together.
std::optional<Line> find_line(const Telemetry& telemetry, const Simulation& simulation, Output output,
                              const Eigen::VectorXd& residual);

}  // namespace hemi::diagnosis

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "golden/diagnosis/nominal_simulation.hpp"

namespace hemi::diagnosis {

/// Faults that single rows show.
struct Events {
  std::vector<Eigen::Index> repeats;  ///< rows that repeat the one before in every output
  std::vector<Eigen::Index> slips;    ///< rows of the frequency that hold a pulse of one turn
};

/// repeats: all outputs, two at least, equal to the row before to the last digit. slips: the frequency less
/// the simulation stands out of its neighbours' median by a pulse whose area is a whole number of turns
/// within a tenth, and by 20 deviations.
Events find_events(const Telemetry& telemetry, const Simulation& simulation);

/// The telemetry without the rows that events have spoilt.
Telemetry without_events(const Telemetry& telemetry, const Events& events);

/// A sinusoid in the residual of one output.
struct Line {
  Output output = Output::rate;
  int harmonic = 0;  ///< of the resonator's frequency that it follows; 0: it stands still
  double amplitude = 0.0, amplitude_deviation = 0.0;
  double frequency_hz = 0.0;  ///< at the start; as the rows show it
  double log_p = 0.0;         ///< of noise alone showing a peak as high anywhere, natural logarithm
};

/// The strongest line of an output's residual (one column, a value a row, NaN where missing) by its
/// periodogram over the local median, plain and with the phase of one and two times the frequency taken out;
/// nothing above p = 1e-7 for all bins together.
std::optional<Line> find_line(const Telemetry& telemetry, const Simulation& simulation, Output output,
                              const Eigen::VectorXd& residual);

}  // namespace hemi::diagnosis

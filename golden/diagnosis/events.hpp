// SPDX-License-Identifier: Apache-2.0
#pragma once

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

}  // namespace hemi::diagnosis

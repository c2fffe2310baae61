// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/scenario/scenario.hpp"
#include "golden/loops/control.hpp"

namespace hemi::scenario {

inline loops::CoreSampling core_sampling(const Scenario& scenario) {
  return scenario.wide ? loops::CoreSampling::wide() : loops::CoreSampling::reference();
}

/// Bandwidths and set point of the scenario; the nco starts from the frequency at the chamber's first
/// temperature.
inline loops::ControlWishes control_wishes(const Scenario& scenario) {
  loops::ControlWishes wishes;
  wishes.reference_phase_hz = scenario.loops.reference_phase_hz;
  wishes.rebalance_hz = scenario.loops.rebalance_hz;
  wishes.quadrature_hz = scenario.loops.quadrature_hz;
  wishes.amplitude_hz = scenario.loops.amplitude_hz;
  wishes.amplitude_setpoint = scenario.inputs.setpoint.value(0.0);
  wishes.start_degc = scenario.inputs.chamber_degc.value(0.0);
  return wishes;
}

}  // namespace hemi::scenario

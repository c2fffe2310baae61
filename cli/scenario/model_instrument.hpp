// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "cli/recording/model.hpp"
#include "golden/physics/instrument.hpp"
#include "golden/physics/slow_twin.hpp"
#include "golden/physics/world.hpp"

namespace hemi::scenario {

/// Range over which the drift that the damping mismatch makes is written as a cubic in f.
struct TemperatureRange {
  double low_degc = -40.0;
  double high_degc = 85.0;
};

/// How telemetry is made, as far as its noise depends on it.
struct TelemetryMaking {
  double interval_s = 1.0;
  physics::LoopBandwidths loops{};
};

/// The nominal `hemi-model/1` of an instrument: all that this format can say of it, without effects.
///
///     frequency   f(T) less half of the split along the primary axis, which is what the primary mode has
///     bias        the instrument's own terms, and d sin(2 th_tau) / (2 kappa) of the damping mismatch as a
///     cubic in f drive       full_scale_v (1/tau + d cos(2 th_tau) / 2) / (growth by full scale) quadrature
///     -full_scale_v dw sin(2 th_w) / (split by full scale) noise       docs/scenarios.md
///
/// Throws std::invalid_argument where f(T) is not monotonic over the range.
recording::InstrumentModel nominal_model(const physics::Instrument& instrument, double setpoint,
                                         double scale_factor, const TemperatureRange& range,
                                         const TelemetryMaking& making);

/// `base` changed so that its nominal model is `model`; what the model does not hold stays. The drive's
/// polynomial becomes relative_damping, the quadrature's the split. InputError naming the file for values
/// that no instrument has (a drive of zero at 20 degC, ...).
physics::Instrument instrument_of(const recording::InstrumentModel& model, const physics::Instrument& base,
                                  const TemperatureRange& range);

/// The `effects` of a corrected model: [{"id": ..., "parameters": {name: number or {"value": ...}}}, ...].
/// InputError where they are not of that form; ids and values are checked by the catalogue.
std::vector<physics::ActiveEffect> effects_of(const recording::InstrumentModel& model);

}  // namespace hemi::scenario
